//! How the L-buffer keeps light: the twin of l_buffer.glsl. Kircher 2009, sections 2.2, 5.1.

use crate::choice::choices;
use crate::gpu::shader::techniques::inferred_lighting::l_buffer::LIGHT_STEPS;
use half::f16;

/// Down to what part of `--light-range` losses are measured.
const LEAST_PART: f32 = 1.0 / 256.0;
/// Lights that a loss is measured at.
const LOSS_SAMPLES: u16 = 4096;

choices! {
    /// How the L-buffer sums up light (`--l-buffer`).
    pub enum Sums {
        /// In 32 bits, packed once to half floats.
        "float" => Float,
        /// Blended in half floats.
        "half" => Half,
        /// In 32 bits, packed once to 16 bits of fixed point.
        "fixed" => Fixed,
    }
}

/// A channel of the L-buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Store {
    Halves,
    /// 16 bits of fixed point; what is brighter than `range` is held there.
    Fixed {
        range: f32,
    },
}

impl Store {
    /// The constant LIGHT_RANGE of the shaders.
    pub fn constant(self) -> (&'static str, u32) {
        ("LIGHT_RANGE", if let Self::Fixed { range } = self { range.to_bits() } else { 0 })
    }

    /// The light that 16 bits encode.
    pub fn read(self, bits: u16) -> f32 {
        match self {
            Self::Halves => f16::from_bits(bits).to_f32(),
            Self::Fixed { .. } if f32::from(bits) > LIGHT_STEPS => f32::NAN,
            Self::Fixed { range } => f32::from(bits) * (range / LIGHT_STEPS),
        }
    }

    /// The bits of finite light, at least 0.
    pub fn bits(self, light: f32) -> u16 {
        match self {
            Self::Halves => f16::from_f32(light.min(f16::MAX.to_f32())).to_bits(),
            Self::Fixed { range } => ((light / range).clamp(0.0, 1.0) * LIGHT_STEPS + 0.5) as u16,
        }
    }

    /// Whether 16 bits hold the most light there can be, so that some of it may be cut off.
    pub fn is_cut(self, bits: u16) -> bool {
        matches!(self, Self::Fixed { .. }) && f32::from(bits) == LIGHT_STEPS
    }

    /// The largest part by which light from a 256th of `range` to all of it is off.
    pub fn loss(self, range: f32) -> f64 {
        let parts = (0..=LOSS_SAMPLES).map(|index| f32::from(index) / f32::from(LOSS_SAMPLES));
        let lights = parts.map(|part| range * (LEAST_PART + (1.0 - LEAST_PART) * part));
        // Nearly all of a loss is near the darkest light: so it is sampled more densely there.
        let dark =
            (0..LOSS_SAMPLES).map(|index| range * LEAST_PART * (1.0 + f32::from(index) / f32::from(LOSS_SAMPLES)));
        let off = |light: f32| (f64::from(self.read(self.bits(light))) / f64::from(light) - 1.0).abs();
        lights.chain(dark).map(off).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_comes_back_and_what_is_too_bright_is_held() {
        let fixed = Store::Fixed { range: 32.0 };
        for (light, read) in [(0.0, 0.0), (16.0, 16.0), (32.0, 32.0), (1e6, 32.0)] {
            assert_eq!(fixed.read(fixed.bits(light)), read, "{light}");
            assert_eq!(fixed.is_cut(fixed.bits(light)), light >= 32.0, "{light}");
        }
        assert!(fixed.read(0xffff).is_nan());
        assert_eq!(Store::Halves.read(Store::Halves.bits(1e6)), 65504.0);
    }

    /// A half float is off by 2^-11 at most; fixed point by half of its steps, which is most of dark light.
    #[test]
    fn what_each_store_loses() {
        let (halves, fixed) = (Store::Halves.loss(32.0), Store::Fixed { range: 32.0 }.loss(32.0));
        println!(
            "largest part that light of a 256th of the range and more is off: half {halves:.3e}, fixed {fixed:.3e}"
        );
        assert!((0.9..1.01).contains(&(halves * 2048.0)), "{halves}");
        assert!((0.9..1.01).contains(&(fixed * 2.0 * 65534.0 / 256.0)), "{fixed}");
    }
}
