//! Where fragments that shade take their place on a triangle from (`--barycentrics`). Clarberg & Munkberg 2014, sections 4.4 and 5.

use crate::choice::choices;

choices! {
    /// Where fragments that shade take their weights of a triangle's corners from (`--barycentrics`).
    pub enum Barycentrics {
        /// Computed from the corners that the fragment fetches, in one order of operations.
        "computed" => Computed,
        /// Interpolated by the rasteriser, as an attribute of the corners.
        "interpolated" => Interpolated,
        /// Given by the device to every fragment (VK_KHR_fragment_shader_barycentric).
        "device" => Device,
    }
}
