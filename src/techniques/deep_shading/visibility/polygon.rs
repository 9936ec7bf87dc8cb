//! The stage that makes the polygons of stochastic rasterisation (`--polygon-from`): vertex shaders (stochastic.rs), or
//! a geometry shader as in the paper (section 4.2), once for all corners. Shaders: polygon.vert, polygon.geom.

use crate::gpu::shader::techniques::deep_shading::visibility::polygon::{GEOM_VARIANTS, VERT};
use crate::gpu::shader::variant;
use crate::resident::Sides;
use crate::techniques::deep_shading::visibility::draw::SampleStages;

/// `tests`: the value of the shader's axis.
pub(super) fn stages(tests: &str) -> SampleStages {
    // As in stochastic.rs.
    SampleStages {
        vertex: &VERT,
        geometry: Some(variant(GEOM_VARIANTS, &[tests])),
        sides: Some(Sides::Both),
        vertex_count: 3,
        is_indexed: false,
    }
}
