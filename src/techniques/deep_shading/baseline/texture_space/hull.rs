//! Draws' triangles in their textures: all texels that look-ups read, for fragments to claim or to shade. Shader: hull.vert.
//! reads   the scene, texture_space.atlas, texture_space.charts

use super::super::super::choices::Choices;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::Shader;
use crate::gpu::shader::techniques::deep_shading::baseline::texture_space::hull::VERT;
use crate::gpu::shader::techniques::deep_shading::hull::HULL_VERTICES;
use crate::gpu::{Bound, Commands, Gpu};
use crate::passes::mesh;
use crate::resident::{DrawList, SceneGpu, Sides};
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::pass_inputs::DrawInputs;
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

pub struct Hulls {
    pipeline: GraphicsPipeline,
    texture: Extent,
}

impl Hulls {
    /// `fragment`: what is done with a texel; `side_px`: of textures.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        choices: &Choices,
        side_px: u32,
        fragment: &'static Shader,
    ) -> Result<Self> {
        let constants = constants_of(choices, &[Some(&VERT), Some(fragment)]);
        let pipeline = GraphicsPipeline::new(
            gpu,
            &GraphicsDescription {
                vertex: &VERT,
                geometry: None,
                fragment: Some(fragment),
                constants: &constants,
                vertex_buffers: &[],
                color_formats: &[],
                samples: 1,
                are_placed: false,
                blending: Blending::Replace,
                depth_format: None,
                depth_write: false,
                depth_compare: vk::CompareOp::ALWAYS,
                depth_clamp: false,
                depth_bias: DepthBias::NONE,
                conservative_margin_px: None,
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        Ok(Self { pipeline, texture: Extent::new(side_px, side_px) })
    }

    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn set(&self, cmd: &mut Commands, bound: &[(&'static str, Bound<'_>)]) -> Result<Option<vk::DescriptorSet>> {
        cmd.set_for(&self.pipeline, &self.pipeline.interface.own(bound))
    }

    /// Each of `draws` into the texture of its place, whose set is in `sets`.
    pub fn draw(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        draws: &[DrawList],
        sets: &[Option<vk::DescriptorSet>],
    ) {
        let DrawInputs { scene, primitives, .. } = inputs;
        cmd.begin_rendering(self.texture, &[], None);
        for (list, set) in draws.iter().zip(sets) {
            let Some(first) = list.calls().next() else { continue };
            cmd.bind_with_set(&self.pipeline, bytemuck::bytes_of(&primitives.params(scene, first)), *set);
            mesh::for_each(cmd, &self.pipeline, scene, Some(Sides::Both), list.calls(), |call| {
                cmd.push(&self.pipeline.interface, bytemuck::bytes_of(&primitives.params(scene, call)));
                let [count, first] = [call.index_count, call.first_index].map(|indices| indices / 3 * HULL_VERTICES);
                // SAFETY: the buffer is being recorded inside rendering; the importer checked that every index has its vertex.
                unsafe { cmd.gpu().device.cmd_draw(cmd.buffer(), count, 1, first, 0) };
            });
        }
        cmd.end_rendering();
    }
}
