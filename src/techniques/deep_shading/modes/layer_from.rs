//! Which stage says the layer (`--layer-from`).

use crate::caps::Caps;
use crate::settings::Values;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerFrom {
    /// The vertex shader.
    Vertex,
    /// A geometry shader after it.
    Geometry,
}

impl LayerFrom {
    /// `--layer-from`, `auto` resolved.
    pub fn of(values: &Values, caps: &Caps) -> Self {
        match values.text("layer-from") {
            "vertex" => Self::Vertex,
            "geometry" => Self::Geometry,
            _ if caps.features.layer_from_vertex_shader => Self::Vertex,
            _ => Self::Geometry,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Geometry => "geometry",
        }
    }
}
