//! Layers filtered and put over each other. Shader: filter.comp.
//! reads   reconstruct.samples.colors, reconstruct.samples.vectors, reconstruct.layers.tiles, resolve.color
//! writes  reconstruct.filter.color   image, RGBA32F, frame extent

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::reconstruct::filter::COMP;
use crate::gpu::{Access, Bound, Commands, Edge, Gpu, Image, Traffic};
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::reconstruct::filter_buffers::FilterBuffers;
use crate::techniques::deep_shading::resources::full;
use std::sync::Arc;

pub const PASS: &str = "reconstruct.filter";

pub struct Filter {
    pipeline: ComputePipeline,
}

impl Filter {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &constants_of(choices, &[Some(&COMP)]))? })
    }

    /// After the layers.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        reconstructed: &FilterBuffers,
        resolved: Edge<'_, Image>,
        color: &Image,
    ) -> Result<()> {
        let extent = color.description.extent;
        // Blur decides how often samples are read: at least once.
        let traffic = Traffic {
            read_bytes: reconstructed.sample_bytes() + reconstructed.tiles.bytes + color.description.bytes(),
            written_bytes: color.description.bytes(),
            invocations: Some(extent.pixel_count()),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            let FilterBuffers { colors, vectors, tiles } = reconstructed;
            cmd.barriers([colors, vectors].map(|buffer| buffer.from(Access::ComputeRead).to(Access::ComputeRead)));
            cmd.barriers([tiles.from(Access::ComputeWrite).to(Access::ComputeRead)]);
            cmd.barriers([resolved.to(Access::ComputeRead), color.discard(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(reconstructed.bound());
            bound.extend([("resolved", Bound::Storage(resolved.resource)), ("color", Bound::Storage(color))]);
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
