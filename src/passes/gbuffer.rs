//! G-buffer creation: Segovia 2006, section 4.1 (BC). Shaders: mesh.vert, gbuffer.frag; encoding: gbuffer.glsl.
//! reads   the scene
//! writes  gbuffer.normal, gbuffer.color   images, 8 B a pixel each
//!         gbuffer.position                image, 8 or 16 B a pixel; none where the depth buffer holds positions
//!         gbuffer.emissive                image, 8 B a pixel, where the scene has emissive materials, or extras that
//!                                 travel in its spare bits
//!         gbuffer.depth                   image, 4 B a pixel, reversed
//!
//! Differs from the paper: normals are 16-bit snorm, not half floats (their error is 32 times smaller near 1), positions
//! are fractions of the scene's box by default, and emission has an image of its own, because it is added after the
//! filter and no component is spare.

use super::{decode, mesh};
use crate::caps::{Ability, Need};
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::passes::gbuffer::FRAG_VARIANTS;
use crate::gpu::shader::structs::GBufferParams;
use crate::gpu::shader::variant;
use crate::gpu::{
    Access, AccessSet, Barrier, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic, readback,
};
use crate::picture::{Aov, AovChannels};
use crate::plan::{Plan, Resources};
use crate::resident::{DrawList, SceneGpu};
use crate::settings::PositionStorage;
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

impl PositionStorage {
    /// Bytes of a position in an image or a buffer.
    pub fn bytes(self) -> u64 {
        match self {
            Self::Half | Self::Unorm16 => 8,
            Self::Depth => 4,
            Self::Float => 16,
        }
    }

    fn image_format(self) -> Option<vk::Format> {
        match self {
            Self::Half | Self::Unorm16 => Some(vk::Format::R32G32_UINT),
            Self::Float => Some(vk::Format::R32G32B32A32_UINT),
            Self::Depth => None,
        }
    }
}

/// The value of the shaders' axis EMISSIVE.
pub fn emissive_name(has_emissive: bool) -> &'static str {
    if has_emissive { "on" } else { "off" }
}

/// What a pass reads of each surface, beside what a composite reads last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceParts {
    /// Normal and position: what irradiance needs.
    Geometry,
    /// Colour too, and what few materials say where any of the scene's does.
    Material { has_extras: bool },
}

impl SurfaceParts {
    /// Images beside those of the geometry.
    fn materials(self) -> &'static [&'static str] {
        match self {
            Self::Geometry => &[],
            Self::Material { has_extras: false } => &["color"],
            Self::Material { has_extras: true } => &["color", "emissive"],
        }
    }

    pub fn has_color(self) -> bool {
        self != Self::Geometry
    }

    /// The value of the shaders' axis COLOR.
    pub fn color_name(self) -> &'static str {
        if self.has_color() { "on" } else { "off" }
    }

    /// SURFACE_EXTRAS, where a shader knows of it that reads these parts.
    pub fn constant(self) -> Option<(&'static str, u32)> {
        self.has_color().then_some(("SURFACE_EXTRAS", u32::from(self == Self::Material { has_extras: true })))
    }
}

const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;
const WORDS: vk::Format = vk::Format::R32G32_UINT;

/// What every frame with a G-buffer needs of a device.
pub fn need() -> Need {
    Need { of: "the G-buffer".to_owned(), ability: Ability::FloatDepth, instead: "" }
}

/// Plans the images of one G-buffer, as resources of `technique`.
pub fn plan(plan: &mut Plan, technique: &str, extent: Extent, position: PositionStorage, has_emissive: bool) {
    use vk::ImageUsageFlags as Usage;
    let color = Usage::COLOR_ATTACHMENT | Usage::SAMPLED | Usage::TRANSFER_SRC;
    let mut image = |what: &str, format, usage| {
        plan.image("gbuffer", full(technique, what), extent, format, usage);
    };
    for what in color_images(position, has_emissive) {
        let format = position.image_format().filter(|_| what == "position");
        image(what, format.unwrap_or(WORDS), color);
    }
    image("depth", DEPTH_FORMAT, Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED | Usage::TRANSFER_SRC);
}

/// Resources that the pass which fills it touches.
pub fn written(technique: &str, position: PositionStorage, has_emissive: bool) -> Vec<(String, Access)> {
    let images = color_images(position, has_emissive).into_iter().map(|what| (what, Access::ColorWrite));
    images.chain([("depth", Access::DepthWrite)]).map(|(what, access)| (full(technique, what), access)).collect()
}

/// What it holds is kept for more runs than the one that draws it (`GBuffer::kept`).
pub fn keep(plan: &mut Plan, technique: &str, position: PositionStorage, has_emissive: bool) {
    for (image, _) in written(technique, position, has_emissive) {
        plan.keep(&image);
    }
}

/// Resources that a compute pass touches to read normal and position.
pub fn surface(technique: &str, position: PositionStorage) -> Vec<(String, Access)> {
    surface_as(technique, position, Access::ComputeSample)
}

/// The same for a pass that samples them by `access`.
pub fn surface_as(technique: &str, position: PositionStorage, access: Access) -> Vec<(String, Access)> {
    let place = if position.image_format().is_some() { "position" } else { "depth" };
    ["normal", place].map(|what| (full(technique, what), access)).to_vec()
}

/// Resources that a pass touches that samples `parts` by `access`.
pub fn parts_as(
    technique: &str,
    position: PositionStorage,
    parts: SurfaceParts,
    access: Access,
) -> Vec<(String, Access)> {
    let materials = parts.materials().iter().map(|what| (full(technique, what), access));
    surface_as(technique, position, access).into_iter().chain(materials).collect()
}

/// Resources that a compute pass touches to read all of it.
pub fn shading(technique: &str, position: PositionStorage, has_emissive: bool) -> Vec<(String, Access)> {
    let materials = ["color"].into_iter().chain(has_emissive.then_some("emissive"));
    let mut touches = surface(technique, position);
    touches.extend(materials.map(|what| (full(technique, what), Access::ComputeSample)));
    touches
}

/// Full name of the depth buffer.
pub fn depth(technique: &str) -> String {
    full(technique, "depth")
}

fn color_images(position: PositionStorage, has_emissive: bool) -> Vec<&'static str> {
    let emissive = has_emissive.then_some("emissive");
    let position = position.image_format().map(|_| "position");
    ["normal", "color"].into_iter().chain(emissive).chain(position).collect()
}

fn full(technique: &str, what: &str) -> String {
    format!("{technique}.gbuffer.{what}")
}

/// The images of one G-buffer.
pub struct GBuffer {
    pub position_storage: PositionStorage,
    pub normal: Image,
    pub color: Image,
    pub emissive: Option<Image>,
    pub position: Option<Image>,
    pub depth: Image,
    nearest: Sampler,
    /// All of it is readable by compute shaders as soon as it is drawn, and stays so: later runs read it too.
    is_kept: bool,
    /// What a pass before the composite reads, one in each run, and how.
    early: (SurfaceParts, Access),
}

impl GBuffer {
    /// Takes the images out that `plan` put in.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        technique: &str,
        position_storage: PositionStorage,
        has_emissive: bool,
    ) -> Result<Self> {
        let mut image = |what: &str| resources.image(&full(technique, what));
        Ok(Self {
            position_storage,
            normal: image("normal"),
            color: image("color"),
            emissive: has_emissive.then(|| image("emissive")),
            position: position_storage.image_format().map(|_| image("position")),
            depth: image("depth"),
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
            is_kept: false,
            early: (SurfaceParts::Geometry, Access::ComputeSample),
        })
    }

    /// The same, of which one pass before the composite reads `parts` by `access`, in each run.
    pub fn read_early(self, parts: SurfaceParts, access: Access) -> Self {
        Self { early: (parts, access), ..self }
    }

    /// The same, kept for more runs than the one that draws it, where `is_kept`.
    pub fn kept(self, is_kept: bool) -> Self {
        Self { is_kept, ..self }
    }

    /// As the pass leaves it that draws it, or an earlier run.
    pub fn drawn(&self) -> Edge<'_, Self> {
        self.from(if self.is_kept { Access::ComputeSample } else { Access::ColorWrite })
    }

    /// What makes a kept one readable, once it is drawn.
    fn made_readable(&self) -> Vec<Barrier> {
        let depth = self.depth.from(Access::DepthWrite).to(match self.position {
            Some(_) => Access::DepthTest,
            None => Access::ComputeSample,
        });
        let colors = self.attachments().into_iter().map(|image| image.from(Access::ColorWrite));
        colors.map(|edge| edge.to(Access::ComputeSample)).chain([depth]).collect()
    }

    /// Makes the depth of a kept one readable again where it holds positions, after a pass that tested it: it is as that pass
    /// was handed it.
    pub fn restore_depth(&self, cmd: &mut Commands) {
        assert!(self.is_kept, "only a later run asks for it");
        if self.position.is_none() {
            cmd.barriers([self.depth.from(Access::DepthTest).to(Access::ComputeSample)]);
        }
    }

    pub fn extent(&self) -> Extent {
        self.normal.description.extent
    }

    /// Bytes a pixel of normal and position: what irradiance needs.
    pub fn surface_bytes(&self) -> u64 {
        8 + self.position_storage.bytes()
    }

    /// Bytes a pixel of `parts`.
    pub fn parts_bytes(&self, parts: SurfaceParts) -> u64 {
        self.surface_bytes() + 8 * parts.materials().len() as u64
    }

    /// Bytes a pixel of all that a composite reads.
    pub fn shading_bytes(&self) -> u64 {
        self.surface_bytes() + 8 + if self.emissive.is_some() { 8 } else { 0 }
    }

    /// Names the access that touched normal and position last. `ColorWrite` means the G-buffer pass, which wrote the
    /// depth too.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    /// What gbuffer_read.glsl binds, in compute and in fragment shaders: the layout is the same.
    pub fn bound_surface(&self) -> Vec<(&'static str, Bound<'_>)> {
        let position = self.position.as_ref().unwrap_or(&self.depth);
        vec![("gbuffer_position", self.sampled(position)), ("gbuffer_normal", self.sampled(&self.normal))]
    }

    /// The same with what a shader binds that reads `parts`: without extras nothing reads the emission, and the colour
    /// stands for it.
    pub fn bound_parts(&self, parts: SurfaceParts) -> Vec<(&'static str, Bound<'_>)> {
        let mut bound = self.bound_surface();
        if let SurfaceParts::Material { has_extras } = parts {
            let emissive = self.emissive.as_ref().filter(|_| has_extras).unwrap_or(&self.color);
            bound.extend([("gbuffer_color", self.sampled(&self.color)), ("gbuffer_emissive", self.sampled(emissive))]);
        }
        bound
    }

    /// What composite.glsl binds.
    pub fn bound_shading(&self) -> Vec<(&'static str, Bound<'_>)> {
        let mut bound = self.bound_surface();
        bound.push(("gbuffer_color", self.sampled(&self.color)));
        if let Some(emissive) = &self.emissive {
            bound.push(("gbuffer_emissive", self.sampled(emissive)));
        }
        bound
    }

    /// The images of materials that are there, by name.
    fn materials(&self) -> impl Iterator<Item = (&'static str, &Image)> {
        [("color", Some(&self.color)), ("emissive", self.emissive.as_ref())]
            .into_iter()
            .filter_map(|(what, image)| Some((what, image?)))
    }

    /// How the images of materials were touched before anything in this run reads them.
    fn materials_drawn(&self) -> Access {
        if self.is_kept { Access::ComputeSample } else { Access::ColorWrite }
    }

    fn sampled<'a>(&'a self, image: &'a Image) -> Bound<'a> {
        Bound::Sampled(image, self.nearest.handle, Access::ComputeSample)
    }

    /// Colour attachments in the order of gbuffer.frag's locations.
    fn attachments(&self) -> Vec<&Image> {
        [Some(&self.normal), Some(&self.color), self.emissive.as_ref(), self.position.as_ref()]
            .into_iter()
            .flatten()
            .collect()
    }
}

impl Edge<'_, GBuffer> {
    /// Normal and position become readable by compute shaders.
    pub fn surface_to_sampled(self) -> Vec<Barrier> {
        self.surface_to(Access::ComputeSample)
    }

    /// Normal and position become readable as `access` says.
    pub fn surface_to(self, access: Access) -> Vec<Barrier> {
        let gbuffer = self.resource;
        let position = match &gbuffer.position {
            Some(position) => position.from(self.from),
            None if self.from == Access::ColorWrite.into() => gbuffer.depth.from(Access::DepthWrite),
            None => gbuffer.depth.from(self.from),
        };
        vec![gbuffer.normal.from(self.from).to(access), position.to(access)]
    }

    /// `parts` become readable as the pass reads them that `GBuffer::read_early` names.
    pub fn parts_to(self, parts: SurfaceParts, access: Access) -> Vec<Barrier> {
        let gbuffer = self.resource;
        assert!(!parts.has_color() || gbuffer.early == (parts, access), "a pass that reads materials is named");
        let read = gbuffer.materials().filter(|(what, _)| parts.materials().contains(what));
        let mut barriers = self.surface_to(access);
        barriers.extend(read.map(|(_, image)| image.from(gbuffer.materials_drawn()).to(access)));
        barriers
    }

    /// All that a composite reads becomes readable by compute shaders. One pass before it may have read colour and emission,
    /// whatever read the surface.
    pub fn shading_to_sampled(self) -> Vec<Barrier> {
        let gbuffer = self.resource;
        let (parts, access) = gbuffer.early;
        let last = |what| match parts.materials().contains(&what) {
            true if gbuffer.is_kept => access | Access::ComputeSample,
            true => access.into(),
            false => gbuffer.materials_drawn().into(),
        };
        let mut barriers = self.surface_to_sampled();
        barriers.extend(gbuffer.materials().map(|(what, image)| image.from(last(what)).to(Access::ComputeSample)));
        barriers
    }
}

/// AOVs that every technique with a G-buffer has.
pub const AOVS: &[&str] = &["gbuffer.normal", "gbuffer.color", "gbuffer.color.id"];

impl GBuffer {
    /// How a pass that tests depth takes it over: written by the G-buffer pass, or since sampled as positions by
    /// `readers`.
    pub fn depth_edge(&self, readers: impl Into<AccessSet>) -> Edge<'_, Image> {
        match self.position_storage {
            PositionStorage::Depth => self.depth.from(readers),
            PositionStorage::Half | PositionStorage::Unorm16 | PositionStorage::Float => {
                self.depth.from(if self.is_kept { Access::DepthTest } else { Access::DepthWrite })
            }
        }
    }

    /// One of `AOVS`, read back; None where the name is another's. Normals are in world space; an id is the material's number
    /// in the scene, its lower 16 bits, and 0 where no surface is.
    pub fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Option<Result<Aov>> {
        let decoded = |image: &Image, channels: fn(&[u8]) -> AovChannels| -> Result<Aov> {
            let bytes = readback::image(gpu, image, Access::ComputeSample)?;
            Ok(Aov { name: name.to_owned(), channels: channels(&bytes) })
        };
        match name {
            "gbuffer.normal" => Some(decoded(&self.normal, |bytes| {
                AovChannels::Rgb(decode::words(bytes).map(decode::normal).collect())
            })),
            "gbuffer.color" => {
                Some(decoded(&self.color, |bytes| AovChannels::Rgb(decode::words(bytes).map(decode::halves).collect())))
            }
            "gbuffer.color.id" => Some(decoded(&self.color, |bytes| {
                AovChannels::YU32(decode::words(bytes).map(decode::last16).collect())
            })),
            _ => None,
        }
    }
}

/// The pass that fills a G-buffer.
pub struct GBufferPass {
    opaque: GraphicsPipeline,
    mask: GraphicsPipeline,
    list: DrawList,
}

impl GBufferPass {
    /// `list`: what it draws.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        list: DrawList,
        position: PositionStorage,
        has_emissive: bool,
    ) -> Result<Self> {
        let mut formats = vec![WORDS, WORDS];
        if has_emissive {
            formats.push(WORDS);
        }
        formats.extend(position.image_format());
        // Only what writes emission knows of it.
        let extras = has_emissive.then_some(("SURFACE_EXTRAS", u32::from(scene.has_extras)));
        let constants: Vec<_> = extras.into_iter().chain([scene.texture_constant()]).collect();
        let pipeline = |alpha: &str| {
            let names = [position.name(), emissive_name(has_emissive), alpha, mesh::vertex_name(scene)];
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: mesh::vertex_shader(scene),
                    geometry: None,
                    fragment: Some(variant(FRAG_VARIANTS, &names)),
                    constants: &constants,
                    vertex_buffers: mesh::vertex_buffers(scene),
                    color_formats: &formats,
                    samples: 1,
                    are_placed: false,
                    blending: Blending::Replace,
                    depth_format: Some(DEPTH_FORMAT),
                    depth_write: true,
                    depth_compare: mesh::DEPTH_COMPARE,
                    depth_clamp: false,
                    depth_bias: DepthBias::NONE,
                    conservative_margin_px: None,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        Ok(Self { opaque: pipeline("opaque")?, mask: pipeline("mask")?, list })
    }

    /// Numbers for the report's `counters`.
    pub fn counters(&self) -> [(&'static str, f64); 3] {
        self.list.counters()
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        technique: &str,
        frame: &Buffer,
        scene: &SceneGpu,
        gbuffer: &GBuffer,
    ) -> Result<()> {
        let attachments = gbuffer.attachments();
        let pixel_bytes = 8 * (attachments.len() as u64 - u64::from(gbuffer.position.is_some()))
            + 4
            + gbuffer.position.as_ref().map_or(0, |_| gbuffer.position_storage.bytes());
        let traffic = Traffic {
            // Each pixel once: overdraw depends on the view.
            written_bytes: Some(gbuffer.extent().pixel_count() * pixel_bytes),
            ..Traffic::default()
        };
        cmd.pass(&format!("{technique}.gbuffer"), traffic, |cmd| {
            cmd.barriers(attachments.iter().map(|image| image.discard(Access::ColorWrite)));
            cmd.barriers([gbuffer.depth.discard(Access::DepthWrite)]);
            // All bits 0: no surface.
            let clear = Some(vk::ClearColorValue { uint32: [0; 4] });
            let colors: Vec<_> = attachments.iter().map(|image| ColorTarget::new(image, clear)).collect();
            cmd.begin_rendering(gbuffer.extent(), &colors, Some((&gbuffer.depth, Some(0.0), Access::DepthWrite)));
            mesh::bind_streams(cmd, scene);
            for (pipeline, calls) in [(&self.opaque, &self.list.opaque), (&self.mask, &self.list.mask)] {
                if !calls.is_empty() {
                    let params = |material: u32| GBufferParams { material: scene.material_blocks[material as usize] };
                    let first = params(calls[0].material);
                    cmd.bind_graphics(pipeline, bytemuck::bytes_of(&first), &mesh::bound(frame, scene))?;
                    let push = |material| cmd.push(&pipeline.interface, bytemuck::bytes_of(&params(material)));
                    mesh::draw_with(cmd, pipeline, scene, calls, push);
                }
            }
            cmd.end_rendering();
            if gbuffer.is_kept {
                cmd.barriers(gbuffer.made_readable());
            }
            Ok(())
        })
    }
}
