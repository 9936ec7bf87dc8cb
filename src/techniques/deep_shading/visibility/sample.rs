//! The draws of one tuple: sharp triangles, in the places where the tuple has them. Shaders: sample.vert, sample.frag.

use super::super::choices::Choices;
use super::super::constants_of;
use super::super::plan::{DEPTH_FORMAT, SHADING_DEPTH_FORMAT, SPID_FORMAT};
use super::super::primitives::Primitives;
use super::stochastic;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::visibility::sample::{FRAG_VARIANTS, VERT_VARIANTS};
use crate::gpu::shader::{Shader, variant};
use crate::gpu::{Bound, Commands, Gpu};
use crate::passes::mesh::{self, Sides};
use crate::resident::{DrawCall, DrawList, SceneGpu};
use ash::vk;
use std::sync::Arc;

/// What triangles are drawn with.
pub struct Stages {
    pub vertex: &'static Shader,
    pub sides: Sides,
    /// Vertices of a triangle.
    pub vertex_count: u32,
}

/// Of the chosen visibility; what draws the same triangles again shares its vertex stage.
pub fn stages(scene: &SceneGpu, choices: &Choices) -> Stages {
    if choices.is_stochastic {
        return Stages {
            vertex: stochastic::vertex_shader(),
            // The shader tells sides apart: polygons have none.
            sides: Sides::Both,
            vertex_count: stochastic::vertex_count(choices),
        };
    }
    let vertex = variant(VERT_VARIANTS, &[mesh::vertex_name(scene)]);
    Stages { vertex, sides: Sides::AsDrawn, vertex_count: 3 }
}

/// Draws `calls` by vertex fetches of the shaders' own: one after the other as the index buffer has them.
pub fn draw<'a>(
    cmd: &Commands,
    (pipeline, stages): (&GraphicsPipeline, &Stages),
    scene: &SceneGpu,
    primitives: &Primitives,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    tuple: u32,
) {
    mesh::for_each(cmd, pipeline, scene, stages.sides, calls, |call| {
        let params = super::super::primitives::of_tuple(primitives.params(scene, call), tuple);
        cmd.push(&pipeline.interface, bytemuck::bytes_of(&params));
        let of = |indices: u32| indices / 3 * stages.vertex_count;
        let (count, first) = (of(call.index_count), of(call.first_index));
        // SAFETY: the buffer is being recorded inside rendering; the importer checked that every index has its vertex.
        unsafe { cmd.gpu().device.cmd_draw(cmd.buffer(), count, 1, first, 0) };
    });
}

/// Sets of both pipelines.
pub struct Sets([Option<vk::DescriptorSet>; 2]);

pub struct Sample {
    opaque: GraphicsPipeline,
    tested: GraphicsPipeline,
    stages: Stages,
}

impl Sample {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, choices: &Choices) -> Result<Self> {
        let depth = if choices.has_zmax { "shading" } else { "none" };
        let formats = [SPID_FORMAT, SHADING_DEPTH_FORMAT];
        let stages = stages(scene, choices);
        let fragments = if choices.is_stochastic { stochastic::fragment_shaders() } else { FRAG_VARIANTS };
        let pipeline = |alpha| {
            let fragment = variant(fragments, &[alpha, mesh::vertex_name(scene), depth]);
            let constants = constants_of(choices, &[Some(stages.vertex), Some(fragment)]);
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: stages.vertex,
                    geometry: None,
                    fragment: Some(fragment),
                    constants: &constants,
                    vertex_buffers: &[],
                    color_formats: if choices.has_zmax { &formats } else { &formats[..1] },
                    samples: 1,
                    blending: Blending::Replace,
                    depth_format: Some(DEPTH_FORMAT),
                    depth_write: true,
                    depth_compare: vk::CompareOp::GREATER,
                    depth_clamp: false,
                    depth_slope_bias: 0.0,
                    conservative: false,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        Ok(Self::of([pipeline("opaque")?, pipeline("tested")?], stages))
    }

    /// Of solid surfaces, and of those with an alpha.
    pub fn of([opaque, tested]: [GraphicsPipeline; 2], stages: Stages) -> Self {
        Self { opaque, tested, stages }
    }

    /// One set for all tuples. `bound`: what shaders of the technique may read.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn sets(&self, cmd: &mut Commands, bound: &[(&'static str, Bound<'_>)]) -> Result<Sets> {
        let mut set = |pipeline: &GraphicsPipeline| cmd.set_for(pipeline, &pipeline.interface.own(bound));
        Ok(Sets([set(&self.opaque)?, set(&self.tested)?]))
    }

    /// All draws of a tuple, inside rendering.
    pub fn draw(
        &self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        list: &DrawList,
        primitives: &Primitives,
        Sets([opaque, tested]): &Sets,
        tuple: u32,
    ) {
        for (pipeline, set, calls) in [(&self.opaque, opaque, &list.opaque), (&self.tested, tested, &list.mask)] {
            if let Some(first) = calls.first() {
                let params = primitives.params(scene, first);
                cmd.bind_with_set(pipeline, bytemuck::bytes_of(&params), *set);
                draw(cmd, (pipeline, &self.stages), scene, primitives, calls, tuple);
            }
        }
    }
}
