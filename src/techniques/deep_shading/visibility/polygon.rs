//! The stage that makes the polygons of stochastic rasterisation (`--polygon-from`): vertex shaders (stochastic.rs), or
//! a geometry shader as in the paper (section 4.2), once for all corners. Shaders: polygon.vert, polygon.geom.

use super::sample::Stages;
use crate::gpu::Caps;
use crate::gpu::shader::techniques::deep_shading::visibility::polygon::{GEOM_VARIANTS, VERT};
use crate::gpu::shader::variant;
use crate::passes::mesh::Sides;
use crate::settings::Values;

/// Which stage makes polygons (`--polygon-from`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolygonFrom {
    /// Each of a polygon's vertices makes all of it.
    Vertex,
    /// A geometry shader, once.
    Geometry,
}

impl PolygonFrom {
    /// `--polygon-from`, `auto` resolved.
    pub fn of(values: &Values, caps: &Caps) -> Self {
        match values.text("polygon-from") {
            "vertex" => Self::Vertex,
            "geometry" => Self::Geometry,
            _ if caps.features.geometry_shader => Self::Geometry,
            _ => Self::Vertex,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Geometry => "geometry",
        }
    }
}

/// `tests`: the value of the shader's axis.
pub(super) fn stages(tests: &str) -> Stages {
    // As in stochastic.rs.
    Stages { vertex: &VERT, geometry: Some(variant(GEOM_VARIANTS, &[tests])), sides: Sides::Both, vertex_count: 3 }
}
