//! Structural similarity (Wang et al. 2004, "Image quality assessment: from error visibility to structural similarity").
//!
//! The paper treats grey pictures: luma here is the Rec.709 mix of the 8-bit sRGB codes, not rounded. Windows that
//! reach past the border are left out, as in the paper's own program and in scikit-image.

use crate::picture::tonemap::{REC709_WEIGHTS, Srgb8, weighted};

/// Side of the window in pixels (section III-C).
const WINDOW_PX: usize = 11;
/// Standard deviation of the window's Gaussian in pixels (section III-C).
const SIGMA_PX: f64 = 1.5;
/// (K1 L)^2 and (K2 L)^2 with K1 = 0.01, K2 = 0.03, L = 255 (equations 7 and 9).
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);

/// The mean of SSIM over all windows inside the picture, -1 to 1. The extents are equal.
///
/// Where a side is shorter than the window, the window is cut to the largest odd length that fits.
pub(super) fn ssim(a: &Srgb8, b: &Srgb8) -> f64 {
    let (a, b) = (Plane::luma(a), Plane::luma(b));
    let mean_a = a.blurred();
    let mean_b = b.blurred();
    let square_a = a.times(&a).blurred();
    let square_b = b.times(&b).blurred();
    let product = a.times(&b).blurred();
    let mut sum = 0.0;
    for index in 0..mean_a.values.len() {
        let (mean_a, mean_b) = (mean_a.values[index], mean_b.values[index]);
        let variance_a = square_a.values[index] - mean_a * mean_a;
        let variance_b = square_b.values[index] - mean_b * mean_b;
        let covariance = product.values[index] - mean_a * mean_b;
        // Equation 13.
        sum += (2.0 * mean_a * mean_b + C1) * (2.0 * covariance + C2)
            / ((mean_a * mean_a + mean_b * mean_b + C1) * (variance_a + variance_b + C2));
    }
    sum / mean_a.values.len() as f64
}

/// One number a pixel, row-major.
struct Plane {
    width: usize,
    height: usize,
    values: Vec<f64>,
}

impl Plane {
    fn luma(codes: &Srgb8) -> Self {
        let values = codes.pixels.iter().map(|pixel| weighted(pixel.map(f64::from), REC709_WEIGHTS)).collect();
        Self { width: codes.extent.width as usize, height: codes.extent.height as usize, values }
    }

    fn times(&self, other: &Self) -> Self {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a * b).collect();
        Self { values, ..*self }
    }

    /// The Gaussian mean of every window inside the plane: smaller by the window's side less one.
    fn blurred(&self) -> Self {
        let (across, down) = (window(self.width), window(self.height));
        let width = self.width + 1 - across.len();
        let height = self.height + 1 - down.len();
        let mut rows = vec![0.0; width * self.height];
        for y in 0..self.height {
            for x in 0..width {
                let under = &self.values[y * self.width + x..];
                rows[y * width + x] = across.iter().zip(under).map(|(weight, value)| weight * value).sum();
            }
        }
        let mut values = vec![0.0; width * height];
        for y in 0..height {
            for (offset, weight) in down.iter().enumerate() {
                let row = &rows[(y + offset) * width..][..width];
                for (value, above) in values[y * width..].iter_mut().zip(row) {
                    *value += weight * above;
                }
            }
        }
        Self { width, height, values }
    }
}

/// The Gaussian's weights along a side of `side_px`; their sum is 1.
fn window(side_px: usize) -> Vec<f64> {
    let largest_odd = if side_px % 2 == 1 { side_px } else { side_px - 1 };
    let length = WINDOW_PX.min(largest_odd);
    let center = (length / 2) as f64;
    let weights: Vec<f64> =
        (0..length).map(|index| (-(index as f64 - center).powi(2) / (2.0 * SIGMA_PX * SIGMA_PX)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::formula_pictures;
    use crate::units::Extent;

    #[test]
    fn as_scikit_image_computes_it() {
        // skimage.metrics.structural_similarity of the luma, version 0.26.0, with gaussian_weights=True, sigma=1.5,
        // use_sample_covariance=False, data_range=255.
        for (extent, expected) in [((24, 16), 0.941_521_235_182_358_6), ((11, 11), 0.866_014_448_556_236_5)] {
            let [a, b] = formula_pictures(extent.0, extent.1);
            assert!((ssim(&a, &b) - expected).abs() < 1e-9, "{extent:?}: {}", ssim(&a, &b));
        }
    }

    #[test]
    fn flat_pictures_by_hand_at_every_size() {
        // Without variance only the luminance term is left: (2 m n + C1) / (m^2 + n^2 + C1).
        let expected = (2.0 * 100.0 * 120.0 + C1) / (100.0 * 100.0 + 120.0 * 120.0 + C1);
        for (width, height) in [(1, 1), (2, 1), (10, 3), (12, 40)] {
            let flat =
                |code| Srgb8 { extent: Extent::new(width, height), pixels: vec![[code; 3]; (width * height) as usize] };
            assert!((ssim(&flat(100), &flat(120)) - expected).abs() < 1e-9, "{width}x{height}");
            assert_eq!(ssim(&flat(100), &flat(100)), 1.0);
        }
    }
}
