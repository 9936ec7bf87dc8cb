//! Basis patterns: samples over a rectangle of pixels that repeats over the frame, so that each of them becomes a regular
//! grid (Keller and Heidrich 2001, section 2.1).
//!
//! The rectangle need not have whole sides: the graph paper of pixels is then laid over what repeats, and pixels hold
//! different numbers of samples. As a `Pattern` such a basis stands several times in a period, and each of its samples is
//! a subset.

use super::kept::{self, Asked};
use super::pattern::{Dimension, MOST_FURTHER, Pattern, Sample};
use super::sampler::{Places, Points, Sampler};
use super::side::Side;
use crate::error::Result;
use crate::user_folder;

/// The samples of one basis. Member `i` is sample `i` and its copies in all bases: a regular grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    pub sides: [Side; 2],
    further: Vec<Dimension>,
    points: Points,
    /// Places lie at sixteenths of pixels.
    is_in_sixteenths: bool,
}

impl Basis {
    /// `samples_per_px` times the pixels of a basis, rounded to a whole number of samples, of which there is at least
    /// one.
    ///
    /// `further`: dimensions beside the place, at most `MOST_FURTHER`. Samples that take long are kept in the user's cache folder.
    ///
    /// Errors: a sampler that counts by pixels has no whole number of samples for each (exit code 2).
    pub fn new(
        sides: [Side; 2],
        further: &[Dimension],
        samples_per_px: f64,
        sampler: Sampler,
        places: Places,
        seed: u32,
    ) -> Result<Self> {
        assert!(further.len() <= MOST_FURTHER && samples_per_px > 0.0, "{further:?}, {samples_per_px}");
        let area_px = sides[0].length_px() * sides[1].length_px();
        let count = (samples_per_px * area_px).round().max(1.0) as u32;
        let asked = Asked { sampler, sides, count, dimensions: 2 + further.len(), seed, places };
        let points = kept::points(&asked, user_folder::cache().map(|folder| folder.join("patterns")).as_deref())?;
        Ok(Self { sides, further: further.to_vec(), points, is_in_sixteenths: false })
    }

    /// The same with each sample at the sixteenth of its pixel that is nearest, as hardware has them. The sides are whole.
    pub fn in_sixteenths(self) -> Self {
        assert!(
            self.sides.iter().all(|side| side.whole_px().is_some()),
            "bases begin at parts of pixels: {:?}",
            self.sides
        );
        Self { is_in_sixteenths: true, ..self }
    }

    /// Whether it is such a basis.
    pub fn is_in_sixteenths(&self) -> bool {
        self.is_in_sixteenths
    }

    /// Number of samples of one basis.
    pub fn member_count(&self) -> u32 {
        self.points.len() as u32
    }

    /// Place of a member's sample in the first basis, px from its upper left corner.
    pub fn place_px(&self, member: u32) -> [f64; 2] {
        let point = &self.points[member as usize];
        [0, 1].map(|axis| {
            let length_px = self.sides[axis].length_px();
            let at_px = point[axis] * length_px;
            if !self.is_in_sixteenths {
                return at_px;
            }
            let pixel = at_px.floor().min(length_px - 1.0);
            pixel + (16.0 * (at_px - pixel)).round().min(15.0) / 16.0
        })
    }

    /// The number of 0 to 1 without 1 that a member has in `dimension`; None: it is none of the basis's.
    pub fn number(&self, member: u32, dimension: Dimension) -> Option<f32> {
        let index = self.further.iter().position(|further| *further == dimension)?;
        Some(below_one(self.further_of(member)[index]))
    }

    /// A number of 0 to 1 without 1 for each further dimension.
    fn further_of(&self, member: u32) -> &[f64] {
        &self.points[member as usize][2..]
    }

    /// The pattern that it makes: its period is the least number of whole pixels in which whole bases lie.
    pub fn pattern(&self) -> Pattern {
        let period_px = self.sides.map(|side| side.pixels);
        let [across, down] = self.sides.map(|side| side.bases);
        let bases = (0..down).flat_map(|y| (0..across).map(move |x| [x, y]));
        let samples = bases.flat_map(|base| {
            (0..self.member_count()).map(move |member| {
                let place = self.place_px(member);
                let along = |axis: usize| {
                    let at = place[axis] + f64::from(base[axis]) * self.sides[axis].length_px();
                    let pixel = (at.floor() as u32).min(period_px[axis] - 1);
                    (pixel, below_one(at - f64::from(pixel)))
                };
                let [(x, u), (y, v)] = [along(0), along(1)];
                let further = Sample::further(self.further_of(member).iter().copied().map(below_one));
                ([x, y], Sample { place_px: [u, v], further, subset: member })
            })
        });
        Pattern::new(period_px, &self.further, samples.collect())
    }
}

/// The nearest float that is below 1.
pub fn below_one(number: f64) -> f32 {
    (number as f32).clamp(0.0, 1.0 - f32::EPSILON / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Choice;
    use proptest::prelude::*;

    fn square(text: &str) -> [Side; 2] {
        [Side::from_text(text).unwrap(); 2]
    }

    /// Every sampler's members are regular grids: between two of its samples lie whole bases.
    #[test]
    fn members_are_regular_grids() {
        for sampler in Sampler::ALL {
            let basis = Basis::new(square("3"), &[Dimension::Time], 4.0, *sampler, Places::Spread, 5).unwrap();
            let pattern = basis.pattern();
            assert_eq!((pattern.subset_count(), pattern.samples().len()), (36, 36), "{}", sampler.name());
            assert_eq!(pattern.period_px(), [3, 3]);
        }
        for sampler in Sampler::ALL.iter().filter(|sampler| !sampler.counts_by_pixels()) {
            let basis = Basis::new(square("2.5"), &[], 4.0, *sampler, Places::Spread, 5).unwrap();
            let pattern = basis.pattern();
            assert_eq!((pattern.subset_count(), pattern.samples().len()), (25, 100), "{}", sampler.name());
            assert_eq!(pattern.period_px(), [5, 5]);
            for member in 0..25 {
                let of_member = |(_, sample): &([u32; 2], &Sample)| sample.subset == member;
                let places: Vec<[f64; 2]> = pattern
                    .placed()
                    .filter(of_member)
                    .map(|(pixel, sample)| [0, 1].map(|i| f64::from(pixel[i]) + f64::from(sample.place_px[i])))
                    .collect();
                assert_eq!(places.len(), 4);
                for [x, y] in &places {
                    let apart = [x - places[0][0], y - places[0][1]].map(|apart| apart / 2.5);
                    assert!(apart.iter().all(|bases| (bases - bases.round()).abs() < 1e-6), "{apart:?}");
                }
            }
            // Five rows of five cells lie evenly over pixels: those of `jittered` stay in theirs.
            let [least, most] = pattern.samples_per_pixel();
            assert!(least < most || *sampler == Sampler::Jittered, "{}: 4 a pixel in the mean", sampler.name());
        }
    }

    /// In the middles of pixels every sampler gives each as many, and no two samples of a basis have the same number beside.
    #[test]
    fn in_middles_pixels_have_as_many_samples() {
        for sampler in Sampler::ALL {
            for (side, samples) in [(1, 4), (2, 1), (4, 1), (4, 2)] {
                let basis = Basis::new(
                    [Side::new(side, 1); 2],
                    &[Dimension::Slice],
                    f64::from(samples),
                    *sampler,
                    Places::Middles,
                    5,
                );
                let pattern = basis.unwrap().pattern();
                assert_eq!(pattern.samples_per_pixel(), [samples; 2], "{} {side}", sampler.name());
                assert!(pattern.samples().iter().all(|sample| sample.place_px == [0.5; 2]), "{}", sampler.name());
                let mut slices: Vec<f32> = pattern.samples().iter().map(|sample| sample.further[0]).collect();
                slices.sort_by(f32::total_cmp);
                slices.dedup();
                assert_eq!(slices.len() as u32, side * side * samples, "{}: {slices:?}", sampler.name());
            }
        }
    }

    proptest! {
        /// In sixteenths a sample stays in its pixel, by a thirty-second at most from where it was, but at the last one by a sixteenth.
        #[test]
        fn sixteenths_are_near(seed in any::<u32>(), side in 1u32..5, index in 0..Sampler::ALL.len()) {
            let sides = [Side::new(side, 1); 2];
            let free = Basis::new(sides, &[], 4.0, Sampler::ALL[index], Places::Spread, seed).unwrap();
            let snapped = free.clone().in_sixteenths();
            prop_assert_eq!(free.pattern().samples_per_pixel(), snapped.pattern().samples_per_pixel());
            for member in 0..free.member_count() {
                for (at, near) in free.place_px(member).into_iter().zip(snapped.place_px(member)) {
                    prop_assert_eq!(at.floor(), near.floor());
                    prop_assert_eq!((16.0 * near).fract(), 0.0);
                    let most = if near.fract() == 15.0 / 16.0 { 1.0 / 16.0 } else { 1.0 / 32.0 };
                    prop_assert!((at - near).abs() <= most + 1e-12, "{} {}", at, near);
                }
            }
        }
    }

    #[test]
    fn both_ends_of_the_scale_are_patterns() {
        let one = Basis::new(square("1"), &[], 1.0, Sampler::Relaxed, Places::Spread, 1).unwrap();
        assert_eq!((one.member_count(), one.pattern().samples_per_pixel()), (1, [1, 1]));
        let frame =
            Basis::new([Side::new(13, 1), Side::new(7, 1)], &[], 2.0, Sampler::Random, Places::Spread, 1).unwrap();
        assert_eq!((frame.member_count(), frame.pattern().period_px()), (182, [13, 7]));
        // A sample for two pixels: half of them have none.
        let sparse =
            Basis::new([Side::new(2, 1), Side::new(1, 1)], &[], 0.5, Sampler::Relaxed, Places::Spread, 1).unwrap();
        assert_eq!((sparse.member_count(), sparse.pattern().samples_per_pixel()), (1, [0, 1]));
    }

    proptest! {
        #[test]
        fn a_seed_names_one_pattern(seed in any::<u32>(), index in 0..Sampler::ALL.len()) {
            let make = |seed| Basis::new(square("2"), &[Dimension::LensU, Dimension::LensV], 3.0, Sampler::ALL[index], Places::Spread, seed);
            let pattern = make(seed).unwrap().pattern();
            prop_assert_eq!(&pattern, &make(seed).unwrap().pattern());
            prop_assert_eq!(pattern.dimension_count(), 4);
        }
    }
}
