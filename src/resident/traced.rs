//! The scene for rays that may meet anything: what each triangle of the tree carries, materials with the places of their
//! textures, texels in storage buffers, and the triangles that shine. Shaders see it through glsl/shading/traced.glsl.
//!
//! Each triangle has its own copy of its corners: a ray reads one place instead of three indices and three vertices, which
//! lavapipe would fetch lane by lane.

use super::material_blocks;
use super::structure::{self, SceneStructure};
use crate::bvh::nodes::Nodes;
use crate::bvh::{Bvh, Source};
use crate::choice::choices;
use crate::error::{Error, Result};
use crate::gpu::shader::resident_traced::{
    ALPHA_IS_BLEND, ALPHA_IS_MASK, ALPHA_IS_OPAQUE, TEXELS_BETWEEN_LEVELS, TEXELS_LEVELS, TEXELS_NEAREST,
    TEXELS_NEAREST_SMALL, TEXELS_SRGB, TEXELS_WRAP_U_SHIFT, TEXELS_WRAP_V_SHIFT, WRAP_CLAMP, WRAP_MIRRORED,
    WRAP_REPEAT,
};
use crate::gpu::shader::structs::{
    BvhTriangleBlock, TexelsBlock, TracedClosingBlock, TracedExtendedBlock, TracedMaterialBlock, TracedTangentsBlock,
    TracedTriangleBlock,
};
use crate::gpu::structure::Over;
use crate::gpu::{Access, Bound, Buffer, Gpu, upload};
use crate::plan::{Plan, Requirements, Resources};
use crate::resident::stats::limited;
use crate::scene::{AlphaMode, ColorSpace, Draw, Material, Mesh, Scene, ShownTexels, TextureSlot, Wrap, mipmaps};
use crate::units::Bytes;
use bytemuck::Zeroable;
use glam::{Mat3, Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Buffers that texels may fill: the shader's texels_0 to texels_3.
const TEXEL_BUFFERS: usize = 4;

/// Names of the buffers after the technique's, and of their blocks in GLSL. Nodes are there where rays walk the tree.
const NODES: (&str, &str) = ("bvh.nodes", "BvhNodes");
const BUFFERS: [(&str, &str); 7] = [
    ("bvh.triangles", "BvhTriangles"),
    ("traced.triangles", "TracedTriangles"),
    ("traced.tangents", "TracedTangents"),
    ("traced.extended", "TracedExtended"),
    ("traced.materials", "TracedMaterials"),
    ("bvh.closing", "BvhClosing"),
    ("traced.closing", "TracedClosing"),
];
const TEXELS: [(&str, &str); TEXEL_BUFFERS] = [
    ("traced.texels.0", "Texels0"),
    ("traced.texels.1", "Texels1"),
    ("traced.texels.2", "Texels2"),
    ("traced.texels.3", "Texels3"),
];

/// What rays are traced through.
pub enum Rays {
    /// The tree's nodes, walked by the shader.
    Tree(Nodes),
    /// The driver's structure, by ray queries. `is_opaque`: alpha decides about no triangle.
    Query { is_opaque: bool },
}

choices! {
    /// Levels of a texture that rays read (`--texture-level`).
    pub enum TexelLevels {
        "0" => Finest,
        /// All, by the width of the ray's cone.
        "cone" => Cone,
    }
}

impl TexelLevels {
    /// Levels to keep of a picture whose finest level is number `first`, and which has `all` levels.
    fn of(self, first: u32, all: u32) -> std::ops::Range<u32> {
        first..if self == Self::Cone { all } else { first + 1 }
    }
}

/// What of a scene's textures rays read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reads {
    pub levels: TexelLevels,
    /// Occlusion maps too, where rays do not find the occluders that they describe.
    pub occlusion: bool,
}

impl Reads {
    fn slots(self) -> impl Iterator<Item = TextureSlot> {
        TextureSlot::ALL.into_iter().filter(move |slot| self.occlusion || *slot != TextureSlot::Occlusion)
    }
}

/// Where the first texel of a picture lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    buffer: u32,
    first: u32,
    width_px: u32,
    height_px: u32,
}

/// What a scene needs to be traced, by arithmetic.
pub struct Layout {
    triangle_count: usize,
    rays: Rays,
    material_count: usize,
    has_tangents: bool,
    has_extended: bool,
    /// Triangles move while the shutter is open.
    is_moving: bool,
    /// None: rays walk the tree.
    structures: Option<[Over; 2]>,
    /// Place of each image of the scene; None where no traced material reads it.
    places: Vec<Option<Place>>,
    /// Texels of each buffer.
    texel_counts: Vec<u64>,
    reads: Reads,
    /// Readings of a texture along a slanted cone's footprint, at most.
    anisotropy: u32,
}

impl Layout {
    /// `rays`: nodes are of `bvh`. `reads`: of textures. `most_bytes`: what a device binds of a buffer at once.
    ///
    /// Errors: the textures are more than the shader's buffers hold (exit code 4); structures of what moves (2).
    pub fn new(scene: &Scene, bvh: &Bvh, rays: Rays, reads: Reads, most_bytes: u64) -> Result<Self> {
        if matches!(rays, Rays::Query { .. }) && !bvh.closing.is_empty() {
            return Err(Error::request(format!(
                "--rays query: {} moves while --shutter is open, and the driver's acceleration structure cannot",
                scene.name
            ))
            .note("--rays tree traces what moves; --shutter none stops the motion"));
        }
        let mut places = vec![None; scene.images.len()];
        let mut texel_counts = Vec::new();
        let most_texels = (most_bytes / 4).min(u64::from(u32::MAX));
        for texture in scene.drawn_materials().flat_map(|material| reads.slots().map(|slot| material.texture(slot))) {
            let Some(index) = texture.map(|texture| scene.textures[texture].image) else { continue };
            if places[index].is_some() {
                continue;
            }
            let extent = limited(&scene.images[index], scene.texturing.limit_px);
            let all = mipmaps::level_count(extent.width, extent.height);
            let count = mipmaps::texel_count(extent.width, extent.height, reads.levels.of(0, all));
            let fits = |used: &u64| used + count <= most_texels;
            let buffer = texel_counts.iter().position(fits).unwrap_or(texel_counts.len());
            if buffer == TEXEL_BUFFERS || count > most_texels {
                return Err(Error::memory(format!(
                    "{}: its textures need more than the {TEXEL_BUFFERS} buffers of {} that rays can read them from",
                    scene.name,
                    Bytes(most_bytes)
                ))
                .note("--texture-limit 1024, or less, makes them smaller"));
            }
            if buffer == texel_counts.len() {
                texel_counts.push(0);
            }
            let first = texel_counts[buffer] as u32;
            texel_counts[buffer] += count;
            let (width_px, height_px) = (extent.width, extent.height);
            places[index] = Some(Place { buffer: buffer as u32, first, width_px, height_px });
        }
        Ok(Self {
            triangle_count: bvh.triangles.len(),
            material_count: scene.materials.len(),
            has_tangents: scene.drawn_materials().any(|material| material.normal_texture.is_some()),
            has_extended: scene.meshes.iter().any(|mesh| !mesh.colors.is_empty() || !mesh.uvs_1.is_empty()),
            is_moving: !bvh.closing.is_empty(),
            structures: match rays {
                Rays::Tree(_) => None,
                Rays::Query { is_opaque } => Some(structure::over(bvh, is_opaque)),
            },
            rays,
            places,
            texel_counts,
            reads,
            anisotropy: scene.texturing.anisotropy,
        })
    }

    /// Plans the buffers, as resources of `technique`.
    ///
    /// Errors: as of `structure::plan`.
    pub fn plan(&self, plan: &mut Plan, technique: &str, requirements: Requirements<'_>) -> Result<()> {
        let of = |count: usize, size: usize| count as u64 * size as u64;
        let when = |is_there: bool, bytes: u64| if is_there { bytes } else { 0 };
        if let Rays::Tree(nodes) = &self.rays {
            plan.buffer("bvh", format!("{technique}.{}", NODES.0), nodes.bytes().len() as u64);
        }
        if let Some(over) = self.structures {
            structure::plan(plan, technique, over, requirements)?;
        }
        let bytes = [
            of(self.triangle_count, size_of::<BvhTriangleBlock>()),
            of(self.triangle_count, size_of::<TracedTriangleBlock>()),
            when(self.has_tangents, of(self.triangle_count, size_of::<TracedTangentsBlock>())),
            when(self.has_extended, of(self.triangle_count, size_of::<TracedExtendedBlock>())),
            of(self.material_count, size_of::<TracedMaterialBlock>()),
            when(self.is_moving, of(self.triangle_count, size_of::<BvhTriangleBlock>())),
            when(self.is_moving, of(self.triangle_count, size_of::<TracedClosingBlock>())),
        ];
        for ((name, _), bytes) in BUFFERS.iter().zip(bytes) {
            let group = if name.starts_with("bvh.") { "bvh" } else { "traced" };
            plan.buffer(group, format!("{technique}.{name}"), bytes);
        }
        for (index, (name, _)) in TEXELS.iter().enumerate() {
            let count = self.texel_counts.get(index).copied().unwrap_or(0);
            plan.buffer("traced", format!("{technique}.{name}"), 4 * count);
        }
        Ok(())
    }

    /// The value of the shader's axis RAYS.
    pub fn variant(&self) -> &'static str {
        match &self.rays {
            Rays::Tree(nodes) => nodes.variant(),
            Rays::Query { .. } => "query",
        }
    }

    /// The tree's nodes, where rays walk them.
    pub fn nodes(&self) -> Option<&Nodes> {
        match &self.rays {
            Rays::Tree(nodes) => Some(nodes),
            Rays::Query { .. } => None,
        }
    }

    /// HAS_TEXTURES, HAS_TANGENTS, HAS_EXTENDED, TEXEL_BUFFERS, TEXTURE_CONE, HAS_OCCLUSION, MOVES.
    pub fn constants(&self) -> [(&'static str, u32); 7] {
        [
            ("HAS_TEXTURES", u32::from(!self.texel_counts.is_empty())),
            ("HAS_TANGENTS", u32::from(self.has_tangents)),
            ("HAS_EXTENDED", u32::from(self.has_extended)),
            ("TEXEL_BUFFERS", self.texel_counts.len().max(1) as u32),
            ("TEXTURE_CONE", if self.reads.levels == TexelLevels::Cone { self.anisotropy } else { 0 }),
            ("HAS_OCCLUSION", u32::from(self.reads.occlusion)),
            ("MOVES", u32::from(self.is_moving)),
        ]
    }

    fn texels(&self, scene: &Scene, material: &Material, slot: TextureSlot) -> TexelsBlock {
        let Some(index) = material.texture(slot) else { return TexelsBlock::zeroed() };
        let texture = &scene.textures[index];
        // A material that nothing draws has no texels.
        let Some(place) = self.places[texture.image] else { return TexelsBlock::zeroed() };
        let wrap = |wrap: Wrap| match wrap {
            Wrap::Repeat => WRAP_REPEAT,
            Wrap::MirroredRepeat => WRAP_MIRRORED,
            Wrap::ClampToEdge => WRAP_CLAMP,
        };
        let bit = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
        let placed = material_blocks::placement(material.placement(slot));
        TexelsBlock {
            u: placed.u,
            v: placed.v,
            first: place.first,
            width_px: place.width_px,
            height_px: place.height_px,
            flags: place.buffer
                | wrap(texture.sampler.wrap_u) << TEXELS_WRAP_U_SHIFT
                | wrap(texture.sampler.wrap_v) << TEXELS_WRAP_V_SHIFT
                | bit(!texture.sampler.mag_linear, TEXELS_NEAREST)
                | bit(texture.color_space == ColorSpace::Srgb, TEXELS_SRGB)
                | bit(texture.sampler.mip_linear.is_some(), TEXELS_LEVELS)
                | bit(texture.sampler.mip_linear == Some(true), TEXELS_BETWEEN_LEVELS)
                | bit(!texture.sampler.min_linear, TEXELS_NEAREST_SMALL),
        }
    }

    /// `emitter_density` of a material: how likely a point of it is chosen, per square metre; 0: it lights nothing.
    fn materials(&self, scene: &Scene, emitter_density: impl Fn(&Material) -> f32) -> Vec<TracedMaterialBlock> {
        let block = |material: &Material| TracedMaterialBlock {
            material: material_blocks::block(scene, material),
            base_color: self.texels(scene, material, TextureSlot::BaseColor),
            metallic_roughness: self.texels(scene, material, TextureSlot::MetallicRoughness),
            normal: self.texels(scene, material, TextureSlot::Normal),
            emissive: self.texels(scene, material, TextureSlot::Emissive),
            occlusion: self.texels(scene, material, TextureSlot::Occlusion),
            emitter_density: emitter_density(material),
            alpha: match material.alpha {
                AlphaMode::Opaque => ALPHA_IS_OPAQUE,
                AlphaMode::Mask { .. } => ALPHA_IS_MASK,
                AlphaMode::Blend => ALPHA_IS_BLEND,
            },
            ..TracedMaterialBlock::zeroed()
        };
        scene.materials.iter().map(block).collect()
    }

    /// Writes the words of a texel buffer. An image in both colour spaces lies there once: its words are as the file has
    /// them.
    fn write_words(&self, scene: &Scene, buffer: usize, words: &mut [u8]) {
        for (index, (image, place)) in scene.images.iter().zip(&self.places).enumerate() {
            let Some(place) = place.filter(|place| place.buffer as usize == buffer) else { continue };
            let color_space = scene
                .textures
                .iter()
                .find(|texture| texture.image == index)
                .map_or(ColorSpace::Linear, |texture| texture.color_space);
            let shown = (self.reads.levels == TexelLevels::Cone).then(|| ShownTexels::of(scene, index)).flatten();
            let levels = [(image.width, image.height), (place.width_px, place.height_px)]
                .map(|(width, height)| mipmaps::level_count(width, height));
            let written = self.reads.levels.of(levels[0] - levels[1], levels[0]);
            let start = 4 * place.first as usize;
            let bytes = 4 * mipmaps::texel_count(image.width, image.height, written.clone()) as usize;
            mipmaps::write(image, color_space, written, shown.as_ref(), &mut words[start..start + bytes]);
        }
    }
}

/// The scene's rays on the device.
pub struct TracedGpu {
    buffers: Vec<(&'static str, Buffer)>,
    structure: Option<SceneStructure>,
}

impl TracedGpu {
    /// Fills the planned buffers. `emitter_density`: as of `TracedMaterialBlock`.
    ///
    /// Errors: memory for the copies (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        technique: &str,
        scene: &Scene,
        bvh: &Bvh,
        layout: &Layout,
        emitter_density: impl Fn(&Material) -> f32,
    ) -> Result<Self> {
        let mut buffers = Vec::new();
        let mut fill = |(name, block): (&str, &'static str), bytes: &[u8]| {
            let buffer = resources.buffer(&format!("{technique}.{name}"));
            upload::buffer(gpu, &buffer, bytes, Access::ComputeRead)?;
            buffers.push((block, buffer));
            Result::Ok(())
        };
        let [planes, triangles, tangents, extended, materials, planes_closing, closing] = BUFFERS;
        if let Rays::Tree(nodes) = &layout.rays {
            fill(NODES, nodes.bytes())?;
        }
        fill(planes, bytemuck::cast_slice(&bvh.triangles))?;
        let of = |source: &Source| Corners::of(scene, source);
        let all: Vec<TracedTriangleBlock> = bvh.sources.iter().map(|source| of(source).triangle()).collect();
        fill(triangles, bytemuck::cast_slice(&all))?;
        let all: Vec<TracedTangentsBlock> = match layout.has_tangents {
            true => bvh.sources.iter().map(|source| of(source).tangents()).collect(),
            false => Vec::new(),
        };
        fill(tangents, bytemuck::cast_slice(&all))?;
        let all: Vec<TracedExtendedBlock> = match layout.has_extended {
            true => bvh.sources.iter().map(|source| of(source).extended()).collect(),
            false => Vec::new(),
        };
        fill(extended, bytemuck::cast_slice(&all))?;
        fill(materials, bytemuck::cast_slice(&layout.materials(scene, emitter_density)))?;
        fill(planes_closing, bytemuck::cast_slice(&bvh.closing))?;
        let of = |scene: &Scene| bvh.sources.iter().map(|source| Corners::of(scene, source).closing()).collect();
        let all: Vec<TracedClosingBlock> = scene.closing.as_deref().map(of).unwrap_or_default();
        fill(closing, bytemuck::cast_slice(&all))?;
        for (index, (name, block)) in TEXELS.into_iter().enumerate() {
            let buffer = resources.buffer(&format!("{technique}.{name}"));
            let bytes = 4 * layout.texel_counts.get(index).copied().unwrap_or(0);
            let fill = |words: &mut [u8]| layout.write_words(scene, index, words);
            upload::buffer_with(gpu, &buffer, bytes, Access::ComputeRead, fill)?;
            buffers.push((block, buffer));
        }
        let build = |over| {
            let taken = structure::BUFFERS.map(|name| resources.buffer(&format!("{technique}.{name}")));
            SceneStructure::build(gpu, bvh, over, taken)
        };
        Ok(Self { structure: layout.structures.map(build).transpose()?, buffers })
    }

    /// What shading/traced.glsl and bvh_trace.glsl bind.
    pub fn bound(&self) -> impl Iterator<Item = (&'static str, Bound<'_>)> {
        let buffers = self.buffers.iter().map(|(block, buffer)| (*block, Bound::Buffer(buffer)));
        buffers.chain(self.structure.iter().map(SceneStructure::bound))
    }
}

/// One triangle where it is drawn.
struct Corners<'a> {
    mesh: &'a Mesh,
    draw: &'a Draw,
    vertices: [usize; 3],
}

impl<'a> Corners<'a> {
    fn of(scene: &'a Scene, source: &Source) -> Self {
        let draw = &scene.draws[source.draw as usize];
        let mesh = &scene.meshes[draw.mesh];
        Self { mesh, draw, vertices: mesh.corners(source.triangle as usize) }
    }

    fn triangle(&self) -> TracedTriangleBlock {
        let normals = self.draw.normals_from_object();
        let uvs = self.vertices.map(|vertex| self.mesh.uvs.get(vertex).copied().unwrap_or(Vec2::ZERO));
        let corner = |at: usize| {
            let normal: Vec3 = normals * self.mesh.normals[self.vertices[at]];
            normal.extend(uvs[at].x).to_array()
        };
        let material = f32::from_bits(self.mesh.material as u32);
        TracedTriangleBlock {
            corners: [corner(0), corner(1), corner(2)],
            v_material: [uvs[0].y, uvs[1].y, uvs[2].y, material],
        }
    }

    fn tangents(&self) -> TracedTangentsBlock {
        let turn = Mat3::from_mat4(self.draw.world_from_object);
        let corners = self.vertices.map(|vertex| {
            let tangent = self.mesh.tangents.get(vertex).copied().unwrap_or(Vec4::ZERO);
            (turn * tangent.truncate()).extend(tangent.w).to_array()
        });
        TracedTangentsBlock { corners }
    }

    fn closing(&self) -> TracedClosingBlock {
        TracedClosingBlock { normals: self.triangle().corners, tangents: self.tangents().corners }
    }

    fn extended(&self) -> TracedExtendedBlock {
        let color = |vertex: usize| self.mesh.colors.get(vertex).copied().unwrap_or(Vec4::ONE).to_array();
        let [first, second, third] =
            self.vertices.map(|vertex| self.mesh.uvs_1.get(vertex).copied().unwrap_or(Vec2::ZERO));
        TracedExtendedBlock {
            colors: self.vertices.map(color),
            uvs_01: [first.x, first.y, second.x, second.y],
            uv_2: [third.x, third.y, 0.0, 0.0],
        }
    }
}
