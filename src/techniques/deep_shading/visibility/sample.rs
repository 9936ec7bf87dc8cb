//! The draws of tuples: sharp triangles, in the places where each tuple has them. Shaders: sample.vert, sample.frag.

use super::super::choices::Choices;
use super::super::plan::{DEPTH_FORMAT, SHADING_DEPTH_FORMAT, SPID_FORMAT};
use super::super::primitives::{self, Primitives};
use super::Drawn;
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

/// How each draw call comes to its tuples.
pub struct Repeats {
    /// The call comes again for every `step`th of them, and is told it.
    pub tuples: Range<u32>,
    pub step: u32,
    /// Of each of these. More than one: an instance is a tuple.
    pub instance_count: u32,
}

impl Repeats {
    /// How often a vertex is fetched.
    pub fn round_count(&self) -> u32 {
        (self.tuples.len() as u32).div_ceil(self.step) * self.instance_count
    }
}

/// What tuples are drawn with before fragments.
pub struct Stages {
    pub vertex: &'static Shader,
    pub geometry: Option<&'static Shader>,
}

/// The vertex stage for `scene`; what draws the same triangles again shares it. `layer`: a value of its axis LAYER.
pub fn vertex_shader(scene: &SceneGpu, repeats: &Repeats, layer: &str) -> &'static Shader {
    let tuple = if repeats.instance_count > 1 { "instance" } else { "pushed" };
    variant(VERT_VARIANTS, &[mesh::vertex_name(scene), tuple, layer])
}

/// Draws `calls` by vertex fetches of the shaders' own: one after the other as the index buffer has them.
pub fn draw<'a>(
    cmd: &Commands,
    pipeline: &GraphicsPipeline,
    scene: &SceneGpu,
    primitives: &Primitives,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    repeats: &Repeats,
) {
    mesh::for_each(cmd, pipeline, scene, Sides::AsDrawn, calls, |call| {
        let (params, instances) = (primitives.params(scene, call), repeats.instance_count);
        for tuple in repeats.tuples.clone().step_by(repeats.step as usize) {
            cmd.push(&pipeline.interface, bytemuck::bytes_of(&primitives::of_tuple(params, tuple)));
            // SAFETY: the buffer is being recorded inside rendering; the importer checked that every index has its vertex.
            unsafe { cmd.gpu().device.cmd_draw(cmd.buffer(), call.index_count, instances, call.first_index, 0) };
        }
    });
}

/// Sets of both pipelines.
pub struct Sets([Option<vk::DescriptorSet>; 2]);

pub struct Sample {
    opaque: GraphicsPipeline,
    tested: GraphicsPipeline,
}

impl Sample {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, choices: &Choices) -> Result<Self> {
        let depth = if choices.has_zmax { "shading" } else { "none" };
        let formats = [SPID_FORMAT, SHADING_DEPTH_FORMAT];
        let repeats = choices.order.repeats(scene, &gpu.caps.limits, choices.table.tuple_count());
        let stages = choices.order.stages(scene, &repeats, choices.layer_from);
        let constants = [
            ("IS_MOVING", u32::from(choices.is_moving)),
            ("HAS_LENS", u32::from(choices.lens.is_some())),
            ("HAS_PADDING", u32::from(choices.has_padding)),
        ];
        let pipeline = |alpha| {
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: stages.vertex,
                    geometry: stages.geometry,
                    fragment: Some(variant(FRAG_VARIANTS, &[alpha, mesh::vertex_name(scene), depth])),
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
        Ok(Self { opaque: pipeline("opaque")?, tested: pipeline("tested")? })
    }

    /// One set for all tuples. `bound`: what shaders of the technique may read.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn sets(&self, cmd: &mut Commands, bound: &[(&'static str, Bound<'_>)]) -> Result<Sets> {
        let mut set = |pipeline: &GraphicsPipeline| cmd.set_for(pipeline, &pipeline.interface.own(bound));
        Ok(Sets([set(&self.opaque)?, set(&self.tested)?]))
    }

    /// All draws, inside rendering.
    pub fn draw(&self, cmd: &mut Commands, drawn: &Drawn<'_>, Sets([opaque, tested]): &Sets, repeats: &Repeats) {
        let Drawn { scene, list, primitives, .. } = drawn;
        for (pipeline, set, calls) in [(&self.opaque, opaque, &list.opaque), (&self.tested, tested, &list.mask)] {
            if let Some(first) = calls.first() {
                let params = primitives.params(scene, first);
                cmd.bind_with_set(pipeline, bytemuck::bytes_of(&params), *set);
                draw(cmd, pipeline, scene, primitives, calls, repeats);
            }
        }
    }
}
