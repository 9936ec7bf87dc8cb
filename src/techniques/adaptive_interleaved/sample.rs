//! Initial pass of a component: the first iterations of every pixel (Dubla 2009, Listing 1, lines 1 to 7). Shader:
//! sample.comp.
//! reads   the G-buffer, the tree, the component's samples
//! writes  estimates  buffer, 16 B a texel    rays  buffer, 4 B a texel
//!         irradiance  buffer, 8 B a texel

use super::buffers::{ComponentBuffers, Shared};
use super::choices::{Choices, ComponentChoice};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::adaptive_interleaved::sample::COMP_VARIANTS;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::gbuffer::GBuffer;
use std::sync::Arc;

pub struct SamplePass {
    pipeline: ComputePipeline,
}

impl SamplePass {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, choice: &ComponentChoice) -> Result<Self> {
        let [x, y] = choices.workgroup_constants();
        let constants = [x, y, choices.order_constant()];
        let pipeline = choices.estimating_pipeline(gpu, COMP_VARIANTS, choice.component, &constants)?;
        Ok(Self { pipeline })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        buffers: &ComponentBuffers,
        shared: &Shared<'_>,
        gbuffer: Edge<'_, GBuffer>,
        estimates: &Buffer,
    ) -> Result<()> {
        cmd.pass(&buffers.label("sample"), traffic(buffers), |cmd| {
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers(
                [estimates, &buffers.rays, &buffers.irradiance].map(|buffer| buffer.discard(Access::ComputeWrite)),
            );
            let mut bound = buffers.bound(shared, gbuffer.resource);
            bound.push(("Estimates", Bound::Buffer(estimates)));
            let bound = self.pipeline.interface.own(&bound);
            // By slots the last tile of a row, which may be cut, has all of its threads.
            let across = buffers.params.tile_columns * buffers.params.tile_x;
            let groups = self.pipeline.groups([across, buffers.params.height, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&buffers.params), &bound, groups)
        })
    }
}

/// What estimating every texel moves; what it reads is up to the tree.
pub fn traffic(buffers: &ComponentBuffers) -> Traffic {
    let texels = u64::from(buffers.params.width) * u64::from(buffers.params.height);
    Traffic { read_bytes: None, written_bytes: Some(texels * (16 + 4 + 8)), invocations: Some(texels) }
}
