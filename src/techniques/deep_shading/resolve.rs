//! Resolve: the mean of each pixel's samples, gathered through the address buffer, by following links, or from the samples' own
//! places (Clarberg & Munkberg 2014, section 3.2); of a baseline from what it drew. Shader: resolve.comp.
//! reads  visibility.spids, shade.colors, lists.addresses or the lists; baseline.colors
//! writes  resolve.color  image, RGBA32F; stereo.right, the same of the right one of two eyes

use super::choices::Choices;
use super::sample_colors::{SampleColors, fetch};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::ResolveParams;
use crate::gpu::shader::techniques::deep_shading::resolve::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::resources::full;
use std::sync::Arc;

pub struct Resolve {
    pipeline: ComputePipeline,
}

impl Resolve {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[fetch(choices)]);
        let constants = constants_of(choices, &[Some(shader)]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)? })
    }

    /// `eyes`: the picture of each, the left one's first.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        shaded: SampleColors<'_>,
        counters: Edge<'_, Buffer>,
        eyes: &[&Image],
    ) -> Result<()> {
        let extent = eyes[0].description.extent;
        let traffic = Traffic {
            read_bytes: Some(shaded.bytes()),
            written_bytes: Some(eyes.iter().map(|color| color.description.bytes()).sum()),
            invocations: Some(eyes.len() as u64 * extent.pixel_count()),
        };
        cmd.pass(&full("resolve"), traffic, |cmd| {
            cmd.barriers(shaded.to_compute());
            cmd.barriers(eyes.iter().map(|color| color.discard(Access::ComputeWrite)));
            let mut counters = counters;
            for (eye, color) in (0..).zip(eyes) {
                cmd.barriers([counters.to(Access::ComputeWrite)]);
                counters = counters.resource.from(Access::ComputeWrite);
                let mut bound = bound.to_vec();
                bound.extend(shaded.bound());
                bound.extend([("Counters", Bound::Buffer(counters.resource)), ("color", Bound::Storage(color))]);
                let params = ResolveParams { eye };
                let groups = self.pipeline.groups([extent.width, extent.height, 1]);
                let own = self.pipeline.interface.own(&bound);
                cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &own, groups)?;
            }
            Ok(())
        })
    }
}
