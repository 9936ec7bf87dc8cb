//! Each sub-buffer with its own lights: neighbouring threads walk one list. Shader: sub_buffers.comp.
//! reads  split.position, split.normal, the lights      writes  shade.irradiance  sub-buffers, 8 B a texel

use super::super::NAME;
use super::super::sub_buffers::{Stage, Storage, Surface, Texels};
use super::{ShadeGpu, constants};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::interleaved_deferred::shade::sub_buffers::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::{DirectGpu, ShadingSettings};
use std::sync::Arc;

pub struct ShadeSubBuffers {
    pipeline: ComputePipeline,
    storage: Storage,
    texel_bytes: u64,
}

impl ShadeSubBuffers {
    pub fn new(gpu: &Arc<Gpu>, settings: &ShadingSettings, storage: Storage) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[settings.position.name(), storage.name()]);
        let pipeline = ComputePipeline::new(gpu, shader, &constants(settings))?;
        Ok(Self { pipeline, storage, texel_bytes: 8 + settings.position.bytes() })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        shade: &ShadeGpu,
        direct: &DirectGpu,
        split: Edge<'_, Surface>,
        irradiance: &Texels,
    ) -> Result<()> {
        let mapping = shade.mapping();
        let texels = mapping.texel_count();
        let traffic =
            Traffic { read_bytes: texels * self.texel_bytes, written_bytes: texels * 8, invocations: Some(texels) };
        cmd.pass(&format!("{NAME}.shade"), traffic, |cmd| {
            cmd.barriers(split.to(self.storage.read(Stage::Compute)));
            cmd.barriers([irradiance.discard(Access::ComputeWrite)]);
            let mut bound = shade.bound(frame, direct);
            bound.extend(split.resource.source());
            bound.push(("target_irradiance", irradiance.target()));
            // Rows do not matter here: a workgroup takes whatever texels of its sub-buffer come next.
            let [x, y, _] = self.pipeline.workgroup;
            let groups = [(mapping.sub_texel_count() as u32).div_ceil(x), 1u32.div_ceil(y), mapping.subset_count()];
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&shade.params), &bound, groups)
        })
    }
}
