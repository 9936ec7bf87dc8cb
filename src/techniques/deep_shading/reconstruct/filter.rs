//! Layers filtered and put over each other. Shader: filter.comp.
//! reads   reconstruct.samples.colors, reconstruct.samples.vectors, reconstruct.layers.tiles, resolve.color
//! writes  reconstruct.filter.color   image, RGBA32F, frame extent

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::reconstruct::filter::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
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

    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        gathered: Edge<'_, FilterBuffers>,
        tiles: Edge<'_, Buffer>,
        resolved: Edge<'_, Image>,
        color: &Image,
    ) -> Result<()> {
        let (buffers, extent) = (gathered.resource, color.description.extent);
        // Blur decides how often samples are read: at least once.
        let traffic = Traffic {
            read_bytes: buffers.sample_bytes() + tiles.resource.bytes + color.description.bytes(),
            written_bytes: color.description.bytes(),
            invocations: Some(extent.pixel_count()),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers(gathered.samples_to_read());
            cmd.barriers([tiles.to(Access::ComputeRead)]);
            cmd.barriers([resolved.to(Access::ComputeRead), color.discard(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(buffers.bound());
            bound.extend([("resolved", Bound::Storage(resolved.resource)), ("color", Bound::Storage(color))]);
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
