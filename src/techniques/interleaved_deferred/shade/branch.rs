//! One pass over the un-split G-buffer, each pixel with its own subset. Segovia 2006, section 3.1. Shader: branch.comp.
//! reads  the G-buffer, the lights      writes  the irradiance  buffer, frame order, 8 B a pixel

use super::super::choices::Choices;
use super::ShadeGpu;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::interleaved_deferred::shade::branch::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::GBuffer;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct ShadeBranch {
    pipeline: ComputePipeline,
}

impl ShadeBranch {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &choices.shade_axes());
        let constants = [&choices.shading.workgroup_constants()[..], &choices.irradiance_constants()].concat();
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)? })
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
        let extent = gbuffer.resource.extent();
        let pixels = extent.pixel_count();
        let traffic = Traffic {
            read_bytes: shade
                .read_bytes(direct, shade.mapping().subset_count(), pixels, pixels)
                .map(|bytes| pixels * gbuffer.resource.parts_bytes(shade.parts) + bytes),
            written_bytes: Some(pixels * 8),
            invocations: Some(pixels),
        };
        cmd.pass(&format!("{NAME}.shade"), traffic, |cmd| {
            cmd.barriers(gbuffer.parts_to(shade.parts, Access::ComputeSample));
            cmd.barriers(shade.hidden_to(Access::ComputeRead));
            cmd.barriers([irradiance.discard(Access::ComputeWrite)]);
            let mut bound = shade.bound(frame, direct);
            bound.push(("Irradiance", Bound::Buffer(irradiance)));
            bound.extend(gbuffer.resource.bound_parts(shade.parts));
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&shade.params), &bound, groups)
        })
    }
}
