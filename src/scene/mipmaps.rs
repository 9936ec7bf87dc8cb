//! The levels of a texture, made on the host: the same texels on every driver.

use super::{ColorSpace, Image};
use crate::report::tonemap::linear_from_srgb;

/// How many levels a picture of this size has, down to one texel.
pub fn level_count(width: u32, height: u32) -> u32 {
    32 - width.max(height).max(1).leading_zeros()
}

/// All levels, finest first, one after the other: RGBA8, each a box filter of the one before. Colour is averaged as
/// light, not as code values.
pub fn levels(image: &Image, color_space: ColorSpace) -> Vec<u8> {
    let codec = Codec::new(color_space);
    let mut all = image.rgba8.clone();
    let (mut width, mut height) = (image.width as usize, image.height as usize);
    let mut finer: Vec<[f32; 4]> = image.rgba8.chunks_exact(4).map(|texel| codec.decode(texel)).collect();
    while width > 1 || height > 1 {
        let (coarse_width, coarse_height) = ((width / 2).max(1), (height / 2).max(1));
        let mut coarser = Vec::with_capacity(coarse_width * coarse_height);
        for y in 0..coarse_height {
            let rows = [(2 * y).min(height - 1), (2 * y + 1).min(height - 1)];
            for x in 0..coarse_width {
                let columns = [(2 * x).min(width - 1), (2 * x + 1).min(width - 1)];
                let mut sum = [0.0f32; 4];
                for row in rows {
                    for column in columns {
                        let texel = finer[row * width + column];
                        for channel in 0..4 {
                            sum[channel] += 0.25 * texel[channel];
                        }
                    }
                }
                all.extend_from_slice(&codec.encode(sum));
                coarser.push(sum);
            }
        }
        (finer, width, height) = (coarser, coarse_width, coarse_height);
    }
    all
}

/// Bytes of `levels` before the level of `size_px`, which must be one of the image's.
pub fn bytes_before(image: &Image, size_px: [u32; 2]) -> usize {
    let mut size = [image.width, image.height];
    let mut bytes = 0;
    while size != size_px {
        assert!(size != [1, 1], "{}: no level has {size_px:?} texels", image.name);
        bytes += 4 * size[0] as usize * size[1] as usize;
        size = size.map(|side| (side / 2).max(1));
    }
    bytes
}

/// Code values to numbers and back, by table where it is a curve.
struct Codec {
    linear: Vec<f32>,
    color_space: ColorSpace,
    /// The least light that rounds to each code.
    starts: Vec<f32>,
}

impl Codec {
    fn new(color_space: ColorSpace) -> Self {
        let linear = (0..256)
            .map(|code| match color_space {
                ColorSpace::Linear => code as f32 / 255.0,
                ColorSpace::Srgb => linear_from_srgb(f64::from(code) / 255.0) as f32,
            })
            .collect();
        // A code begins where the light between it and the one before rounds up to it.
        let starts = (0..256)
            .map(|code| match color_space {
                ColorSpace::Linear => (code as f32 - 0.5) / 255.0,
                ColorSpace::Srgb => linear_from_srgb(((f64::from(code) - 0.5) / 255.0).max(0.0)) as f32,
            })
            .collect();
        Self { linear, color_space, starts }
    }

    fn decode(&self, texel: &[u8]) -> [f32; 4] {
        let color = |channel: usize| self.linear[texel[channel] as usize];
        [color(0), color(1), color(2), f32::from(texel[3]) / 255.0]
    }

    fn encode(&self, [r, g, b, a]: [f32; 4]) -> [u8; 4] {
        let alpha = (a * 255.0 + 0.5) as u8;
        let color = |value: f32| match self.color_space {
            ColorSpace::Linear => (value * 255.0 + 0.5) as u8,
            ColorSpace::Srgb => (self.starts.partition_point(|start| *start <= value).max(1) - 1) as u8,
        };
        [color(r), color(g), color(b), alpha]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::tonemap::srgb_from_linear;

    #[test]
    fn levels_go_down_to_one_texel_and_average_light() {
        let rgba8 = [[0u8, 0, 0, 255], [255, 255, 255, 255]].concat().repeat(4);
        let image = Image { name: String::new(), width: 4, height: 2, rgba8 };
        assert_eq!(level_count(4, 2), 3);
        let all = levels(&image, ColorSpace::Srgb);
        assert_eq!(all.len(), 4 * (8 + 2 + 1));
        // Half the light of white is code 188, not 128.
        let half = (srgb_from_linear(0.5) * 255.0).round() as u8;
        assert_eq!(&all[4 * 10..], [half, half, half, 255]);
        assert_eq!(levels(&image, ColorSpace::Linear)[4 * 10], 128);
    }

    #[test]
    fn every_code_survives_a_level_of_its_own_color() {
        for code in 0..=255u8 {
            let image = Image { name: String::new(), width: 2, height: 2, rgba8: vec![code; 16] };
            for space in [ColorSpace::Srgb, ColorSpace::Linear] {
                assert_eq!(&levels(&image, space)[16..], [code; 4], "{space:?}");
            }
        }
    }
}
