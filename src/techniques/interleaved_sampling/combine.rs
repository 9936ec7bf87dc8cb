//! Combine: the samples of a member into the pixels that they lie in (section 3.1). Shader: combine.comp.
//! reads   the member's picture      writes  combine.sums  buffer, 16 B a pixel, kept from member to member
//!
//! Why this way: the paper draws a polygon over the whole frame for each member, behind a mask of its pixels. A thread for
//! each sample touches those pixels alone, in the same order; and no two samples of a member lie in one pixel, unless a side
//! of the basis is shorter than a pixel, which is refused.

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::CombineParams;
use crate::gpu::shader::techniques::interleaved_sampling::combine::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic, upload};
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_sampling::members::Members;
use crate::techniques::interleaved_sampling::resources::{DRAWN, MEMBERS, NAME, SUMS};
use crate::units::Extent;
use std::sync::Arc;

/// Four floats.
const SUM_BYTES: u64 = 16;
const TEXEL_BYTES: u64 = 16;

/// Plans what it reads and writes.
pub fn plan(plan: &mut Plan, members: &Members, frame: Extent) {
    plan.buffer("combine", MEMBERS, 4 * members.table().len() as u64);
    plan.buffer("combine", SUMS, frame.pixel_count() * SUM_BYTES);
}

/// The pass, after those that draw a member.
pub fn plan_pass(plan: &mut Plan) {
    plan.pass(format!("{NAME}.combine"), [(DRAWN.to_owned(), Access::ComputeRead)]);
}

pub struct Combine {
    pipeline: ComputePipeline,
    params: CombineParams,
    members: Buffer,
    pub sums: Buffer,
}

impl Combine {
    /// Fills the planned table.
    ///
    /// Errors: the driver refuses, memory for the upload (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, members: &Members) -> Result<Self> {
        let table = resources.buffer(MEMBERS);
        upload::buffer(gpu, &table, bytemuck::cast_slice(&members.table()), Access::ComputeRead)?;
        let (layer, [x, y]) = (members.layer(), members.basis().sides);
        let params = CombineParams {
            period_x_px: x.pixels,
            period_y_px: y.pixels,
            bases_x: x.bases,
            bases_y: y.bases,
            layer_width: layer.width,
            layer_height: layer.height,
            firsts_at: members.firsts_at(),
        };
        let sums = resources.buffer(SUMS);
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &[])?, params, members: table, sums })
    }

    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, drawn: Edge<'_, Image>) -> Result<()> {
        let CombineParams { layer_width, layer_height, .. } = self.params;
        let samples = u64::from(layer_width) * u64::from(layer_height);
        let traffic = Traffic {
            read_bytes: samples * (TEXEL_BYTES + SUM_BYTES),
            written_bytes: samples * SUM_BYTES,
            invocations: Some(samples),
        };
        cmd.pass(&format!("{NAME}.combine"), traffic, |cmd| {
            // The run before ended with its fence: nothing of this one has touched the sums.
            cmd.barriers([drawn.to(Access::ComputeRead)]);
            cmd.barriers([self.sums.from(Access::ComputeRead).to(Access::ComputeWrite)]);
            let bound = [
                ("Frame", Bound::Buffer(frame)),
                ("Members", Bound::Buffer(&self.members)),
                ("Sums", Bound::Buffer(&self.sums)),
                ("drawn", Bound::Storage(drawn.resource)),
            ];
            let groups = self.pipeline.groups([layer_width, layer_height, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })
    }
}
