//! FLIP: how different two pictures look when flipped between (Andersson et al. 2020, "FLIP: A difference evaluator for
//! alternating images").
//!
//! Two differences are taken of each pixel and joined: of colour, after both pictures went through the contrast
//! sensitivity of the eye, and of features (edges and points), which are seen finer than colour is.
//!
//! Why this way: the authors' C++ behind a crate took 8-bit codes only. HDR-FLIP needs the same of floats, dozens of
//! times a picture; with separable filters this is fast enough for every report.

mod color;
mod filter;
pub mod hdr;
mod magma;

use crate::picture::tonemap::{Srgb8, linear_from_srgb};
use crate::units::Extent;
use color::{hunt_lab, hyab, linear_rgb, ycxcz};
use filter::{FeatureKernels, contrast_sensitive, features};
use rayon::prelude::*;
use std::sync::LazyLock;

pub(super) use magma::magma;

/// Exponents of the colour and the feature difference (sections 4.1.3 and 4.2).
const COLOR_EXPONENT: f32 = 0.7;
const FEATURE_EXPONENT: f32 = 0.5;
/// Colour differences up to this part of the greatest take up `LOW_SHARE` of the range: large ones are squeezed
/// (section 4.1.3).
const LOW_PART: f32 = 0.4;
const LOW_SHARE: f32 = 0.95;

/// The greatest colour difference, between the sRGB primaries green and blue, to the power of `COLOR_EXPONENT`.
static GREATEST_COLOR: LazyLock<f32> = LazyLock::new(|| {
    let lab = |linear: [f32; 3]| hunt_lab(linear);
    hyab(lab([0.0, 1.0, 0.0]), lab([0.0, 0.0, 1.0])).powf(COLOR_EXPONENT)
});

/// What one picture shows, ready to be compared: a value of each kind a pixel, row-major.
struct Seen {
    /// L*, a*, b* after the eye's contrast sensitivity, a* and b* weighted by L* (the Hunt effect).
    lab: Vec<[f32; 3]>,
    /// Strength of edges and of points.
    features: Vec<[f32; 2]>,
}

impl Seen {
    /// `linear`: Rec.709 light, each channel 0 to 1, row-major.
    fn new(extent: Extent, linear: &[[f32; 3]]) -> Self {
        let opponent: Vec<[f32; 3]> = linear.par_iter().map(|pixel| ycxcz(*pixel)).collect();
        let filtered = contrast_sensitive(extent, &opponent);
        // What the filter brings out of the cube of colours is cut to it.
        let lab = filtered.par_iter().map(|pixel| hunt_lab(linear_rgb(*pixel).map(|channel| channel.clamp(0.0, 1.0))));
        Self { lab: lab.collect(), features: features(extent, &opponent, &FeatureKernels::new()) }
    }
}

/// The error of each pixel, row-major, 0 to 1, of linear light between 0 and 1. Both have the pixels of `extent`.
fn linear_map(extent: Extent, actual: &[[f32; 3]], reference: &[[f32; 3]]) -> Vec<f32> {
    let (actual, reference) = rayon::join(|| Seen::new(extent, actual), || Seen::new(extent, reference));
    let pixel = |index: usize| {
        let color = color_error(actual.lab[index], reference.lab[index]);
        let feature = feature_error(actual.features[index], reference.features[index]);
        // Equation 9: a difference of features strengthens that of colours.
        color.powf(1.0 - feature)
    };
    (0..actual.lab.len()).into_par_iter().map(pixel).collect()
}

/// 0 to 1.
fn color_error(a: [f32; 3], b: [f32; 3]) -> f32 {
    let (greatest, difference) = (*GREATEST_COLOR, hyab(a, b).powf(COLOR_EXPONENT));
    let knee = LOW_PART * greatest;
    if difference < knee {
        LOW_SHARE / knee * difference
    } else {
        // Rounding may pass the greatest by a bit.
        (LOW_SHARE + (difference - knee) / (greatest - knee) * (1.0 - LOW_SHARE)).min(1.0)
    }
}

/// 0 to 1.
fn feature_error(a: [f32; 2], b: [f32; 2]) -> f32 {
    let difference = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    (difference * std::f32::consts::FRAC_1_SQRT_2).powf(FEATURE_EXPONENT).min(1.0)
}

/// The error of each pixel of what a screen shows, row-major, 0 to 1. The extents are equal.
pub(super) fn map(actual: &Srgb8, reference: &Srgb8) -> Vec<f32> {
    let linear: Vec<f32> = (0..=255u8).map(|code| linear_from_srgb(f64::from(code) / 255.0) as f32).collect();
    let decode = |codes: &Srgb8| -> Vec<[f32; 3]> {
        codes.pixels.iter().map(|pixel| pixel.map(|code| linear[usize::from(code)])).collect()
    };
    linear_map(actual.extent, &decode(actual), &decode(reference))
}

/// The mean of a map: the single number that the authors recommend.
pub(super) fn mean(map: &[f32]) -> f64 {
    map.iter().map(|error| f64::from(*error)).sum::<f64>() / map.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::formula_pictures;

    #[test]
    fn as_the_authors_program_computes_it() {
        // flip_evaluator.evaluate(reference, actual, "LDR") of the authors' Python package, version 1.7.
        for (extent, mean_expected, max_expected) in
            [((24, 16), 0.098_461_95, 0.210_362_6), ((11, 11), 0.102_861_31, 0.196_741_13f32)]
        {
            let [actual, reference] = formula_pictures(extent.0, extent.1);
            let map = map(&actual, &reference);
            assert!((mean(&map) - mean_expected).abs() < 1e-5, "{extent:?}: {}", mean(&map));
            let max = map.iter().copied().fold(0.0, f32::max);
            assert!((max - max_expected).abs() < 1e-5, "{extent:?}: {max}");
        }
    }

    #[test]
    fn of_flat_pictures_by_hand() {
        // No filter changes a flat picture and it has no features: the colour difference alone is left.
        let extent = Extent::new(40, 30);
        let flat = |pixel: [u8; 3]| Srgb8 { extent, pixels: vec![pixel; 1200] };
        let error = |a: [u8; 3], b: [u8; 3]| {
            let map = map(&flat(a), &flat(b));
            let first = map[0];
            assert!(map.iter().all(|error| (error - first).abs() < 1e-4), "{a:?} {b:?}");
            first
        };
        // L* of white is 100, of black 0; green and blue are the farthest apart.
        let share = |difference: f32| difference.powf(0.7) / *GREATEST_COLOR;
        let above = |share: f32| 0.95 + (share - 0.4) / 0.6 * 0.05;
        assert!((error([255; 3], [0; 3]) - above(share(100.0))).abs() < 1e-4);
        assert!((error([0, 255, 0], [0, 0, 255]) - 1.0).abs() < 1e-4);
        // Code 119 is Y 0.1845: L* 50.03; code 118 49.64. Below the knee the error is in proportion.
        let lightness = |code: f64| 116.0 * linear_from_srgb(code / 255.0).cbrt() - 16.0;
        let difference = (lightness(119.0) - lightness(118.0)) as f32;
        assert!((error([119; 3], [118; 3]) - share(difference) * 0.95 / 0.4).abs() < 1e-3);
        assert_eq!(error([9, 99, 199], [9, 99, 199]), 0.0);
    }
}
