//! What the solid draws are rasterised into: culling asks where a triangle can make a fragment.

use crate::units::Extent;

/// Where in a pixel the device asks whether a triangle covers it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// In the pixel's middle.
    Middle,
    /// Anywhere: at several samples, or in a middle that moves from run to run.
    Anywhere,
}

/// The images that are drawn into; their extent need not be the picture's.
#[derive(Clone, Copy, Debug)]
pub struct Raster {
    pub extent: Extent,
    pub coverage: Coverage,
}
