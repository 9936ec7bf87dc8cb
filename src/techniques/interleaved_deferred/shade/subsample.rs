//! Sub-sampling: all lights at the middle pixel of each pattern. Segovia 2006, section 5.4. Shader: subsample.comp.
//! reads  the G-buffer, the lights      writes  shade.irradiance  buffer, a texel a pattern, 8 B each

use super::super::choices::Choices;
use super::{ShadeGpu, TexelListPipeline};
use crate::error::Result;
use crate::gpu::shader::techniques::interleaved_deferred::shade::subsample::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::GBuffer;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct ShadeSubsample {
    listed: TexelListPipeline,
}

impl ShadeSubsample {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &choices.shade_axes());
        Ok(Self { listed: TexelListPipeline::new(gpu, choices, shader)? })
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
        let threads = self.listed.invocations(1);
        let traffic = Traffic {
            // The one subset has all lights.
            read_bytes: shade
                .read_bytes(direct, 1, threads, cells)
                .map(|bytes| cells * gbuffer.resource.parts_bytes(shade.parts) + bytes),
            written_bytes: Some(cells * 8),
            invocations: Some(threads),
        };
        cmd.pass(&format!("{NAME}.shade"), traffic, |cmd| {
            cmd.barriers(gbuffer.parts_to(shade.parts, Access::ComputeSample));
            cmd.barriers(shade.hidden_to(Access::ComputeRead));
            cmd.barriers([irradiance.discard(Access::ComputeWrite)]);
            let mut bound = shade.bound(frame, direct);
            bound.push(("Irradiance", Bound::Buffer(irradiance)));
            bound.extend(gbuffer.resource.bound_parts(shade.parts));
            let groups = [self.listed.workgroup_count, 1, 1];
            cmd.dispatch(&self.listed.pipeline, bytemuck::bytes_of(&shade.params), &bound, groups)
        })
    }
}
