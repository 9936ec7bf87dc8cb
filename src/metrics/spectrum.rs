//! Which frequencies the error of a picture has: noise is spread over all of them, aliasing stands at some.

use crate::picture::Picture;
use crate::picture::tonemap::{REC709_WEIGHTS, weighted};
use crate::sampling::periodogram::Periodogram;

/// The error of a picture, taken apart by frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorSpectrum {
    /// Mean of the picture minus that of its reference, scene-linear luminance.
    pub mean: f64,
    /// Mean square of the errors without their mean: the sum of the powers at all frequencies but 0 over the pixels.
    pub variance: f64,
    /// Powers of the errors, the mean at frequency 0 included.
    pub periodogram: Periodogram,
}

impl ErrorSpectrum {
    /// The spectrum of actual minus reference in scene-linear luminance. The extents are equal, all values finite.
    pub fn new(actual: &Picture, reference: &Picture) -> Self {
        let luminance = |pixel: &[f32; 3]| weighted(pixel.map(f64::from), REC709_WEIGHTS);
        let pairs = actual.pixels.iter().zip(&reference.pixels);
        let errors: Vec<f64> = pairs.map(|(actual, reference)| luminance(actual) - luminance(reference)).collect();
        let count = errors.len() as f64;
        let mean = errors.iter().sum::<f64>() / count;
        let variance = errors.iter().map(|error| (error - mean).powi(2)).sum::<f64>() / count;
        let size_px = [actual.extent.width, actual.extent.height];
        Self { mean, variance, periodogram: Periodogram::of_raster(&errors, size_px) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::formula_lights;

    /// Powers add up to the error that is measured pixel by pixel, frequency 0 to its mean.
    #[test]
    fn powers_add_up_to_the_mean_square_error() {
        let [actual, reference] = formula_lights(23, 17);
        let found = ErrorSpectrum::new(&actual, &reference);
        let count = 23.0 * 17.0;
        let square = actual.pixels.iter().zip(&reference.pixels).map(|(a, b)| {
            let [r, g, b] = [0, 1, 2].map(|channel| f64::from(a[channel]) - f64::from(b[channel]));
            (0.2126 * r + 0.7152 * g + 0.0722 * b).powi(2)
        });
        let square = square.sum::<f64>() / count;
        let mean_power = found.periodogram.powers().iter().map(|power| f64::from(*power)).sum::<f64>() / count;
        assert!((mean_power - square).abs() < 1e-6 * square, "{mean_power} of {square}");
        assert!((found.variance + found.mean * found.mean - square).abs() < 1e-12 * square);
        let middle = f64::from(found.periodogram.power([0, 0]));
        assert!((middle - count * found.mean * found.mean).abs() < 1e-6 * middle, "{middle}");
    }

    /// Equal pictures have no error at any frequency.
    #[test]
    fn equal_pictures_have_no_power() {
        let [picture, _] = formula_lights(6, 5);
        let same = ErrorSpectrum::new(&picture, &picture);
        assert_eq!((same.mean, same.variance), (0.0, 0.0));
        assert!(same.periodogram.powers().iter().all(|power| *power == 0.0));
    }
}
