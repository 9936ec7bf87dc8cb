//! Each sub-buffer with its own lights: neighbouring threads walk one list. Shader: sub_buffers.comp.
//! reads  split.position, split.normal, split.color where surfaces are glossy, the lights      writes  shade.irradiance  sub-buffers, 8 B a texel

use super::super::choices::Choices;
use super::super::sub_buffers::{Stage, Storage, Surface, Texels, texel_bytes};
use super::{ShadeGpu, TexelListPipeline};
use crate::error::Result;
use crate::gpu::shader::techniques::interleaved_deferred::shade::sub_buffers::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::DirectGpu;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct ShadeSubBuffers {
    listed: TexelListPipeline,
    storage: Storage,
    texel_bytes: u64,
}

impl ShadeSubBuffers {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, storage: Storage) -> Result<Self> {
        let [position, shadow, brdf] = choices.shade_axes();
        let shader = variant(COMP_VARIANTS, &[position, storage.name(), shadow, brdf]);
        let listed = TexelListPipeline::new(gpu, choices, shader)?;
        Ok(Self { listed, storage, texel_bytes: texel_bytes(choices.shaded(), choices.shading.position) })
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
        let threads = self.listed.invocations(mapping.subset_count());
        let light_bytes = shade.read_bytes(direct, mapping.subset_count(), threads, texels);
        let traffic = Traffic {
            read_bytes: light_bytes.map(|bytes| texels * self.texel_bytes + bytes),
            written_bytes: Some(texels * 8),
            invocations: Some(threads),
        };
        cmd.pass(&format!("{NAME}.shade"), traffic, |cmd| {
            cmd.barriers(split.to(shade.parts, self.storage.read(Stage::Compute)));
            cmd.barriers(shade.hidden_to(Access::ComputeRead));
            cmd.barriers([irradiance.discard(Access::ComputeWrite)]);
            let mut bound = shade.bound(frame, direct);
            bound.extend(split.resource.source(shade.parts));
            bound.push(("target_irradiance", irradiance.target()));
            // Rows do not matter here: a workgroup takes whatever texels of its sub-buffer come next.
            let groups = [self.listed.workgroup_count, 1, mapping.subset_count()];
            cmd.dispatch(&self.listed.pipeline, bytemuck::bytes_of(&shade.params), &bound, groups)
        })
    }
}
