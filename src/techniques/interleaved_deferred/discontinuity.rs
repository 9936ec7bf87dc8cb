//! Discontinuity buffer (DB): Segovia 2006, section 4.5 (SG10). Shader: discontinuity.comp.
//! reads  the G-buffer      writes  discontinuity.flags  buffer, frame order, 4 B a pixel, a bit a neighbour
//!
//! The paper leaves the measure open. Here: 1 - cos of the angle between the normals, and the distance of the
//! neighbour from the pixel's tangent plane, which does not flag a floor seen at a grazing angle.
//!
//! Differs from the paper: one bit for each neighbour instead of one flag for all. With one flag, every pixel along a
//! horizontal edge is flagged and finds its neighbours along x flagged too, so that it is not filtered at all; with
//! `--discontinuity any` the filter reads the bits as the paper's flag.

use super::NAME;
use crate::error::Result;
use crate::gpu::Bound;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::{DiscontinuityParams, MappingParams};
use crate::gpu::shader::techniques::interleaved_deferred::discontinuity::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::ShadingSettings;
use crate::passes::gbuffer::GBuffer;
use crate::plan::Plan;
use std::sync::Arc;

/// Plans the flags.
pub fn plan(plan: &mut Plan, mapping: &MappingParams) {
    plan.buffer("discontinuity", format!("{NAME}.discontinuity.flags"), mapping.frame_texel_count() * 4);
}

pub struct Discontinuity {
    pipeline: ComputePipeline,
    params: DiscontinuityParams,
    /// Pixels of a column that a thread flags.
    texels: u32,
}

impl Discontinuity {
    pub fn new(gpu: &Arc<Gpu>, settings: &ShadingSettings, params: DiscontinuityParams) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[settings.position.name()]);
        let texels = settings.texels.of_filter();
        let constants = [&settings.workgroup_constants()[..], &[("TEXELS", texels)]].concat();
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)?, params, texels })
    }

    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, gbuffer: Edge<'_, GBuffer>, flags: &Buffer) -> Result<()> {
        let extent = gbuffer.resource.extent();
        let pixels = extent.pixel_count();
        let traffic = Traffic {
            // Two columns, a row more than are flagged.
            read_bytes: 2 * pixels * u64::from(self.texels + 1) / u64::from(self.texels)
                * gbuffer.resource.surface_bytes(),
            written_bytes: pixels * 4,
            invocations: Some(u64::from(extent.width) * u64::from(extent.height.div_ceil(self.texels))),
        };
        cmd.pass(&format!("{NAME}.discontinuity"), traffic, |cmd| {
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers([flags.discard(Access::ComputeWrite)]);
            let mut bound = gbuffer.resource.bound_surface();
            bound.extend([("Frame", Bound::Buffer(frame)), ("Flags", Bound::Buffer(flags))]);
            let groups = self.pipeline.groups([extent.width, extent.height.div_ceil(self.texels), 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })
    }
}
