//! FLIP's filters: the contrast sensitivity of the eye, and what finds edges and points. All are sums of products of
//! one-dimensional kernels, so each runs along rows first and then along columns. The last pixel is repeated past the
//! border.

use crate::units::Extent;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Sensitivity of an opponent channel: a sum of Gaussians, in space a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees
/// (table 1). Luma and red-green have one Gaussian, blue-yellow has two.
const LUMA: (f64, f64) = (1.0, 0.0047);
const RED_GREEN: (f64, f64) = (1.0, 0.0053);
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];
/// The widest Gaussian decides the radius of all of them: three of its standard deviations.
const WIDEST: f64 = 0.04;
/// Width of a feature, in degrees (section 4.2).
const FEATURE_WIDTH_DEGREES: f64 = 0.082;

/// Weights of -r..=r.
type Kernel = Vec<f32>;

/// Values at -radius..=radius, divided by their sum.
fn normalized(radius: i32, value: impl Fn(f64) -> f64) -> Kernel {
    let values: Vec<f64> = (-radius..=radius).map(|x| value(f64::from(x))).collect();
    let sum: f64 = values.iter().sum();
    values.iter().map(|value| (value / sum) as f32).collect()
}

/// Values at -radius..=radius, positive ones divided by their sum, negative ones by the amount of theirs.
fn balanced(radius: i32, value: impl Fn(f64) -> f64) -> Kernel {
    let values: Vec<f64> = (-radius..=radius).map(|x| value(f64::from(x))).collect();
    let positive: f64 = values.iter().filter(|value| **value > 0.0).sum();
    let negative: f64 = -values.iter().filter(|value| **value < 0.0).sum::<f64>();
    values.iter().map(|value| (value / if *value > 0.0 { positive } else { negative }) as f32).collect()
}

/// `N` planes filtered along one axis, each output plane by its kernel from its input plane. All kernels are of one
/// length. `step`: pixels to the next sample, `length` samples along the axis, `place` of a pixel on it.
fn along<const N: usize, const M: usize>(
    extent: Extent,
    horizontal: bool,
    planes: &[[f32; N]],
    kernels: &[(usize, &Kernel); M],
) -> Vec<[f32; M]> {
    let (width, height) = (extent.width as usize, extent.height as usize);
    let radius = kernels[0].1.len() / 2;
    let mut filtered = vec![[0.0; M]; planes.len()];
    filtered.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, pixel) in row.iter_mut().enumerate() {
            let (place, last) = if horizontal { (x, width - 1) } else { (y, height - 1) };
            for tap in 0..=2 * radius {
                let at = (place + tap).saturating_sub(radius).min(last);
                let sample = &planes[if horizontal { y * width + at } else { at * width + x }];
                for (sum, (plane, kernel)) in pixel.iter_mut().zip(kernels) {
                    *sum += kernel[tap] * sample[*plane];
                }
            }
        }
    });
    filtered
}

/// YCxCz as the eye passes it on.
pub fn contrast_sensitive(extent: Extent, opponent: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    let gauss = |b: f64| move |x: f64| (-PI * PI * (x / PIXELS_PER_DEGREE).powi(2) / b).exp();
    let kernels = [LUMA.1, RED_GREEN.1, BLUE_YELLOW[0].1, BLUE_YELLOW[1].1].map(|b| normalized(radius, gauss(b)));
    // What each Gaussian of blue-yellow has of the whole two-dimensional kernel.
    let volumes = BLUE_YELLOW.map(|(a, b)| {
        let sum: f64 = (-radius..=radius).map(|x| gauss(b)(f64::from(x))).sum();
        a * (PI / b).sqrt() * sum * sum
    });
    let share = (volumes[0] / (volumes[0] + volumes[1])) as f32;
    let planes = [0, 1, 2, 2];
    let rows: [(usize, &Kernel); 4] = std::array::from_fn(|index| (planes[index], &kernels[index]));
    let columns: [(usize, &Kernel); 4] = std::array::from_fn(|index| (index, &kernels[index]));
    let filtered = along(extent, false, &along(extent, true, opponent, &rows), &columns);
    filtered.into_iter().map(|[y, cx, wide, narrow]| [y, cx, share * wide + (1.0 - share) * narrow]).collect()
}

/// A Gaussian and its two derivatives, as wide as a feature.
pub struct FeatureKernels {
    gauss: Kernel,
    edge: Kernel,
    point: Kernel,
}

impl FeatureKernels {
    pub fn new() -> Self {
        let sigma = 0.5 * FEATURE_WIDTH_DEGREES * PIXELS_PER_DEGREE;
        let radius = (3.0 * sigma).ceil() as i32;
        let gauss = |x: f64| (-x * x / (2.0 * sigma * sigma)).exp();
        Self {
            gauss: normalized(radius, gauss),
            edge: balanced(radius, |x| -x * gauss(x)),
            point: balanced(radius, |x| (x * x / (sigma * sigma) - 1.0) * gauss(x)),
        }
    }
}

/// Lengths of the first and of the second derivative of luma, taken from 0 to 1: edges and points.
pub fn features(extent: Extent, opponent: &[[f32; 3]], kernels: &FeatureKernels) -> Vec<[f32; 2]> {
    let luma: Vec<[f32; 1]> = opponent.par_iter().map(|pixel| [(pixel[0] + 16.0) / 116.0]).collect();
    let FeatureKernels { gauss, edge, point } = kernels;
    let rows = along(extent, true, &luma, &[(0, gauss), (0, edge), (0, point)]);
    let derivatives = along(extent, false, &rows, &[(1, gauss), (0, edge), (2, gauss), (0, point)]);
    derivatives.into_iter().map(|[dx, dy, dxx, dyy]| [dx.hypot(dy), dxx.hypot(dyy)]).collect()
}

/// Pixels a degree of a 4K screen of 0.7 m width at 0.7 m distance: the authors' own viewing conditions.
pub(super) const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * std::f64::consts::PI / 180.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_picture_passes_and_has_no_features() {
        let extent = Extent::new(7, 5);
        let flat = vec![[60.0, -30.0, 20.0]; 35];
        for pixel in contrast_sensitive(extent, &flat) {
            assert!(pixel.iter().zip([60.0, -30.0, 20.0]).all(|(a, b)| (a - b).abs() < 1e-4), "{pixel:?}");
        }
        for pixel in features(extent, &flat, &FeatureKernels::new()) {
            assert!(pixel[0] < 1e-5 && pixel[1] < 1e-5, "{pixel:?}");
        }
    }

    #[test]
    fn a_step_is_an_edge_of_its_height_in_either_direction() {
        // Halfway on a step from 0 to 1 the positive half of the edge kernel sums to 1; a thin line is a point as well.
        for horizontal in [true, false] {
            let extent = Extent::new(41, 41);
            let step = |index: i32| {
                let place = if horizontal { index % 41 } else { index / 41 };
                [if place > 20 { 100.0 } else { -16.0 }, 0.0, 0.0]
            };
            let picture: Vec<[f32; 3]> = (0..41 * 41).map(step).collect();
            let [edge, _] = features(extent, &picture, &FeatureKernels::new())[20 * 41 + 20];
            assert!((edge - 1.0).abs() < 1e-4, "{edge}");
        }
    }
}
