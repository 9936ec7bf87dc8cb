//! How draws of tuples come by vertices (`--vertices`).

use crate::caps::Caps;
use crate::choice::choices;
use crate::settings::Values;

choices! {
    /// How draws of tuples come by vertices (`--vertices`).
    pub enum Vertices {
        /// By the scene's indices: a vertex is placed once for the triangles around it.
        "indexed" => Indexed,
        /// Shaders read what the index of each corner says.
        "fetched" => Fetched,
    }
}

impl Vertices {
    /// `--vertices`, `auto` resolved.
    pub fn of(values: &Values, caps: &Caps) -> Self {
        // Fragments ask for their triangle's number, which Vulkan has with geometry shaders.
        let best = if caps.features.geometry_shader { Self::Indexed } else { Self::Fetched };
        values.unless_auto("vertices", Values::choice).unwrap_or(best)
    }
}
