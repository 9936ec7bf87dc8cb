//! Pack: sums of lights that were drawn to the L-buffer's words, each rounded once. Shader: pack.comp.
//! reads  light.sums, light.more_sums      writes  light.l_buffer

use super::LBuffer;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::techniques::inferred_lighting::light::pack::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Image, Traffic};
use crate::plan::Resources;
use crate::techniques::inferred_lighting::resources::NAME;
use ash::vk;
use std::sync::Arc;

pub struct Pack {
    pipeline: ComputePipeline,
    nearest: Sampler,
    /// One, or two.
    pub sums: Vec<Image>,
}

impl Pack {
    /// `constants`: the workgroup's and the store's. Takes the sums out.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        l_buffer: LBuffer,
        constants: &[(&'static str, u32)],
    ) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[l_buffer.targets_axis()]);
        Ok(Self {
            pipeline: ComputePipeline::new(gpu, shader, constants)?,
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
            sums: super::sums(l_buffer).iter().map(|name| resources.image(name)).collect(),
        })
    }

    /// `frame`: the block of the light buffer's extent. Lights have been drawn into the sums.
    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, l_buffer: &Image) -> Result<()> {
        let extent = l_buffer.description.extent;
        let pixels = extent.pixel_count();
        let read_bytes = self.sums.iter().map(|sums| sums.description.bytes()).sum();
        let traffic =
            Traffic { read_bytes: Some(read_bytes), written_bytes: Some(pixels * 8), invocations: Some(pixels) };
        cmd.pass(&format!("{NAME}.pack"), traffic, |cmd| {
            cmd.barriers(self.sums.iter().map(|sums| sums.from(Access::ColorWrite).to(Access::ComputeSample)));
            cmd.barriers([l_buffer.discard(Access::ComputeWrite)]);
            let sampled = |sums| Bound::Sampled(sums, self.nearest.handle, Access::ComputeSample);
            let mut bound = vec![("Frame", Bound::Buffer(frame)), ("l_buffer", Bound::Storage(l_buffer))];
            bound.extend(["sums", "more_sums"].into_iter().zip(self.sums.iter().map(sampled)));
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &bound, groups)
        })
    }
}
