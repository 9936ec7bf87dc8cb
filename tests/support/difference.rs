//! How far two pictures are apart, as tests judge it.

use quincunx::gpu::Gpu;
use quincunx::metrics;
use quincunx::picture::Picture;
use quincunx::units::Extent;
use std::fmt::Debug;

/// Greatest difference of two pictures, as a part of the brighter pixel's greatest channel and a hundredth of the
/// picture's.
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

/// Part of the pixels of one picture by two methods that may be more than one 8-bit code apart: where rounding decides
/// on which side of an edge a point lies.
const ROUNDED_PIXELS: f64 = 0.005;
/// Greatest RMSE of the others, as a part of the brightest channel. Ours: with sums fused or last bits moved at random
/// an RMSE of 2.4e-5 was the most that was seen (deferred, `--cull none` beside tiled, lavapipe 22.3.6).
const ROUNDED_RMSE: f64 = 1e-4;

/// Requires one picture of two methods that are different shaders. Software drivers round one source one way, so that
/// theirs has the same bits; others may fuse sums and be a last bit off in each shader for itself, so that theirs is
/// the same within a bound.
///
/// One shader in other bytes, submits or bands is no other method: its bits are the same everywhere.
#[track_caller]
pub fn require_same(gpu: &Gpu, one: &Picture, other: &Picture, what: &dyn Debug) {
    if gpu.caps.identity.is_software() {
        assert_eq!(one.hash().unwrap(), other.hash().unwrap(), "{what:?}");
    } else {
        rounded(one, other).unwrap_or_else(|figures| panic!("{what:?}: {figures}"));
    }
}

/// `require_same` of traced paths. Rounding turns some of them elsewhere, which is noise in their pixels, of which few paths a pixel
/// have much: on devices that round each shader for itself the means are the same within 2 %.
#[track_caller]
pub fn require_same_paths(gpu: &Gpu, one: &Picture, other: &Picture, what: &dyn Debug) {
    if gpu.caps.identity.is_software() {
        return require_same(gpu, one, other, what);
    }
    let [mean, expected] = [one, other].map(|picture| picture.mean().into_iter().sum::<f64>());
    assert!((mean - expected).abs() < 0.02 * expected, "{what:?}: means {mean} and {expected}");
}

/// `require_same` of whole numbers, such as which triangle a sample sees: on devices that round each shader for itself
/// few may be others.
#[track_caller]
pub fn require_same_numbers(gpu: &Gpu, one: &[u32], other: &[u32], what: &dyn Debug) {
    assert_eq!(one.len(), other.len(), "{what:?}");
    let apart = one.iter().zip(other).filter(|(a, b)| a != b).count();
    let most = if gpu.caps.identity.is_software() { 0.0 } else { ROUNDED_PIXELS * other.len() as f64 };
    assert!(apart as f64 <= most, "{what:?}: {apart} of {} are others", other.len());
}

/// Whether two pictures differ by no more than rounding; the figures where they do.
fn rounded(one: &Picture, other: &Picture) -> Result<(), String> {
    assert_eq!(one.extent, other.extent);
    let brightest = f64::from(other.pixels.iter().flatten().fold(0f32, |most, channel| most.max(*channel)));
    let code = |channel: f32| (255.0 * channel.clamp(0.0, 1.0)).round() as i32;
    let is_near =
        |(a, b): &(&[f32; 3], &[f32; 3])| (0..3).all(|channel| (code(a[channel]) - code(b[channel])).abs() <= 1);
    let near: Vec<_> = one.pixels.iter().zip(&other.pixels).filter(is_near).collect();
    let apart_part = 1.0 - near.len() as f64 / other.pixels.len() as f64;
    let squares = near.iter().flat_map(|(a, b)| (0..3).map(|channel| f64::from(a[channel] - b[channel]).powi(2)));
    let rmse = (squares.sum::<f64>() / (3 * near.len().max(1)) as f64).sqrt();
    // Written so that NaN is none of it.
    if rmse <= ROUNDED_RMSE * brightest && apart_part <= ROUNDED_PIXELS {
        return Ok(());
    }
    Err(format!("{:.2} % of the pixels apart, the others' RMSE {rmse:.6} of {brightest:.3}", 100.0 * apart_part))
}

#[test]
fn rounding_is_told_from_another_picture() {
    let flat = |value: f32| Picture::filled(Extent { width: 100, height: 10 }, [value; 3]);
    let plain = flat(0.5);
    assert_eq!(rounded(&flat(0.5 + 1e-6), &plain), Ok(()));
    assert!(rounded(&flat(0.5 + 1e-3), &plain).is_err());
    let mut lost = plain.clone();
    for pixel in &mut lost.pixels[..10] {
        *pixel = [0.49; 3];
    }
    assert!(rounded(&lost, &plain).is_err());
}
