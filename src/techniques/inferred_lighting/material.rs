//! Material: the scene at full size with full materials, lit by the L-buffer through a filter.
//! Kircher 2009, sections 2.3, 3, 4. Shaders: mesh.vert, material.frag; the filter: light_filter.glsl.
//! reads   the scene, light.l_buffer, geometry.dsf, and geometry.normal where the filter compares normals
//! writes  material.color       image, RGBA32F, frame extent; with --msaa material.samples, which `resolve` averages
//!         material.depth       image, 4 B a sample, reversed; with --depth-prepass the pass before this one writes it
//!         material.rejections  buffer: fragments, solid and BLEND, that none of the four samples belonged to

use super::choices::{Choices, LightFilter};
use super::geometry::LowGeometry;
use super::light;
use super::stipple::StippledDraw;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::structs::InferredMaterialParams;
use crate::gpu::shader::techniques::inferred_lighting::material::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic, readback};
use crate::passes::depth_prepass::{self, DepthBegins, DepthPrepass};
use crate::passes::resolve::{self, Resolve};
use crate::passes::samples::Samples;
use crate::passes::{blend, mesh};
use crate::plan::{Plan, Resources};
use crate::resident::{DrawList, SceneGpu};
use crate::techniques::inferred_lighting::resources::NAME;
use crate::units::Extent;
use ash::vk;
use bytemuck::Zeroable;
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Bytes of the two counters.
const REJECTIONS_BYTES: u64 = 8;

fn full(what: &str) -> String {
    format!("{NAME}.material.{what}")
}

/// Plans its images and its counters.
pub fn plan(plan: &mut Plan, extent: Extent, samples: Samples, is_counted: bool) {
    use vk::ImageUsageFlags as Usage;
    plan.picture(full("color"), extent);
    if samples.are_many() {
        plan.multisampled("picture", full("samples"), extent, samples.format, samples.count, resolve::DRAWN);
    }
    plan.multisampled(
        "picture",
        full("depth"),
        extent,
        depth_prepass::FORMAT,
        samples.count,
        Usage::DEPTH_STENCIL_ATTACHMENT,
    );
    if is_counted {
        plan.buffer("counters", full("rejections"), REJECTIONS_BYTES);
        plan.read_back(&full("rejections"));
    }
}

/// Plans its pass, the one before it and the one that resolves it.
pub fn plan_passes(plan: &mut Plan, choices: &Choices) {
    let is_resolved = choices.samples.are_many();
    let drawn = full(if is_resolved { "samples" } else { "color" });
    if choices.has_prepass {
        plan.pass(depth_prepass::pass(NAME), [(full("depth"), Access::DepthWrite)]);
    }
    plan.pass(format!("{NAME}.material"), touches(&drawn, choices));
    if is_resolved {
        plan.pass(format!("{NAME}.resolve"), resolve::touches(&drawn, &full("color")));
    }
}

/// What the pass touches. `drawn`: the picture that it draws into.
fn touches(drawn: &str, choices: &Choices) -> Vec<(String, Access)> {
    let mut touches = super::geometry::filtered(choices.filter.reads_normals());
    touches.extend([
        (light::l_buffer(), Access::FragmentSample),
        (drawn.to_owned(), Access::ColorWrite),
        (full("depth"), depth_prepass::access(choices.has_prepass)),
    ]);
    if choices.is_counted {
        touches.extend([Access::TransferWrite, Access::FragmentWrite].map(|access| (full("rejections"), access)));
    }
    touches
}

/// What the filter gets for every surface.
#[derive(Clone, Copy, Debug)]
pub struct FilterSettings {
    pub kind: LightFilter,
    /// Linear depth of the first step, and of all of them, metres.
    pub depth_range_m: [f32; 2],
    /// Part of its depth by which a sample's may be off.
    pub depth_threshold: f32,
    pub light_extent: Extent,
    pub stipple_side: u32,
    /// In the material pass.
    pub samples: Samples,
    pub has_prepass: bool,
    pub is_counted: bool,
    /// A sampler reads the L-buffer's channels.
    pub is_sampled: bool,
}

/// What tells the filter which texels of the light buffer belong to a surface.
pub struct FilterGuides<'a> {
    /// Linear depth, ids of object and normal group.
    pub dsf: Edge<'a, Image>,
    /// Read where the filter reads normals.
    pub normals: Edge<'a, Image>,
}

/// What the pass draws.
pub struct MaterialDraws {
    pub solid: DrawList,
    /// All others, farthest first.
    pub stippled: Vec<StippledDraw>,
}

pub struct Material {
    prepass: Option<DepthPrepass>,
    opaque: GraphicsPipeline,
    mask: GraphicsPipeline,
    blend: GraphicsPipeline,
    solid: DrawList,
    stippled: Vec<StippledDraw>,
    filter: FilterSettings,
    background: Vec3,
    /// What is drawn into.
    drawn: Image,
    /// With several samples a pixel.
    resolve: Option<Resolve>,
    depth: Image,
    /// Where they are counted.
    rejections: Option<Buffer>,
}

impl Material {
    /// `constants`: of material.frag.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        scene: &SceneGpu,
        draws: MaterialDraws,
        filter: FilterSettings,
        constants: &[(&str, u32)],
        background: Vec3,
    ) -> Result<Self> {
        let MaterialDraws { solid, stippled } = draws;
        let guide = if filter.kind.reads_normals() { "normals" } else { "ids" };
        let light = if filter.is_sampled { "sampled" } else { "words" };
        let count = if filter.is_counted { "on" } else { "off" };
        let shaded = filter.samples.shaded_name();
        let pipeline = |alpha: &str| {
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: mesh::vertex_shader(scene),
                    geometry: None,
                    fragment: Some(variant(
                        FRAG_VARIANTS,
                        &[alpha, mesh::vertex_name(scene), guide, light, count, shaded],
                    )),
                    constants: &[constants, &[scene.texture_constant()]].concat(),
                    vertex_buffers: mesh::vertex_buffers(scene),
                    color_formats: &[filter.samples.format],
                    samples: filter.samples.count,
                    are_placed: false,
                    blending: if alpha == "blend" { Blending::Over } else { Blending::Replace },
                    depth_format: Some(depth_prepass::FORMAT),
                    depth_write: alpha != "blend" && !filter.has_prepass,
                    // What is blended may lie in one place with what is solid.
                    depth_compare: depth_prepass::compare(filter.has_prepass && alpha != "blend"),
                    depth_clamp: false,
                    depth_bias: if alpha == "blend" { blend::DECAL_BIAS } else { DepthBias::NONE },
                    conservative_margin_px: None,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        let color = resources.image(&full("color"));
        let (drawn, resolve) = if filter.samples.are_many() {
            (resources.image(&full("samples")), Some(Resolve::new(gpu, filter.samples, color)?))
        } else {
            (color, None)
        };
        Ok(Self {
            prepass: filter.has_prepass.then(|| DepthPrepass::new(gpu, scene, filter.samples, &[])).transpose()?,
            opaque: pipeline("opaque")?,
            mask: pipeline("mask")?,
            blend: pipeline("blend")?,
            solid,
            stippled,
            filter,
            background,
            drawn,
            resolve,
            depth: resources.image(&full("depth")),
            rejections: filter.is_counted.then(|| resources.buffer(&full("rejections"))),
        })
    }

    fn params(&self, scene: &SceneGpu, material: u32) -> InferredMaterialParams {
        let (frame, light) = (self.drawn.description.extent, self.filter.light_extent);
        InferredMaterialParams {
            material: scene.material_blocks[material as usize],
            first_depth_m: self.filter.depth_range_m[0],
            depth_range_m: self.filter.depth_range_m[1],
            depth_threshold: self.filter.depth_threshold,
            light_scale_x: light.width as f32 / frame.width as f32,
            light_scale_y: light.height as f32 / frame.height as f32,
            stipple_side: 1,
            ..InferredMaterialParams::zeroed()
        }
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        scene: &SceneGpu,
        geometry: &LowGeometry,
        guides: FilterGuides<'_>,
        l_buffer: Edge<'_, Image>,
    ) -> Result<()> {
        let extent = self.drawn.description.extent;
        let drawn = &self.drawn;
        let traffic = Traffic {
            // Each pixel once: overdraw depends on the view.
            written_bytes: Some(
                drawn.description.bytes() + if self.prepass.is_some() { 0 } else { self.depth.description.bytes() },
            ),
            ..Traffic::default()
        };
        if let Some(prepass) = &self.prepass {
            prepass.record(cmd, NAME, frame, scene, &self.solid, (&self.depth, DepthBegins::Far))?;
        }
        cmd.pass(&format!("{NAME}.material"), traffic, |cmd| {
            if let Some(rejections) = &self.rejections {
                cmd.barriers([rejections.discard(Access::TransferWrite)]);
                cmd.clear(rejections);
                cmd.barriers([rejections.from(Access::TransferWrite).to(Access::FragmentWrite)]);
            }
            cmd.barriers([
                l_buffer.to(Access::FragmentSample),
                guides.dsf.to(Access::FragmentSample),
                drawn.discard(Access::ColorWrite),
            ]);
            let depth = depth_prepass::attach(cmd, &self.depth, DepthBegins::Far, self.prepass.is_some());
            if self.filter.kind.reads_normals() {
                cmd.barriers([guides.normals.to(Access::FragmentSample)]);
            }
            let [r, g, b] = self.background.to_array();
            let colors = [ColorTarget::new(drawn, Some(vk::ClearColorValue { float32: [r, g, b, 0.0] }))];
            cmd.begin_rendering(extent, &colors, Some(depth));
            mesh::bind_streams(cmd, scene);
            let mut bound = mesh::bound(frame, scene);
            // Words are fetched alone.
            let light = match self.filter.is_sampled {
                true => geometry.blended(l_buffer.resource, Access::FragmentSample),
                false => geometry.sampled(l_buffer.resource, Access::FragmentSample),
            };
            bound.extend([
                ("l_buffer", light),
                ("geometry_dsf", geometry.sampled(&geometry.dsf, Access::FragmentSample)),
            ]);
            bound.extend(self.rejections.as_ref().map(|rejections| ("Rejections", Bound::Buffer(rejections))));
            if self.filter.kind.reads_normals() {
                bound.push(("geometry_normal", geometry.sampled(&geometry.normal, Access::FragmentSample)));
            }
            for (pipeline, calls) in [(&self.opaque, &self.solid.opaque), (&self.mask, &self.solid.mask)] {
                let Some(first) = calls.first() else { continue };
                let first = self.params(scene, first.material);
                cmd.bind_graphics(pipeline, bytemuck::bytes_of(&first), &bound)?;
                let push = |material| cmd.push(&pipeline.interface, bytemuck::bytes_of(&self.params(scene, material)));
                mesh::draw_with(cmd, pipeline, scene, calls, push);
            }
            if let Some(first) = self.stippled.first() {
                let params = |stippled: &StippledDraw| InferredMaterialParams {
                    stipple_side: if stippled.is_decal() { 0 } else { self.filter.stipple_side },
                    stipple_layer: stippled.layer,
                    ..self.params(scene, stippled.call.material)
                };
                cmd.bind_graphics(&self.blend, bytemuck::bytes_of(&params(first)), &bound)?;
                let mut next = self.stippled.iter();
                let calls = self.stippled.iter().map(|stippled| &stippled.call);
                mesh::draw_each(cmd, &self.blend, scene, calls, |_| {
                    let stippled = next.next().expect("as many as calls");
                    cmd.push(&self.blend.interface, bytemuck::bytes_of(&params(stippled)));
                });
            }
            cmd.end_rendering();
            Ok(())
        })?;
        match &self.resolve {
            Some(resolve) => resolve.record(cmd, NAME, self.drawn.from(Access::ColorWrite)),
            None => Ok(()),
        }
    }

    /// The plain picture, and how it is last touched.
    pub fn picture(&self) -> (&Image, Access) {
        match &self.resolve {
            Some(resolve) => (&resolve.color, Access::ComputeWrite),
            None => (&self.drawn, Access::ColorWrite),
        }
    }

    /// Fragments of solid and of BLEND surfaces that none of the four samples belonged to; nothing where they are not
    /// counted.
    ///
    /// Errors: memory for the copy (exit code 4).
    pub fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        let Some(rejections) = &self.rejections else { return Ok(BTreeMap::new()) };
        let bytes = readback::buffer(gpu, rejections, REJECTIONS_BYTES, Access::FragmentWrite)?;
        let count = |at: usize| f64::from(u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]));
        Ok(BTreeMap::from([("rejected_fragments", count(0)), ("rejected_alpha_fragments", count(4))]))
    }
}
