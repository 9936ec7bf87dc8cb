//! Compaction: sorts each list, drops what it holds twice, and puts its first 16 triangles and its colours in rows.
//! Shader: compact.comp.
//! reads and writes  lists.begins, lists.nodes      writes  lists.linear; in places of colours entries that wait

use super::super::choices::Choices;
use super::ListsEdge;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::lists::compact::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::resources::full;
use crate::units::Extent;
use std::sync::Arc;

pub struct Compact {
    pipeline: ComputePipeline,
}

impl Compact {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let constants = constants_of(choices, &[Some(&COMP)]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &constants)? })
    }

    /// `space`: pixels of shading space.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        inserted: ListsEdge<'_>,
        colors: Edge<'_, Buffer>,
        counters: Edge<'_, Buffer>,
        space: Extent,
    ) -> Result<()> {
        let lists = inserted.lists;
        let traffic = Traffic { invocations: Some(space.pixel_count()), ..Traffic::default() };
        cmd.pass(&full("lists.compact"), traffic, |cmd| {
            let links = [&lists.begins, &lists.nodes].map(|buffer| buffer.from(inserted.links));
            cmd.barriers(links.into_iter().chain([colors, counters]).map(|edge| edge.to(Access::ComputeWrite)));
            cmd.barriers(lists.linear.iter().map(|buffer| buffer.discard(Access::ComputeWrite)));
            let mut bound = bound.to_vec();
            bound.extend(lists.bound());
            bound.extend([("Colors", Bound::Buffer(colors.resource)), ("Counters", Bound::Buffer(counters.resource))]);
            let groups = self.pipeline.groups([space.width, space.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
