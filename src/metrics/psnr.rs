//! Peak signal-to-noise ratio of what a screen shows.

use crate::picture::tonemap::Srgb8;

/// 10 log10(255^2 / mean squared difference of the codes over pixels and channels), in decibels; infinite where the
/// pictures are equal. The extents are equal.
pub(super) fn psnr(a: &Srgb8, b: &Srgb8) -> f64 {
    let squares = a.as_bytes().iter().zip(b.as_bytes()).map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2));
    let sum: u64 = squares.sum();
    if sum == 0 {
        return f64::INFINITY;
    }
    let mean = sum as f64 / a.as_bytes().len() as f64;
    10.0 * (255.0 * 255.0 / mean).log10()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::formula_pictures;
    use crate::units::Extent;

    #[test]
    fn by_hand() {
        let extent = Extent::new(2, 1);
        let black = Srgb8 { extent, pixels: vec![[0; 3]; 2] };
        let white = Srgb8 { extent, pixels: vec![[255; 3]; 2] };
        assert_eq!(psnr(&black, &white), 0.0);
        // A tenth of the range everywhere would be 20 dB; one code of 255 is 48.13 dB.
        let nearly = Srgb8 { extent, pixels: vec![[1; 3]; 2] };
        assert!((psnr(&black, &nearly) - 20.0 * 255f64.log10()).abs() < 1e-12);
        assert_eq!(psnr(&white, &white), f64::INFINITY);
    }

    #[test]
    fn as_scikit_image_computes_it() {
        // skimage.metrics.peak_signal_noise_ratio(a, b, data_range=255), version 0.26.0.
        for (extent, expected) in [((24, 16), 27.980_671_685_391_357), ((11, 11), 27.912_989_609_994_34)] {
            let [a, b] = formula_pictures(extent.0, extent.1);
            assert!((psnr(&a, &b) - expected).abs() < 1e-9, "{extent:?}");
        }
    }
}
