//! Draws of a scene and the attributes of their vertices, as they lie in device memory.

use crate::scene::{AlphaMode, Material};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::ops::Range;

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

/// Which sides of a draw's triangles are drawn; they sort in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sides {
    Fronts,
    Backs,
    Both,
}

impl Sides {
    /// What is seen of a material.
    pub fn of(material: &Material) -> Self {
        if material.double_sided { Self::Both } else { Self::Fronts }
    }

    /// Each side for itself, backs first: of a closed shape they are what is farther away.
    pub fn apart(self) -> &'static [Self] {
        match self {
            Self::Fronts => &[Self::Fronts],
            Self::Backs => &[Self::Backs],
            Self::Both => &[Self::Backs, Self::Fronts],
        }
    }
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
    pub sides: Sides,
    /// The transform mirrors: front faces are clockwise.
    pub mirrored: bool,
    /// Middle of its box, world space: what BLEND draws are sorted by.
    pub center_ws: Vec3,
}

impl DrawCall {
    /// Its range of `SceneGpu::clusters`.
    pub(super) fn clusters(&self) -> Range<usize> {
        self.first_cluster as usize..(self.first_cluster + self.cluster_count) as usize
    }
}
