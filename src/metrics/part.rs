//! The errors of a part of a picture's pixels: what happens on edges is lost in the mean of everything.

use super::Comparison;
use crate::report::picture::Picture;
use serde::Serialize;

/// The measures that are means over pixels, of some of them; null and None where there are none of these.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Part {
    pub pixels: usize,
    /// As `Metrics` has them.
    pub rmse: Option<f64>,
    pub relmse: Option<f64>,
    /// Of FLIP's map of the whole picture: what lies around a pixel counts, wherever it belongs.
    pub flip: Option<f64>,
    pub hdr_flip: Option<f64>,
    /// Percent of these pixels.
    pub over_threshold: Option<f64>,
}

impl Part {
    /// The names in the order of `values`.
    pub const NAMES: [&'static str; 5] = ["rmse", "relmse", "flip", "hdr_flip", "over_threshold"];

    /// The measures in the order of `NAMES`.
    pub fn values(&self) -> [Option<f64>; 5] {
        [self.rmse, self.relmse, self.flip, self.hdr_flip, self.over_threshold]
    }
}

impl Comparison {
    /// The errors of the pixels that `chosen` has. `actual`, `reference`: the compared pictures; `threshold`: of
    /// `Part::over_threshold`; `chosen`: a flag for each pixel, row-major.
    pub fn part(&self, actual: &Picture, reference: &Picture, threshold: f64, chosen: &[bool]) -> Part {
        let indices = || chosen.iter().enumerate().filter_map(|(index, is_chosen)| is_chosen.then_some(index));
        let pixels = indices().count();
        let mean = |of: &dyn Fn(usize) -> f64| (pixels > 0).then(|| indices().map(of).sum::<f64>() / pixels as f64);
        let squares = |index: usize, weigh: &dyn Fn(f64) -> f64| {
            let channels = actual.pixels[index].into_iter().zip(reference.pixels[index]);
            channels.map(|(a, b)| (f64::from(a) - f64::from(b)).powi(2) * weigh(f64::from(b))).sum::<f64>() / 3.0
        };
        Part {
            pixels,
            rmse: mean(&|index| squares(index, &|_| 1.0)).map(f64::sqrt),
            relmse: mean(&|index| squares(index, &|b| (b.powi(2) + super::linear::RELMSE_EPSILON).recip())),
            flip: mean(&|index| f64::from(self.flip_map[index])),
            hdr_flip: mean(&|index| f64::from(self.hdr_flip_map[index])),
            over_threshold: mean(&|index| if f64::from(self.hdr_flip_map[index]) > threshold { 100.0 } else { 0.0 }),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::metrics::{Metrics, compare, formula_lights};

    /// All pixels are the whole, and two halves have its mean between them.
    #[test]
    fn parts_add_up_to_the_whole() {
        let [actual, reference] = formula_lights(24, 16);
        let comparison = compare(&actual, &reference, 0.1).unwrap();
        let count = actual.pixels.len();
        let whole = comparison.part(&actual, &reference, 0.1, &vec![true; count]);
        assert_eq!(whole.pixels, count);
        let Metrics { rmse, relmse, flip, hdr_flip, over_threshold, .. } = comparison.metrics;
        for (found, expected) in whole.values().into_iter().zip([rmse, relmse, flip, hdr_flip, over_threshold]) {
            assert!((found.unwrap() - expected).abs() < 1e-6 * expected, "{found:?} for {expected}");
        }
        let chosen: Vec<bool> = (0..count).map(|index| index % 3 == 0).collect();
        let others: Vec<bool> = chosen.iter().map(|is_chosen| !is_chosen).collect();
        let [some, rest] = [chosen, others].map(|chosen| comparison.part(&actual, &reference, 0.1, &chosen));
        assert_eq!([some.pixels, rest.pixels], [128, 256]);
        let squares = (some.rmse.unwrap().powi(2) + 2.0 * rest.rmse.unwrap().powi(2)) / 3.0;
        assert!((squares.sqrt() - rmse).abs() < 1e-9);
        assert!(((some.flip.unwrap() + 2.0 * rest.flip.unwrap()) / 3.0 - flip).abs() < 1e-6);
        let none = comparison.part(&actual, &reference, 0.1, &vec![false; count]);
        assert_eq!((none.pixels, none.values()), (0, [None; 5]));
    }
}
