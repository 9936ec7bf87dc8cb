//! Material pass: every solid surface that is seen, with its whole material, under the lights of its object's list.
//! Shaders: mesh.vert, material.frag.
//! reads   the scene, the lights, their lists, the tree or the shadow maps, the depth buffer
//! writes  the picture, all samples; without a pre-pass the depth buffer
//!
//! Where pixels have one sample the same picture is made with and without a pre-pass (depth_prepass.rs).

use super::choices::ForwardChoices;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::passes::forward::material::FRAG_VARIANTS;
use crate::gpu::shader::structs::MaterialParams;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic};
use crate::lights::object_lists::ObjectLights;
use crate::passes::depth_prepass::{self, DepthBegins};
use crate::passes::mesh;
use crate::passes::shadow_maps::{self, ShadowMaps};
use crate::resident::{DrawCall, DrawList, SceneGpu};
use ash::vk;
use bytemuck::Zeroable;
use glam::Vec3;
use std::sync::Arc;

/// Full name of a technique's pass.
pub fn pass(technique: &str) -> String {
    format!("{technique}.material")
}

pub struct Material {
    /// Its full name.
    pass: String,
    opaque: GraphicsPipeline,
    mask: GraphicsPipeline,
    has_prepass: bool,
    /// By index into the scene's draws.
    objects: Vec<ObjectLights>,
    background: Vec3,
}

impl Material {
    /// `constants`: of light and of levels. `background`: radiance where no surface is.
    pub fn new(
        gpu: &Arc<Gpu>,
        technique: &str,
        scene: &SceneGpu,
        choices: &ForwardChoices,
        constants: &[(&'static str, u32)],
        (objects, background): (&[ObjectLights], Vec3),
    ) -> Result<Self> {
        let ForwardChoices { samples, has_prepass, is_uniform, .. } = *choices;
        let lights = if is_uniform { "uniform" } else { "storage" };
        let shaded = samples.shaded_name();
        let shadows = shadow_maps::axis(choices.maps.is_some());
        let pipeline = |alpha: &str| {
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: mesh::vertex_shader(scene),
                    geometry: None,
                    fragment: Some(variant(FRAG_VARIANTS, &[alpha, mesh::vertex_name(scene), lights, shadows, shaded])),
                    constants: &[constants, &[scene.texture_constant()]].concat(),
                    vertex_buffers: mesh::vertex_buffers(scene),
                    color_formats: &[samples.format],
                    samples: samples.count,
                    are_placed: samples.are_placed,
                    blending: Blending::Replace,
                    depth_format: Some(depth_prepass::FORMAT),
                    depth_write: !has_prepass,
                    depth_compare: depth_prepass::compare(has_prepass),
                    depth_clamp: false,
                    depth_bias: DepthBias::NONE,
                    conservative_margin_px: None,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        let (opaque, mask) = (pipeline("opaque")?, pipeline("mask")?);
        Ok(Self { pass: pass(technique), opaque, mask, has_prepass, objects: objects.to_vec(), background })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        scene: &SceneGpu,
        list: &DrawList,
        lights: &MaterialLights<'_>,
        targets: &Targets,
    ) -> Result<()> {
        let (depth, color) = (&targets.depth, &targets.drawn);
        let traffic = Traffic {
            // Each sample once: overdraw depends on the view.
            written_bytes: Some(
                color.description.bytes() + if self.has_prepass { 0 } else { depth.description.bytes() },
            ),
            ..Traffic::default()
        };
        let mut bound = mesh::bound(frame, scene);
        bound.extend_from_slice(lights.bound);
        bound.extend(lights.maps.iter().flat_map(|maps| maps.resource.bound()));
        cmd.pass(&self.pass, traffic, |cmd| {
            cmd.barriers([color.discard(Access::ColorWrite)]);
            cmd.barriers(lights.maps.and_then(|maps| maps.to(Access::FragmentSample)));
            let depth = depth_prepass::attach(cmd, depth, targets.begins, self.has_prepass);
            let clear = vk::ClearColorValue { float32: self.background.extend(0.0).to_array() };
            cmd.begin_rendering(color.description.extent, &[ColorTarget::new(color, Some(clear))], Some(depth));
            mesh::bind_streams(cmd, scene);
            self.draw(cmd, &self.opaque, scene, &bound, &list.opaque)?;
            self.draw(cmd, &self.mask, scene, &bound, &list.mask)?;
            cmd.end_rendering();
            Ok(())
        })
    }

    fn draw(
        &self,
        cmd: &mut Commands,
        pipeline: &GraphicsPipeline,
        scene: &SceneGpu,
        bound: &[(&str, Bound<'_>)],
        calls: &[DrawCall],
    ) -> Result<()> {
        if calls.is_empty() {
            return Ok(());
        }
        cmd.bind_graphics(pipeline, bytemuck::bytes_of(&MaterialParams::zeroed()), bound)?;
        let mut known = None;
        mesh::draw_each(cmd, pipeline, scene, calls, |call| {
            if known != Some(call.draw) {
                known = Some(call.draw);
                let params = MaterialParams {
                    material: scene.material_blocks[call.material as usize],
                    object: self.objects[call.draw as usize].block(),
                };
                cmd.push(&pipeline.interface, bytemuck::bytes_of(&params));
            }
        });
        Ok(())
    }
}

/// What the draws are lit by.
pub struct MaterialLights<'a> {
    /// The lights, their lists, the tree.
    pub bound: &'a [(&'static str, Bound<'a>)],
    pub maps: Option<Edge<'a, ShadowMaps>>,
}

/// What the draws are drawn into, of one extent and `ForwardChoices::samples`.
pub struct Targets {
    pub depth: Image,
    pub begins: DepthBegins,
    pub drawn: Image,
}
