//! Initial pass of a component: the first iterations of every pixel (Dubla 2009, Listing 1, lines 1 to 7). Shader:
//! sample.comp.
//! reads   the G-buffer, the tree, the component's samples
//! writes  estimates  buffer, 16 B a pixel    rays  buffer, 4 B a pixel
//!         a stretch of adaptive_interleaved.irradiance  buffer, 8 B a pixel

use super::buffers::{ComponentBuffers, Shared};
use super::choices::{Choices, ComponentChoice};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::adaptive_interleaved::sample::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Barrier, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::gbuffer::GBuffer;
use std::sync::Arc;

pub struct SamplePass {
    pipeline: ComputePipeline,
}

impl SamplePass {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, choice: &ComponentChoice) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[choices.position.name(), choice.component.name()]);
        let constants = [&choices.workgroup_constants()[..], &choices.ray_constants()].concat();
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)? })
    }

    /// `irradiance`: how its buffer becomes writable.
    pub fn record(
        &self,
        cmd: &mut Commands,
        buffers: &ComponentBuffers,
        shared: &Shared<'_>,
        gbuffer: Edge<'_, GBuffer>,
        irradiance: Barrier,
        estimates: &Buffer,
    ) -> Result<()> {
        let extent = gbuffer.resource.extent();
        cmd.pass(&buffers.label("sample"), traffic(gbuffer.resource), |cmd| {
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers([estimates, &buffers.rays].map(|buffer| buffer.discard(Access::ComputeWrite)));
            cmd.barriers([irradiance]);
            let mut bound = buffers.bound(shared, gbuffer.resource);
            bound.push(("Estimates", Bound::Buffer(estimates)));
            let bound = self.pipeline.interface.own(&bound);
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&buffers.params), &bound, groups)
        })
    }
}

/// What estimating every pixel moves, the samples and the tree apart.
pub fn traffic(gbuffer: &GBuffer) -> Traffic {
    let pixels = gbuffer.extent().pixel_count();
    Traffic {
        read_bytes: pixels * gbuffer.surface_bytes(),
        written_bytes: pixels * (16 + 4 + 8),
        invocations: Some(pixels),
    }
}
