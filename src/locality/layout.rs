//! Where the texels of an image lie: in rows, in square blocks, or along Morton's curve.

use crate::choice::choices;
use crate::units::Extent;

choices! {
    /// How an image lies in memory. What GPUs call optimal tiling is of the latter two kinds.
    pub enum Layout {
        /// Row by row.
        "linear" => Linear,
        /// In squares of 8 x 8 texels, row by row in each, the squares row by row.
        "blocked" => Blocked,
        /// In squares of 64 x 64 texels, along Morton's curve in each, the squares row by row.
        "morton" => Morton,
    }
}

/// Sides of squares, texels.
const BLOCK: u32 = 8;
const MORTON: u32 = 64;

impl Layout {
    /// Texels that an image takes, with its padding to whole squares.
    pub fn texel_count(self, extent: Extent) -> u64 {
        let side = self.side();
        let [width, height] = [extent.width, extent.height].map(|length| u64::from(length.next_multiple_of(side)));
        width * height
    }

    fn side(self) -> u32 {
        match self {
            Self::Linear => 1,
            Self::Blocked => BLOCK,
            Self::Morton => MORTON,
        }
    }

    /// Number of a texel among all.
    pub fn index(self, extent: Extent, [x, y]: [u32; 2]) -> u64 {
        let side = self.side();
        let across = u64::from(extent.width.div_ceil(side));
        let square = u64::from(y / side) * across + u64::from(x / side);
        let [x, y] = [x % side, y % side];
        let inside = match self {
            Self::Linear => 0,
            Self::Blocked => u64::from(y * side + x),
            Self::Morton => interleaved(x) | interleaved(y) << 1,
        };
        square * u64::from(side) * u64::from(side) + inside
    }
}

/// The bits of a number, each followed by a zero.
fn interleaved(number: u32) -> u64 {
    (0..32).map(|bit| u64::from(number >> bit & 1) << (2 * bit)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_texel_has_a_place_of_its_own() {
        for extent in [Extent::new(1, 1), Extent::new(70, 33), Extent::new(128, 64)] {
            for layout in [Layout::Linear, Layout::Blocked, Layout::Morton] {
                let all = (0..extent.height).flat_map(|y| (0..extent.width).map(move |x| [x, y]));
                let places: HashSet<u64> = all.map(|at| layout.index(extent, at)).collect();
                assert_eq!(places.len() as u64, extent.pixel_count());
                assert!(places.iter().all(|place| *place < layout.texel_count(extent)), "{layout:?} {extent}");
            }
        }
    }

    #[test]
    fn places_are_those_counted_on_paper() {
        let extent = Extent::new(128, 128);
        assert_eq!(Layout::Linear.index(extent, [3, 2]), 2 * 128 + 3);
        // The second square of the second row of squares, its third texel of the second row.
        assert_eq!(Layout::Blocked.index(extent, [8 + 2, 8 + 1]), (16 + 1) * 64 + 8 + 2);
        // 5 = 101 and 3 = 011: y before x, 01 10 11 read from y.
        assert_eq!(Layout::Morton.index(extent, [5, 3]), 0b011011);
        assert_eq!(Layout::Morton.index(extent, [64, 0]), 64 * 64);
    }
}
