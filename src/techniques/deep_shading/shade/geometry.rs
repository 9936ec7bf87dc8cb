//! Hulls from a geometry shader (Clarberg & Munkberg 2014, section 4.4). Shaders: corner.vert, geometry.geom, hull.glsl.

use crate::gpu::shader::techniques::deep_shading::shade::{corner::VERT_VARIANTS, geometry::GEOM_VARIANTS};
use crate::gpu::shader::variant;
use crate::techniques::deep_shading::shade::stages::SpaceStages;

/// `marks`: the value of the geometry shader's axis; corners are made of all triangles, without weights.
pub(super) fn stages(marks: &str) -> SpaceStages {
    let geometry = Some(variant(GEOM_VARIANTS, &[marks]));
    SpaceStages {
        vertex: variant(VERT_VARIANTS, &["off", "off"]),
        geometry,
        is_conservative: false,
        has_hulls: true,
        vertex_count: 3,
    }
}
