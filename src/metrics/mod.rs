//! How far a picture is from its reference, in seven numbers.
//!
//! Four are of light (RMSE, relMSE, HDR-FLIP and the pixels over a threshold of it: scene-linear RGB), three of what a
//! screen shows (PSNR, SSIM, FLIP: 8-bit sRGB at exposure 0, cut at 1), because a bound on an algorithm needs the first and
//! a claim about looks the second. How far pictures of a sequence are from each other is `flicker`; which frequencies an
//! error has is `spectrum`.

mod flicker;
mod flip;
pub mod gate;
mod linear;
mod measure;
pub mod noise;
mod part;
mod psnr;
mod spectrum;
mod ssim;

pub use flicker::{ErrorFlickerMeter, FlickerMeter};
pub use measure::{Measure, Metrics};
pub use part::Part;
pub use spectrum::ErrorSpectrum;

use crate::error::{Error, Result};
use crate::picture::Picture;
use crate::picture::tonemap::{Srgb8, ToneMap};
use crate::units::Extent;

/// HDR-FLIP above which a pixel counts, where nothing else is asked for: ours, no published number. Two flat
/// greys, 8-bit codes 118 and 124, are as far apart.
pub const DEFAULT_THRESHOLD: f64 = 0.1;

/// What a comparison leaves: the numbers, and where the difference is.
#[derive(Clone, Debug)]
pub struct Comparison {
    pub extent: Extent,
    pub metrics: Metrics,
    /// FLIP's error of each pixel, row-major, 0 to 1.
    flip_map: Vec<f32>,
    /// HDR-FLIP's.
    hdr_flip_map: Vec<f32>,
}

impl Comparison {
    /// FLIP's map in the magma colours: black where nothing is seen, pale yellow where the error is 1.
    pub fn error_picture(&self) -> Srgb8 {
        flip::magma(self.extent, &self.flip_map)
    }

    /// HDR-FLIP's map in the same colours.
    pub fn hdr_error_picture(&self) -> Srgb8 {
        flip::magma(self.extent, &self.hdr_flip_map)
    }
}

/// Compares a picture with its reference. `threshold`: of `Metrics::over_threshold`, an HDR-FLIP of 0 to 1.
///
/// Fails as a bad request where the extents differ, as a gate where either holds NaN or infinity (with their count and the
/// first pixel of each).
pub fn compare(actual: &Picture, reference: &Picture, threshold: f64) -> Result<Comparison> {
    if actual.extent != reference.extent {
        return Err(Error::request(format!(
            "the picture is {}, the reference {}: only pictures of one size compare",
            actual.extent, reference.extent
        )));
    }
    let broken = [broken_pixels(actual, "the picture"), broken_pixels(reference, "the reference")];
    let broken: Vec<String> = broken.into_iter().flatten().collect();
    if !broken.is_empty() {
        return Err(Error::gate(broken.join("; ")));
    }
    let actual_codes = Srgb8::from_picture(actual, 0.0, ToneMap::Clip);
    let reference_codes = Srgb8::from_picture(reference, 0.0, ToneMap::Clip);
    let flip_map = flip::map(&actual_codes, &reference_codes);
    let hdr_flip_map = flip::hdr::map(actual, reference);
    let metrics = Metrics {
        rmse: linear::rmse(actual, reference),
        relmse: linear::relmse(actual, reference),
        psnr: psnr::psnr(&actual_codes, &reference_codes),
        ssim: ssim::ssim(&actual_codes, &reference_codes),
        flip: flip::mean(&flip_map),
        hdr_flip: flip::mean(&hdr_flip_map),
        over_threshold: percent_over(&hdr_flip_map, threshold),
    };
    Ok(Comparison { extent: actual.extent, metrics, flip_map, hdr_flip_map })
}

/// Percent of the errors of `map` that are greater than `threshold`.
fn percent_over(map: &[f32], threshold: f64) -> f64 {
    let over = map.iter().filter(|error| f64::from(**error) > threshold).count();
    100.0 * over as f64 / map.len() as f64
}

/// How many pixels hold NaN or infinity, and which is the first; None where all are finite.
fn broken_pixels(picture: &Picture, name: &str) -> Option<String> {
    let broken = |pixel: &[f32; 3]| pixel.iter().any(|channel| !channel.is_finite());
    let first = picture.pixels.iter().position(broken)?;
    let count = picture.pixels.iter().filter(|pixel| broken(pixel)).count();
    let width = picture.extent.width as usize;
    let (x, y) = (first % width, first / width);
    let [red, green, blue] = picture.pixels[first];
    Some(format!(
        "{name} holds NaN or infinity in {count} of {} pixels, first at ({x}, {y}): {red} {green} {blue}",
        picture.pixels.len()
    ))
}

/// The pictures on which the metrics are held against other programs; 8-bit formulas, so that both sides compute them.
#[cfg(test)]
fn formula_pictures(width: u32, height: u32) -> [Srgb8; 2] {
    let extent = Extent::new(width, height);
    let mut actual = Srgb8 { extent, pixels: Vec::new() };
    let mut reference = Srgb8 { extent, pixels: Vec::new() };
    for y in 0..height as i32 {
        for x in 0..width as i32 {
            let codes = [(10 * x + 3 * y) % 256, (x * x + 5 * y) % 256, (7 * x * y) % 256];
            let difference = ((x + 2 * y) % 7) * 5 - 12;
            actual.pixels.push(codes.map(|code| code as u8));
            reference.pixels.push(codes.map(|code| (code + difference).clamp(0, 255) as u8));
        }
    }
    [actual, reference]
}

/// The same with light up to 16: what of it is brighter goes in columns.
#[cfg(test)]
fn formula_lights(width: u32, height: u32) -> [Picture; 2] {
    formula_pictures(width, height).map(|codes| {
        let light = |(index, pixel): (usize, &[u8; 3])| {
            let scale = [0.5, 1.0, 2.0, 4.0][index % width as usize % 4];
            pixel.map(|code| f32::from(code) / 32.0 * scale)
        };
        Picture { extent: codes.extent, pixels: codes.pixels.iter().enumerate().map(light).collect() }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_have_no_error() {
        let [picture, _] = formula_pictures(24, 16);
        let comparison = compare(&picture.to_picture(), &picture.to_picture(), DEFAULT_THRESHOLD).unwrap();
        assert_eq!(comparison.metrics, Metrics::EQUAL);
        assert_eq!(
            serde_json::to_string(&comparison.metrics).unwrap(),
            r#"{"rmse":0.0,"relmse":0.0,"psnr":null,"ssim":1.0,"flip":0.0,"hdr_flip":0.0,"over_threshold":0.0}"#
        );
        assert!(comparison.error_picture().pixels.iter().all(|pixel| *pixel == comparison.error_picture().pixels[0]));
    }

    #[test]
    fn all_but_relmse_and_the_exposures_are_symmetric() {
        let [a, b] = formula_pictures(24, 16).map(|codes| codes.to_picture());
        let forth = compare(&a, &b, 0.1).unwrap().metrics;
        let back = compare(&b, &a, 0.1).unwrap().metrics;
        assert_eq!(forth.rmse, back.rmse);
        assert_eq!(forth.psnr, back.psnr);
        assert!((forth.ssim - back.ssim).abs() < 1e-12);
        assert!((forth.flip - back.flip).abs() < 1e-6);
        assert_ne!(forth.relmse, back.relmse);
    }

    #[test]
    fn measures_are_the_keys_of_the_json_in_their_order() {
        let metrics =
            Metrics { rmse: 1.0, relmse: 2.0, psnr: 3.0, ssim: 4.0, flip: 5.0, hdr_flip: 6.0, over_threshold: 7.0 };
        let json = serde_json::to_value(metrics).unwrap();
        let keys: Vec<&String> = json.as_object().unwrap().keys().collect();
        assert_eq!(keys, Metrics::NAMES);
        for (measure, value) in metrics.each() {
            assert_eq!(json[measure.name], value);
            assert_eq!(Measure::named(measure.name).unwrap().title, measure.title);
        }
        assert!(Measure::named("mse").is_none());
    }

    #[test]
    fn a_document_of_before_a_measure_is_read_and_written_without_it() {
        let [a, b] = formula_pictures(24, 16).map(|codes| codes.to_picture());
        let whole = serde_json::to_value(compare(&a, &b, 0.1).unwrap().metrics).unwrap();
        for later in Metrics::MEASURES {
            let mut of_before = whole.clone();
            of_before.as_object_mut().unwrap().remove(later.name).unwrap();
            let read: Metrics = serde_json::from_value(of_before.clone()).unwrap();
            assert!((later.value)(&read).is_nan());
            assert_eq!(read, read.clone());
            assert_eq!(serde_json::to_value(read).unwrap(), of_before);
            assert_ne!(read, serde_json::from_value(whole.clone()).unwrap());
        }
    }

    #[test]
    fn other_sizes_and_broken_pixels_are_refused() {
        let picture = Picture::filled(Extent::new(3, 2), [0.5; 3]);
        let error = compare(&picture, &Picture::filled(Extent::new(2, 3), [0.5; 3]), 0.1).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.message().contains("3x2") && error.message().contains("2x3"), "{error}");

        let mut broken = picture.clone();
        broken.pixels[4][1] = f32::NAN;
        broken.pixels[5] = [f32::INFINITY; 3];
        for (actual, reference, name) in [(&broken, &picture, "the picture"), (&picture, &broken, "the reference")] {
            let error = compare(actual, reference, 0.1).unwrap_err();
            assert_eq!(error.exit_code(), 1);
            let expected = format!("{name} holds NaN or infinity in 2 of 6 pixels, first at (1, 1): 0.5 NaN 0.5");
            assert_eq!(error.message(), expected);
        }
        let mut other = picture.clone();
        other.pixels[3] = [f32::NEG_INFINITY, 0.0, 0.0];
        let both = compare(&broken, &other, 0.1).unwrap_err();
        assert_eq!(
            both.message(),
            "the picture holds NaN or infinity in 2 of 6 pixels, first at (1, 1): 0.5 NaN 0.5; the reference holds NaN or \
             infinity in 1 of 6 pixels, first at (0, 1): -inf 0 0"
        );
    }

    #[test]
    fn pixels_over_a_threshold_are_counted_in_percent() {
        assert_eq!(percent_over(&[0.0, 0.1, 0.25, 0.5], 0.25), 25.0);
        assert_eq!(percent_over(&[0.0, 0.1, 0.25, 0.5], 0.0), 75.0);
        // The authors' HDR-FLIP map of these pictures (flip_evaluator 1.7) has 145 of 384 pixels above 0.1, 3 above
        // 0.3.
        let [actual, reference] = formula_lights(24, 16);
        for (threshold, count) in [(0.1, 145.0), (0.3, 3.0)] {
            let metrics = compare(&actual, &reference, threshold).unwrap().metrics;
            assert_eq!(metrics.over_threshold, 100.0 * count / 384.0);
        }
    }
}
