//! Mask: with `--members tuples` the depth of pixels in which a member has no sample, so near that nothing is drawn there.
//! Shader: mask.frag.
//! reads  combine.members      writes  depth.reversed  all of it
//!
//! Why depth: what draws the scene tests it anyway, before it shades.

use super::resources::{DEPTH, NAME};
use super::table::Table;
use crate::error::Result;
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::interleaved_sampling::mask::FRAG;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Image, Traffic};
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
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>) -> Result<Self> {
        let description = GraphicsDescription {
            depth_format: Some(depth_prepass::FORMAT),
            depth_write: true,
            ..fullscreen::description(&FRAG, &[])
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
