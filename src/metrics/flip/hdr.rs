//! HDR-FLIP: FLIP at a range of exposures, the worst of them for each pixel (Andersson et al. 2021, "Visualizing Errors in
//! Rendered High Dynamic Range Images"). Nothing that could be seen at any exposure is cut.

use super::linear_map;
use crate::picture::Picture;
use crate::picture::tonemap::{REC709_WEIGHTS, ToneMap, weighted};

/// Scale of light before the tone map's fit, which makes it the fit that the paper uses (Narkowicz 2015).
const ACES_SCALE: f64 = 0.6;
/// The part of white up to which a tone-mapped picture is well exposed (section 3.2).
const WELL_EXPOSED: f64 = 0.85;
/// The least luminance that counts: the gap between 1 and the next 32-bit float, as in the authors' program.
const LEAST_LUMINANCE: f64 = f32::EPSILON as f64;

/// Exposures at which a reference is compared, in stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposures {
    /// The brightest pixel is well exposed: the darkest picture.
    pub start_ev: f64,
    /// The median pixel is.
    pub stop_ev: f64,
    /// At least two: a stop or less apart.
    pub count: usize,
}

impl Exposures {
    /// Exposures for a reference without NaN and infinity.
    pub fn of(reference: &Picture) -> Self {
        let luminance = |pixel: &[f32; 3]| weighted(pixel.map(|channel| f64::from(channel.max(0.0))), REC709_WEIGHTS);
        let mut luminances: Vec<f64> = reference.pixels.iter().map(luminance).collect();
        let greatest = luminances.iter().copied().fold(LEAST_LUMINANCE, f64::max);
        let middle = luminances.len() / 2;
        let median = luminances.select_nth_unstable_by(middle, f64::total_cmp).1.max(LEAST_LUMINANCE);
        let start_ev = (well_exposed() / greatest).log2();
        let stop_ev = (well_exposed() / median).log2();
        Self { start_ev, stop_ev, count: ((stop_ev - start_ev).ceil() as usize).max(2) }
    }

    /// From start to stop, evenly.
    fn iter(self) -> impl Iterator<Item = f64> {
        let step = (self.stop_ev - self.start_ev) / (self.count - 1) as f64;
        (0..self.count).map(move |index| self.start_ev + index as f64 * step)
    }
}

/// The light that the tone map takes to `WELL_EXPOSED`: the root of (2.51 - 2.43 t) x^2 + (0.03 - 0.59 t) x - 0.14 t.
fn well_exposed() -> f64 {
    let (a, b, c) = (2.51 - 2.43 * WELL_EXPOSED, 0.03 - 0.59 * WELL_EXPOSED, -0.14 * WELL_EXPOSED);
    (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a) / ACES_SCALE
}

/// The error of each pixel, row-major, 0 to 1: the greatest over all exposures. The extents are equal; light below 0 is
/// taken as 0.
pub fn map(actual: &Picture, reference: &Picture) -> Vec<f32> {
    let mut greatest = vec![0.0f32; reference.pixels.len()];
    for exposure_ev in Exposures::of(reference).iter() {
        let scale = ACES_SCALE * exposure_ev.exp2();
        let shown = |picture: &Picture| -> Vec<[f32; 3]> {
            let tone_map = |pixel: &[f32; 3]| {
                let exposed = pixel.map(|channel| f64::from(channel.max(0.0)) * scale);
                ToneMap::Aces.apply(exposed).map(|channel| channel as f32)
            };
            picture.pixels.iter().map(tone_map).collect()
        };
        for (most, error) in greatest.iter_mut().zip(linear_map(reference.extent, &shown(actual), &shown(reference))) {
            *most = most.max(error);
        }
    }
    greatest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::flip::mean;
    use crate::metrics::formula_lights;
    use crate::units::Extent;

    #[test]
    fn as_the_authors_program_computes_it() {
        // flip_evaluator.evaluate(reference, actual, "HDR") of the authors' Python package, version 1.7.
        for (extent, mean_expected, max_expected, start_ev, stop_ev, count) in [
            ((24, 16), 0.102_523_88, 0.302_941_32, -3.773_058_7, -1.167_387_8, 3),
            ((11, 11), 0.145_168_80, 0.392_174_4f32, -2.904_928_4, -0.115_849_14, 3),
        ] {
            let [actual, reference] = formula_lights(extent.0, extent.1);
            let exposures = Exposures::of(&reference);
            assert!((exposures.start_ev - start_ev).abs() < 1e-5, "{exposures:?}");
            assert!((exposures.stop_ev - stop_ev).abs() < 1e-5, "{exposures:?}");
            assert_eq!(exposures.count, count);
            let map = map(&actual, &reference);
            assert!((mean(&map) - mean_expected).abs() < 1e-5, "{extent:?}: {}", mean(&map));
            let max = map.iter().copied().fold(0.0, f32::max);
            assert!((max - max_expected).abs() < 1e-5, "{extent:?}: {max}");
        }
    }

    #[test]
    fn exposures_follow_the_light() {
        // 63 pixels of 1 and one of 64: six stops between median and greatest; twice the light is a stop less.
        let mut picture = Picture::filled(Extent::new(8, 8), [1.0; 3]);
        picture.pixels[9] = [64.0; 3];
        let exposures = Exposures::of(&picture);
        assert!((exposures.stop_ev - exposures.start_ev - 6.0).abs() < 1e-6 && exposures.count >= 6, "{exposures:?}");
        assert!((ToneMap::Aces.apply([ACES_SCALE * exposures.stop_ev.exp2(); 3])[0] - 0.85).abs() < 1e-12);
        let twice = picture.pixels.iter().map(|pixel| pixel.map(|channel| 2.0 * channel)).collect();
        let twice = Exposures::of(&Picture { pixels: twice, ..picture });
        assert!((exposures.stop_ev - twice.stop_ev - 1.0).abs() < 1e-6);
        // Darkness has no light to follow, and no error against itself.
        let dark = Picture::filled(Extent::new(8, 8), [0.0; 3]);
        assert_eq!(Exposures::of(&dark).count, 2);
        assert!(map(&dark, &dark).iter().all(|error| *error == 0.0));
    }

    #[test]
    fn it_sees_what_a_screen_cuts() {
        let reference = Picture::filled(Extent::new(16, 16), [4.0; 3]);
        let actual = Picture::filled(Extent::new(16, 16), [2.0; 3]);
        assert!(map(&actual, &reference).iter().all(|error| *error > 0.05));
    }
}
