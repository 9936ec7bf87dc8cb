//! How far a picture is from its twin, and whether that is too far.
//!
//! Why these figures: a compiler that rounds otherwise changes every pixel by nothing that is seen and a few along
//! edges by all that surfaces differ; so pixels that are apart are counted. Light that is missing everywhere moves the
//! mean, and little else.

use crate::error::Result;
use crate::metrics;
use crate::picture::Picture;
use serde::Serialize;

/// Two pixels are apart where a channel differs by more than this, radiance, and by more than `APART_PART` of the
/// brighter one.
const APART: f32 = 0.01;
const APART_PART: f32 = 0.02;

/// The most that two pictures may be off by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bounds {
    /// Part of the pixels that are apart, 0 to 1.
    pub apart: f64,
    pub rmse: f64,
    /// Mean FLIP error.
    pub flip: f64,
    /// Difference of the pictures' means, as a part of the reference's.
    pub mean: f64,
    /// Where the numbers come from.
    pub why: &'static str,
}

/// What was found of two pictures.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Figures {
    pub is_equal: bool,
    /// Pixels that differ in any bit.
    pub differing_pixels: u64,
    pub pixels: u64,
    /// As `Bounds` has it.
    pub apart: f64,
    pub rmse: f64,
    pub flip: f64,
    pub mean: f64,
    /// Greatest difference of a channel.
    pub most: f32,
}

impl Figures {
    /// Errors: the pictures are not of one size (exit code 2), or hold NaN or infinity (1).
    pub fn of(picture: &Picture, reference: &Picture) -> Result<Self> {
        let found = metrics::compare(picture, reference, metrics::DEFAULT_THRESHOLD)?.metrics;
        let pairs = || picture.pixels.iter().zip(&reference.pixels);
        // -0 and 0 are one number, as in hashes.
        let differing = pairs().filter(|(a, b)| a != b).count();
        let apart = pairs().filter(|(a, b)| (0..3).any(|channel| is_apart(a[channel], b[channel]))).count();
        let most = pairs().flat_map(|(a, b)| [0, 1, 2].map(|channel| (a[channel] - b[channel]).abs()));
        let (mean, expected) = (picture.mean(), reference.mean());
        let off = (0..3).map(|channel| (mean[channel] - expected[channel]).abs()).fold(0.0, f64::max);
        let count = picture.pixels.len();
        Ok(Self {
            is_equal: differing == 0,
            differing_pixels: differing as u64,
            pixels: count as u64,
            apart: apart as f64 / count as f64,
            rmse: found.rmse,
            flip: found.flip,
            mean: if off > 0.0 { off / expected.into_iter().fold(0.0, f64::max).max(1e-6) } else { 0.0 },
            most: most.fold(0.0, f32::max),
        })
    }

    /// What of `must` does not hold, in words; nothing where all does.
    pub fn complaints(&self, must: &Must, is_software: bool) -> Vec<String> {
        if must.is_exact(is_software) {
            let Self { differing_pixels, pixels, most, .. } = self;
            let differs = format!("{differing_pixels} of {pixels} pixels differ, by {most} at most, and no bit may");
            return if self.is_equal { Vec::new() } else { vec![differs] };
        }
        let Some(bounds) = must.bounds(is_software) else { return Vec::new() };
        let held = [
            ("pixels apart", self.apart, bounds.apart),
            ("RMSE", self.rmse, bounds.rmse),
            ("FLIP", self.flip, bounds.flip),
            ("means", self.mean, bounds.mean),
        ];
        let broken = held.into_iter().filter(|(_, found, most)| found > most);
        broken.map(|(name, found, most)| format!("{name}: {found:.6}, at most {most} may be")).collect()
    }
}

fn is_apart(a: f32, b: f32) -> bool {
    (a - b).abs() > APART.max(APART_PART * a.max(b))
}

/// What must hold between a method's picture and its twin's.
#[derive(Clone, Copy, Debug)]
pub enum Must {
    /// Equal bits on every device: the same shaders on the same numbers.
    Same { why: &'static str },
    /// Equal bits on software drivers; within bounds on devices whose compilers may round two shaders otherwise.
    Equal(Bounds),
    /// Within bounds on every device: two ways to nearly the same picture.
    Near(Bounds),
    /// Some samples have no colour, which shows that their counter counts.
    LackSamples,
}

impl Must {
    /// What a picture may be off by; None: equal bits are asked for, or nothing of the picture.
    pub fn bounds(&self, is_software: bool) -> Option<Bounds> {
        match self {
            Self::Equal(bounds) if !is_software => Some(*bounds),
            Self::Near(bounds) => Some(*bounds),
            _ => None,
        }
    }

    /// Whether equal bits are asked for.
    pub fn is_exact(&self, is_software: bool) -> bool {
        matches!(self, Self::Same { .. }) || (matches!(self, Self::Equal(_)) && is_software)
    }

    /// Why it is this that must hold.
    pub fn why(&self) -> &'static str {
        match self {
            Self::Same { why } => why,
            Self::Equal(bounds) | Self::Near(bounds) => bounds.why,
            Self::LackSamples => {
                "pixels at rims whose middle no triangle covers are not shaded: what counts them must see some"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::selftest::cases::bounds::{PATHS, ROUNDING};
    use crate::units::Extent;

    /// What becomes of a pixel, by its index.
    type Change<'a> = &'a dyn Fn(usize, [f32; 3]) -> [f32; 3];

    const EXTENT: Extent = Extent { width: 61, height: 37 };

    /// A slope with some structure, about as bright as the cases' pictures.
    fn picture() -> Picture {
        let pixel = |index: u32| {
            let [x, y] = [index % EXTENT.width, index / EXTENT.width].map(|at| at as f32);
            [0.1 + x / 100.0, 0.05 + y / 50.0, if (x as u32 / 7 + y as u32 / 5).is_multiple_of(2) { 0.4 } else { 0.1 }]
        };
        Picture { extent: EXTENT, pixels: (0..EXTENT.width * EXTENT.height).map(pixel).collect() }
    }

    fn complaints(change: impl Fn(usize, [f32; 3]) -> [f32; 3], must: Must, is_software: bool) -> Vec<String> {
        let reference = picture();
        let pixels = reference.pixels.iter().enumerate().map(|(index, pixel)| change(index, *pixel)).collect();
        let changed = Picture { extent: EXTENT, pixels };
        Figures::of(&changed, &reference).unwrap().complaints(&must, is_software)
    }

    #[test]
    fn rounding_is_let_through_where_bounds_hold_and_nowhere_else() {
        let rounded = |_: usize, pixel: [f32; 3]| pixel.map(|channel| channel * (1.0 + 2e-7));
        assert_eq!(complaints(rounded, Must::Equal(ROUNDING), false), [] as [&str; 0]);
        assert_eq!(complaints(rounded, Must::Near(ROUNDING), true), [] as [&str; 0]);
        for (must, is_software) in
            [(Must::Equal(ROUNDING), true), (Must::Same { why: "" }, true), (Must::Same { why: "" }, false)]
        {
            assert_eq!(complaints(rounded, must, is_software).len(), 1);
            assert_eq!(complaints(|_, pixel| pixel, must, is_software), [] as [&str; 0]);
        }
        // A minus sign of nothing is no difference.
        let zero = |index, pixel: [f32; 3]| if index == 5 { [-0.0, 0.0, 0.0] } else { pixel };
        let mut reference = picture();
        reference.pixels[5] = [0.0; 3];
        let pixels = reference.pixels.iter().enumerate().map(|(index, pixel)| zero(index, *pixel)).collect();
        assert!(Figures::of(&Picture { extent: EXTENT, pixels }, &reference).unwrap().is_equal);
    }

    /// What a driver's mistakes look like: the bounds for a GPU must detect each.
    #[test]
    fn wrong_pictures_are_found_by_the_bounds_of_other_devices() {
        let width = EXTENT.width as usize;
        let reference = picture();
        let moved = |index: usize, _: [f32; 3]| reference.pixels[index.saturating_sub(1)];
        let wrong: [(&str, Change<'_>); 7] = [
            ("a black row", &|index, pixel| if index / width == 20 { [0.0; 3] } else { pixel }),
            ("a black tile", &|index, pixel| if index % width < 8 && index / width < 8 { [0.0; 3] } else { pixel }),
            ("a pixel aside", &moved),
            ("a hundredth of the light lost", &|_, pixel| pixel.map(|channel| 0.99 * channel)),
            ("a two-hundredth of the light lost", &|_, pixel| pixel.map(|channel| 0.995 * channel)),
            ("red and blue exchanged", &|_, [red, green, blue]| [blue, green, red]),
            (
                "one in a pattern of 16 without its subset",
                &|index, pixel| match index % width % 4 + index / width % 4 {
                    0 => pixel.map(|channel| 0.8 * channel),
                    _ => pixel,
                },
            ),
        ];
        for (name, change) in wrong {
            let found = complaints(change, Must::Equal(ROUNDING), false);
            println!("{name}: {found:?}");
            assert!(!found.is_empty(), "{name}");
        }
        // Paths that an edge sends elsewhere cost more; a tile, and a tenth of the light, are found all the same.
        let darker = |_: usize, pixel: [f32; 3]| pixel.map(|channel| 0.9 * channel);
        assert!(!complaints(darker, Must::Equal(PATHS), false).is_empty());
        assert!(!complaints(wrong[1].1, Must::Equal(PATHS), false).is_empty());
    }
}
