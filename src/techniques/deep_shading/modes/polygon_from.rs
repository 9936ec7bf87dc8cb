//! Which stage makes polygons (`--polygon-from`).

use crate::caps::Caps;
use crate::choice::choices;
use crate::settings::Values;

choices! {
    /// Which stage makes polygons (`--polygon-from`).
    pub enum PolygonFrom {
        /// A geometry shader, once.
        "geometry" => Geometry,
        /// Each of a polygon's vertices makes all of it.
        "vertex" => Vertex,
    }
}

impl PolygonFrom {
    /// `--polygon-from`, `auto` resolved.
    pub fn of(values: &Values, caps: &Caps) -> Self {
        let best = if caps.features.geometry_shader { Self::Geometry } else { Self::Vertex };
        values.unless_auto("polygon-from", Values::choice).unwrap_or(best)
    }
}
