//! The draws of tuples: sharp triangles, in the places where each tuple has them. Shaders: sample.vert, sample.frag.

use super::super::choices::Choices;
use super::super::constants_of;
use super::super::plan::{DEPTH_FORMAT, SHADING_DEPTH_FORMAT, SPID_FORMAT};
use super::super::primitives::{self, Primitives};
use super::{Drawn, Visibility, stochastic};
use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::visibility::sample::{FRAG_VARIANTS, VERT_VARIANTS};
use crate::gpu::shader::{Shader, variant};
use crate::gpu::{Bound, Commands, Gpu};
use crate::passes::mesh::{self, Sides};
use crate::resident::{DrawCall, SceneGpu};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// How each draw call is repeated for its tuples.
pub struct Repeats {
    /// The call is repeated for every `step`th of them, whose number it gets.
    pub tuples: Range<u32>,
    pub step: u32,
    /// Instances of each of these draws. More than one: an instance is a tuple.
    pub instance_count: u32,
}

impl Repeats {
    /// How often a vertex is fetched.
    pub fn round_count(&self) -> u32 {
        (self.tuples.len() as u32).div_ceil(self.step) * self.instance_count
    }
}

/// Shader stages that triangles are drawn with.
pub struct Stages {
    pub vertex: &'static Shader,
    pub geometry: Option<&'static Shader>,
    pub sides: Sides,
    /// Vertices of a triangle.
    pub vertex_count: u32,
}

impl Stages {
    /// Stages that draw triangles as one tuple sees them.
    pub fn sharp(vertex: &'static Shader, geometry: Option<&'static Shader>) -> Self {
        Self { vertex, geometry, sides: Sides::AsDrawn, vertex_count: 3 }
    }

    /// How many vertices a call has, and the first.
    pub fn vertices(&self, call: &DrawCall) -> [u32; 2] {
        [call.index_count, call.first_index].map(|indices| indices / 3 * self.vertex_count)
    }
}

/// The vertex stage for `scene`. `layer`: a value of its axis LAYER.
pub fn vertex_shader(scene: &SceneGpu, repeats: &Repeats, layer: &str) -> &'static Shader {
    let tuple = if repeats.instance_count > 1 { "instance" } else { "pushed" };
    variant(VERT_VARIANTS, &[mesh::vertex_name(scene), tuple, layer])
}

/// Draws `calls` by vertex fetches of the shaders' own: one after the other as the index buffer has them.
pub fn draw<'a>(
    cmd: &Commands,
    (pipeline, stages): (&GraphicsPipeline, &Stages),
    scene: &SceneGpu,
    primitives: &Primitives,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    repeats: &Repeats,
) {
    draw_by(cmd, (pipeline, stages.sides), scene, primitives, calls, repeats, |call| {
        let [count, first] = stages.vertices(call);
        // SAFETY: the buffer is being recorded inside rendering; the importer checked that every index has its vertex.
        unsafe { cmd.gpu().device.cmd_draw(cmd.buffer(), count, repeats.instance_count, first, 0) };
    });
}

/// The same for a caller that draws the vertices of a call itself: `draw`, for each of its repeats.
pub fn draw_by<'a>(
    cmd: &Commands,
    (pipeline, sides): (&GraphicsPipeline, Sides),
    scene: &SceneGpu,
    primitives: &Primitives,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    repeats: &Repeats,
    mut draw: impl FnMut(&DrawCall),
) {
    mesh::for_each(cmd, pipeline, scene, sides, calls, |call| {
        let params = primitives.params(scene, call);
        for tuple in repeats.tuples.clone().step_by(repeats.step as usize) {
            cmd.push(&pipeline.interface, bytemuck::bytes_of(&primitives::of_tuple(params, tuple)));
            draw(call);
        }
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
        let repeats = choices.visibility.repeats(scene, &gpu.caps.limits, choices.table.tuple_count());
        let stages = super::stages(scene, choices, &repeats);
        let fragments =
            if choices.visibility == Visibility::Stochastic { stochastic::FRAGMENTS } else { FRAG_VARIANTS };
        let pipeline = |alpha| {
            let fragment = variant(fragments, &[alpha, mesh::vertex_name(scene), depth]);
            let constants = constants_of(choices, &[Some(stages.vertex), stages.geometry, Some(fragment)]);
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: stages.vertex,
                    geometry: stages.geometry,
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
                    conservative_margin_px: None,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        Ok(Self::of([pipeline("opaque")?, pipeline("tested")?], stages))
    }

    /// Pipelines of solid surfaces, and of surfaces with an alpha.
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

    /// All draws, inside rendering.
    pub fn draw(&self, cmd: &mut Commands, drawn: Drawn<'_>, Sets([opaque, tested]): &Sets, repeats: &Repeats) {
        let Drawn { scene, list, primitives, .. } = drawn;
        for (pipeline, set, calls) in [(&self.opaque, opaque, &list.opaque), (&self.tested, tested, &list.mask)] {
            if let Some(first) = calls.first() {
                let params = primitives.params(scene, first);
                cmd.bind_with_set(pipeline, bytemuck::bytes_of(&params), *set);
                draw(cmd, (pipeline, &self.stages), scene, primitives, calls, repeats);
            }
        }
    }
}
