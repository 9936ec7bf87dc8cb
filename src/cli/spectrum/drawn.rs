//! The picture of a periodogram: powers as grey.

use crate::picture::tonemap::Srgb8;
use crate::sampling::periodogram::Periodogram;
use crate::units::Extent;

/// Side that a picture grows to by whole steps, px.
const SIDE_PX: u32 = 512;

/// Powers as grey, frequency 0 in the middle: 0 is black, `grey_power` half way, and what is far above it white. With a
/// `grey_power` of 0 every power but 0 is white.
pub fn powers(of: &Periodogram, grey_power: f64) -> Srgb8 {
    let [width, height] = of.size();
    let side = (SIDE_PX / width.max(height)).max(1);
    let extent = Extent::new(width * side, height * side);
    let grey = |power: f32| {
        let power = f64::from(power);
        let level = if power > 0.0 { power / (power + grey_power) } else { 0.0 };
        [(255.0 * level).round() as u8; 3]
    };
    let row = |powers: &[f32]| -> Vec<[u8; 3]> {
        powers.iter().flat_map(|power| std::iter::repeat_n(grey(*power), side as usize)).collect()
    };
    let rows = of.powers().chunks(width as usize).map(row);
    Srgb8 { extent, pixels: rows.flat_map(|row| std::iter::repeat_n(row, side as usize)).flatten().collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pattern::Pattern;

    #[test]
    fn powers_are_grey() {
        let grid = Pattern::grid([2, 2]);
        let picture = powers(&Periodogram::new(&grid, [2, 2], |_| true), 1.0);
        // Five frequencies a side, 102 px each.
        assert_eq!(picture.extent, Extent::new(510, 510));
        let at = |u: u32, v: u32| picture.pixels[((102 * v + 51) * 510 + 102 * u + 51) as usize];
        assert_eq!((at(2, 2), at(0, 4), at(1, 2), at(3, 0)), ([204; 3], [204; 3], [0; 3], [0; 3]));
    }

    #[test]
    fn the_grey_power_is_half_way_and_nothing_is_black() {
        // One value of 12 in a row of four has the power 36 everywhere; none has none.
        let impulse = Periodogram::of_raster(&[12.0, 0.0, 0.0, 0.0], [4, 1]);
        let picture = powers(&impulse, 36.0);
        assert_eq!(picture.extent, Extent::new(512, 128));
        assert!(picture.pixels.iter().all(|pixel| *pixel == [128; 3]));
        let nothing = powers(&Periodogram::of_raster(&[0.0; 600], [600, 1]), 0.0);
        assert_eq!((nothing.extent, nothing.pixels[300]), (Extent::new(600, 1), [0; 3]));
    }
}
