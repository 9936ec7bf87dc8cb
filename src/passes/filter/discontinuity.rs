//! Discontinuity buffer (DB): Segovia 2006, section 4.5. Shader: discontinuity.comp.
//! reads  the G-buffer      writes  discontinuity.flags  buffer, frame order, 4 B a pixel, a bit a neighbour
//!
//! The paper leaves the measure open. Here: 1 - cos of the angle between the normals, and the distance of the
//! neighbour from the pixel's tangent plane, which does not flag a floor seen at a grazing angle.
//!
//! Differs from the paper: one bit for each neighbour instead of one flag for all. With one flag, every pixel along a
//! horizontal edge is flagged and finds its neighbours along x flagged too, so that it is not filtered at all; with
//! `--discontinuity any` the filter reads the bits as the paper's flag.

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::passes::filter::discontinuity::COMP_VARIANTS;
use crate::gpu::shader::structs::DiscontinuityParams;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::gbuffer::{self, GBuffer};
use crate::plan::Plan;
use crate::settings::PositionStorage;
use std::sync::Arc;

/// Full name of the flags that the pass of this full name writes.
pub fn flags(label: &str) -> String {
    format!("{label}.flags")
}

/// Plans the pass `label` of `technique` and its flags. `texel_count`: pixels that are flagged, and what pads their rows.
pub fn plan(plan: &mut Plan, technique: &str, label: &str, texel_count: u64, position: PositionStorage) {
    let flags = flags(label);
    plan.buffer("discontinuity", &flags, texel_count * 4);
    let surface = gbuffer::surface(technique, position);
    plan.pass(label.to_owned(), surface.into_iter().chain([(flags, Access::ComputeWrite)]));
}

/// Columns that a thread flags at most: 1024x768 take 7.9 ms with 1, 6.5 with 2, 6.3 with 4, 9.7 with 8 (rows of 8;
/// lavapipe 22.3.6).
pub const MOST_COLUMNS: u32 = 2;

pub struct Discontinuity {
    label: String,
    pipeline: ComputePipeline,
    params: DiscontinuityParams,
    /// Pixels that a thread flags: a rectangle.
    columns: u32,
    rows: u32,
}

impl Discontinuity {
    /// The pass of this full name, over a G-buffer that has positions as `position` says. `workgroup`: WORKGROUP_X and
    /// WORKGROUP_Y; `rows`: of pixels that a thread flags, at least 1.
    pub fn new(
        gpu: &Arc<Gpu>,
        label: String,
        position: PositionStorage,
        workgroup: &[(&'static str, u32)],
        rows: u32,
        params: DiscontinuityParams,
    ) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[position.name()]);
        let columns = rows.min(MOST_COLUMNS);
        let constants = [workgroup, &[("COLUMNS", columns), ("ROWS", rows)]].concat();
        let pipeline = ComputePipeline::new(gpu, shader, &constants)?;
        Ok(Self { label, pipeline, params, columns, rows })
    }

    /// Hands the G-buffer on as it leaves it.
    pub fn record<'a>(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
        flags: &Buffer,
    ) -> Result<Edge<'a, GBuffer>> {
        let extent = gbuffer.resource.extent().reduced(self.params.stride);
        let pixels = extent.pixel_count();
        let [across, down] = [extent.width.div_ceil(self.columns), extent.height.div_ceil(self.rows)];
        let threads = u64::from(across) * u64::from(down);
        let traffic = Traffic {
            // A column and a row more than are flagged.
            read_bytes: Some(
                threads * u64::from((self.columns + 1) * (self.rows + 1)) * gbuffer.resource.surface_bytes(),
            ),
            written_bytes: Some(pixels * 4),
            invocations: Some(threads),
        };
        cmd.pass(&self.label, traffic, |cmd| {
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers([flags.discard(Access::ComputeWrite)]);
            let mut bound = gbuffer.resource.bound_surface();
            bound.extend([("Frame", Bound::Buffer(frame)), ("Flags", Bound::Buffer(flags))]);
            let groups = self.pipeline.groups([across, down, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })?;
        Ok(gbuffer.after(Access::ComputeSample))
    }
}
