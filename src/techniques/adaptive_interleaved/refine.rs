//! Refinement of a component: the further iterations of the listed tiles, dispatched from the device (Dubla 2009,
//! Listing 1, lines 14 to 19). Shader: refine.comp.
//! reads   the G-buffer, the tree, the component's samples, tiles, guidance, bins, estimates
//! writes  rays and irradiance of the texels of those tiles

use super::buffers::{ComponentBuffers, Shared};
use super::choices::{Choices, ComponentChoice};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::adaptive_interleaved::refine::COMP_VARIANTS;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::gbuffer::GBuffer;
use std::sync::Arc;

pub struct RefinePass {
    pipeline: ComputePipeline,
}

/// What the passes before it left.
pub struct Listed<'a> {
    pub estimates: Edge<'a, Buffer>,
    pub rays: Edge<'a, Buffer>,
    pub irradiance: Edge<'a, Buffer>,
    pub guidance: Edge<'a, Buffer>,
    pub bins: Edge<'a, Buffer>,
    pub tiles: Edge<'a, Buffer>,
}

impl RefinePass {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, choice: &ComponentChoice) -> Result<Self> {
        let pipeline =
            choices.estimating_pipeline(gpu, COMP_VARIANTS, choice.component, &[choices.order_constant()])?;
        Ok(Self { pipeline })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        buffers: &ComponentBuffers,
        shared: &Shared<'_>,
        gbuffer: Edge<'_, GBuffer>,
        listed: &Listed<'_>,
    ) -> Result<()> {
        // How many tiles there are, the device alone knows.
        cmd.pass(&buffers.label("refine"), Traffic::default(), |cmd| {
            let Listed { estimates, rays, irradiance, guidance, bins, tiles } = listed;
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers([estimates, guidance, bins, tiles].map(|edge| edge.to(Access::ComputeRead)));
            cmd.barriers([rays, irradiance].map(|edge| edge.to(Access::ComputeWrite)));
            cmd.barriers([bins.after(Access::ComputeRead).to(Access::IndirectRead)]);
            let mut bound = buffers.bound(shared, gbuffer.resource);
            bound.extend([
                ("Estimates", Bound::Buffer(estimates.resource)),
                ("Guidance", Bound::Buffer(guidance.resource)),
                ("Bins", Bound::Buffer(bins.resource)),
                ("Tiles", Bound::Buffer(tiles.resource)),
            ]);
            let bound = self.pipeline.interface.own(&bound);
            cmd.dispatch_indirect(&self.pipeline, bytemuck::bytes_of(&buffers.params), &bound, bins.resource)
        })
    }
}
