//! Points in clip space, and on which side of the planes that clip they surely are.

use glam::{DVec2, DVec4};

/// Rounding of a clip-space number that two products with a matrix made in 32 bits, as a part of the sum of its terms'
/// magnitudes: eight roundings of 2^-24 each, doubled.
pub const ROUNDING: f64 = 1.0 / (1 << 20) as f64;

/// A point in clip space and how far rounding may have moved each of its coordinates.
#[derive(Clone, Copy)]
pub struct Clipped {
    pub at: DVec4,
    pub error: DVec4,
    /// How far a picture that is moved moves x and y: all points alike, which turns no triangle round, but for what a lens adds.
    pub reach: DVec2,
}

impl Clipped {
    /// Distances to the six planes that clip, each times something positive; inside is 0 and above.
    pub fn inside(&self) -> [f64; 6] {
        let [x, y, z, w] = self.at.to_array();
        // Depth is reversed: w at the near plane, 0 at the far one, which an infinite one never reaches.
        [w + x, w - x, w + y, w - y, w - z, z]
    }

    /// By how much each of them may be wrong.
    pub fn errors(&self) -> [f64; 6] {
        let [x, y, z, w] = self.error.to_array();
        let [x, y] = [x + self.reach.x, y + self.reach.y];
        [w + x, w + x, w + y, w + y, w + z, z]
    }
}

/// True: for one plane, all points are surely outside of it.
pub fn outside_one_plane(points: &[Clipped]) -> bool {
    (0..6).any(|plane| points.iter().all(|point| point.inside()[plane] < -point.errors()[plane]))
}
