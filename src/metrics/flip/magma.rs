//! The magma colours: dark for 0, pale yellow for 1, evenly apart for the eye and in print.

use crate::picture::tonemap::Srgb8;
use crate::units::Extent;

/// sRGB at sixteenths of the way, between which is interpolated: within 3 codes of matplotlib's table of 256 (van der Walt
/// and Smith 2015, in the public domain).
const MAGMA: [[u8; 3]; 17] = [
    [0, 0, 4],
    [10, 8, 34],
    [29, 17, 71],
    [54, 16, 107],
    [80, 18, 124],
    [105, 28, 129],
    [130, 38, 129],
    [156, 46, 127],
    [182, 54, 122],
    [207, 64, 112],
    [230, 81, 100],
    [244, 106, 92],
    [251, 136, 97],
    [254, 165, 113],
    [254, 194, 135],
    [253, 224, 161],
    [252, 253, 191],
];

/// A map of errors, 0 to 1, in these colours.
pub fn magma(extent: Extent, map: &[f32]) -> Srgb8 {
    let last = MAGMA.len() - 1;
    let color = |error: &f32| {
        let place = error.clamp(0.0, 1.0) * last as f32;
        let step = (place as usize).min(last - 1);
        let (from, to, part) = (MAGMA[step], MAGMA[step + 1], place - step as f32);
        std::array::from_fn(|channel| {
            let (from, to) = (f32::from(from[channel]), f32::from(to[channel]));
            (from + (to - from) * part).round() as u8
        })
    };
    Srgb8 { extent, pixels: map.iter().map(color).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magma_runs_from_black_to_pale_yellow() {
        let colours = magma(Extent::new(4, 1), &[0.0, 0.5, 1.0, 1.01]).pixels;
        assert_eq!(colours[0], [0, 0, 4]);
        assert_eq!(colours[2], [252, 253, 191]);
        assert_eq!(colours[3], colours[2]);
        assert!(colours[1][0] > colours[1][1], "the middle is purple: {:?}", colours[1]);
    }
}
