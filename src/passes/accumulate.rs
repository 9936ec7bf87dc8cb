//! Accumulate: the mean of the pictures of all runs so far (`--supersample`, `--accumulate`). Shader: accumulate.comp.
//! reads  the run's picture      writes  accumulate.sums  buffer, 16 B a pixel, kept from run to run, and
//! accumulate.color  image, RGBA32F, frame extent

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::passes::accumulate::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::plan::{Plan, Resources};
use crate::units::Extent;
use std::sync::Arc;

/// Four channels of 32 bits.
const SUM_BYTES: u64 = 16;

fn sums(technique: &str) -> String {
    format!("{technique}.accumulate.sums")
}

/// Full name of the mean of all runs.
fn color(technique: &str) -> String {
    format!("{technique}.accumulate.color")
}

/// Plans the sums and the mean.
pub fn plan(plan: &mut Plan, technique: &str, extent: Extent) {
    plan.buffer("accumulation", sums(technique), extent.pixel_count() * SUM_BYTES);
    plan.picture(color(technique), extent);
}

/// The pass, after one that leaves the picture of a run, of this full name.
pub fn plan_pass(plan: &mut Plan, technique: &str, run: &str) {
    let touches = [(run.to_owned(), Access::ComputeRead), (color(technique), Access::ComputeWrite)];
    plan.pass(format!("{technique}.accumulate"), touches);
}

pub struct Accumulate {
    pipeline: ComputePipeline,
    sums: Buffer,
    pub color: Image,
}

impl Accumulate {
    pub fn new(gpu: &Arc<Gpu>, technique: &str, resources: &mut Resources) -> Result<Self> {
        let (sums, color) = (resources.buffer(&sums(technique)), resources.image(&color(technique)));
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &[])?, sums, color })
    }

    pub fn record(&self, cmd: &mut Commands, technique: &str, frame: &Buffer, run: Edge<'_, Image>) -> Result<()> {
        let extent = self.color.description.extent;
        let pixels = extent.pixel_count();
        let traffic = Traffic {
            read_bytes: Some(pixels * (SUM_BYTES + 16)),
            written_bytes: Some(pixels * (SUM_BYTES + 16)),
            invocations: Some(pixels),
        };
        cmd.pass(&format!("{technique}.accumulate"), traffic, |cmd| {
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
