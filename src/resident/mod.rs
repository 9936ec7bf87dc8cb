//! SceneGpu: the scene in device memory: vertex streams, indices, draws, materials with their textures. Shaders see it
//! through glsl/resident.glsl.
//!
//! What few scenes use costs the others nothing: vertex colours and second UV sets lie in a third stream, which is there
//! (and read, by the EXTENDED variants of the shaders) where a drawn mesh has them or a texture is placed; what materials
//! say beyond the common is read where SURFACE_EXTRAS is 1 (glsl/shading/extras.glsl).
//!
//! Positions lie in a stream of their own, because depth and visibility passes read nothing else.

mod boxes;
mod clipped;
mod clusters;
pub mod coarse;
mod disc;
mod draw_call;
mod draw_view;
pub mod geometry;
mod material_blocks;
mod raster;
mod relief;
mod stats;
pub mod structure;
mod swept;
mod textures;
pub mod traced;
mod visible;
pub mod volume;

pub use boxes::{Casters, ClusterBoxes};
pub use clusters::Cluster;
pub use disc::LensDisc;
pub use geometry::{Geometry, groups_of};
pub use raster::{Coverage, Raster};
pub use relief::advise;
pub use swept::Sweep;
pub use textures::Textures;
pub use visible::DrawList;

use crate::error::Result;
use crate::gpu::marks::Slots;
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::structs::{DrawBlock, MaterialBlock};
use crate::gpu::{Access, AccessSet, Buffer, Gpu, upload};
use crate::plan::{Resources, Sharing};
use crate::scene::{AlphaMode, Material, Scene, object_ids};
use ash::vk;
use bytemuck::Zeroable;
pub use draw_call::{DrawCall, ExtendedAttributes, Sides, VertexAttributes};
use glam::Vec3;
pub use stats::SceneStats;
use std::sync::Arc;
use textures::MaterialSets;

/// What the EXTENDED variants of shaders read.
#[derive(Clone)]
pub struct Extended {
    /// The third vertex stream.
    pub attributes: Arc<Buffer>,
    /// Placements of each material's textures.
    pub placements: Arc<Buffer>,
}

/// Where the scene stands at a moment.
#[derive(Clone)]
pub struct Pose {
    /// Three floats a vertex, object space.
    pub positions: Arc<Buffer>,
    /// The second vertex stream.
    pub attributes: Arc<Buffer>,
    /// A block a draw.
    pub draws: Arc<Buffer>,
}

/// The scene in device memory. Clones share it.
#[derive(Clone)]
pub struct SceneGpu {
    pub pose: Pose,
    pub extended: Option<Extended>,
    pub indices: Arc<Buffer>,
    pub materials: Arc<Buffer>,
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
    /// `Texturing::reads_along` of the scene.
    reads_along: bool,
    /// Layout of set 1: the textures of a material.
    pub material_layout: vk::DescriptorSetLayout,
    /// Set 1 of each material.
    pub material_sets: Vec<vk::DescriptorSet>,
    owner: Arc<SetOwner>,
}

/// What sets of materials are made of: alive as long as they are.
struct SetOwner {
    gpu: Arc<Gpu>,
    layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    textures: Arc<Textures>,
    _samplers: Vec<Sampler>,
    _slots: Vec<Slots>,
}

/// Draw calls, and the clusters of triangles that they are made of.
pub struct ClusteredCalls<'a> {
    pub calls: &'a [DrawCall],
    pub clusters: &'a [Cluster],
    pub indices: &'a [u32],
}

impl SceneGpu {
    /// READS_ALONG, of shaders that read the textures of a material.
    pub fn texture_constant(&self) -> (&'static str, u32) {
        ("READS_ALONG", u32::from(self.reads_along))
    }

    /// `calls`, which are of this scene, with its clusters.
    pub fn clustered<'a>(&'a self, calls: &'a [DrawCall]) -> ClusteredCalls<'a> {
        ClusteredCalls { calls, clusters: &self.clusters, indices: &self.host_indices }
    }

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
        // Vertex inputs, and what shaders fetch for themselves.
        let shaders = Access::GraphicsRead | Access::ComputeRead;
        let vertices = shaders.with(Access::VertexRead);
        let mut sent = |name: &str, bytes: &[u8], accesses: AccessSet| -> Result<Arc<Buffer>> {
            let buffer = resources.buffer(name);
            upload::buffer(gpu, &buffer, bytes, accesses)?;
            Ok(Arc::new(buffer))
        };
        let positions = sent("scene.positions", bytemuck::cast_slice(&geometry.positions), vertices)?;
        let attributes = sent("scene.attributes", bytemuck::cast_slice(&geometry.attributes), vertices)?;
        let extended = match stats.has_extended {
            false => None,
            true => Some(Extended {
                attributes: sent("scene.extended", bytemuck::cast_slice(&geometry::extended(scene)), vertices)?,
                placements: sent(
                    "scene.placements",
                    bytemuck::cast_slice(&material_blocks::placements(scene)),
                    shaders,
                )?,
            }),
        };
        let indices = sent("scene.indices", bytemuck::cast_slice(&geometry.indices), vertices)?;
        let draws = sent("scene.draws", bytemuck::cast_slice(&draw_blocks(scene)), shaders)?;
        let blocks: Vec<MaterialBlock> =
            scene.materials.iter().map(|material| material_blocks::block(scene, material)).collect();
        let materials = sent("scene.materials", bytemuck::cast_slice(&blocks), shaders)?;
        let MaterialSets { samplers, layout, pool, sets, slots } = MaterialSets::new(gpu, scene, &textures)?;
        let mut calls = geometry.calls(scene);
        sort(&mut calls);
        let owner = SetOwner { gpu: gpu.clone(), layout, pool, textures, _samplers: samplers, _slots: slots };
        Ok(Self {
            pose: Pose { positions, attributes, draws },
            extended,
            indices,
            materials,
            material_blocks: blocks,
            calls,
            clusters: geometry.clusters,
            host_indices: geometry.indices,
            has_extras: scene.drawn_materials().any(Material::has_extras),
            reads_along: scene.texturing.reads_along(),
            material_layout: layout,
            material_sets: sets,
            owner: Arc::new(owner),
        })
    }

    /// The same scene where it stands at another moment.
    pub fn posed(&self, pose: Pose) -> Self {
        Self { pose, ..self.clone() }
    }

    /// The textures, for a scene that shows the same pictures.
    pub fn textures(&self) -> Arc<Textures> {
        self.owner.textures.clone()
    }
}

impl Drop for SetOwner {
    fn drop(&mut self) {
        // SAFETY: renderers are dropped before the scene, after their fences.
        unsafe {
            self.gpu.device.destroy_descriptor_pool(self.pool, None);
            self.gpu.device.destroy_descriptor_set_layout(self.layout, None);
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
        (alpha, call.sides, call.mirrored, call.material, call.draw)
    });
}

pub fn draw_blocks(scene: &Scene) -> Vec<DrawBlock> {
    scene
        .draws
        .iter()
        .zip(object_ids::of(scene))
        .map(|(draw, object_id)| {
            let normals = draw.normals_from_object();
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
    use crate::plan::Shape;
    use crate::resident::stats::limited;
    use crate::resident::stats::texture_shape;
    use crate::units::Extent;

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
