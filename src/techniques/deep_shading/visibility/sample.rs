//! The draws of tuples: sharp triangles, in the places where each tuple has them. Shaders: sample.vert, sample.frag.

use super::super::choices::Choices;
use super::stages;
use super::stochastic;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::visibility::sample::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Bound, Commands, Gpu};
use crate::passes::mesh::{self};
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::pass_inputs::DrawInputs;
use crate::techniques::deep_shading::resources::{DEPTH_FORMAT, SHADING_DEPTH_FORMAT, SPID_FORMAT};
use crate::techniques::deep_shading::visibility::draw::{Repeats, SampleStages, draw};
use ash::vk;
use std::sync::Arc;

/// Sets of both pipelines.
pub struct PipelineSets([Option<vk::DescriptorSet>; 2]);

pub struct TupleDraws {
    opaque: GraphicsPipeline,
    tested: GraphicsPipeline,
    stages: SampleStages,
}

impl TupleDraws {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, choices: &Choices) -> Result<Self> {
        let vertices = choices.raster.vertices;
        let depth = if choices.lists.has_zmax { "shading" } else { "none" };
        let formats = [SPID_FORMAT, SHADING_DEPTH_FORMAT];
        let repeats = choices.visibility.repeats(scene, &gpu.caps.limits, choices.table.tuple_count());
        let stages = stages::stages(scene, choices, &repeats);
        let pipeline = |alpha| {
            let vertex = mesh::vertex_name(scene);
            // What is interleaved counts nothing.
            let fragment = match choices.visibility {
                Visibility::Stochastic => variant(stochastic::FRAGMENTS, &[alpha, vertex, depth, choices.count_axis()]),
                _ => variant(FRAG_VARIANTS, &[alpha, vertex, depth, vertices.name()]),
            };
            let constants = constants_of(choices, &[Some(stages.vertex), stages.geometry, Some(fragment)]);
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: stages.vertex,
                    geometry: stages.geometry,
                    fragment: Some(fragment),
                    constants: &constants,
                    vertex_buffers: &[],
                    color_formats: if choices.lists.has_zmax { &formats } else { &formats[..1] },
                    samples: 1,
                    are_placed: false,
                    blending: Blending::Replace,
                    depth_format: Some(DEPTH_FORMAT),
                    depth_write: true,
                    depth_compare: vk::CompareOp::GREATER,
                    depth_clamp: false,
                    depth_bias: DepthBias::NONE,
                    conservative_margin_px: None,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        Ok(Self::of([pipeline("opaque")?, pipeline("tested")?], stages))
    }

    /// Pipelines of solid surfaces, and of surfaces with an alpha.
    pub fn of([opaque, tested]: [GraphicsPipeline; 2], stages: SampleStages) -> Self {
        Self { opaque, tested, stages }
    }

    /// One set for all tuples. `bound`: what shaders of the technique may read.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn sets(&self, cmd: &mut Commands, bound: &[(&'static str, Bound<'_>)]) -> Result<PipelineSets> {
        let mut set = |pipeline: &GraphicsPipeline| cmd.set_for(pipeline, &pipeline.interface.own(bound));
        Ok(PipelineSets([set(&self.opaque)?, set(&self.tested)?]))
    }

    /// All draws, inside rendering.
    pub fn draw(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        PipelineSets([opaque, tested]): &PipelineSets,
        repeats: &Repeats,
    ) {
        let DrawInputs { scene, list, primitives, .. } = inputs;
        for (pipeline, set, calls) in [(&self.opaque, opaque, &list.opaque), (&self.tested, tested, &list.mask)] {
            if let Some(first) = calls.first() {
                let params = primitives.params(scene, first);
                cmd.bind_with_set(pipeline, bytemuck::bytes_of(&params), *set);
                draw(cmd, pipeline, &self.stages, inputs, calls, repeats);
            }
        }
    }
}
