//! Samples find their shading samples in the cache; what has no entry yet gets one, which waits in the place of its colour
//! (Liktor & Dachsbacher 2012). Shaders: memoise.comp, cache.glsl.
//! reads  visibility.spids      writes  indirect.pointers, indirect.cache, shade.colors

use super::super::choices::Choices;
use super::compact::Entries;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::indirect::memoise::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::Samples;
use std::sync::Arc;

pub const PASS: &str = "indirect.memoise";

pub struct Memoise {
    pipeline: ComputePipeline,
}

impl Memoise {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &constants_of(choices, &[Some(&COMP)]))? })
    }

    /// Nothing has touched `colors`.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        seen: Edge<'_, Samples>,
        entries: &Entries,
        colors: &Buffer,
        counters: Edge<'_, Buffer>,
    ) -> Result<()> {
        let samples = seen.resource;
        let traffic = Traffic {
            // Entries that are looked for and made are counted after the frame.
            read_bytes: None,
            written_bytes: None,
            invocations: Some(samples.count()),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers([entries.cache.discard(Access::TransferWrite)]);
            cmd.clear(&entries.cache);
            cmd.barriers([entries.cache.from(Access::TransferWrite).to(Access::ComputeWrite)]);
            cmd.barriers([&entries.pointers, colors].map(|buffer| buffer.discard(Access::ComputeWrite)));
            cmd.barriers([counters.to(Access::ComputeWrite), seen.spids_to(Access::ComputeSample)]);
            let mut bound = bound.to_vec();
            bound.extend(entries.bound());
            bound.extend([
                ("Colors", Bound::Buffer(colors)),
                ("Counters", Bound::Buffer(counters.resource)),
                ("spids", samples.sampled(&samples.spids, Access::ComputeSample)),
            ]);
            let [width, height, tuples] = samples.threads();
            let groups = self.pipeline.groups([tuples * width, height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
