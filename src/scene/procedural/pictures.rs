//! Pictures made from formulas: base colour, normals and metallic-roughness from one pattern, so that they agree.
//!
//! Noise is hashed from integers and repeats after a whole number of cells: every picture tiles without a seam.

use crate::scene::Image;
use rayon::prelude::*;

/// One point of a pattern.
#[derive(Clone, Copy, Debug)]
pub struct Texel {
    /// sRGB-encoded, 0 to 1.
    pub color: [f32; 3],
    pub alpha: f32,
    /// 0 to 1, in units of the relief that `Sheet::normals` is given.
    pub height: f32,
    /// Perceptual, 0 to 1.
    pub roughness: f32,
    /// 0 to 1.
    pub metallic: f32,
}

impl Default for Texel {
    fn default() -> Self {
        Self { color: [1.0; 3], alpha: 1.0, height: 0.0, roughness: 1.0, metallic: 0.0 }
    }
}

/// A pattern, evaluated: `size_px` x `size_px` texels from the upper left corner.
pub struct Sheet {
    size_px: u32,
    texels: Vec<Texel>,
}

impl Sheet {
    /// `pattern` gets the texel's centre in 0 to 1, y down, and must repeat there.
    pub fn paint(size_px: u32, pattern: impl Fn(f32, f32) -> Texel + Sync) -> Self {
        let centre = |index: u32| (index as f32 + 0.5) / size_px as f32;
        let texel = |index: u32| pattern(centre(index % size_px), centre(index / size_px));
        let texels = (0..size_px * size_px).into_par_iter().map(texel).collect();
        Self { size_px, texels }
    }

    /// Colour and alpha, sRGB-encoded.
    pub fn base_color(&self, name: &str) -> Image {
        self.image(name, |texel, _| [texel.color[0], texel.color[1], texel.color[2], texel.alpha])
    }

    /// Green roughness, blue metallic, linear.
    pub fn metallic_roughness(&self, name: &str) -> Image {
        self.image(name, |texel, _| [0.0, texel.roughness, texel.metallic, 1.0])
    }

    /// Tangent-space normals, linear, +y up in the picture. `relief` is the height of 1 in widths of the picture.
    pub fn normals(&self, name: &str, relief: f32) -> Image {
        let size = self.size_px;
        let height = |x: u32, y: u32| self.texels[((y % size) * size + x % size) as usize].height;
        // Two texels lie between the neighbours whose heights are compared.
        let slope = relief * size as f32 * 0.5;
        self.image(name, |_, index| {
            let (x, y) = (index % size + size, index / size + size);
            let to_right = (height(x + 1, y) - height(x - 1, y)) * slope;
            let to_top = (height(x, y - 1) - height(x, y + 1)) * slope;
            let length = (to_right * to_right + to_top * to_top + 1.0).sqrt();
            [0.5 - 0.5 * to_right / length, 0.5 - 0.5 * to_top / length, 0.5 + 0.5 / length, 1.0]
        })
    }

    fn image(&self, name: &str, channels: impl Fn(&Texel, u32) -> [f32; 4]) -> Image {
        let bytes = |(index, texel): (usize, &Texel)| {
            channels(texel, index as u32).map(|value| (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
        };
        let rgba8 = self.texels.iter().enumerate().flat_map(bytes).collect();
        Image { name: name.to_owned(), width: self.size_px, height: self.size_px, rgba8 }
    }
}

/// 0 to 1 from a place on an integer grid.
#[inline]
pub fn hashed(x: u32, y: u32, seed: u32) -> f32 {
    // Multiply and shift in turn until every input bit reaches every output bit (the finisher of MurmurHash3).
    let mut bits = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ seed.wrapping_mul(0xc2b2_ae3d);
    bits = (bits ^ (bits >> 16)).wrapping_mul(0x85eb_ca6b);
    bits = (bits ^ (bits >> 13)).wrapping_mul(0xc2b2_ae35);
    bits ^= bits >> 16;
    (bits >> 8) as f32 / 16_777_216.0
}

/// Smooth noise, 0 to 1, of `cells` cells in each direction over 0 to 1, repeating.
pub fn noise([u, v]: [f32; 2], cells: [u32; 2], seed: u32) -> f32 {
    let ([left, right], s) = cell_of(u * cells[0] as f32, cells[0]);
    let ([top, bottom], t) = cell_of(v * cells[1] as f32, cells[1]);
    let along = |y: u32| mix(hashed(left, y, seed), hashed(right, y, seed), s);
    mix(along(top), along(bottom), t)
}

/// The cell of `count` that `at` lies in and the next one, and how far it lies in it, smoothly. No call for the whole part, and a
/// division only outside 0 to 1: most of the time of a scene that is made goes here.
#[inline]
fn cell_of(at: f32, count: u32) -> ([u32; 2], f32) {
    let cut = at as i32;
    let whole = cut - i32::from(cut as f32 > at);
    let cell = if (0..count as i32).contains(&whole) { whole as u32 } else { whole.rem_euclid(count as i32) as u32 };
    let next = if cell + 1 == count { 0 } else { cell + 1 };
    ([cell, next], step(0.0, 1.0, at - whole as f32))
}

/// Noise in `octaves` sizes, each half as wide and half as strong as the one before; 0 to 1.
pub fn fractal(at: [f32; 2], cells: [u32; 2], octaves: u32, seed: u32) -> f32 {
    let mut sum = 0.0;
    let mut weight = 1.0;
    let mut total = 0.0;
    for octave in 0..octaves {
        sum += weight * noise(at, cells.map(|count| count << octave), seed.wrapping_add(octave));
        total += weight;
        weight *= 0.5;
    }
    sum / total
}

/// From `a` to `b` as t goes from 0 to 1.
#[inline]
pub fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// `mix` for colours.
pub fn blend(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    [mix(a[0], b[0], t), mix(a[1], b[1], t), mix(a[2], b[2], t)]
}

/// 0 below `low`, 1 above `high`, smooth between.
#[inline]
pub fn step(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_and_stays_between_0_and_1() {
        for index in 0..64 {
            let v = index as f32 / 64.0;
            assert!((fractal([0.0, v], [3, 5], 4, 9) - fractal([1.0, v], [3, 5], 4, 9)).abs() < 1e-6, "{v}");
            assert!((0.0..=1.0).contains(&fractal([v, 0.3], [4, 4], 5, 2)), "{v}");
        }
    }

    #[test]
    fn a_slope_up_to_the_right_leans_left() {
        // Height rises by the picture's width over its width: 45 degrees, away from the seam.
        let sheet = Sheet::paint(8, |u, _| Texel { height: u, ..Texel::default() });
        let normals = sheet.normals("slope", 1.0);
        let middle = &normals.rgba8[4 * (3 * 8 + 4)..][..4];
        assert_eq!(middle, [37, 128, 218, 255]);
    }
}
