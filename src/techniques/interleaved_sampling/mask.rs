//! Mask: where members are drawn over the whole frame the depth of pixels in which a member has no sample, so near that nothing is
//! drawn there; of several members at once, the depth of each of their samples.
//! Shader: mask.frag.
//! reads  combine.members      writes  depth.reversed  all of it
//!
//! Why depth: what draws the scene tests it anyway, before it shades.

use super::resources::{DEPTH, NAME};
use super::table::Table;
use crate::error::Result;
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::interleaved_sampling::mask::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Image, Traffic};
use crate::passes::samples::Samples;
use crate::passes::{depth_prepass, fullscreen};
use crate::plan::Plan;
use std::sync::Arc;

/// Plans the pass, before those that draw the scene.
pub fn plan_pass(plan: &mut Plan) {
    plan.pass(format!("{NAME}.mask"), [(DEPTH.to_owned(), Access::DepthWrite)]);
}

pub struct Mask {
    pipeline: GraphicsPipeline,
}

impl Mask {
    /// `samples`: of the depth buffer, each of which is a member's.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, samples: Samples) -> Result<Self> {
        let shader = variant(FRAG_VARIANTS, &[if samples.are_many() { "several" } else { "one" }]);
        let description = GraphicsDescription {
            depth_format: Some(depth_prepass::FORMAT),
            depth_write: true,
            samples: samples.count,
            are_placed: samples.are_placed,
            ..fullscreen::description(shader, &[])
        };
        Ok(Self { pipeline: GraphicsPipeline::new(gpu, &description)? })
    }

    /// Leaves `depth` as `Access::DepthWrite` does.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, table: &Table, depth: &Image) -> Result<()> {
        let bytes = depth.description.bytes();
        let traffic = Traffic { read_bytes: Some(0), written_bytes: Some(bytes), invocations: Some(bytes / 4) };
        cmd.pass(&format!("{NAME}.mask"), traffic, |cmd| {
            cmd.barriers([depth.discard(Access::DepthWrite)]);
            cmd.begin_rendering(depth.description.extent, &[], Some((depth, Some(0.0), Access::DepthWrite)));
            let bound = [("Frame", Bound::Buffer(frame)), ("Members", Bound::Buffer(&table.buffer))];
            cmd.bind_graphics(&self.pipeline, bytemuck::bytes_of(&table.params), &bound)?;
            fullscreen::draw(cmd, 0);
            cmd.end_rendering();
            Ok(())
        })
    }
}
