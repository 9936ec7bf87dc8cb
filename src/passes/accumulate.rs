//! Accumulate: the mean of the pictures of all runs so far (`--supersample`). Shader: accumulate.comp.
//! reads  the run's picture      writes  forward.accumulate.sums  buffer, 16 B a pixel, kept from run to run, and
//! forward.accumulate.color  image, RGBA32F, frame extent

use super::NAME;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::forward::accumulate::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::plan::Resources;
use std::sync::Arc;

/// Four channels of 32 bits.
pub const SUM_BYTES: u64 = 16;

pub struct Accumulate {
    pipeline: ComputePipeline,
    sums: Buffer,
    pub color: Image,
}

impl Accumulate {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources) -> Result<Self> {
        let (sums, color) = (resources.buffer(super::plan::SUMS), resources.image(super::plan::MEAN));
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &[])?, sums, color })
    }

    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, run: Edge<'_, Image>) -> Result<()> {
        let extent = self.color.description.extent;
        let pixels = extent.pixel_count();
        let traffic = Traffic {
            read_bytes: pixels * (SUM_BYTES + 16),
            written_bytes: pixels * (SUM_BYTES + 16),
            invocations: Some(pixels),
        };
        cmd.pass(&format!("{NAME}.accumulate"), traffic, |cmd| {
            cmd.barriers([run.to(Access::ComputeRead), self.color.discard(Access::ComputeWrite)]);
            // The run before ended with its fence: nothing of this frame has touched the sums.
            cmd.barriers([self.sums.from(Access::ComputeRead).to(Access::ComputeWrite)]);
            let bound = [
                ("Frame", Bound::Buffer(frame)),
                ("Sums", Bound::Buffer(&self.sums)),
                ("run", Bound::Storage(run.resource)),
                ("color", Bound::Storage(&self.color)),
            ];
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &bound, groups)
        })
    }
}
