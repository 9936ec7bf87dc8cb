//! What casts shadows, drawn into one map or a part of one. Shaders: shadow_maps.vert and, for MASK surfaces, shadow_maps.frag.

use super::format::FORMAT;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::passes::shadow_maps::{FRAG_VARIANTS, VERT_VARIANTS};
use crate::gpu::shader::structs::ShadowMapsParams;
use crate::gpu::shader::variant;
use crate::gpu::{Bound, Buffer, Commands, Gpu};
use crate::passes::mesh;
use crate::resident::{DrawList, SceneGpu};
use ash::vk;
use bytemuck::Zeroable;
use std::sync::Arc;

pub struct CasterPipelines {
    opaque: GraphicsPipeline,
    mask: GraphicsPipeline,
}

/// What both read.
pub struct CasterSets {
    opaque: Option<vk::DescriptorSet>,
    mask: Option<vk::DescriptorSet>,
}

impl CasterPipelines {
    /// `slope_bias_px`: texels whose change of depth surfaces are pushed away by.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, slope_bias_px: f32) -> Result<Self> {
        let vertex_name = mesh::vertex_name(scene);
        let of_textures = [scene.texture_constant()];
        let pipeline = |alpha, vertex_buffers, fragment: Option<_>| {
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: variant(VERT_VARIANTS, &[alpha, vertex_name]),
                    geometry: None,
                    fragment,
                    constants: if fragment.is_some() { &of_textures } else { &[] },
                    vertex_buffers,
                    color_formats: &[],
                    samples: 1,
                    are_placed: false,
                    blending: Blending::Replace,
                    depth_format: Some(FORMAT),
                    depth_write: true,
                    depth_compare: vk::CompareOp::GREATER,
                    depth_clamp: false,
                    // Depth is reversed: less is farther from the light.
                    depth_bias: DepthBias { slope: -slope_bias_px, ..DepthBias::NONE },
                    conservative_margin_px: None,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        let mask = variant(FRAG_VARIANTS, &[vertex_name]);
        Ok(Self {
            opaque: pipeline("opaque", mesh::POSITIONS, None)?,
            mask: pipeline("mask", mesh::vertex_buffers(scene), Some(mask))?,
        })
    }

    /// `views`: clip space of each map or part.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn sets(&self, cmd: &mut Commands, scene: &SceneGpu, views: &Buffer) -> Result<CasterSets> {
        let draws = [("Draws", Bound::Buffer(&scene.pose.draws)), ("ShadowMapViews", Bound::Buffer(views))];
        let placements = scene.extended.as_ref().map(|extended| ("Placements", Bound::Buffer(&extended.placements)));
        let cut: Vec<_> = draws.into_iter().chain(placements).collect();
        Ok(CasterSets { opaque: cmd.set_for(&self.opaque, &draws)?, mask: cmd.set_for(&self.mask, &cut)? })
    }

    /// Draws `casters` as the view of this number sees them, inside rendering, where the scene's streams are bound.
    pub fn draw(&self, cmd: &mut Commands, scene: &SceneGpu, sets: &CasterSets, view: u32, casters: &DrawList) {
        let params = |material: u32| ShadowMapsParams {
            material: scene.material_blocks[material as usize],
            layer: view,
            ..ShadowMapsParams::zeroed()
        };
        if let Some(first) = casters.opaque.first() {
            cmd.bind_with_set(&self.opaque, bytemuck::bytes_of(&params(first.material)), sets.opaque);
            mesh::draw_with(cmd, &self.opaque, scene, &casters.opaque, |_| ());
        }
        if let Some(first) = casters.mask.first() {
            cmd.bind_with_set(&self.mask, bytemuck::bytes_of(&params(first.material)), sets.mask);
            let push = |material| cmd.push(&self.mask.interface, bytemuck::bytes_of(&params(material)));
            mesh::draw_with(cmd, &self.mask, scene, &casters.mask, push);
        }
    }
}
