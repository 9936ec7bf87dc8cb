//! The stipple, and how stippled surfaces get their layers.

use crate::choice::choices;
use crate::sampling::pattern::Pattern;
use crate::settings::Values;
use crate::techniques::NamedPattern;

/// Patterns that the settings choose.
pub const PATTERNS: &[NamedPattern] = &[NamedPattern {
    name: "stipple",
    summary: "Texels of the light buffer by their layer: 0 is the solid surfaces', the others are BLEND surfaces'",
    keys: &["stipple"],
    // Which one auto is says a scene.
    make: |values| Ok(values.unless_auto("stipple", Values::choice).unwrap_or(StippleSize::Two).stipple()),
}];

choices! {
    /// Sides of the stipple, texels (`--stipple`).
    pub enum StippleSize {
        "2x2" => Two,
        "4x4" => Four,
    }
}

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

impl StippleSize {
    /// The square of texels, each a layer; layer 0 is the solid surfaces'.
    pub fn stipple(self) -> Pattern {
        Pattern::grid([if self == Self::Two { 2 } else { 4 }; 2])
    }
}

/// Layers of a stipple that BLEND draws can have.
pub fn layer_count(stipple: &Pattern) -> u32 {
    stipple.subset_count() - 1
}
