//! Sub-sampling: all lights at the middle pixel of each pattern. Segovia 2006, section 5.4. Shader: subsample.comp.
//! reads  the G-buffer, the lights      writes  shade.irradiance  buffer, a texel a pattern, 8 B each

use super::super::NAME;
use super::{ShadeGpu, constants};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::interleaved_deferred::shade::subsample::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::{DirectGpu, ShadingSettings};
use crate::passes::gbuffer::GBuffer;
use std::sync::Arc;

pub struct ShadeSubsample {
    pipeline: ComputePipeline,
}

impl ShadeSubsample {
    pub fn new(gpu: &Arc<Gpu>, settings: &ShadingSettings) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[settings.position.name()]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants(settings))? })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        shade: &ShadeGpu,
        direct: &DirectGpu,
        gbuffer: Edge<'_, GBuffer>,
        irradiance: &Buffer,
    ) -> Result<()> {
        let mapping = shade.mapping();
        let cells = mapping.sub_texel_count();
        let traffic = Traffic {
            read_bytes: cells * gbuffer.resource.surface_bytes(),
            written_bytes: cells * 8,
            invocations: Some(cells),
        };
        cmd.pass(&format!("{NAME}.shade"), traffic, |cmd| {
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers([irradiance.discard(Access::ComputeWrite)]);
            let mut bound = shade.bound(frame, direct);
            bound.push(("Irradiance", Bound::Buffer(irradiance)));
            bound.extend(gbuffer.resource.bound_surface());
            let groups = self.pipeline.groups([mapping.sub_width_px, mapping.sub_height_px, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&shade.params), &bound, groups)
        })
    }
}
