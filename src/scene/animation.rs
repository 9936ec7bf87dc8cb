//! Animated values: what a curve through keyframes is at a moment (glTF 2.0, section 3.11 and appendix C).

use std::cmp::Ordering::Less;

use glam::{Quat, Vec3, Vec4};

use crate::error::{Error, Result};

/// Which animations of a file play.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AnimationChoice {
    /// All of them at once.
    All,
    /// None: the rest pose.
    None,
    /// The one of this name, else of this index.
    One(String),
}

impl AnimationChoice {
    /// `all`, `none`, or an index or a name; which of them a file has is asked when it is read.
    pub fn parse(text: &str) -> Self {
        match text {
            "all" => Self::All,
            "none" => Self::None,
            other => Self::One(other.to_owned()),
        }
    }
}

/// How values pass from one keyframe to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// A key's value stays until the next key.
    Step,
    /// A straight line; of rotations, the shorter arc at even speed.
    Linear,
    /// A cubic Hermite spline, with a tangent before and one after each key.
    CubicSpline,
}

impl Interpolation {
    /// How many values stand in a curve for each key: a spline has in-tangent, value and out-tangent.
    pub fn values_per_key(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

/// A value of one or more numbers over time, held before the first and after the last key.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    interpolation: Interpolation,
    times_s: Vec<f32>,
    /// `values_per_key` values of `width` numbers for each key.
    values: Vec<f32>,
    width: usize,
}

/// Where in a curve a moment is.
enum Place {
    /// At a key, or where its value is held.
    Key(usize),
    /// After key `from`: `part` of the way, 0 to 1, through `interval_s` seconds.
    Between { from: usize, part: f32, interval_s: f32 },
}

impl Curve {
    /// A curve through `times_s`, seconds. `values`: for each key one value of `width` numbers, of a spline three
    /// (in-tangent, value, out-tangent).
    ///
    /// Errors: no key, times that do not ascend, another number of values (exit code 2).
    pub fn new(interpolation: Interpolation, times_s: Vec<f32>, values: Vec<f32>, width: usize) -> Result<Self> {
        if times_s.is_empty() {
            return Err(Error::request("its input has no keyframe; at least one is needed"));
        }
        if let Some(key) = times_s.windows(2).position(|pair| pair[0].partial_cmp(&pair[1]) != Some(Less)) {
            return Err(Error::request(format!(
                "its input goes from {} s to {} s after key {key}; the times of keyframes must ascend",
                times_s[key],
                times_s[key + 1]
            )));
        }
        let needed = times_s.len().checked_mul(interpolation.values_per_key()).and_then(|n| n.checked_mul(width));
        if needed != Some(values.len()) {
            return Err(Error::request(format!(
                "its output holds {} numbers; {} keyframes of {} numbers need {}",
                values.len(),
                times_s.len(),
                interpolation.values_per_key() * width,
                needed.map_or_else(|| "more than there can be".to_owned(), |needed| needed.to_string())
            )));
        }
        Ok(Self { interpolation, times_s, values, width })
    }

    /// When the last key is, seconds.
    pub fn end_s(&self) -> f32 {
        self.times_s[self.times_s.len() - 1]
    }

    /// When the keys are, seconds, ascending.
    pub fn times_s(&self) -> &[f32] {
        &self.times_s
    }

    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// All numbers in glTF's order: key by key, of a spline in-tangent, value and out-tangent.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The values at the keys, without tangents.
    pub fn key_values(&self) -> impl Iterator<Item = &[f32]> {
        (0..self.times_s.len()).map(|key| self.key_value(key))
    }

    fn key_value(&self, key: usize) -> &[f32] {
        // A key has in-tangent, value and out-tangent: take the second.
        self.row(key, self.interpolation.values_per_key() / 2)
    }

    fn row(&self, key: usize, row: usize) -> &[f32] {
        &self.values[(key * self.interpolation.values_per_key() + row) * self.width..][..self.width]
    }

    fn place(&self, time_s: f64) -> Place {
        let next = self.times_s.partition_point(|key_s| f64::from(*key_s) <= time_s);
        if next == 0 || next == self.times_s.len() || self.interpolation == Interpolation::Step {
            return Place::Key(next.saturating_sub(1));
        }
        let [start_s, end_s] = [next - 1, next].map(|key| f64::from(self.times_s[key]));
        let interval_s = end_s - start_s;
        let part = ((time_s - start_s) / interval_s) as f32;
        Place::Between { from: next - 1, part, interval_s: interval_s as f32 }
    }

    /// The value at `time_s`: `width` numbers.
    pub fn at(&self, time_s: f64) -> Vec<f32> {
        match self.place(time_s) {
            Place::Key(key) => self.key_value(key).to_vec(),
            Place::Between { from, part, interval_s } => self.between(from, part, interval_s),
        }
    }

    fn between(&self, from: usize, part: f32, interval_s: f32) -> Vec<f32> {
        let weights = if self.interpolation == Interpolation::CubicSpline {
            let (square, cube) = (part * part, part * part * part);
            // glTF 2.0, appendix C.5: tangents are per second, so the interval scales them.
            [
                2.0 * cube - 3.0 * square + 1.0,
                interval_s * (cube - 2.0 * square + part),
                3.0 * square - 2.0 * cube,
                interval_s * (cube - square),
            ]
        } else {
            [1.0 - part, 0.0, part, 0.0]
        };
        let last = self.interpolation.values_per_key() - 1;
        let rows = [self.key_value(from), self.row(from, last), self.key_value(from + 1), self.row(from + 1, 0)];
        (0..self.width).map(|at| (0..4).map(|row| weights[row] * rows[row][at]).sum()).collect()
    }

    /// The value at `time_s` of a curve of three numbers.
    pub fn vector_at(&self, time_s: f64) -> Vec3 {
        Vec3::from_slice(&self.at(time_s))
    }

    /// The value at `time_s` of a curve of quaternions (x, y, z, w), each longer than zero at its key.
    pub fn rotation_at(&self, time_s: f64) -> Quat {
        let key_rotation = |key| unit_quaternion(Vec4::from_slice(self.key_value(key))).unwrap_or_default();
        match self.place(time_s) {
            Place::Key(key) => key_rotation(key),
            Place::Between { from, part, .. } if self.interpolation == Interpolation::Linear => {
                key_rotation(from).slerp(key_rotation(from + 1), part)
            }
            Place::Between { from, part, interval_s } => {
                // A spline may pass through zero, where it has no direction.
                let value = Vec4::from_slice(&self.between(from, part, interval_s));
                unit_quaternion(value).unwrap_or_else(|| key_rotation(from))
            }
        }
    }
}

/// The rotation of a quaternion of any length; None where it is zero or not finite.
pub fn unit_quaternion(value: Vec4) -> Option<Quat> {
    // Length first in the largest component: the square of a tiny quaternion vanishes.
    let unit = (value / value.abs().max_element()).try_normalize()?;
    unit.is_finite().then(|| Quat::from_vec4(unit))
}

#[cfg(test)]
mod tests {
    use std::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

    use proptest::prelude::*;

    use super::*;

    fn curve(interpolation: Interpolation, times_s: &[f32], values: &[f32], width: usize) -> Curve {
        Curve::new(interpolation, times_s.to_vec(), values.to_vec(), width).unwrap()
    }

    #[test]
    fn a_step_stays_until_the_next_key_and_ends_are_held() {
        let step = curve(Interpolation::Step, &[1.0, 2.0, 4.0], &[10.0, 20.0, 40.0], 1);
        for (time_s, value) in
            [(0.0, 10.0), (1.0, 10.0), (1.999, 10.0), (2.0, 20.0), (3.9, 20.0), (4.0, 40.0), (9.0, 40.0)]
        {
            assert_eq!(step.at(time_s), [value], "{time_s}");
        }
        let one = curve(Interpolation::CubicSpline, &[1.0], &[5.0, 7.0, 9.0], 1);
        assert_eq!((one.at(0.0), one.at(1.0), one.at(2.0)), (vec![7.0], vec![7.0], vec![7.0]));
    }

    #[test]
    fn a_line_is_straight_and_passes_its_keys() {
        let line = curve(Interpolation::Linear, &[1.0, 3.0], &[0.0, 4.0, 10.0, -4.0], 2);
        assert_eq!(line.at(0.0), [0.0, 4.0]);
        assert_eq!(line.at(1.5), [2.5, 2.0]);
        assert_eq!(line.at(3.0), [10.0, -4.0]);
        assert_eq!(line.end_s(), 3.0);
    }

    /// At the middle a Hermite spline is (v0 + v1) / 2 + interval (b0 - a1) / 8, at a quarter the sum of its four
    /// polynomials there: 27/32, 9/64, 5/32, -3/64.
    #[test]
    fn a_spline_scales_its_tangents_by_the_interval() {
        let (v0, out, into, v1, interval) = (3.0, 5.0, -2.0, 7.0, 4.0);
        let spline = curve(Interpolation::CubicSpline, &[1.0, 5.0], &[99.0, v0, out, into, v1, 99.0], 1);
        let middle = 0.5 * (v0 + v1) + interval * (out - into) / 8.0;
        assert!((spline.at(3.0)[0] - middle).abs() < 1e-5, "{:?} {middle}", spline.at(3.0));
        let quarter = 27.0 / 32.0 * v0 + interval * 9.0 / 64.0 * out + 5.0 / 32.0 * v1 - interval * 3.0 / 64.0 * into;
        assert!((spline.at(2.0)[0] - quarter).abs() < 1e-5, "{:?} {quarter}", spline.at(2.0));
        assert_eq!((spline.at(1.0)[0], spline.at(5.0)[0]), (v0, v1));
    }

    #[test]
    fn rotations_take_the_shorter_arc_at_even_speed() {
        // 0 to 90 degrees about y; the second key has the other sign, which is the same rotation.
        let turned = [0.0, -FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2];
        let values = [&[0.0, 0.0, 0.0, 1.0][..], &turned].concat();
        let turn = curve(Interpolation::Linear, &[0.0, 3.0], &values, 4);
        for part in [0.0, 1.0 / 3.0, 0.5, 1.0] {
            let expected = Quat::from_rotation_y(part * FRAC_PI_2);
            let found = turn.rotation_at(f64::from(3.0 * part));
            assert!(found.dot(expected).abs() > 1.0 - 1e-6, "{part}: {found} {expected}");
        }
        // Keys need not be of unit length.
        let long: Vec<f32> = values.iter().map(|value| 1e-30 * value).collect();
        let found = curve(Interpolation::Linear, &[0.0, 3.0], &long, 4).rotation_at(1.5);
        assert!(found.dot(Quat::from_rotation_y(PI / 4.0)).abs() > 1.0 - 1e-6, "{found}");
    }

    #[test]
    fn a_spline_of_rotations_is_made_unit_and_survives_zero() {
        let key = |value: [f32; 4]| [[0.0; 4], value, [0.0; 4]].concat();
        let turned = [0.0, 1.0, 0.0, 0.0];
        let turn =
            curve(Interpolation::CubicSpline, &[0.0, 1.0], &[key([0.0, 0.0, 0.0, 1.0]), key(turned)].concat(), 4);
        let half = turn.rotation_at(0.5);
        assert!(half.dot(Quat::from_rotation_y(FRAC_PI_2)) > 1.0 - 1e-6, "{half}");
        let through_zero = [key([0.0, 0.0, 0.0, 1.0]), key([0.0, 0.0, 0.0, -1.0])].concat();
        let held = curve(Interpolation::CubicSpline, &[0.0, 1.0], &through_zero, 4).rotation_at(0.5);
        assert_eq!(held, Quat::IDENTITY);
        assert_eq!(unit_quaternion(Vec4::ZERO), None);
        assert_eq!(unit_quaternion(Vec4::splat(f32::NAN)), None);
    }

    #[test]
    fn keys_that_do_not_ascend_or_lack_values_are_refused() {
        let refused = |times_s: &[f32], values: usize, words: &str| {
            let error = Curve::new(Interpolation::Linear, times_s.to_vec(), vec![0.0; values], 3).unwrap_err();
            assert!(error.message().contains(words), "{error}");
        };
        refused(&[], 0, "no keyframe");
        refused(&[0.0, 1.0, 1.0], 9, "from 1 s to 1 s after key 1");
        refused(&[0.0, 2.0, 1.0], 9, "from 2 s to 1 s");
        refused(&[0.0, 1.0], 5, "5 numbers; 2 keyframes of 3 numbers need 6");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Whatever the moment, a line stays between the keys around it, and a spline meets its keys.
        #[test]
        fn any_moment_has_a_value(time_s in -10f64..20.0, key in 0usize..4) {
            let times_s = [0.0, 1.0, 2.5, 7.0];
            let line = curve(Interpolation::Linear, &times_s, &[1.0, -2.0, 3.0, 8.0], 1).at(time_s)[0];
            // A part of the way rounds by a few units in the last place.
            prop_assert!((-2.00001..=8.00001).contains(&line));
            let values: Vec<f32> = (0..12).map(|value| value as f32).collect();
            let spline = curve(Interpolation::CubicSpline, &times_s, &values, 1);
            prop_assert_eq!(spline.at(f64::from(times_s[key])), vec![(3 * key + 1) as f32]);
        }
    }
}
