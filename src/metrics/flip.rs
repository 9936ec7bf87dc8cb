//! FLIP: how different two pictures look when flipped between (Andersson et al. 2020), as its authors compute it.

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageFloat, FlipImageRgb8};

use crate::report::tonemap::Srgb8;
use crate::units::Extent;

/// The error of each pixel, row-major, 0 to 1, at 67 pixels a degree. The extents are equal.
pub(super) fn map(actual: &Srgb8, reference: &Srgb8) -> Vec<f32> {
    let image = |codes: &Srgb8| FlipImageRgb8::with_data(codes.extent.width, codes.extent.height, codes.as_bytes());
    nv_flip::flip(image(reference), image(actual), DEFAULT_PIXELS_PER_DEGREE).to_vec()
}

/// The mean of a map: the one number that the authors advise.
pub(super) fn mean(map: &[f32]) -> f64 {
    map.iter().map(|error| f64::from(*error)).sum::<f64>() / map.len() as f64
}

/// A map in the magma colours, dark for 0.
pub(super) fn magma(extent: Extent, map: &[f32]) -> Srgb8 {
    // The colour table wraps around: a rounding above 1 would come out black.
    let cut: Vec<f32> = map.iter().map(|error| error.clamp(0.0, 1.0)).collect();
    let coloured =
        FlipImageFloat::with_data(extent.width, extent.height, &cut).apply_color_lut(&nv_flip::magma_lut()).to_vec();
    Srgb8 { extent, pixels: coloured.as_chunks().0.to_vec() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::formula_pictures;

    #[test]
    fn as_the_authors_program_computes_it() {
        // flip_evaluator.evaluate(reference, actual, "LDR") of the authors' Python package, version 1.7, with ppd 67.
        for (extent, mean_expected, max_expected) in
            [((24, 16), 0.098_468_52, 0.210_401_61), ((11, 11), 0.102_865_346, 0.196_781_44f32)]
        {
            let [actual, reference] = formula_pictures(extent.0, extent.1);
            let map = map(&actual, &reference);
            assert!((mean(&map) - mean_expected).abs() < 1e-5, "{extent:?}: {}", mean(&map));
            let max = map.iter().copied().fold(0.0, f32::max);
            assert!((max - max_expected).abs() < 1e-5, "{extent:?}: {max}");
        }
    }

    #[test]
    fn magma_runs_from_black_to_pale_yellow() {
        let colours = magma(Extent::new(4, 1), &[0.0, 0.5, 1.0, 1.01]).pixels;
        assert_eq!(colours[0], [0, 0, 4]);
        assert_eq!(colours[2], [252, 253, 191]);
        assert_eq!(colours[3], colours[2]);
        assert!(colours[1][0] > colours[1][1], "the middle is purple: {:?}", colours[1]);
    }
}
