//! SceneGpu: the scene in device memory: vertex streams, indices, draws, materials with their textures. Shaders see it
//! through glsl/resident.glsl.
//!
//! What few scenes use costs the others nothing: vertex colours and second UV sets lie in a third stream, which is there
//! (and read, by the EXTENDED variants of the shaders) where a drawn mesh has them or a texture is placed; what materials
//! say beyond the common is read where SURFACE_EXTRAS is 1 (glsl/shading/extras.glsl).
//!
//! Positions lie in a stream of their own, because depth and visibility passes read nothing else.

mod clusters;
mod geometry;
mod material_blocks;
mod raster;
mod relief;
pub mod structure;
mod textures;
pub mod traced;
mod visible;

pub use clusters::Cluster;
pub use geometry::{Geometry, groups_of};
pub use raster::{Coverage, Raster};
pub use relief::advise;
pub use textures::Textures;
pub use visible::{DrawList, GeometryChoice};

use crate::error::Result;
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::structs::{DrawBlock, MaterialBlock, PlacementBlock};
use crate::gpu::{Access, AccessSet, Buffer, Caps, Gpu, ImageDescription, upload};
use crate::plan::{Plan, Resources, Shape, Sharing};
use crate::scene::{AlphaMode, ColorSpace, Draw, Material, Mesh, Scene, TextureSlot, mipmaps, object_ids};
use crate::units::Extent;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec3};
use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;
use textures::MaterialSets;

/// What a vertex carries beside its position.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct VertexAttributes {
    pub normal: [f32; 3],
    /// xyz as `Mesh::tangents` has it; w: the handedness, +1 or -1, times 1 + the id of the vertex's normal group.
    pub tangent: [f32; 4],
    pub uv: [f32; 2],
}

/// What few vertices carry, in a stream of its own.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct ExtendedAttributes {
    pub color: [f32; 4],
    pub uv_1: [f32; 2],
}

/// One draw call.
#[derive(Clone, Copy, Debug)]
pub struct DrawCall {
    /// Index into `Scene::draws`, and of the draw's block.
    pub draw: u32,
    pub material: u32,
    pub first_index: u32,
    pub index_count: u32,
    /// First cluster of its mesh in `SceneGpu::clusters`.
    pub first_cluster: u32,
    pub cluster_count: u32,
    pub vertex_offset: i32,
    pub alpha: AlphaMode,
    pub double_sided: bool,
    /// The transform mirrors: front faces are clockwise.
    pub mirrored: bool,
    /// Middle of its box, world space: what BLEND draws are sorted by.
    pub center_ws: Vec3,
}

impl DrawCall {
    /// Its range of `SceneGpu::clusters`.
    fn clusters(&self) -> Range<usize> {
        self.first_cluster as usize..(self.first_cluster + self.cluster_count) as usize
    }
}

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

fn format_of(color_space: ColorSpace) -> vk::Format {
    match color_space {
        ColorSpace::Srgb => vk::Format::R8G8B8A8_SRGB,
        ColorSpace::Linear => vk::Format::R8G8B8A8_UNORM,
    }
}

/// Distinct images in their colour spaces, in the order of their first texture.
fn distinct_images(scene: &Scene) -> Vec<(usize, ColorSpace)> {
    let mut seen = HashSet::new();
    let all = scene.textures.iter().map(|texture| (texture.image, texture.color_space));
    all.filter(|image| seen.insert(*image)).collect()
}

/// The first level of an image whose sides are at most `limit_px`; 0: no limit.
fn limited(image: &crate::scene::Image, limit_px: u32) -> Extent {
    let (mut width, mut height) = (image.width, image.height);
    while limit_px > 0 && width.max(height) > limit_px {
        (width, height) = ((width / 2).max(1), (height / 2).max(1));
    }
    Extent::new(width, height)
}

impl SceneStats {
    pub fn of(scene: &Scene) -> Self {
        Self::with_texture_limit(scene, scene.texture_limit_px)
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
        let heap_bytes = caps.heaps.iter().map(|heap| heap.bytes).max().unwrap_or_default();
        let room_bytes = heap_bytes.min(budget_bytes.unwrap_or(u64::MAX)) / 4 * 3;
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
    fn geometry_plan(&self) -> Plan {
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

    fn plan_textures(&self, plan: &mut Plan) {
        for (index, (extent, format)) in self.textures.iter().enumerate() {
            plan.push("scene.textures", format!("scene.textures.{index}"), texture_shape(*extent, *format));
        }
        let white = texture_shape(Extent::new(1, 1), vk::Format::R8G8B8A8_UNORM);
        plan.push("scene.textures", "scene.textures.white", white);
    }
}

fn texture_shape(extent: Extent, format: vk::Format) -> Shape {
    Shape::Image(ImageDescription {
        extent,
        format,
        sampled_as: None,
        level_count: mipmaps::level_count(extent.width, extent.height),
        layer_count: None,
        samples: 1,
        usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
    })
}

/// What the EXTENDED variants of shaders read.
pub struct Extended {
    /// The third vertex stream.
    pub attributes: Buffer,
    /// Placements of each material's textures.
    pub placements: Buffer,
}

/// The scene in device memory.
pub struct SceneGpu {
    gpu: Arc<Gpu>,
    pub positions: Buffer,
    pub attributes: Buffer,
    pub extended: Option<Extended>,
    pub indices: Buffer,
    pub draws: Buffer,
    pub materials: Buffer,
    /// What `materials` holds.
    pub material_blocks: Vec<MaterialBlock>,
    /// Sorted so that state changes least; BLEND draws last.
    pub calls: Vec<DrawCall>,
    /// Clusters of all meshes, one mesh after the other, in the order of `indices`.
    pub clusters: Vec<Cluster>,
    /// What `indices` holds, for tests of single triangles on the host.
    pub host_indices: Vec<u32>,
    /// Whether a drawn material has `Material::has_extras`.
    pub has_extras: bool,
    /// Layout of set 1: the textures of a material.
    pub material_layout: vk::DescriptorSetLayout,
    /// Set 1 of each material.
    pub material_sets: Vec<vk::DescriptorSet>,
    material_pool: vk::DescriptorPool,
    // Alive as long as the sets that name them.
    textures: Arc<Textures>,
    _samplers: Vec<Sampler>,
}

impl SceneGpu {
    /// Uploads the scene; `kept`, the textures of another one, serves again where they are the same.
    ///
    /// Errors: memory is too small or a limit is passed (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, scene: &Scene, kept: Option<Arc<Textures>>) -> Result<Self> {
        // What is not needed goes first: the device need not have room for both.
        let kept = kept.filter(|textures| textures.are_of(scene));
        let stats = SceneStats::of(scene);
        let mut resources = Resources::make(gpu, "scene", &stats.geometry_plan(), &Sharing::default())?;
        let textures = kept.map_or_else(|| Textures::new(gpu, scene, &stats).map(Arc::new), Ok)?;
        let geometry = Geometry::of(scene);
        let send = |buffer: &Buffer, bytes: &[u8], accesses: AccessSet| upload::buffer(gpu, buffer, bytes, accesses);
        // Vertex inputs, and what shaders fetch for themselves.
        let vertices = Access::VertexRead | Access::GraphicsRead;
        let shaders = AccessSet::from(Access::GraphicsRead);
        let positions = resources.buffer("scene.positions");
        send(&positions, bytemuck::cast_slice(&geometry.positions), vertices)?;
        let attributes = resources.buffer("scene.attributes");
        send(&attributes, bytemuck::cast_slice(&geometry.attributes), vertices)?;
        let extended = match stats.has_extended {
            false => None,
            true => {
                let attributes = resources.buffer("scene.extended");
                send(&attributes, bytemuck::cast_slice(&geometry::extended(scene)), vertices)?;
                let placements = resources.buffer("scene.placements");
                send(&placements, bytemuck::cast_slice(&material_blocks::placements(scene)), shaders)?;
                Some(Extended { attributes, placements })
            }
        };
        let indices = resources.buffer("scene.indices");
        send(&indices, bytemuck::cast_slice(&geometry.indices), vertices)?;
        let draws = resources.buffer("scene.draws");
        send(&draws, bytemuck::cast_slice(&draw_blocks(scene)), shaders)?;
        let materials = resources.buffer("scene.materials");
        let blocks: Vec<MaterialBlock> = scene.materials.iter().map(material_blocks::block).collect();
        send(&materials, bytemuck::cast_slice(&blocks), shaders)?;
        let MaterialSets { samplers, layout, pool, sets } = MaterialSets::new(gpu, scene, &textures)?;
        let mut calls = geometry.calls(scene);
        sort(&mut calls);
        Ok(Self {
            gpu: gpu.clone(),
            positions,
            attributes,
            extended,
            indices,
            draws,
            materials,
            material_blocks: blocks,
            calls,
            clusters: geometry.clusters,
            host_indices: geometry.indices,
            has_extras: scene.drawn_materials().any(Material::has_extras),
            material_layout: layout,
            material_sets: sets,
            material_pool: pool,
            textures,
            _samplers: samplers,
        })
    }

    /// The textures, for a scene that shows the same pictures.
    pub fn textures(&self) -> Arc<Textures> {
        self.textures.clone()
    }
}

impl Drop for SceneGpu {
    fn drop(&mut self) {
        // SAFETY: renderers are dropped before the scene, after their fences.
        unsafe {
            self.gpu.device.destroy_descriptor_pool(self.material_pool, None);
            self.gpu.device.destroy_descriptor_set_layout(self.material_layout, None);
        }
    }
}

/// State changes cost: opaque before masked before blended, then by side, winding and material.
fn sort(calls: &mut [DrawCall]) {
    calls.sort_by_key(|call| {
        let alpha = match call.alpha {
            AlphaMode::Opaque => 0,
            AlphaMode::Mask { .. } => 1,
            AlphaMode::Blend => 2,
        };
        (alpha, call.double_sided, call.mirrored, call.material, call.draw)
    });
}

/// Turns normals as a draw turns its surface: the inverse transpose up to a positive factor, which normalising takes out
/// again.
fn normals_from(draw: &Draw) -> Mat3 {
    let linear = Mat3::from_mat4(draw.world_from_object);
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    Mat3::from_cols(sign * y.cross(z), sign * z.cross(x), sign * x.cross(y))
}

pub fn draw_blocks(scene: &Scene) -> Vec<DrawBlock> {
    scene
        .draws
        .iter()
        .zip(object_ids::of(scene))
        .map(|(draw, object_id)| {
            let normals = normals_from(draw);
            let column = |v: Vec3| v.extend(0.0).to_array();
            DrawBlock {
                world_from_object: draw.world_from_object.to_cols_array_2d(),
                normal_x: column(normals.x_axis),
                normal_y: column(normals.y_axis),
                normal_z: column(normals.z_axis),
                material: scene.meshes[draw.mesh].material as u32,
                object_id: u32::from(object_id),
                ..DrawBlock::zeroed()
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The levels that a limit leaves are the last ones of all: an upload counts them from the end.
    #[test]
    fn a_limited_texture_is_the_end_of_the_whole_one() {
        for (width, height) in [(1024, 1024), (1000, 3), (7, 513), (1, 1), (641, 359)] {
            let image = crate::scene::Image { width, height, ..Default::default() };
            let shape = |extent| match texture_shape(extent, vk::Format::R8G8B8A8_SRGB) {
                Shape::Image(description) => description,
                Shape::Buffer { .. } => unreachable!("a texture is an image"),
            };
            let whole = shape(Extent::new(width, height));
            for limit_px in [0, 1, 2, 5, 100, 512, 1024, 4096] {
                let extent = limited(&image, limit_px);
                assert!(limit_px == 0 || extent.width.max(extent.height) <= limit_px);
                let kept = shape(extent);
                let left_out = whole.level_count - kept.level_count;
                assert!(left_out == 0 || (width.max(height) >> (left_out - 1)) > limit_px, "no finer level is allowed");
                let finer: u64 = (0..left_out)
                    .map(|level| 4 * u64::from((width >> level).max(1)) * u64::from((height >> level).max(1)))
                    .sum();
                assert_eq!(finer + kept.bytes(), whole.bytes(), "{width}x{height} within {limit_px}");
            }
        }
    }
}
