//! How far two pictures are apart, as tests judge it.

use quincunx::metrics;
use quincunx::report::picture::Picture;

/// Greatest difference of two pictures, as a part of the brighter pixel's greatest channel and a hundredth of the picture's.
pub fn greatest_part(a: &Picture, b: &Picture) -> f32 {
    let brightest = |pixel: &[f32; 3]| pixel.iter().fold(0f32, |most, channel| most.max(*channel));
    let all = b.pixels.iter().map(brightest).fold(0f32, f32::max);
    let part = |(a, b): (&[f32; 3], &[f32; 3])| {
        let difference = (0..3).map(|channel| (a[channel] - b[channel]).abs()).fold(0f32, f32::max);
        difference / (brightest(a).max(brightest(b)) + 0.01 * all)
    };
    a.pixels.iter().zip(&b.pixels).map(part).fold(0f32, f32::max)
}

/// Root of the mean squared difference of their numbers.
pub fn rmse(a: &Picture, b: &Picture) -> f64 {
    metrics::compare(a, b, metrics::DEFAULT_THRESHOLD).unwrap().metrics.rmse
}
