//! The additive recurrence of the generalised golden ratio: Roberts 2018, "The unreasonable effectiveness of quasirandom
//! sequences"; in two dimensions it is called R2.

use super::over::{Over, PixelGrid, Points, part};
use crate::sampling::pcg::Pcg32;

/// The steps of the recurrence in so many dimensions: 1 / g, 1 / g^2 and so on, g the root above 1 of g^(d + 1) = g + 1.
pub fn steps(dimensions: usize) -> Vec<f64> {
    // Newton's steps from above come down to the root and stop there.
    let mut root = 2.0f64;
    for _ in 0..64 {
        let power = (0..dimensions).fold(1.0, |power, _| power * root);
        let (value, slope) = (power * root - root - 1.0, (dimensions as f64 + 1.0) * power - 1.0);
        root -= value / slope;
    }
    let mut step = 1.0;
    (0..dimensions)
        .map(|_| {
            step /= root;
            step
        })
        .collect()
}

/// Point `index` of the recurrence that begins at `start`.
pub fn point(index: u32, start: &[f64], steps: &[f64]) -> Vec<f64> {
    start.iter().zip(steps).map(|(start, step)| part(start + f64::from(index) * step)).collect()
}

/// The recurrence's points, cell by cell, from a place that the seed names.
pub fn points(over: &Over, grid: &PixelGrid) -> Points {
    let mut random = Pcg32::new(u64::from(over.seed), 1);
    let start: Vec<f64> = (0..over.dimensions).map(|_| f64::from(random.unit())).collect();
    let steps = steps(over.dimensions);
    let mut index = 0;
    grid.points(|_, _| {
        index += 1;
        point(index - 1, &start, &steps)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Roots as the source has them: the golden ratio, the plastic number, 1.2207...
    #[test]
    fn steps_are_powers_of_the_generalised_golden_ratio() {
        for (dimensions, root) in [(1, 1.618_033_988_7), (2, 1.324_717_957_2), (3, 1.220_744_084_6)] {
            let steps = steps(dimensions);
            let mut power = 1.0;
            for step in steps {
                power /= root;
                assert!((step - power).abs() < 1e-9, "{dimensions}: {step} for {power}");
            }
        }
    }
}
