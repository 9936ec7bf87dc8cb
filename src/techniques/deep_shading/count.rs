//! Count: how long the lists are, after the frame (`--instrument on`). Shader: count.comp.
//! reads  the lists, and sorts them, as nothing needs them any more
//! writes  count.lengths  buffer, 4 B a pixel of shading space; the counters

use super::choices::Choices;
use super::lists::ListsEdge;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::count::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::plan::Resources;
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::resources::full;
use crate::units::Extent;
use std::sync::Arc;

pub struct Count {
    pipeline: ComputePipeline,
    /// Triangles of each list, each once.
    pub lengths: Buffer,
    space: Extent,
}

impl Count {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let lists = if choices.lists.is_compacted { "compact" } else { "linked" };
        let shader = variant(COMP_VARIANTS, &[lists]);
        let pipeline = ComputePipeline::new(gpu, shader, &constants_of(choices, &[Some(shader)]))?;
        let lengths = resources.buffer(&full(super::resources::LENGTHS));
        Ok(Self { pipeline, lengths, space: choices.space.extent })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        read: ListsEdge<'_>,
        counters: Edge<'_, Buffer>,
    ) -> Result<()> {
        let lists = read.lists;
        let traffic = Traffic {
            // Lists are as long as they are.
            read_bytes: None,
            written_bytes: Some(self.lengths.bytes),
            invocations: Some(self.space.pixel_count()),
        };
        cmd.pass(&full("count"), traffic, |cmd| {
            cmd.barriers(read.links_to(Access::ComputeWrite));
            cmd.barriers([self.lengths.discard(Access::ComputeWrite), counters.to(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(lists.bound());
            bound.extend([("Counters", Bound::Buffer(counters.resource)), ("Lengths", Bound::Buffer(&self.lengths))]);
            let groups = self.pipeline.groups([self.space.width, self.space.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
