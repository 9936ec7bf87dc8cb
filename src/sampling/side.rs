//! Lengths in pixels that need not be whole, as exact fractions.

/// A side of a basis: `bases` of them lie along `pixels` whole pixels; the fraction is in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    pub pixels: u32,
    pub bases: u32,
}

impl Side {
    /// `pixels / bases`, both at least 1.
    pub fn new(pixels: u32, bases: u32) -> Self {
        assert!(pixels > 0 && bases > 0, "{pixels} px of {bases} bases");
        let divisor = greatest_common_divisor(pixels, bases);
        Self { pixels: pixels / divisor, bases: bases / divisor }
    }

    /// From a decimal number of at most two places behind its point, such as `2.5`; None: it is none, or it is 0.
    pub fn from_text(text: &str) -> Option<Self> {
        let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
        let has_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
        if whole.is_empty() || whole.len() > 6 || fraction.len() > 2 || !has_digits(whole) || !has_digits(fraction) {
            return None;
        }
        let hundredths = whole.parse::<u32>().ok()? * 100 + format!("{fraction:0<2}").parse::<u32>().ok()?;
        (hundredths > 0).then(|| Self::new(hundredths, 100))
    }

    /// Its length in pixels.
    pub fn length_px(self) -> f64 {
        f64::from(self.pixels) / f64::from(self.bases)
    }

    /// Its length where that is a whole number of pixels.
    pub fn whole_px(self) -> Option<u32> {
        (self.bases == 1).then_some(self.pixels)
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_is_a_fraction_in_lowest_terms() {
        let sides = ["1", "2.5", "0.75", "640", "1.10"].map(|text| Side::from_text(text).unwrap());
        assert_eq!(sides.map(|side| [side.pixels, side.bases]), [[1, 1], [5, 2], [3, 4], [640, 1], [11, 10]]);
        for text in ["", "0", "0.00", ".5", "1.234", "-1", "1e3", "1234567", "2,5", "١"] {
            assert_eq!(Side::from_text(text), None, "{text}");
        }
    }
}
