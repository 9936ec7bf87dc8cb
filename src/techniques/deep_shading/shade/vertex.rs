//! Hulls from vertex shaders, each of which makes the hull for itself: for devices without geometry shaders.
//! Shaders: vertex.vert, hull.glsl, ../hull.glsl.

use super::Stages;
use crate::gpu::shader::techniques::deep_shading::shade::vertex::VERT;

/// HULL_VERTICES of hull.glsl.
pub const HULL_VERTICES: u32 = 18;

pub(super) fn stages() -> Stages {
    Stages { vertex: &VERT, geometry: None, is_conservative: false, vertex_count: HULL_VERTICES }
}
