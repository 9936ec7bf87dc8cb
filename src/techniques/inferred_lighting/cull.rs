//! Cull: a list of lights for each tile of the light buffer, for `--volumes tiled`. Shader: cull.comp.
//! reads  geometry.depth, the lights      writes  cull.masks  buffer, one bit a light, tiles in row order

use super::geometry::LowGeometry;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::inferred_lighting::cull::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::cull;
use crate::passes::cull::{CullLights, CullSurface, MaskPipeline};
use crate::settings::CullBy;
use crate::techniques::inferred_lighting::resources::NAME;
use std::sync::Arc;

pub struct Cull {
    masks: MaskPipeline,
}

impl Cull {
    pub fn new(gpu: &Arc<Gpu>, by: CullBy) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[by.name()]);
        Ok(Self { masks: MaskPipeline { pipeline: ComputePipeline::new(gpu, shader, &[])?, by } })
    }

    /// `frame`: the block of the light buffer's extent.
    pub fn record(
        &self,
        cmd: &mut Commands,
        geometry: Edge<'_, LowGeometry>,
        frame: &Buffer,
        lights: CullLights<'_>,
        masks: &Buffer,
    ) -> Result<()> {
        let surface = CullSurface {
            extent: geometry.resource.extent(),
            texel_bytes: 4,
            barriers: vec![geometry.depth_to(Access::ComputeSample)],
            bound: vec![geometry.resource.bound_depth(Access::ComputeSample)],
        };
        cull::record(cmd, NAME, &self.masks, surface, frame, lights, masks)
    }
}
