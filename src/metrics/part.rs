//! The errors of a part of a picture's pixels: what happens on edges is lost in the mean of everything.

use super::{Comparison, flip, linear, percent_over};
use crate::picture::Picture;
use crate::units::Extent;
use serde::Serialize;

/// The measures that are means over pixels, of some of them; null and None where there are none of these.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Part {
    pub pixels: usize,
    /// As `Metrics` has them.
    pub rmse: Option<f64>,
    pub relmse: Option<f64>,
    /// Mean over these pixels of FLIP's map of the whole picture: what surrounds a pixel counts, whichever part it is
    /// in.
    pub flip: Option<f64>,
    pub hdr_flip: Option<f64>,
    /// Percent of these pixels.
    pub over_threshold: Option<f64>,
}

impl Part {
    /// The measures by their names, in the order of the fields.
    pub fn means(&self) -> [(&'static str, Option<f64>); 5] {
        [
            ("rmse", self.rmse),
            ("relmse", self.relmse),
            ("flip", self.flip),
            ("hdr_flip", self.hdr_flip),
            ("over_threshold", self.over_threshold),
        ]
    }
}

impl Comparison {
    /// The errors of the pixels that `chosen` has. `actual`, `reference`: the compared pictures; `threshold`: of
    /// `Part::over_threshold`; `chosen`: a flag for each pixel, row-major.
    pub fn part(&self, actual: &Picture, reference: &Picture, threshold: f64, chosen: &[bool]) -> Part {
        let indices: Vec<usize> = (0..chosen.len()).filter(|index| chosen[*index]).collect();
        let pixels = indices.len();
        let picture = |of: &Picture| {
            let pixels = indices.iter().map(|index| of.pixels[*index]).collect();
            Picture { extent: Extent::new(indices.len() as u32, 1), pixels }
        };
        let map = |of: &[f32]| -> Vec<f32> { indices.iter().map(|index| of[*index]).collect() };
        let ([actual, reference], flip_map, hdr_flip_map) =
            ([actual, reference].map(picture), map(&self.flip_map), map(&self.hdr_flip_map));
        // Without pixels there is no mean.
        let mean = |value: f64| (pixels > 0).then_some(value);
        Part {
            pixels,
            rmse: mean(linear::rmse(&actual, &reference)),
            relmse: mean(linear::relmse(&actual, &reference)),
            flip: mean(flip::mean(&flip_map)),
            hdr_flip: mean(flip::mean(&hdr_flip_map)),
            over_threshold: mean(percent_over(&hdr_flip_map, threshold)),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::metrics::{Measure, Metrics, compare, formula_lights};

    /// All pixels are the whole, and two halves have its mean between them.
    #[test]
    fn parts_add_up_to_the_whole() {
        let [actual, reference] = formula_lights(24, 16);
        let comparison = compare(&actual, &reference, 0.1).unwrap();
        let count = actual.pixels.len();
        let whole = comparison.part(&actual, &reference, 0.1, &vec![true; count]);
        assert_eq!(whole.pixels, count);
        for (name, found) in whole.means() {
            let expected = (Measure::named(name).unwrap().value)(&comparison.metrics);
            assert!((found.unwrap() - expected).abs() < 1e-6 * expected, "{name}: {found:?} for {expected}");
        }
        let Metrics { rmse, flip, .. } = comparison.metrics;
        let chosen: Vec<bool> = (0..count).map(|index| index % 3 == 0).collect();
        let others: Vec<bool> = chosen.iter().map(|is_chosen| !is_chosen).collect();
        let [some, rest] = [chosen, others].map(|chosen| comparison.part(&actual, &reference, 0.1, &chosen));
        assert_eq!([some.pixels, rest.pixels], [128, 256]);
        let squares = (some.rmse.unwrap().powi(2) + 2.0 * rest.rmse.unwrap().powi(2)) / 3.0;
        assert!((squares.sqrt() - rmse).abs() < 1e-9);
        assert!(((some.flip.unwrap() + 2.0 * rest.flip.unwrap()) / 3.0 - flip).abs() < 1e-6);
        let none = comparison.part(&actual, &reference, 0.1, &vec![false; count]);
        assert_eq!((none.pixels, none.means().map(|(_, mean)| mean)), (0, [None; 5]));
    }
}
