//! Edge-aware filters of an irradiance buffer, one file each.

pub mod gauss;
pub mod gauss_fast;
pub mod gauss_pack;

/// A separable Gaussian's shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// Taps in one direction: odd, 5 to 17.
    pub taps: u32,
    /// Standard deviation in px.
    pub sigma: f32,
}

impl Kernel {
    /// Taps on either side of the middle.
    pub fn radius(self) -> u32 {
        self.taps / 2
    }

    /// -1 / (2 sigma^2), in 1/px^2.
    pub fn falloff(self) -> f32 {
        -0.5 / (self.sigma * self.sigma)
    }
}
