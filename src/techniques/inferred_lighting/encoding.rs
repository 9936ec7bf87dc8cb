//! The geometry pass's texels, on the host: the twin of encoding.glsl. Kircher 2009, equations 1 to 3, section 5.
//!
//! A texel is a word of two 16-bit numbers, however its target keeps it: as that word, as bytes in four channels (the
//! paper's PlayStation 3), or as two numbers of fixed point (its Xbox 360, where what shaders write is scaled to a format
//! from -32 to 32, and only the scaled part of the steps is used).

use crate::choice::choices;
use crate::settings::Values;
use glam::{Vec2, Vec3};

/// The range of the fixed-point format is from minus this to this (section 5.1).
pub const FIXED_LIMIT: f64 = 32.0;
/// Most of the 16-bit numbers.
const LAST: u32 = 0xffff;

choices! {
    /// The format in which a texel's two numbers are written (`--packing`).
    pub enum PackingFormat {
        "words" => Words,
        "rgba8" => Rgba8,
        "fixed" => Fixed,
    }
}

/// How texels lie in their targets (`--packing`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// A whole number of 32 bits.
    Words,
    /// Four channels of 8 bits.
    Bytes,
    /// Two channels of 16 bits, of which `steps` steps are used, those in the middle. Odd, 2047 to 65535.
    Fixed { steps: u32 },
}

impl Packing {
    /// The values of `--packing` and `--fixed-range`.
    pub fn from_settings(values: &Values) -> Self {
        match values.choice("packing") {
            PackingFormat::Words => Self::Words,
            PackingFormat::Rgba8 => Self::Bytes,
            PackingFormat::Fixed => {
                let steps = f64::from(LAST) * values.number("fixed-range") / FIXED_LIMIT;
                // Odd: so many lie left and right of the middle.
                Self::Fixed { steps: steps as u32 | 1 }
            }
        }
    }

    /// The constant FIXED_STEPS of the shaders.
    pub fn fixed_steps(self) -> u32 {
        if let Self::Fixed { steps } = self { steps } else { 0 }
    }

    /// Steps of the numbers, and the first of them.
    fn steps(self) -> (u32, u32) {
        if let Self::Fixed { steps } = self { (steps, (LAST - steps) / 2) } else { (LAST, 0) }
    }

    /// Steps of linear depth; the number after the last stands where no surface is.
    fn depth_steps(self) -> u32 {
        self.steps().0 - 1
    }

    /// The number in both halves of texels that nothing is drawn into.
    pub fn nothing(self) -> u32 {
        let (steps, first) = self.steps();
        first + steps
    }

    /// Whether a normal's word is of a surface.
    pub fn has_normal(self, word: u32) -> bool {
        word != self.nothing() * 0x1_0001
    }

    /// The word of a unit normal in view space, equation 1.
    pub fn normal_word(self, normal_vs: Vec3) -> u32 {
        let mapped = (normal_vs + Vec3::Z).normalize_or_zero().truncate();
        let code = |value: f32| match self {
            Self::Fixed { steps } => {
                let most = (steps / 2) as f32;
                self.steps().1 + (value.clamp(-1.0, 1.0) * most + most + 0.5) as u32
            }
            Self::Words | Self::Bytes => u32::from((value * 32767.0).round() as i16 as u16),
        };
        code(mapped.x) | code(mapped.y) << 16
    }

    /// The unit normal in view space of a word, equations 2 and 3.
    pub fn view_normal(self, word: u32) -> Vec3 {
        let value = |number: u32| match self {
            Self::Fixed { steps } => {
                let most = (steps / 2) as f32;
                (number.wrapping_sub(self.steps().1) as f32 - most) / most
            }
            Self::Words | Self::Bytes => (f32::from(number as u16 as i16) / 32767.0).max(-1.0),
        };
        let mapped = Vec2::new(value(word & LAST), value(word >> 16));
        let z = (1.0 - mapped.length_squared()).max(0.0).sqrt();
        (2.0 * z * mapped).extend(2.0 * z * z - 1.0)
    }

    /// The word of linear depth and id. `range`: depth of the first step, and of all of them, metres. `id`: the object's
    /// times 256, plus the normal group's.
    pub fn dsf_word(self, depth_m: f32, range: [f32; 2], id: u32) -> u32 {
        let part = ((depth_m - range[0]) / range[1]).clamp(0.0, 1.0);
        (self.steps().1 + (part * self.depth_steps() as f32 + 0.5) as u32) | self.id_code(id) << 16
    }

    /// Metres from the eye's plane; None where no surface is. `range` as for `dsf_word`.
    pub fn depth_m(self, word: u32, range: [f32; 2]) -> Option<f32> {
        let number = word & LAST;
        let steps = number.wrapping_sub(self.steps().1) as f32;
        (number != self.nothing()).then(|| range[0] + steps * self.depth_step_m(range))
    }

    /// Metres of a step of linear depth, of the same `range`.
    pub fn depth_step_m(self, range: [f32; 2]) -> f32 {
        range[1] / self.depth_steps() as f32
    }

    /// Code of an id; with fewer steps than ids, neighbours share it.
    pub fn id_code(self, id: u32) -> u32 {
        let (steps, first) = self.steps();
        first + (id * steps + LAST / 2) / LAST
    }

    /// The object's id times 256, plus the normal group's: the least of those that the word may encode.
    pub fn id(self, word: u32) -> u32 {
        let (steps, first) = self.steps();
        // The least id whose code is not less: id * steps + half >= code * LAST.
        let code = u64::from((word >> 16).wrapping_sub(first));
        (code * u64::from(LAST)).saturating_sub(u64::from(LAST / 2)).div_ceil(u64::from(steps)) as u32 & LAST
    }
}

/// Greatest loss of a packing, measured by packing and reading back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// Angle between a normal and what is read, degrees, over all directions but those within 8 degrees of straight away
    /// from the eye, where the map is singular.
    pub normal_most_deg: f64,
    /// Its mean over the same.
    pub normal_mean_deg: f64,
    /// Part of the range of depths.
    pub depth_most: f64,
}

/// Directions and depths that a loss is measured at.
const LOSS_SAMPLES: u32 = 4096;
/// Cosine of the angle to straight towards the eye down to which directions are measured.
const LEAST_Z: f64 = -0.99;

impl Loss {
    pub fn of(packing: Packing) -> Self {
        let (mut most, mut sum) = (0f64, 0f64);
        let mut depth_most = 0f64;
        for index in 0..LOSS_SAMPLES {
            // A spiral of even density on the sphere.
            let part = (f64::from(index) + 0.5) / f64::from(LOSS_SAMPLES);
            let z = 1.0 - part * (1.0 - LEAST_Z);
            let (sin, cos) = (f64::from(index) * 2.399_963_229_728_653).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let normal = Vec3::new((radius * cos) as f32, (radius * sin) as f32, z as f32);
            let read = packing.view_normal(packing.normal_word(normal)).as_dvec3();
            // For small angles the chord is exact where the cosine is not.
            let degrees = (2.0 * (0.5 * read.distance(normal.as_dvec3())).asin()).to_degrees();
            most = most.max(degrees);
            sum += degrees;
            let read = packing.depth_m(packing.dsf_word(part as f32, [0.0, 1.0], 0), [0.0, 1.0]);
            depth_most = depth_most.max((f64::from(read.unwrap_or_default()) - part).abs());
        }
        Self { normal_most_deg: most, normal_mean_deg: sum / f64::from(LOSS_SAMPLES), depth_most }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ALL: [Packing; 4] =
        [Packing::Words, Packing::Bytes, Packing::Fixed { steps: LAST }, Packing::Fixed { steps: 2047 }];

    proptest! {
        #[test]
        fn normals_come_back(x in -1f32..1.0, y in -1f32..1.0, z in -0.99f32..1.0) {
            let normal = Vec3::new(x, y, z).normalize_or(Vec3::Z);
            // Near the direction away from the eye the map is singular: a step there is many degrees.
            prop_assume!(normal.z > -0.99);
            for packing in ALL {
                let word = packing.normal_word(normal);
                let found = packing.view_normal(word);
                let bound = if packing.fixed_steps() == 2047 { 0.02 } else { 1e-3 };
                prop_assert!((found.length() - 1.0).abs() < 1e-5);
                prop_assert!(found.distance(normal) < bound, "{packing:?}: {found} for {normal}");
                prop_assert!(packing.has_normal(word));
            }
        }

        /// Ids that share a number are read as the least of them; with all steps none share one.
        #[test]
        fn ids_come_back(id in 0u32..0x1_0000) {
            for packing in ALL {
                let found = packing.id(packing.id_code(id) << 16);
                prop_assert_eq!(packing.id_code(found), packing.id_code(id));
                prop_assert!(found <= id && (packing.fixed_steps() == 2047 || found == id), "{:?}: {}", packing, found);
                prop_assert!(found == 0 || packing.id_code(found - 1) < packing.id_code(found));
            }
        }
    }

    #[test]
    fn depth_runs_from_the_first_step_to_the_last() {
        for packing in ALL {
            for depth_m in [2.0, 5.0, 8.0] {
                let word = packing.dsf_word(depth_m, [2.0, 6.0], 0x1234);
                let found = packing.depth_m(word, [2.0, 6.0]).unwrap();
                assert!((found - depth_m).abs() <= 6.0 / 4000.0, "{packing:?}: {found} for {depth_m}");
                assert!(packing.fixed_steps() == 2047 || packing.id(word) == 0x1234);
            }
            assert_eq!(packing.depth_m(packing.nothing() * 0x1_0001, [2.0, 6.0]), None);
        }
        assert_eq!(Packing::Words.depth_m(0xabcd_0000, [2.0, 6.0]), Some(2.0));
        assert_eq!(Packing::Words.depth_m(65534, [2.0, 6.0]), Some(8.0));
        assert_eq!((Packing::Words.nothing(), Packing::Words.id(0x1234_0000)), (0xffff, 0x1234));
    }

    /// Two numbers of 16 bits are as exact in every target that keeps all steps of them; of an unscaled one a 32nd is used.
    #[test]
    fn what_each_packing_loses() {
        println!("packing | largest, mean error of a normal (degrees) | largest of depth (part of the range)");
        let losses = ALL.map(|packing| {
            let loss = Loss::of(packing);
            println!(
                "{packing:?} | {:.5}, {:.6} | {:.3e}",
                loss.normal_most_deg, loss.normal_mean_deg, loss.depth_most
            );
            loss
        });
        assert_eq!(losses[0], losses[1]);
        for loss in &losses[..3] {
            assert!(loss.normal_most_deg < 0.03 && loss.normal_mean_deg < 0.005, "{loss:?}");
            assert!((0.4..0.6).contains(&(loss.depth_most * 65534.0)), "{loss:?}");
        }
        assert!((20.0..50.0).contains(&(losses[3].normal_mean_deg / losses[0].normal_mean_deg)), "{:?}", losses[3]);
        assert!((0.4..0.6).contains(&(losses[3].depth_most * 2046.0)), "{:?}", losses[3]);
    }
}
