//! Pack: float sums to the L-buffer's 16 bits a channel, each rounded once. Shader: pack.comp.
//! reads  light.sums      writes  light.l_buffer

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::techniques::inferred_lighting::resources::NAME;
use ash::vk;
use std::sync::Arc;

pub struct Pack {
    pipeline: ComputePipeline,
    nearest: Sampler,
}

impl Pack {
    /// `constants`: the workgroup's and LIGHT_RANGE.
    pub fn new(gpu: &Arc<Gpu>, constants: &[(&str, u32)]) -> Result<Self> {
        let shader = &crate::gpu::shader::techniques::inferred_lighting::light::pack::COMP;
        let pipeline = ComputePipeline::new(gpu, shader, constants)?;
        Ok(Self { pipeline, nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)? })
    }

    /// `frame`: the block of the light buffer's extent.
    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, sums: Edge<'_, Image>, l_buffer: &Image) -> Result<()> {
        let extent = l_buffer.description.extent;
        let pixels = extent.pixel_count();
        let traffic = Traffic { read_bytes: pixels * 16, written_bytes: pixels * 8, invocations: Some(pixels) };
        cmd.pass(&format!("{NAME}.pack"), traffic, |cmd| {
            cmd.barriers([sums.to(Access::ComputeSample), l_buffer.discard(Access::ComputeWrite)]);
            let bound = [
                ("Frame", Bound::Buffer(frame)),
                ("sums", Bound::Sampled(sums.resource, self.nearest.handle, Access::ComputeSample)),
                ("l_buffer", Bound::Storage(l_buffer)),
            ];
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &bound, groups)
        })
    }
}
