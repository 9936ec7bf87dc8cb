//! What a scene takes in device memory, by arithmetic.

use crate::caps::Caps;
use crate::gpu::ImageDescription;
use crate::gpu::shader::structs::{DrawBlock, MaterialBlock, PlacementBlock};
use crate::plan::{Plan, Shape};
use crate::resident::{ExtendedAttributes, VertexAttributes};
use crate::scene::{AlphaMode, ColorSpace, Material, Mesh, Scene, TextureSlot, mipmaps};
use crate::units::Extent;
use ash::vk;
use std::collections::HashSet;

/// Sizes of the scene's resources: all that a plan needs to know of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneStats {
    pub vertex_count: u64,
    pub index_count: u64,
    pub draw_count: u64,
    pub material_count: u64,
    /// Extent, within the scene's limit, and format of each distinct image in its colour space.
    pub textures: Vec<(Extent, vk::Format)>,
    /// Whether the G-buffer has an image of emission: a drawn material shines, or has something that travels with it.
    pub has_emissive: bool,
    /// Whether vertices have the third stream, and textures their placements.
    pub has_extended: bool,
    pub has_blend: bool,
}

pub fn format_of(color_space: ColorSpace) -> vk::Format {
    match color_space {
        ColorSpace::Srgb => vk::Format::R8G8B8A8_SRGB,
        ColorSpace::Linear => vk::Format::R8G8B8A8_UNORM,
    }
}

/// Distinct images in their colour spaces, in the order of their first texture.
pub fn distinct_images(scene: &Scene) -> Vec<(usize, ColorSpace)> {
    let mut seen = HashSet::new();
    let all = scene.textures.iter().map(|texture| (texture.image, texture.color_space));
    all.filter(|image| seen.insert(*image)).collect()
}

/// The first level of an image whose sides are at most `limit_px`; 0: no limit.
pub fn limited(image: &crate::scene::Image, limit_px: u32) -> Extent {
    let (mut width, mut height) = (image.width, image.height);
    while limit_px > 0 && width.max(height) > limit_px {
        (width, height) = ((width / 2).max(1), (height / 2).max(1));
    }
    Extent::new(width, height)
}

impl SceneStats {
    pub fn of(scene: &Scene) -> Self {
        Self::with_texture_limit(scene, scene.texturing.limit_px)
    }

    /// The numbers of `scene` as if its limit were `limit_px`; 0: none.
    pub fn with_texture_limit(scene: &Scene, limit_px: u32) -> Self {
        let drawn = || scene.drawn_materials();
        let is_extended = |mesh: &Mesh| !mesh.colors.is_empty() || !mesh.uvs_1.is_empty();
        Self {
            vertex_count: scene.meshes.iter().map(|mesh| mesh.positions.len() as u64).sum(),
            index_count: scene.meshes.iter().map(|mesh| mesh.indices.len() as u64).sum(),
            draw_count: scene.draws.len() as u64,
            material_count: scene.materials.len() as u64,
            textures: distinct_images(scene)
                .into_iter()
                .map(|(image, color_space)| (limited(&scene.images[image], limit_px), format_of(color_space)))
                .collect(),
            has_emissive: drawn().any(|material| material.is_emissive() || material.has_extras()),
            has_extended: scene.meshes.iter().any(is_extended) || drawn().any(Material::has_placements),
            has_blend: drawn().any(|material| material.alpha == AlphaMode::Blend),
        }
    }

    /// The texture limit that `auto` means on a device of `caps`: 0, none, where the scene takes at most three quarters
    /// of the greatest heap, or of `budget_bytes` where that is less; else the greatest power of two with which it
    /// does. 0 too where no limit would do.
    ///
    /// The last quarter is the frame's and the staging buffers'.
    pub fn fitting_limit_px(scene: &Scene, caps: &Caps, budget_bytes: Option<u64>) -> u32 {
        let room_bytes = caps.budget_bytes(budget_bytes) / 4 * 3;
        let fits = |limit_px: u32| Self::with_texture_limit(scene, limit_px).plan().bytes() <= room_bytes;
        let side_px = scene.images.iter().map(|image| image.width.max(image.height)).max().unwrap_or(1);
        let powers = 0..=side_px.ilog2();
        if fits(0) { 0 } else { powers.rev().map(|power| 1 << power).find(|limit_px| fits(*limit_px)).unwrap_or(0) }
    }

    /// The scene's resources.
    pub fn plan(&self) -> Plan {
        let mut plan = self.geometry_plan();
        self.plan_textures(&mut plan);
        plan
    }

    /// Plan of the resources of one moment of the scene: all except its textures.
    pub(super) fn geometry_plan(&self) -> Plan {
        use vk::BufferUsageFlags as Flags;
        let mut plan = Plan::default();
        let geometry = |bytes: u64, flags: Flags| Shape::Buffer {
            bytes: bytes.max(16),
            // deep_shading reads vertices as storage.
            flags: flags | Flags::STORAGE_BUFFER | Flags::TRANSFER_DST,
            usage: crate::memory::kinds::Use::Device,
        };
        let attributes = size_of::<VertexAttributes>() as u64;
        plan.push("scene.geometry", "scene.positions", geometry(12 * self.vertex_count, Flags::VERTEX_BUFFER));
        plan.push("scene.geometry", "scene.attributes", geometry(attributes * self.vertex_count, Flags::VERTEX_BUFFER));
        if self.has_extended {
            let bytes = size_of::<ExtendedAttributes>() as u64 * self.vertex_count;
            plan.push("scene.geometry", "scene.extended", geometry(bytes, Flags::VERTEX_BUFFER));
            let bytes = (size_of::<PlacementBlock>() * TextureSlot::ALL.len()) as u64 * self.material_count;
            plan.buffer("scene.materials", "scene.placements", bytes);
        }
        plan.push("scene.geometry", "scene.indices", geometry(4 * self.index_count, Flags::INDEX_BUFFER));
        plan.buffer("scene.geometry", "scene.draws", self.draw_count * size_of::<DrawBlock>() as u64);
        plan.buffer("scene.materials", "scene.materials", self.material_count * size_of::<MaterialBlock>() as u64);
        plan
    }

    pub(super) fn plan_textures(&self, plan: &mut Plan) {
        for (index, (extent, format)) in self.textures.iter().enumerate() {
            plan.push("scene.textures", format!("scene.textures.{index}"), texture_shape(*extent, *format));
        }
        let white = texture_shape(Extent::new(1, 1), vk::Format::R8G8B8A8_UNORM);
        plan.push("scene.textures", "scene.textures.white", white);
    }
}

pub fn texture_shape(extent: Extent, format: vk::Format) -> Shape {
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let level_count = mipmaps::level_count(extent.width, extent.height);
    Shape::Image(ImageDescription { level_count, ..ImageDescription::plain(extent, format, 1, usage) })
}
