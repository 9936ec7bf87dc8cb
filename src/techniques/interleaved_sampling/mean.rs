//! Mean: after the last member, the mean of each pixel's samples. Shader: mean.comp.
//! reads   combine.sums, and where pixels have no sample mean.sources
//! writes  mean.color  image, RGBA32F, frame extent
//!
//! Pixels hold different numbers of samples where the basis has no whole sides, and some none where there are fewer samples
//! than pixels. The paper averages what fell into a pixel (section 2.1) and does not say what a pixel shows into which
//! nothing did: here that of the nearest pixel.

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MeanParams;
use crate::gpu::shader::techniques::interleaved_sampling::mean::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic, upload};
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_sampling::members::Members;
use crate::techniques::interleaved_sampling::resources::{COLOR, NAME, SOURCES};
use crate::units::Extent;
use std::sync::Arc;

/// Plans what it reads and writes, and the pass, the last of a run.
pub fn plan(plan: &mut Plan, members: &Members, frame: Extent) {
    if let Some(sources) = members.sources() {
        plan.buffer("combine", SOURCES, 4 * sources.len() as u64);
    }
    plan.picture(COLOR, frame);
    plan.pass(format!("{NAME}.mean"), [(COLOR.to_owned(), Access::ComputeWrite)]);
}

pub struct Mean {
    pipeline: ComputePipeline,
    params: MeanParams,
    sources: Option<Buffer>,
    pub color: Image,
}

impl Mean {
    /// Fills the planned sources.
    ///
    /// Errors: the driver refuses, memory for the upload (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, members: &Members) -> Result<Self> {
        let sources = match members.sources() {
            None => None,
            Some(sources) => {
                let buffer = resources.buffer(SOURCES);
                upload::buffer(gpu, &buffer, bytemuck::cast_slice(sources), Access::ComputeRead)?;
                Some(buffer)
            }
        };
        let shader = variant(COMP_VARIANTS, &[if sources.is_some() { "some" } else { "none" }]);
        let params = MeanParams { last_run: members.run_count() - 1 };
        let pipeline = ComputePipeline::new(gpu, shader, &[])?;
        Ok(Self { pipeline, params, sources, color: resources.image(COLOR) })
    }

    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, sums: Edge<'_, Buffer>) -> Result<()> {
        let extent = self.color.description.extent;
        // One run of all reads and writes.
        let pixels = extent.pixel_count() / u64::from(self.params.last_run + 1);
        let source_bytes = if self.sources.is_some() { 4 } else { 0 };
        let traffic = Traffic {
            read_bytes: Some(pixels * (16 + source_bytes)),
            written_bytes: Some(pixels * 16),
            invocations: Some(extent.pixel_count()),
        };
        cmd.pass(&format!("{NAME}.mean"), traffic, |cmd| {
            let sums_buffer = sums.resource;
            cmd.barriers([self.color.discard(Access::ComputeWrite)]);
            cmd.barriers([sums.to(Access::ComputeRead)]);
            let mut bound = vec![
                ("Frame", Bound::Buffer(frame)),
                ("Sums", Bound::Buffer(sums_buffer)),
                ("color", Bound::Storage(&self.color)),
            ];
            bound.extend(self.sources.as_ref().map(|sources| ("PixelSources", Bound::Buffer(sources))));
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })
    }
}
