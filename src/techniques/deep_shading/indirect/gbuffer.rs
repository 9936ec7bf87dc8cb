//! What materials say of the entries, into the compact geometry buffer. Shader: gbuffer.comp.
//! reads   shade.colors, entries.order, the scene, the tuples
//! writes  indirect.places, indirect.normals, indirect.base_colors, indirect.radiances

use super::super::choices::Choices;
use super::super::entries::order::EntryOrder;
use super::super::pass_inputs::DrawInputs;
use super::compact::Entries;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::indirect::gbuffer::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::mesh;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::resources::full;
use std::sync::Arc;

pub const PASS: &str = "indirect.gbuffer";

pub struct Gbuffer {
    pipeline: ComputePipeline,
}

impl Gbuffer {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, choices: &Choices) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[mesh::vertex_name(scene)]);
        let constants = constants_of(choices, &[Some(shader)]);
        Ok(Self { pipeline: ComputePipeline::with_sets(gpu, shader, &constants, &[scene.material_layout])? })
    }

    /// `colors`: where entries wait.
    pub fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        order: &EntryOrder,
        entries: &Entries,
        colors: Edge<'_, Buffer>,
    ) -> Result<()> {
        // Entries are counted after the frame.
        cmd.pass(&full(PASS), Traffic::default(), |cmd| {
            cmd.barriers(entries.entries.iter().map(|buffer| buffer.discard(Access::ComputeWrite)));
            cmd.barriers(inputs.scales_to(Access::ComputeRead));
            cmd.barriers([colors.to(Access::ComputeRead)]);
            let mut bound = inputs.bound.to_vec();
            bound.extend(entries.bound());
            bound.push(("Colors", Bound::Buffer(colors.resource)));
            order.dispatch(cmd, &self.pipeline, inputs, bound)
        })
    }
}
