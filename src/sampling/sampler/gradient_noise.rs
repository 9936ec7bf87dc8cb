//! One sequence for all pixels, turned by interleaved gradient noise: Jimenez 2014, "Next Generation Post Processing in
//! Call of Duty: Advanced Warfare", whose formula gives any 3 x 3 pixels values that are well spread.

use super::over::{Over, PixelGrid, Points, part};
use super::recurrence;
use crate::sampling::pcg::Pcg32;

/// The noise at a place, px: 0 to 1 without 1. Its constants are the talk's.
fn noise([x, y]: [f64; 2]) -> f64 {
    part(52.982_918_9 * part(0.067_110_56 * x + 0.005_837_15 * y))
}

/// R2's points in each pixel, turned in each dimension by noise that is taken elsewhere.
pub fn points(over: &Over, grid: &PixelGrid) -> Points {
    let mut random = Pcg32::new(u64::from(over.seed), 3);
    let places: Vec<[f64; 2]> =
        (0..over.dimensions).map(|_| [0, 1].map(|_| f64::from(random.below(1 << 12)))).collect();
    let steps = recurrence::steps(over.dimensions);
    grid.points(|[x, y], sample| {
        let turned: Vec<f64> =
            places.iter().map(|place| noise([place[0] + f64::from(x), place[1] + f64::from(y)])).collect();
        recurrence::point(sample, &turned, &steps)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the talk shows: the nine values of any 3 x 3 pixels lie about a ninth apart.
    #[test]
    fn nine_pixels_have_nine_values() {
        for corner in [[0.0, 0.0], [17.0, 5.0], [100.0, 63.0]] {
            let mut values: Vec<f64> = (0..9)
                .map(|index| noise([corner[0] + f64::from(index % 3), corner[1] + f64::from(index / 3)]))
                .collect();
            values.sort_by(f64::total_cmp);
            let gaps = (0..9).map(|i| if i < 8 { values[i + 1] - values[i] } else { values[0] + 1.0 - values[8] });
            assert!(gaps.clone().fold(0.0, f64::max) < 0.25, "{values:?}");
        }
    }
}
