//! The picture of a pattern: its samples over the pixels of the period.

use crate::picture::tonemap::Srgb8;
use crate::sampling::pattern::Pattern;
use crate::units::Extent;

/// Side that the picture grows to by whole steps, px.
const SIDE_PX: u32 = 1024;
/// Side of a pattern's pixel in the picture at most, px.
const MOST_PIXEL_PX: u32 = 64;
/// From this side on pixels have an edge, and samples are discs, px.
const LEAST_DRAWN_PX: u32 = 8;

const PAPER: [u8; 3] = [255; 3];
const EDGE: [u8; 3] = [208; 3];

/// Colour of a subset: hues turn by the golden ratio, so that neighbours in number differ.
fn color(subset: u32) -> [u8; 3] {
    let hue = (f64::from(subset) * 0.618_033_988_749_895).fract() * 6.0;
    // Dark enough to stand out from the paper: full saturation, value 0.8.
    [5.0, 3.0, 1.0].map(|shift| {
        let at = (shift + hue) % 6.0;
        (204.0 * (1.0 - at.min(4.0 - at).clamp(0.0, 1.0))).round() as u8
    })
}

/// Samples of one period, each in the colour of its subset; pixels have an edge where there is room. `subset`: only its
/// samples.
pub fn samples(pattern: &Pattern, subset: Option<u32>) -> Srgb8 {
    let [width, height] = pattern.period_px();
    let side = (SIDE_PX / width.max(height)).clamp(1, MOST_PIXEL_PX);
    let extent = Extent::new(width * side, height * side);
    let mut pixels = vec![PAPER; extent.pixel_count() as usize];
    if side >= LEAST_DRAWN_PX {
        for (index, pixel) in pixels.iter_mut().enumerate() {
            let [x, y] = [index as u32 % extent.width, index as u32 / extent.width];
            if x.is_multiple_of(side) || y.is_multiple_of(side) {
                *pixel = EDGE;
            }
        }
    }
    let radius = if side >= LEAST_DRAWN_PX { f64::from(side) / 12.0 } else { 0.0 };
    for ([x, y], sample) in pattern.placed().filter(|(_, sample)| subset.is_none_or(|one| one == sample.subset)) {
        let middle = [(x, sample.place_px[0]), (y, sample.place_px[1])]
            .map(|(pixel, place)| (f64::from(pixel) + f64::from(place)) * f64::from(side));
        let around = |middle: f64, size: u32| {
            let first = (middle - radius).floor().max(0.0) as u32;
            first..=((middle + radius).floor() as u32).min(size - 1)
        };
        for row in around(middle[1], extent.height) {
            for column in around(middle[0], extent.width) {
                let away = [(column, middle[0]), (row, middle[1])].map(|(at, middle)| f64::from(at) + 0.5 - middle);
                if radius == 0.0 || away[0].hypot(away[1]) <= radius.max(1.0) {
                    pixels[row as usize * extent.width as usize + column as usize] = color(sample.subset);
                }
            }
        }
    }
    Srgb8 { extent, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_sample_stands_in_its_pixel_in_the_colour_of_its_subset() {
        let grid = Pattern::grid([3, 2]);
        let picture = samples(&grid, None);
        assert_eq!(picture.extent, Extent::new(3 * 64, 2 * 64));
        let at = |x: u32, y: u32| picture.pixels[(y * picture.extent.width + x) as usize];
        for (subset, [x, y]) in (0..).zip([[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]) {
            assert_eq!(at(64 * x + 32, 64 * y + 32), color(subset));
            assert_eq!((at(64 * x, 64 * y + 9), at(64 * x + 9, 64 * y + 9)), (EDGE, PAPER));
        }
        let alone: BTreeSet<[u8; 3]> = samples(&grid, Some(4)).pixels.into_iter().collect();
        assert_eq!(alone, BTreeSet::from([PAPER, EDGE, color(4)]));
        let first: BTreeSet<[u8; 3]> = (0..16).map(color).collect();
        assert_eq!(first.len(), 16);
    }

    #[test]
    fn a_period_as_large_as_a_picture_has_a_point_a_sample() {
        let picture = samples(&Pattern::grid([700, 3]), None);
        assert_eq!(picture.extent, Extent::new(700, 3));
        assert!((0..2100).all(|index| picture.pixels[index as usize] == color(index)));
    }
}
