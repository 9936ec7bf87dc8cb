//! Hulls from vertex shaders, each of which makes the hull for itself: for devices without geometry shaders.
//! Shaders: vertex.vert, hull.glsl, ../hull.glsl.

use crate::gpu::shader::techniques::deep_shading::hull::HULL_VERTICES;
use crate::gpu::shader::techniques::deep_shading::shade::vertex::VERT_VARIANTS;
use crate::gpu::shader::variant;
use crate::techniques::deep_shading::shade::stages::SpaceStages;

/// `marks`: the value of the shader's axis.
pub(super) fn stages(marks: &str) -> SpaceStages {
    SpaceStages {
        vertex: variant(VERT_VARIANTS, &[marks]),
        geometry: None,
        is_conservative: false,
        has_hulls: true,
        vertex_count: HULL_VERTICES,
    }
}
