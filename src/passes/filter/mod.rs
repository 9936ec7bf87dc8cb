//! Edge-aware filters of an irradiance buffer, one file each.

pub mod gauss;
pub mod gauss_fast;
pub mod gauss_pack;

use crate::gpu::shader::structs::WalkParams;

/// Which discontinuities end a walk: bits of the flags (1: differs from +x, 2: from +y, 4: from +xy).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopBits {
    pub x: u32,
    pub y: u32,
}

impl StopBits {
    /// Any of the three ends a walk in either direction: the paper's one flag.
    pub const ANY: Self = Self { x: 7, y: 7 };
    /// Only a step in the walk's own direction ends it.
    pub const DIRECTIONAL: Self = Self { x: 1, y: 2 };
}

/// A separable Gaussian's shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// Taps in one direction: odd, 5 to 17.
    pub taps: u32,
    /// Standard deviation in px.
    pub sigma: f32,
    pub stop_bits: StopBits,
}

impl Kernel {
    /// Taps on either side of the middle.
    pub fn radius(self) -> u32 {
        self.taps / 2
    }

    /// Weight of the tap `distance_px` beside the middle, whose weight is 1.
    pub fn weight(self, distance_px: u32) -> f32 {
        ((distance_px * distance_px) as f32 * self.falloff()).exp()
    }

    /// The walk along x, or along y, for walk.glsl.
    pub fn walk(self, horizontal: bool) -> WalkParams {
        let weights = |first: u32| [0, 1, 2, 3].map(|next| self.weight(first + next));
        WalkParams {
            weights_near: weights(1),
            weights_far: weights(5),
            stop_bits: if horizontal { self.stop_bits.x } else { self.stop_bits.y },
            _unused: [0; 3],
        }
    }

    /// -1 / (2 sigma^2), in 1/px^2.
    pub fn falloff(self) -> f32 {
        -0.5 / (self.sigma * self.sigma)
    }
}
