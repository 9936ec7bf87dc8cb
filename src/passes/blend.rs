//! BLEND surfaces over the finished picture: forward, back to front by their boxes' middles, counted.
//! Shaders: mesh.vert, blend.frag.
//! reads  the scene, every light, the G-buffer's depth      writes  the picture
//!
//! Their indirect light comes from all virtual point lights, or from the subset of the pixel as that of every other
//! surface does. A blended surface has no neighbours to filter with, so that its subsets show as a faint pattern; hall at
//! 1024x768, 480 lights, 8x6: FLIP against every light on every pixel is 0.0431 with subsets and 0.0415 without, and the
//! pass takes 15 ms instead of 104 on lavapipe.

use super::{gbuffer, mesh};
use crate::error::Result;
use crate::frame::View;
use crate::gpu::Bound;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::passes::blend::FRAG_VARIANTS;
use crate::gpu::shader::structs::BlendParams;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic};
use crate::plan::PICTURE_FORMAT;
use crate::resident::{DrawCall, SceneGpu};
use crate::scene::AlphaMode;
use ash::vk;
use std::sync::Arc;

/// What the fragment stage reads beside the scene.
pub struct BlendLights<'a> {
    pub lights: &'a Buffer,
    pub vpls: &'a Buffer,
    /// Stretches of `vpls`; read where the pattern is not 0x0.
    pub subsets: &'a Buffer,
    pub bvh_nodes: &'a Buffer,
    pub bvh_triangles: &'a Buffer,
}

/// What the pass touches: depth, and the picture of this full name.
pub fn touches(technique: &str, picture: &str) -> [(String, Access); 2] {
    [gbuffer::depth_tested(technique), (picture.to_owned(), Access::ColorWrite)]
}

/// Every virtual point light on every pixel, none nearer than the root of `least_squared` (m^2).
pub fn all_lights(least_squared: f32) -> BlendParams {
    BlendParams { least_squared, weight: 1.0, pattern_x: 0, pattern_y: 0 }
}

/// The BLEND draws, farthest first, by the middles of their boxes.
pub fn back_to_front(scene: &SceneGpu, view: &View) -> Vec<DrawCall> {
    let eye = view.eye();
    let mut calls: Vec<DrawCall> = scene.calls.iter().filter(|call| call.alpha == AlphaMode::Blend).copied().collect();
    calls.sort_by(|a, b| {
        let distance = |call: &DrawCall| call.center_ws.distance_squared(eye);
        distance(b).total_cmp(&distance(a))
    });
    calls
}

pub struct Blend {
    pipeline: GraphicsPipeline,
    /// Farthest first.
    calls: Vec<DrawCall>,
    params: BlendParams,
}

impl Blend {
    /// None where the scene has no BLEND surface. `constants`: `ShadingSettings::light_constants`.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        view: &View,
        params: BlendParams,
        constants: &[(&str, u32)],
    ) -> Result<Option<Self>> {
        let calls = back_to_front(scene, view);
        if calls.is_empty() {
            return Ok(None);
        }
        let pipeline = GraphicsPipeline::new(
            gpu,
            &GraphicsDescription {
                vertex: mesh::vertex_shader(scene),
                fragment: Some(variant(FRAG_VARIANTS, &[mesh::vertex_name(scene)])),
                constants,
                vertex_buffers: mesh::vertex_buffers(scene),
                color_formats: &[PICTURE_FORMAT],
                samples: 1,
                blending: Blending::Over,
                depth_format: Some(vk::Format::D32_SFLOAT),
                depth_write: false,
                depth_compare: vk::CompareOp::GREATER_OR_EQUAL,
                depth_clamp: false,
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        Ok(Some(Self { pipeline, calls, params }))
    }

    #[allow(clippy::too_many_arguments)]
    pub fn record(
        &self,
        cmd: &mut Commands,
        technique: &str,
        frame: &Buffer,
        scene: &SceneGpu,
        lights: &BlendLights<'_>,
        depth: Edge<'_, Image>,
        picture: Edge<'_, Image>,
    ) -> Result<()> {
        let traffic = Traffic { read_bytes: mesh::read_bytes(scene, &self.calls), written_bytes: 0, invocations: None };
        cmd.pass(&format!("{technique}.blend"), traffic, |cmd| {
            cmd.barriers([depth.to(Access::DepthTest), picture.to(Access::ColorWrite)]);
            let extent = picture.resource.description.extent;
            cmd.begin_rendering(
                extent,
                &[ColorTarget::new(picture.resource, None)],
                Some((depth.resource, None, Access::DepthTest)),
            );
            mesh::bind_streams(cmd, scene);
            let mut bound = mesh::bound(frame, scene);
            bound.extend([
                ("Materials", Bound::Buffer(&scene.materials)),
                ("Lights", Bound::Buffer(lights.lights)),
                ("Vpls", Bound::Buffer(lights.vpls)),
                ("Subsets", Bound::Buffer(lights.subsets)),
                ("BvhNodes", Bound::Buffer(lights.bvh_nodes)),
                ("BvhTriangles", Bound::Buffer(lights.bvh_triangles)),
            ]);
            cmd.bind_graphics(&self.pipeline, bytemuck::bytes_of(&self.params), &bound)?;
            mesh::draw(cmd, &self.pipeline, scene, &self.calls);
            cmd.end_rendering();
            Ok(())
        })
    }
}
