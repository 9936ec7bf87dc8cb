//! A picture on the host, and its hash.

use crate::error::{Error, Result};
use crate::units::Extent;

/// Scene-linear RGB, Rec.709 primaries, row-major from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub extent: Extent,
    /// `extent.pixel_count()` entries.
    pub pixels: Vec<[f32; 3]>,
}

impl Picture {
    /// A picture of one colour.
    pub fn filled(extent: Extent, color: [f32; 3]) -> Self {
        Self { extent, pixels: vec![color; extent.pixel_count() as usize] }
    }

    /// Mean of each channel.
    pub fn mean(&self) -> [f64; 3] {
        let mut sum = [0.0f64; 3];
        for pixel in &self.pixels {
            for channel in 0..3 {
                sum[channel] += f64::from(pixel[channel]);
            }
        }
        sum.map(|channel| channel / self.pixels.len().max(1) as f64)
    }

    /// Fails with the first pixel that is NaN or infinite: such a picture has no hash (exit code 1).
    pub fn check(&self) -> Result<()> {
        let broken = self.pixels.iter().position(|pixel| pixel.iter().any(|channel| !channel.is_finite()));
        let Some(index) = broken else { return Ok(()) };
        let width = self.extent.width as usize;
        let [r, g, b] = self.pixels[index];
        Err(Error::gate(format!("the picture holds ({r}, {g}, {b}) at pixel ({}, {})", index % width, index / width)))
    }

    /// BLAKE3 of width, height (both u32, little-endian) and the row-major RGB float32, with -0 taken as 0.
    ///
    /// Fails as `check` does.
    pub fn hash(&self) -> Result<String> {
        self.check()?;
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.extent.width.to_le_bytes());
        hasher.update(&self.extent.height.to_le_bytes());
        let mut row = Vec::with_capacity(self.extent.width as usize * 12);
        for pixels in self.pixels.chunks(self.extent.width as usize) {
            row.clear();
            for pixel in pixels {
                for channel in pixel {
                    // Adding +0 turns -0 into +0 and changes nothing else.
                    row.extend_from_slice(&(channel + 0.0).to_le_bytes());
                }
            }
            hasher.update(&row);
        }
        Ok(hasher.finalize().to_hex().to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_takes_minus_zero_as_zero_and_refuses_nan() {
        let zero = Picture::filled(Extent::new(2, 1), [0.0; 3]);
        let minus = Picture::filled(Extent::new(2, 1), [-0.0; 3]);
        assert_eq!(zero.hash().unwrap(), minus.hash().unwrap());
        let wide = Picture::filled(Extent::new(1, 2), [0.0; 3]);
        assert_ne!(zero.hash().unwrap(), wide.hash().unwrap());
        let mut broken = zero;
        broken.pixels[1][2] = f32::NAN;
        let error = broken.hash().unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(error.message().contains("(1, 0)"), "{error}");
    }
}
