//! Which stage makes polygons (`--polygon-from`).

use crate::caps::Caps;
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
