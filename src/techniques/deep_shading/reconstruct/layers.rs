//! The depths that part the samples of a tile and of those around it into layers of like blur, and how far filters reach in it.
//! Shader: layers.comp.
//! reads   reconstruct.bins
//! writes  reconstruct.layers.tiles   buffer, 96 B a tile of 16x16 pixels

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::reconstruct::layers::COMP;
use crate::gpu::{Access, Bound, Commands, Gpu, Traffic};
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::reconstruct::filter_buffers::FilterBuffers;
use crate::techniques::deep_shading::resources::full;
use std::sync::Arc;

pub const PASS: &str = "reconstruct.layers";

pub struct Layers {
    pipeline: ComputePipeline,
}

impl Layers {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &constants_of(choices, &[Some(&COMP)]))? })
    }

    /// After the pass that counts bins. `tiles` across and down: a workgroup each.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        buffers: &FilterBuffers,
        [across, down]: [u32; 2],
    ) -> Result<()> {
        // A tile's bins and those of the eight around it, twice.
        let traffic = Traffic {
            read_bytes: Some(18 * buffers.bins.bytes),
            written_bytes: Some(buffers.tiles.bytes),
            invocations: Some(u64::from(across) * u64::from(down) * u64::from(self.pipeline.workgroup[0])),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers([buffers.bins.from(Access::ComputeWrite).to(Access::ComputeRead)]);
            cmd.barriers([buffers.tiles.discard(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(buffers.bound());
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), [across, down, 1])
        })
    }
}
