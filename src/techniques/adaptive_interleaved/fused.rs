//! All three steps of a component in one dispatch: each tile iterates as often as it must (`--refine fused`). Dubla
//! 2009, Listing 1. Shader: fused.comp.
//! reads   the G-buffer, the tree, the component's samples
//! writes  rays  buffer, 4 B a texel    guidance  buffer, 4 B a tile
//!         irradiance  buffer, 8 B a texel

use super::buffers::{ComponentBuffers, Shared, rows_of_groups};
use super::choices::{Choices, ComponentChoice};
use super::sample;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::adaptive_interleaved::bins::REFINE_LANES;
use crate::gpu::shader::techniques::adaptive_interleaved::fused::COMP_VARIANTS;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu};
use crate::passes::gbuffer::GBuffer;
use std::sync::Arc;

pub struct FusedPass {
    pipeline: ComputePipeline,
}

impl FusedPass {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, choice: &ComponentChoice) -> Result<Self> {
        let pipeline = choices.estimating_pipeline(gpu, COMP_VARIANTS, choice.component, &[])?;
        Ok(Self { pipeline })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        buffers: &ComponentBuffers,
        shared: &Shared<'_>,
        gbuffer: Edge<'_, GBuffer>,
        guidance: &Buffer,
    ) -> Result<()> {
        cmd.pass(&buffers.label("sample"), sample::traffic(buffers), |cmd| {
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers(
                [&buffers.rays, &buffers.irradiance, guidance].map(|buffer| buffer.discard(Access::ComputeWrite)),
            );
            let mut bound = buffers.bound(shared, gbuffer.resource);
            bound.push(("Guidance", Bound::Buffer(guidance)));
            let bound = self.pipeline.interface.own(&bound);
            let tiles_per_group = REFINE_LANES / buffers.params.tile_size();
            let groups = rows_of_groups(buffers.params.tile_count.div_ceil(tiles_per_group));
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&buffers.params), &bound, groups)
        })
    }
}
