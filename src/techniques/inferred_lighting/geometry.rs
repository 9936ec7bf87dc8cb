//! Geometry: what the light pass needs of the surfaces, at the light buffer's size. Kircher 2009, sections 2.1, 3.1, 4.
//! Shaders: mesh.vert, geometry.frag; encoding: encoding.glsl.
//! reads   the scene
//! writes  geometry.normal   image, 4 B a texel: view-space normal through the map of the sphere to the hemisphere
//!         geometry.dsf      image, 4 B a texel: linear depth, ids of object and normal group
//!         geometry.extras   image, 4 B a texel, with --extras on: roughness, material id, F0
//!         geometry.motion   image, 4 B a texel, with --motion-vectors on: texels on the screen (motion.rs)
//!         geometry.depth    image, 4 B a texel, reversed; with a stencil where lights are counted into one
//!
//! Targets hold words of two 16-bit numbers as `--packing` says; they are always read as words (section 5).
//!
//! BLEND surfaces are drawn last, each into its own texels of the stipple.

use super::choices::Choices;
use super::encoding::Packing;
use super::motion::{self, PreviousMoment};
use super::stipple::StippledDraw;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::structs::GeometryParams;
use crate::gpu::shader::techniques::inferred_lighting::geometry::FRAG_VARIANTS;
use crate::gpu::shader::{constants_of, variant};
use crate::gpu::{Access, Barrier, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::{blend, mesh};
use crate::plan::{Plan, Resources};
use crate::resident::{DrawList, SceneGpu};
use crate::techniques::inferred_lighting::resources::NAME;
use crate::units::Extent;
use ash::vk;
use bytemuck::Zeroable;
use std::sync::Arc;

const WORD: vk::Format = vk::Format::R32_UINT;

/// Format that a word is drawn as.
pub fn target_format(packing: Packing) -> vk::Format {
    match packing {
        Packing::Words => WORD,
        Packing::Bytes => vk::Format::R8G8B8A8_UNORM,
        Packing::Fixed { .. } => vk::Format::R16G16_UNORM,
    }
}

/// What a pass touches.
pub type Touches = Vec<(String, Access)>;

fn full(what: &str) -> String {
    format!("{NAME}.geometry.{what}")
}

fn color_images(has_extras: bool) -> Vec<&'static str> {
    ["normal", "dsf"].into_iter().chain(has_extras.then_some("extras")).collect()
}

/// Plans its images.
pub fn plan(plan: &mut Plan, choices: &Choices) {
    use vk::ImageUsageFlags as Usage;
    let (extent, read) = (choices.light_extent, Usage::SAMPLED | Usage::TRANSFER_SRC);
    for what in color_images(choices.has_extras) {
        let formats = [target_format(choices.packing), WORD];
        plan.reinterpreted("g-buffer", full(what), extent, formats, Usage::COLOR_ATTACHMENT | read);
    }
    if choices.has_motion {
        plan.image("g-buffer", full("motion"), extent, WORD, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);
    }
    let depth_format = choices.depth_format();
    plan.image("g-buffer", full("depth"), extent, depth_format, Usage::DEPTH_STENCIL_ATTACHMENT | read);
}

/// What the pass that fills them touches.
pub fn written(choices: &Choices) -> Touches {
    let all = color_images(choices.has_extras).into_iter().chain(choices.has_motion.then_some("motion"));
    let images = all.map(|what| (full(what), Access::ColorWrite));
    images.chain([(full("depth"), Access::DepthWrite)]).collect()
}

/// What the pass of decals touches.
pub fn marked() -> Touches {
    let accesses = [("dsf", Access::FragmentSample), ("normal", Access::ColorWrite), ("depth", Access::DepthTest)];
    accesses.map(|(what, access)| (full(what), access)).to_vec()
}

/// What a pass touches that lights its surfaces.
pub fn lit(has_extras: bool, access: Access, depth_access: Access) -> Touches {
    let read = ["normal"].into_iter().chain(has_extras.then_some("extras")).map(|what| (full(what), access));
    read.chain([(full("depth"), depth_access)]).collect()
}

/// What a pass touches that looks where its surfaces are.
pub fn placed(access: Access) -> Touches {
    vec![(full("depth"), access)]
}

/// What a pass touches that filters by its DSF data, and by its normals where it compares them.
pub fn filtered(reads_normals: bool) -> Touches {
    let normal = reads_normals.then_some("normal");
    ["dsf"].into_iter().chain(normal).map(|what| (full(what), Access::FragmentSample)).collect()
}

/// The value of the shaders' axis EXTRAS.
pub fn extras_name(has_extras: bool) -> &'static str {
    if has_extras { "on" } else { "off" }
}

/// The images of the geometry pass.
pub struct LowGeometry {
    pub normal: Image,
    pub dsf: Image,
    pub extras: Option<Image>,
    pub motion: Option<Image>,
    pub depth: Image,
    nearest: Sampler,
    linear: Sampler,
}

impl LowGeometry {
    /// Takes the images out that `plan` put in.
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        Ok(Self {
            normal: resources.image(&full("normal")),
            dsf: resources.image(&full("dsf")),
            extras: choices.has_extras.then(|| resources.image(&full("extras"))),
            motion: choices.has_motion.then(|| resources.image(&full("motion"))),
            depth: resources.image(&full("depth")),
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
            linear: Sampler::clamped(gpu, vk::Filter::LINEAR)?,
        })
    }

    pub fn extent(&self) -> Extent {
        self.normal.description.extent
    }

    /// Bytes a texel that lighting reads.
    pub fn lit_bytes(&self) -> u64 {
        8 + if self.extras.is_some() { 4 } else { 0 }
    }

    /// Names the access that touched the depth last. Nothing reads the rest before the lights do.
    pub fn from(&self, access: Access) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    pub fn sampled<'a>(&'a self, image: &'a Image, access: Access) -> Bound<'a> {
        Bound::Sampled(image, self.nearest.handle, access)
    }

    /// The same, blended by the sampler where it does not fetch texels.
    pub fn blended<'a>(&'a self, image: &'a Image, access: Access) -> Bound<'a> {
        Bound::Sampled(image, self.linear.handle, access)
    }

    /// What surface.glsl binds.
    pub fn bound_with_depth(&self, access: Access, depth_access: Access) -> Vec<(&'static str, Bound<'_>)> {
        let normal = self.sampled(&self.normal, access);
        let mut bound = vec![("geometry_normal", normal), self.bound_depth(depth_access)];
        bound.extend(self.extras.as_ref().map(|extras| ("geometry_extras", self.sampled(extras, access))));
        bound
    }

    /// The same, where no light is evaluated.
    pub fn bound_depth(&self, access: Access) -> (&'static str, Bound<'_>) {
        ("geometry_depth", self.sampled(&self.depth, access))
    }

    /// Colour attachments of words in the order of geometry.frag's locations; after them comes the motion.
    fn attachments(&self) -> Vec<&Image> {
        [Some(&self.normal), Some(&self.dsf), self.extras.as_ref()].into_iter().flatten().collect()
    }
}

impl Edge<'_, LowGeometry> {
    /// The depth becomes readable as `access` says.
    pub fn depth_to(self, access: Access) -> Barrier {
        self.resource.depth.from(self.from).to(access)
    }

    /// What `lit` names becomes readable as both say.
    pub fn lit_with_depth_to(self, access: Access, depth_access: Access) -> Vec<Barrier> {
        let written = [Some(&self.resource.normal), self.resource.extras.as_ref()].into_iter().flatten();
        let mut barriers = vec![self.depth_to(depth_access)];
        barriers.extend(written.map(|image| image.from(Access::ColorWrite).to(access)));
        barriers
    }
}

/// The pass that fills them.
pub struct Geometry {
    opaque: GraphicsPipeline,
    mask: GraphicsPipeline,
    blend: GraphicsPipeline,
    list: DrawList,
    stippled: Vec<StippledDraw>,
    stipple_side: u32,
    packing: Packing,
    earlier: Option<PreviousMoment>,
    /// Linear depth of the first step, and of all of them, metres.
    pub depth_range_m: [f32; 2],
}

impl Geometry {
    /// `list`: the solid surfaces that it draws. `stippled`: the others. `earlier`: with motion vectors.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        list: DrawList,
        stippled: Vec<StippledDraw>,
        depth_range_m: [f32; 2],
        choices: &Choices,
        earlier: Option<PreviousMoment>,
    ) -> Result<Self> {
        let mut formats = vec![target_format(choices.packing); color_images(choices.has_extras).len()];
        formats.extend(earlier.as_ref().map(|_| WORD));
        let vertex = if earlier.is_some() { motion::vertex_shader(scene) } else { mesh::vertex_shader(scene) };
        let motion = if earlier.is_some() { "on" } else { "off" };
        let packing = if choices.packing == Packing::Words { "words" } else { "channels" };
        let pipeline = |alpha: &str| {
            let names = [alpha, extras_name(choices.has_extras), motion, packing, mesh::vertex_name(scene)];
            let fragment = variant(FRAG_VARIANTS, &names);
            let mut constants = constants_of(&choices.geometry_constants(), &[Some(fragment)]);
            constants.push(scene.texture_constant());
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex,
                    geometry: None,
                    fragment: Some(fragment),
                    constants: &constants,
                    vertex_buffers: mesh::vertex_buffers(scene),
                    color_formats: &formats,
                    samples: 1,
                    are_placed: false,
                    blending: Blending::Replace,
                    depth_format: Some(choices.depth_format()),
                    depth_write: true,
                    depth_compare: mesh::DEPTH_COMPARE,
                    depth_clamp: false,
                    depth_bias: if alpha == "blend" { blend::DECAL_BIAS } else { DepthBias::NONE },
                    conservative_margin_px: None,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        Ok(Self {
            opaque: pipeline("opaque")?,
            mask: pipeline("mask")?,
            blend: pipeline("blend")?,
            list,
            stippled,
            stipple_side: choices.stipple_side(),
            packing: choices.packing,
            earlier,
            depth_range_m,
        })
    }

    pub fn triangles_drawn(&self) -> u64 {
        self.list.triangles_drawn()
    }

    fn params(&self, scene: &SceneGpu, material: u32) -> GeometryParams {
        GeometryParams {
            material: scene.material_blocks[material as usize],
            first_depth_m: self.depth_range_m[0],
            depth_range_m: self.depth_range_m[1],
            ..GeometryParams::zeroed()
        }
    }

    /// `frame`: the block of the light buffer's extent.
    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, scene: &SceneGpu, geometry: &LowGeometry) -> Result<()> {
        let attachments = geometry.attachments();
        let image_count = (attachments.len() + usize::from(geometry.motion.is_some()) + 1) as u64;
        let traffic = Traffic {
            // Each texel once: overdraw depends on the view.
            written_bytes: Some(geometry.extent().pixel_count() * 4 * image_count),
            ..Traffic::default()
        };
        cmd.pass(&format!("{NAME}.geometry"), traffic, |cmd| {
            cmd.barriers(attachments.iter().map(|image| image.discard(Access::ColorWrite)));
            cmd.barriers([geometry.depth.discard(Access::DepthWrite)]);
            let nothing = match self.packing {
                Packing::Words => vk::ClearColorValue { uint32: [u32::MAX; 4] },
                Packing::Bytes => vk::ClearColorValue { float32: [1.0; 4] },
                // A quarter of a step more, as channels_of of encoding.glsl.
                Packing::Fixed { .. } => {
                    vk::ClearColorValue { float32: [(self.packing.nothing() as f32 + 0.25) / 65535.0; 4] }
                }
            };
            let clear = Some(nothing);
            let mut colors: Vec<_> = attachments.iter().map(|image| ColorTarget::new(image, clear)).collect();
            if let Some(motion) = &geometry.motion {
                cmd.barriers([motion.discard(Access::ColorWrite)]);
                colors.push(ColorTarget::new(motion, Some(vk::ClearColorValue { uint32: [u32::MAX; 4] })));
            }
            cmd.begin_rendering(geometry.extent(), &colors, Some((&geometry.depth, Some(0.0), Access::DepthWrite)));
            mesh::bind_streams(cmd, scene);
            let mut bound = mesh::bound(frame, scene);
            bound.extend(self.earlier.iter().flat_map(PreviousMoment::bound));
            for (pipeline, calls) in [(&self.opaque, &self.list.opaque), (&self.mask, &self.list.mask)] {
                let Some(first) = calls.first() else { continue };
                let first = self.params(scene, first.material);
                cmd.bind_graphics(pipeline, bytemuck::bytes_of(&first), &bound)?;
                let push = |material| cmd.push(&pipeline.interface, bytemuck::bytes_of(&self.params(scene, material)));
                mesh::draw_with(cmd, pipeline, scene, calls, push);
            }
            if let Some(first) = self.stippled.first() {
                let params = |stippled: &StippledDraw| GeometryParams {
                    stipple_side: self.stipple_side,
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
        })
    }
}
