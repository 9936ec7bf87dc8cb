//! Resolve: the samples of a picture to their mean (`--msaa`). Shader: resolve.comp.
//! reads  a picture of several samples a pixel      writes  the plain one, RGBA32F
//!
//! Why no driver's resolve: it wants both of one format, and half floats (`--sample-format`) would round the mean as well.

use super::samples::Samples;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::passes::resolve::COMP;
use crate::gpu::{Access, Bound, Commands, Edge, Gpu, Image, Traffic};
use ash::vk;
use std::sync::Arc;

/// How a picture is used whose samples are drawn and then resolved.
pub const DRAWN: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::COLOR_ATTACHMENT.as_raw() | vk::ImageUsageFlags::SAMPLED.as_raw(),
);

/// What the pass touches: both pictures by their full names.
pub fn touches(drawn: &str, plain: &str) -> [(String, Access); 2] {
    [(drawn.to_owned(), Access::ComputeSample), (plain.to_owned(), Access::ComputeWrite)]
}

pub struct Resolve {
    pipeline: ComputePipeline,
    /// Texels are fetched: it only has to be there.
    nearest: Sampler,
    /// The mean.
    pub color: Image,
}

impl Resolve {
    /// `color`: the plain picture.
    pub fn new(gpu: &Arc<Gpu>, samples: Samples, color: Image) -> Result<Self> {
        let pipeline = ComputePipeline::new(gpu, &COMP, &[("SAMPLE_COUNT", samples.count)])?;
        Ok(Self { pipeline, nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?, color })
    }

    pub fn record(&self, cmd: &mut Commands, technique: &str, drawn: Edge<'_, Image>) -> Result<()> {
        let extent = self.color.description.extent;
        let traffic = Traffic {
            read_bytes: Some(drawn.resource.description.bytes()),
            written_bytes: Some(self.color.description.bytes()),
            invocations: Some(extent.pixel_count()),
        };
        cmd.pass(&format!("{technique}.resolve"), traffic, |cmd| {
            cmd.barriers([drawn.to(Access::ComputeSample), self.color.discard(Access::ComputeWrite)]);
            let bound = [
                ("drawn", Bound::Sampled(drawn.resource, self.nearest.handle, Access::ComputeSample)),
                ("color", Bound::Storage(&self.color)),
            ];
            cmd.dispatch(&self.pipeline, &[], &bound, self.pipeline.groups([extent.width, extent.height, 1]))
        })
    }
}
