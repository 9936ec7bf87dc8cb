//! A tile's samples by depth, and how far they are blurred. Shader: bins.comp.
//! reads   reconstruct.samples.colors, reconstruct.samples.vectors
//! writes  reconstruct.bins   buffer, 33 bins of 48 B a tile of 16x16 pixels

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::reconstruct::bins::COMP;
use crate::gpu::{Access, Bound, Commands, Gpu, Traffic};
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::reconstruct::filter_buffers::FilterBuffers;
use crate::techniques::deep_shading::resources::full;
use std::sync::Arc;

pub const PASS: &str = "reconstruct.bins";

pub struct Bins {
    pipeline: ComputePipeline,
}

impl Bins {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &constants_of(choices, &[Some(&COMP)]))? })
    }

    /// After the pass that gathers samples. `tiles` across and down: a workgroup each.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        buffers: &FilterBuffers,
        [across, down]: [u32; 2],
    ) -> Result<()> {
        // Depths, and then all.
        let traffic = Traffic {
            read_bytes: Some(buffers.vectors.bytes + buffers.sample_bytes()),
            written_bytes: Some(buffers.bins.bytes),
            invocations: Some(u64::from(across) * u64::from(down) * u64::from(self.pipeline.workgroup[0])),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers(buffers.samples_to_read(Access::ComputeWrite));
            cmd.barriers([buffers.bins.discard(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(buffers.bound());
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), [across, down, 1])
        })
    }
}
