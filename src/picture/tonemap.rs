//! Scene-linear light to 8-bit sRGB and back: exposure, tone map, transfer function, rounding.
//!
//! Everything is computed in double precision and rounded once, without dither, so that the same picture gives the same
//! bytes on every machine.

use crate::choice::choices;
use crate::picture::Picture;
use crate::units::Extent;
use std::ops::RangeInclusive;

/// What `--exposure` may be, stops.
pub const EXPOSURES_EV: RangeInclusive<f64> = -32.0..=32.0;

choices! {
    /// How radiance above what a screen can show is brought down to 0 to 1 (`--tonemap`). Input and output are linear.
    #[derive(Default)]
    pub enum ToneMap {
        /// Each channel cut to 0 to 1. The default: below 1 it changes nothing, so two such pictures compare.
        #[default]
        "clip" => Clip,
        /// L / (1 + L) of the luminance with the hue kept, then cut (Reinhard et al. 2002, equation 3).
        "reinhard" => Reinhard,
        /// A rational fit of the ACES reference rendering transform, each channel by itself (Narkowicz 2015).
        "aces" => Aces,
    }
}

impl ToneMap {
    /// Linear RGB, finite and at least 0, to linear RGB in 0 to 1.
    pub(crate) fn apply(self, color: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Clip => color.map(|channel| channel.min(1.0)),
            Self::Reinhard => {
                let scale = 1.0 / (1.0 + weighted(color, REC709_WEIGHTS));
                color.map(|channel| (channel * scale).min(1.0))
            }
            Self::Aces => color.map(|x| {
                let mapped = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
                mapped.min(1.0)
            }),
        }
    }
}

/// Shares of red, green and blue in luminance (ITU-R BT.709, section 3.2).
pub const REC709_WEIGHTS: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The sum of the channels, each times its weight.
pub fn weighted(color: [f64; 3], weights: [f64; 3]) -> f64 {
    color[0] * weights[0] + color[1] * weights[1] + color[2] * weights[2]
}

/// What the log average of a picture's luminance is brought to: a middle grey (Reinhard et al. 2002, "Photographic Tone
/// Reproduction for Digital Images", section 3.1).
const KEY: f64 = 0.18;
/// Pixels darker than this part of the brightest one do not count: noise of a path tracer, or one ray of a million.
const DARKEST: f64 = 1e-6;
/// What exposures of `--exposure auto` are rounded to, stops: typed again, such a number makes the same picture.
const EXPOSURE_STEP_EV: f64 = 0.01;

/// The exposure that brings the log average of the luminance (Reinhard et al. 2002, equations 1 and 2) to a middle grey,
/// stops. It is that of the pixels that are not black: pixels without a surface under the default background are no
/// part of a picture's light, and the logarithm of black would outweigh everything. None where all pixels are black.
pub fn exposure_for(picture: &Picture) -> Option<f64> {
    let luminances = picture.pixels.iter().map(|pixel| weighted(pixel.map(f64::from), REC709_WEIGHTS));
    let brightest = luminances.clone().fold(0.0, f64::max);
    let (mut sum, mut count) = (0.0, 0u64);
    for luminance in luminances.filter(|luminance| *luminance > 0.0 && *luminance >= DARKEST * brightest) {
        sum += luminance.log2();
        count += 1;
    }
    if count == 0 {
        return None;
    }
    let exposure_ev = KEY.log2() - sum / count as f64;
    // Adding 0 turns -0 into 0.
    let rounded = (exposure_ev / EXPOSURE_STEP_EV).round() / (1.0 / EXPOSURE_STEP_EV) + 0.0;
    Some(rounded.clamp(*EXPOSURES_EV.start(), *EXPOSURES_EV.end()))
}

/// Linear 0 to 1 to sRGB-encoded 0 to 1 (IEC 61966-2-1).
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// sRGB-encoded 0 to 1 to linear 0 to 1 (IEC 61966-2-1).
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// 8-bit sRGB, row-major from the upper left corner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Srgb8 {
    pub extent: Extent,
    /// `extent.pixel_count()` entries.
    pub pixels: Vec<[u8; 3]>,
}

impl Srgb8 {
    /// What a screen shows of a picture: times 2^`exposure_ev` (at 0, radiance 1 is white), tone-mapped, encoded, rounded
    /// to the nearest code.
    ///
    /// Below zero and NaN are black, infinity is white.
    pub fn from_picture(picture: &Picture, exposure_ev: f64, tone_map: ToneMap) -> Self {
        let exposure = exposure_ev.exp2();
        let encode = |pixel: &[f32; 3]| {
            let exposed = pixel.map(|channel| {
                // `max` turns NaN into 0; the upper bound keeps the tone maps away from infinity over infinity.
                (f64::from(channel) * exposure).max(0.0).min(f64::from(f32::MAX))
            });
            tone_map.apply(exposed).map(|channel| (255.0 * srgb_from_linear(channel)).round() as u8)
        };
        Self { extent: picture.extent, pixels: picture.pixels.iter().map(encode).collect() }
    }

    /// Back to scene-linear light at exposure 0 without a tone map: code 255 is radiance 1.
    ///
    /// `from_picture` with exposure 0 and `ToneMap::Clip` undoes it exactly.
    pub fn to_picture(&self) -> Picture {
        let linear: Vec<f32> = (0..=255u8).map(|code| linear_from_srgb(f64::from(code) / 255.0) as f32).collect();
        let decode = |pixel: &[u8; 3]| pixel.map(|code| linear[usize::from(code)]);
        Picture { extent: self.extent, pixels: self.pixels.iter().map(decode).collect() }
    }

    /// The same bytes in a row, three a pixel.
    pub fn as_bytes(&self) -> &[u8] {
        self.pixels.as_flattened()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(color: [f32; 3], exposure_ev: f64, tone_map: ToneMap) -> [u8; 3] {
        Srgb8::from_picture(&Picture::filled(Extent::new(1, 1), color), exposure_ev, tone_map).pixels[0]
    }

    #[test]
    fn every_code_survives_the_way_to_linear_and_back() {
        let pixels = (0..=255u8).map(|code| [code, 255 - code, code ^ 0x55]).collect();
        let codes = Srgb8 { extent: Extent::new(16, 16), pixels };
        assert_eq!(Srgb8::from_picture(&codes.to_picture(), 0.0, ToneMap::Clip), codes);
    }

    #[test]
    fn the_transfer_function_has_the_standards_values() {
        // 0.5 linear is 187.516 / 255 encoded, code 188; 0.18 is 117.6, code 118.
        assert_eq!(one([0.5, 0.18, 1.0], 0.0, ToneMap::Clip), [188, 118, 255]);
        for encoded in [0.0, 0.02, 0.040_45, 0.2, 0.7, 1.0] {
            assert!((srgb_from_linear(linear_from_srgb(encoded)) - encoded).abs() < 1e-6, "{encoded}");
        }
    }

    #[test]
    fn an_exposure_is_made_for_what_shines() {
        let extent = Extent::new(4, 1);
        let of = |pixels: [f32; 4]| exposure_for(&Picture { extent, pixels: pixels.map(|grey| [grey; 3]).to_vec() });
        assert_eq!(of([0.18; 4]), Some(0.0));
        assert_eq!(of([0.09; 4]), Some(1.0));
        // The mean of logarithms, not the logarithm of the mean.
        assert_eq!(of([0.72, 0.18, 0.18, 0.72]), Some(-1.0));
        // Neither what does not shine counts, nor what shines a million times less.
        assert_eq!(of([0.0, 0.09, 1e-9, 0.09]), Some(1.0));
        assert_eq!(of([0.0; 4]), None);
        assert_eq!(of([1e-30; 4]), Some(32.0));
        assert_eq!(of([0.1; 4]), Some(0.85));
        let green = Picture::filled(extent, [0.0, 0.18, 0.0]);
        assert_eq!(exposure_for(&green), Some(0.48), "luminance, not the mean of the channels");
    }

    #[test]
    fn exposure_counts_in_stops() {
        assert_eq!(one([0.25; 3], 1.0, ToneMap::Clip), one([0.5; 3], 0.0, ToneMap::Clip));
        assert_eq!(one([2.0; 3], -1.0, ToneMap::Clip), [255; 3]);
    }

    #[test]
    fn tone_maps_bring_light_down_and_keep_black() {
        assert_eq!(one([1.0; 3], 0.0, ToneMap::Reinhard), one([0.5; 3], 0.0, ToneMap::Clip));
        // (2.51 + 0.03) / (2.43 + 0.59 + 0.14) = 0.803797
        assert_eq!(one([1.0; 3], 0.0, ToneMap::Aces), one([0.803_797; 3], 0.0, ToneMap::Clip));
        for tone_map in [ToneMap::Clip, ToneMap::Reinhard, ToneMap::Aces] {
            let name = tone_map.name();
            assert_eq!(one([0.0; 3], 0.0, tone_map), [0; 3], "{name}");
            assert_eq!(one([-1.0, f32::NAN, f32::NEG_INFINITY], 0.0, tone_map), [0; 3], "{name}");
            assert_eq!(one([f32::INFINITY; 3], 0.0, tone_map), [255; 3], "{name}");
        }
    }
}
