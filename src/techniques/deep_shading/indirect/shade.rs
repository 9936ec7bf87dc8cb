//! Shade: the entries of the compact geometry buffer, each once (Liktor & Dachsbacher 2012). Shader: shade.comp.
//! reads   indirect.places, .normals, .base_colors, .radiances, the lights
//! writes  shade.colors  buffer, 8 B an entry: RGBA16F

use super::super::choices::Choices;
use super::super::pass_inputs::ShadingEdges;
use super::compact::Entries;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::indirect::shade::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Commands, Edge, Gpu, Traffic};
use crate::passes::shadow_maps;
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::resources::full;
use crate::units::Extent;
use std::sync::Arc;

pub struct Shade {
    pipeline: ComputePipeline,
    /// As many threads as samples: so many entries there may be.
    threads: [u32; 3],
}

impl Shade {
    /// `frame`: its extent.
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, frame: Extent) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[shadow_maps::axis(choices.maps.is_some())]);
        let layer = choices.table.layer(frame);
        Ok(Self {
            pipeline: ComputePipeline::new(gpu, shader, &constants_of(choices, &[Some(shader)]))?,
            threads: [layer.width, layer.height, choices.table.tuple_count()],
        })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        made: Edge<'_, Entries>,
        edges: ShadingEdges<'_>,
    ) -> Result<()> {
        let ShadingEdges { colors, counters, maps } = edges;
        // Entries are counted after the frame.
        cmd.pass(&full("indirect.shade"), Traffic::default(), |cmd| {
            cmd.barriers(maps.and_then(|maps| maps.to(Access::ComputeSample)));
            cmd.barriers(made.to(Access::ComputeRead));
            cmd.barriers([colors, counters].map(|edge| edge.to(Access::ComputeWrite)));
            let mut bound = bound.to_vec();
            bound.extend(made.resource.bound());
            bound.extend(
                [("Colors", colors), ("Counters", counters)].map(|(name, edge)| (name, Bound::Buffer(edge.resource))),
            );
            let groups = self.pipeline.groups(self.threads);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
