//! How finely triangles are shaded (`--shading-rate`).

use crate::choice::choices;
use crate::settings::Values;

choices! {
    /// How finely triangles are shaded (`--shading-rate`).
    pub enum ShadingRate {
        /// A pixel of shading space each.
        "full" => Full,
        /// Coarser along axes on which all of a triangle is blurred.
        "blur" => Blur,
    }
}

/// Pixels of shading space across a blur, at least, with `--shading-rate blur`.
pub fn blur_pixels(values: &Values) -> Option<f32> {
    values.is("shading-rate", ShadingRate::Blur).then(|| values.number("blur-pixels") as f32)
}
