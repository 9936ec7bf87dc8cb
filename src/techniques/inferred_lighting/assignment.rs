//! How stippled surfaces get their layers.

use crate::choice::choices;

choices! {
    /// How layers are given out (`--assignment`).
    pub enum Assignment {
        /// Overlapping draws get different ones, nearest first.
        "overlap" => Overlap,
        /// By turns, from the nearest on.
        "depth" => Depth,
        /// As the user says; the rest in rotation, in the order of the file.
        "static" => Static,
    }
}

/// Layers of a stipple of `side` texels a side that BLEND draws can have.
pub fn layer_count(side: u32) -> u32 {
    side * side - 1
}
