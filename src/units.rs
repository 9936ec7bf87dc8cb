//! Numbers that know their unit: bytes and pixel extents, as they are printed and as they are parsed.

use std::fmt;

/// A number of bytes, printed in binary units (KiB, MiB, GiB).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Bytes(pub u64);

/// Each 1024 times the one before.
const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];

impl Bytes {
    /// A whole number of bytes, or a number with a binary unit, such as `512MiB` or `1.5 GiB`. None where it is neither,
    /// or beyond 2^62.
    pub fn parse(text: &str) -> Option<Self> {
        let digits_end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
        let (number, unit) = text.split_at(digits_end);
        let power = match unit.trim_start() {
            "" => 0,
            unit => UNITS.iter().position(|known| *known == unit)?,
        };
        let bytes = if number.contains('.') {
            let bytes = number.parse::<f64>().ok()? * 1024f64.powi(power as i32);
            (power > 0 && bytes <= (1u64 << 62) as f64).then_some(bytes as u64)?
        } else {
            number.parse::<u64>().ok()?.checked_mul(1 << (10 * power))?
        };
        (bytes <= 1 << 62).then_some(Self(bytes))
    }
}

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut value = self.0 as f64;
        let mut unit = 0;
        while value >= 1024.0 && unit + 1 < UNITS.len() {
            value /= 1024.0;
            unit += 1;
        }
        if unit == 0 {
            write!(f, "{} B", self.0)
        } else if value >= 100.0 {
            write!(f, "{value:.0} {}", UNITS[unit])
        } else if value >= 10.0 {
            write!(f, "{value:.1} {}", UNITS[unit])
        } else {
            write!(f, "{value:.2} {}", UNITS[unit])
        }
    }
}

/// A width and a height in pixels, at least 1 each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Extent {
    pub width: u32,
    pub height: u32,
}

impl Extent {
    /// Width and height in pixels.
    pub const fn new(width: u32, height: u32) -> Self {
        Self { width, height }
    }

    /// Each `scale`-th pixel of both directions, from the first on.
    pub fn reduced(self, scale: u32) -> Self {
        Self { width: self.width.div_ceil(scale), height: self.height.div_ceil(scale) }
    }

    /// How many pixels it holds.
    pub fn pixel_count(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_print_in_binary_units_with_three_digits() {
        assert_eq!(Bytes(512).to_string(), "512 B");
        assert_eq!(Bytes(4_152_361).to_string(), "3.96 MiB");
        assert_eq!(Bytes(3 << 30).to_string(), "3.00 GiB");
    }

    #[test]
    fn bytes_are_read_as_they_are_printed() {
        for (text, bytes) in
            [("17", 17), ("17B", 17), ("4KiB", 4096), ("512 MiB", 512 << 20), ("2GiB", 2 << 30), ("1.5TiB", 3 << 39)]
        {
            assert_eq!(Bytes::parse(text), Some(Bytes(bytes)), "{text}");
        }
        for text in ["", ".", "1.5", "1.5B", "-1", "1e3", "4kib", "4K", "4MB", "KiB", "1.2.3MiB", "9999999999TiB", " 1"]
        {
            assert_eq!(Bytes::parse(text), None, "{text}");
        }
    }
}
