//! Which stage says the layer (`--layer-from`).

use crate::caps::Caps;
use crate::choice::choices;
use crate::settings::Values;

choices! {
    /// Which stage says the layer (`--layer-from`).
    pub enum LayerFrom {
        "vertex" => Vertex,
        /// A geometry shader after the vertex shader.
        "geometry" => Geometry,
    }
}

impl LayerFrom {
    /// `--layer-from`, `auto` resolved.
    pub fn of(values: &Values, caps: &Caps) -> Self {
        let best = if caps.features.layer_from_vertex_shader { Self::Vertex } else { Self::Geometry };
        values.unless_auto("layer-from", Values::choice).unwrap_or(best)
    }
}
