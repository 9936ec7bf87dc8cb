//! Layers filtered and put over each other. Shader: filter.comp.
//! reads   reconstruct.means, reconstruct.layers.tiles, resolve.color
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

    /// After the pass that sums pixels' layers up.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        buffers: &FilterBuffers,
        resolved: Edge<'_, Image>,
        color: &Image,
    ) -> Result<()> {
        let extent = color.description.extent;
        let traffic = Traffic {
            // Blur decides how often means are read.
            read_bytes: None,
            written_bytes: Some(color.description.bytes()),
            invocations: Some(extent.pixel_count()),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers([buffers.means.from(Access::ComputeWrite).to(Access::ComputeRead)]);
            cmd.barriers([buffers.tiles.from(Access::ComputeRead).to(Access::ComputeRead)]);
            cmd.barriers([resolved.to(Access::ComputeRead), color.discard(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(buffers.bound());
            bound.extend([("resolved", Bound::Storage(resolved.resource)), ("color", Bound::Storage(color))]);
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
