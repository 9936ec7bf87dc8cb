//! What a texel of the L-buffer keeps, in two words: the twin of l_buffer.glsl. Kircher 2009, sections 2.2, 5.1.

use crate::choice::choices;
use crate::gpu::shader::techniques::inferred_lighting::l_buffer::{LIGHT_STEPS, MOST_SHARED, SHARED_NAN};
use half::f16;

/// Down to what part of `--light-range` losses are measured.
const LEAST_PART: f32 = 1.0 / 256.0;
/// Lights that a loss is measured at.
const LOSS_SAMPLES: u16 = 4096;

choices! {
    /// How the L-buffer sums up light (`--l-buffer`).
    pub enum Sums {
        /// In 32 bits, packed once.
        "float" => Float,
        /// Blended in half floats.
        "half" => Half,
        /// In 32 bits, packed once to 16 bits of fixed point.
        "fixed" => Fixed,
    }
}

choices! {
    /// What the L-buffer keeps of highlights (`--highlight`); the number is l_buffer.glsl's HIGHLIGHT_ value.
    pub enum Highlight {
        /// Three channels, by the F0 of the texel.
        "rgb" => Rgb = 2,
        /// Two numbers: what F0 weighs, and what F90 does.
        "split" => Split = 1,
        /// One number, the paper's.
        "intensity" => Intensity = 0,
    }
}

choices! {
    /// Where Fresnel's factor of `--highlight intensity` is taken (`--fresnel`); the number is highlight.glsl's
    /// FRESNEL_PER_LIGHT.
    pub enum Fresnel {
        /// At each light's angle.
        "light" => Light = 1,
        /// At normal incidence.
        "normal" => Normal = 0,
    }
}

/// The encoding of a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Store {
    /// Four half floats, the fourth of the highlight.
    Halves,
    /// Four numbers of 16 bits of fixed point; what is brighter than `range` is held there.
    Fixed { range: f32 },
    /// Three numbers with a common exponent, and two half floats of the highlight.
    Split,
    /// Twice three numbers with a common exponent, of light and of the highlight.
    Shared,
}

/// What a texel says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// Lux.
    pub irradiance: [f32; 3],
    /// By `--highlight`: one number, two, or three; 0 beyond.
    pub highlight: [f32; 3],
}

impl Store {
    /// The constants LIGHT_RANGE and HIGHLIGHT of the shaders.
    pub fn constants(self) -> [(&'static str, u32); 2] {
        let range = if let Self::Fixed { range } = self { range.to_bits() } else { 0 };
        let highlight = match self {
            Self::Halves | Self::Fixed { .. } => Highlight::Intensity,
            Self::Split => Highlight::Split,
            Self::Shared => Highlight::Rgb,
        };
        [("LIGHT_RANGE", range), ("HIGHLIGHT", highlight as u32)]
    }

    /// It has four channels of 16 bits, which can be drawn into and sampled.
    pub fn has_channels(self) -> bool {
        matches!(self, Self::Halves | Self::Fixed { .. })
    }

    /// What two words encode.
    pub fn read(self, [first, second]: [u32; 2]) -> Lighting {
        let halves = |word: u32| [word as u16, (word >> 16) as u16];
        match self {
            Self::Halves | Self::Fixed { .. } => {
                let ([r, g], [b, a]) = (halves(first), halves(second));
                let [r, g, b, a] = [r, g, b, a].map(|bits| self.number(bits));
                Lighting { irradiance: [r, g, b], highlight: [a, 0.0, 0.0] }
            }
            Self::Split => {
                let [by_f0, by_f90] = halves(second).map(|bits| f16::from_bits(bits).to_f32());
                Lighting { irradiance: shared(first), highlight: [by_f0, by_f90, 0.0] }
            }
            Self::Shared => Lighting { irradiance: shared(first), highlight: shared(second) },
        }
    }

    /// The number that 16 bits of a channel encode.
    fn number(self, bits: u16) -> f32 {
        match self {
            Self::Fixed { .. } if f32::from(bits) > LIGHT_STEPS => f32::NAN,
            Self::Fixed { range } => f32::from(bits) * (range / LIGHT_STEPS),
            _ => f16::from_bits(bits).to_f32(),
        }
    }

    /// What is read of gray light, finite and at least 0.
    fn kept(self, light: f32) -> f32 {
        match self {
            Self::Halves => f16::from_f32(light.min(f16::MAX.to_f32())).to_f32(),
            Self::Fixed { range } => self.number(((light / range).clamp(0.0, 1.0) * LIGHT_STEPS + 0.5) as u16),
            Self::Split | Self::Shared => shared(shared_word([light; 3]))[0],
        }
    }

    /// Whether a texel's words hold the most light that there can be in some channel, so that some may be cut off.
    pub fn is_cut(self, words: [u32; 2]) -> bool {
        let full = |word: u32| [word & 0xffff, word >> 16].contains(&(LIGHT_STEPS as u32));
        matches!(self, Self::Fixed { .. }) && words.into_iter().any(full)
    }

    /// The largest part by which gray light from a 256th of `range` to all of it is off.
    pub fn loss(self, range: f32) -> f64 {
        let parts = (0..=LOSS_SAMPLES).map(|index| f32::from(index) / f32::from(LOSS_SAMPLES));
        let lights = parts.map(|part| range * (LEAST_PART + (1.0 - LEAST_PART) * part));
        // Nearly all of a loss is near the darkest light: so it is sampled more densely there.
        let dark =
            (0..LOSS_SAMPLES).map(|index| range * LEAST_PART * (1.0 + f32::from(index) / f32::from(LOSS_SAMPLES)));
        let off = |light: f32| (f64::from(self.kept(light)) / f64::from(light) - 1.0).abs();
        lights.chain(dark).map(off).fold(0.0, f64::max)
    }
}

/// Three numbers with a common exponent, as VK_FORMAT_E5B9G9R9_UFLOAT_PACK32 has them.
fn shared(word: u32) -> [f32; 3] {
    if word == SHARED_NAN {
        return [f32::NAN; 3];
    }
    let step = 2f32.powi((word >> 27) as i32 - 24);
    [0, 9, 18].map(|shift| (word >> shift & 0x1ff) as f32 * step)
}

/// The word of three finite numbers, at least 0.
fn shared_word(light: [f32; 3]) -> u32 {
    let held = light.map(|channel| channel.min(MOST_SHARED));
    let most = held.into_iter().fold(0.0, f32::max);
    let mut exponent = ((most.to_bits() >> 23) as i32 - 127).max(-16) + 16;
    if most * 2f32.powi(24 - exponent) + 0.5 >= 512.0 {
        exponent += 1;
    }
    let [r, g, b] = held.map(|channel| (channel * 2f32.powi(24 - exponent) + 0.5) as u32);
    r | g << 9 | b << 18 | (exponent as u32) << 27
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn light_comes_back_and_what_is_too_bright_is_held() {
        let fixed = Store::Fixed { range: 32.0 };
        for (light, read) in [(0.0, 0.0), (16.0, 16.0), (32.0, 32.0), (1e6, 32.0)] {
            assert_eq!(fixed.kept(light), read, "{light}");
        }
        assert!(fixed.is_cut([0xfffe, 0]) && fixed.is_cut([0, 0xfffe_0000]) && !fixed.is_cut([0xfffd_fffd; 2]));
        assert!(fixed.read([0xffff, 0]).irradiance[0].is_nan());
        assert_eq!(Store::Halves.kept(1e6), 65504.0);
        assert_eq!([Store::Split, Store::Shared].map(|store| store.kept(1e6)), [65280.0; 2]);
    }

    proptest! {
        /// No channel is off by more than half a step of the brightest, which has 9 bits.
        #[test]
        fn numbers_with_a_common_exponent_come_back(
            r in 0f32..70000.0, g in 0f32..3.0, b in 0f32..1e-3, order in 0usize..3, scale in -12i32..0,
        ) {
            let mut light = [r, g, b].map(|channel| channel * 2f32.powi(scale));
            light.rotate_right(order);
            let most = light.into_iter().fold(0.0, f32::max).min(MOST_SHARED);
            let step = (most / 256.0).max(2f32.powi(-24));
            for (found, channel) in shared(shared_word(light)).into_iter().zip(light) {
                prop_assert!((found - channel.min(MOST_SHARED)).abs() <= 0.51 * step, "{found} for {channel}");
            }
        }
    }

    /// A half float is off by 2^-11 at most; fixed point by half of its steps, which is most of dark light; of a common exponent
    /// the brightest channel has 9 bits, 2^-9 of the least of them.
    #[test]
    fn what_each_store_loses() {
        let losses = [Store::Halves, Store::Fixed { range: 32.0 }, Store::Shared].map(|store| store.loss(32.0));
        println!("largest part that light of a 256th of the range and more is off: half, fixed, shared {losses:?}");
        let [halves, fixed, shared] = losses;
        assert!((0.9..1.01).contains(&(halves * 2048.0)), "{halves}");
        assert!((0.9..1.01).contains(&(fixed * 2.0 * 65534.0 / 256.0)), "{fixed}");
        assert!((0.9..1.01).contains(&(shared * 512.0)), "{shared}");
    }
}
