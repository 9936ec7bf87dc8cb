//! What fills a scene between its surfaces.

/// A homogeneous medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Light that a metre scatters and absorbs, each at least 0, not both 0.
    pub scattering: f64,
    pub absorption: f64,
    /// Mean cosine of the angle by which light is turned.
    pub asymmetry: f64,
}
