//! Shade: the entries of the order, each once. Shader: shade.comp.
//! reads and writes  shade.colors: buffer, 8 B an entry: RGBA16F      reads  entries.order, the scene, its lights, the tuples

use super::super::pass_inputs::{DrawInputs, ShadingEdges};
use super::order::EntryOrder;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::entries::shade::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Commands, Gpu, Traffic};
use crate::passes::{mesh, shadow_maps};
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::resources::full;
use std::sync::Arc;

pub struct ShadeEntries {
    pipeline: ComputePipeline,
    pass: &'static str,
}

impl ShadeEntries {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, choices: &Choices) -> Result<Self> {
        let shadows = shadow_maps::axis(choices.maps.is_some());
        let shader = variant(COMP_VARIANTS, &[mesh::vertex_name(scene), shadows]);
        let constants = constants_of(choices, &[Some(shader)]);
        let pipeline = ComputePipeline::with_sets(gpu, shader, &constants, &[scene.material_layout])?;
        Ok(Self { pipeline, pass: choices.entries_pass() })
    }

    /// `order`: as the sort left it.
    pub fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        order: &EntryOrder,
        edges: ShadingEdges<'_>,
    ) -> Result<()> {
        let ShadingEdges { colors, counters, maps } = edges;
        // Entries are counted after the frame.
        cmd.pass(&full(self.pass), Traffic::default(), |cmd| {
            cmd.barriers(inputs.scales_to(Access::ComputeRead));
            cmd.barriers(maps.and_then(|maps| maps.to(Access::ComputeSample)));
            cmd.barriers([colors, counters].map(|edge| edge.to(Access::ComputeWrite)));
            let mut bound = inputs.bound.to_vec();
            bound.extend(
                [("Colors", colors), ("Counters", counters)].map(|(name, edge)| (name, Bound::Buffer(edge.resource))),
            );
            order.dispatch(cmd, &self.pipeline, inputs, bound)
        })
    }
}
