//! The pattern whose every pixel is a subset of its own: n x m subsets, each of one pixel a period (Segovia 2006,
//! section 1).

use super::{Pattern, Sample};

/// Which of the n * m subsets of `Pattern::grid` a pixel uses: the twin of sampling/pattern.glsl.
///
/// `period_px` = [n, m], each at least 1. Returns 0..n*m, row-major inside the period.
pub fn subset_of(period_px: [u32; 2], pixel_px: [u32; 2]) -> u32 {
    pixel_px[1] % period_px[1] * period_px[0] + pixel_px[0] % period_px[0]
}

/// Columns and rows of `count` cells, as square as the number allows; there are at least as many columns. `count`: at least 1.
pub fn squarest(count: u32) -> [u32; 2] {
    let rows = (1..=count.isqrt()).rev().find(|side| count.is_multiple_of(*side)).unwrap_or(1);
    [count / rows, rows]
}

impl Pattern {
    /// n x m pixels with a sample in the middle of each, which is a subset of its own; subsets count row-major.
    pub fn grid(period_px: [u32; 2]) -> Self {
        let pixels = (0..period_px[1]).flat_map(|y| (0..period_px[0]).map(move |x| [x, y]));
        Self::new(period_px, &[], pixels.map(|pixel| (pixel, Sample::middle(subset_of(period_px, pixel)))).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn each_subset_has_one_pixel_of_a_period(n in 1u32..12, m in 1u32..12) {
            let grid = Pattern::grid([n, m]);
            prop_assert_eq!(grid.subset_count(), n * m);
            for (subset, (pixel, sample)) in (0..).zip(grid.placed()) {
                prop_assert_eq!((sample.subset, pixel), (subset, [subset % n, subset / n]));
                prop_assert_eq!(sample.place_px, [0.5; 2]);
            }
        }

        #[test]
        fn the_formula_is_the_pattern(n in 1u32..12, m in 1u32..12, x in 0u32..99, y in 0u32..99) {
            prop_assert_eq!(Pattern::grid([n, m]).subset_of([x, y]), Some(subset_of([n, m], [x, y])));
        }
    }
}
