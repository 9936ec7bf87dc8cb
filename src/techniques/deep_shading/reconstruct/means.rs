//! What a pixel's samples of each of its tile's layers are together: how many, their mean colour and how far it may be spread.
//! Shader: means.comp.
//! reads   reconstruct.samples.colors, reconstruct.samples.vectors, reconstruct.layers.tiles
//! writes  reconstruct.means   buffer, 4 layers of 24 B a pixel of the frame

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::reconstruct::means::COMP;
use crate::gpu::{Access, Bound, Commands, Gpu, Traffic};
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::reconstruct::filter_buffers::FilterBuffers;
use crate::techniques::deep_shading::resources::full;
use crate::units::Extent;
use std::sync::Arc;

pub const PASS: &str = "reconstruct.means";

pub struct Means {
    pipeline: ComputePipeline,
}

impl Means {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &constants_of(choices, &[Some(&COMP)]))? })
    }

    /// After the pass that cuts layers.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        buffers: &FilterBuffers,
        frame: Extent,
    ) -> Result<()> {
        let traffic = Traffic {
            read_bytes: Some(buffers.sample_bytes() + buffers.tiles.bytes),
            written_bytes: Some(buffers.means.bytes),
            invocations: Some(frame.pixel_count()),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers(buffers.samples_to_read(Access::ComputeRead));
            cmd.barriers([buffers.tiles.from(Access::ComputeWrite).to(Access::ComputeRead)]);
            cmd.barriers([buffers.means.discard(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(buffers.bound());
            let groups = self.pipeline.groups([frame.width, frame.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
