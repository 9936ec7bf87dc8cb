//! The draws of one tuple: sharp triangles, in the places where the tuple has them. Shaders: sample.vert, sample.frag.

use super::super::choices::Choices;
use super::super::plan::{DEPTH_FORMAT, SHADING_DEPTH_FORMAT, SPID_FORMAT};
use super::super::primitives::Primitives;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::visibility::sample::{FRAG_VARIANTS, VERT_VARIANTS};
use crate::gpu::shader::{Shader, variant};
use crate::gpu::{Bound, Commands, Gpu};
use crate::passes::mesh::{self, Sides};
use crate::resident::{DrawCall, DrawList, SceneGpu};
use ash::vk;
use std::sync::Arc;

/// The vertex stage for `scene`; what draws the same triangles again shares it.
pub fn vertex_shader(scene: &SceneGpu) -> &'static Shader {
    variant(VERT_VARIANTS, &[mesh::vertex_name(scene)])
}

/// Draws `calls` by vertex fetches of the shaders' own: one after the other as the index buffer has them.
pub fn draw<'a>(
    cmd: &Commands,
    pipeline: &GraphicsPipeline,
    scene: &SceneGpu,
    primitives: &Primitives,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    tuple: u32,
) {
    mesh::for_each(cmd, pipeline, scene, Sides::AsDrawn, calls, |call| {
        let params = super::super::primitives::of_tuple(primitives.params(scene, call), tuple);
        cmd.push(&pipeline.interface, bytemuck::bytes_of(&params));
        // SAFETY: the buffer is being recorded inside rendering; the importer checked that every index has its vertex.
        unsafe { cmd.gpu().device.cmd_draw(cmd.buffer(), call.index_count, 1, call.first_index, 0) };
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
        let constants = [("IS_MOVING", u32::from(choices.is_moving)), ("HAS_LENS", u32::from(choices.lens.is_some()))];
        let pipeline = |alpha| {
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: vertex_shader(scene),
                    geometry: None,
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
                draw(cmd, pipeline, scene, primitives, calls, tuple);
            }
        }
    }
}
