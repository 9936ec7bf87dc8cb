//! What shading space is drawn with.

use crate::gpu::shader::Shader;

/// The pipelines that a method draws with.
pub struct SpaceStages {
    pub(super) vertex: &'static Shader,
    pub(super) geometry: Option<&'static Shader>,
    pub(super) is_conservative: bool,
    /// A hull is drawn in the triangle's place.
    pub(super) has_hulls: bool,
    /// Vertices of a triangle.
    pub(super) vertex_count: u32,
}
