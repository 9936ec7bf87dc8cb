//! Samples as entries, each by itself: the oracle of the lists (`--lists none`). Shader: samples.comp.
//! reads  visibility.spids      writes  shade.colors

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::entries::samples::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::Samples;
use std::sync::Arc;

pub const PASS: &str = "entries.samples";

pub struct SampleEntries {
    pipeline: ComputePipeline,
}

impl SampleEntries {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &constants_of(choices, &[Some(&COMP)]))? })
    }

    /// Nothing has touched `colors`.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        seen: Edge<'_, Samples>,
        colors: &Buffer,
    ) -> Result<()> {
        let samples = seen.resource;
        let traffic = Traffic {
            read_bytes: Some(samples.spids.description.bytes()),
            written_bytes: Some(colors.bytes),
            invocations: Some(samples.count()),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers([seen.spids_to(Access::ComputeSample)]);
            cmd.barriers([colors.discard(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend([
                ("Colors", Bound::Buffer(colors)),
                ("spids", samples.sampled(&samples.spids, Access::ComputeSample)),
            ]);
            let groups = self.pipeline.groups(samples.threads());
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
