//! Periodograms: how much of each frequency a pattern has (Keller and Heidrich 2001, figure 1, shows theirs), or the
//! values of a raster.
//!
//! P(f) = |sum over samples of exp(-2 pi i f p)|^2 / N for N samples at places p of one period: 1 on average for
//! independent samples, N at the multiples of 1 / spacing and 0 elsewhere for a regular grid. The frequencies of what
//! repeats are whole cycles a period.
//!
//! Why this way: samples lie anywhere in their pixels, so a fast transform would need them moved onto a raster; the sum
//! itself is exact, and a period has few enough samples for it.

mod raster;
mod rings;

pub use rings::Ring;

use super::pattern::{Pattern, Sample};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Powers at all whole frequencies around 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Periodogram {
    /// Width and height of what repeats, px: of a pattern's period, or of a raster.
    pub period_px: [u32; 2],
    /// The lowest frequency along x and y is -reach, cycles a period.
    pub reach: [u32; 2],
    /// Numbers of frequencies along x and y.
    size: [u32; 2],
    /// Row by row from frequency -reach of both axes on.
    powers: Vec<f32>,
}

/// Cosine and sine of -2 pi times the cycles at 0 to `most` cycles a period.
fn waves(place: f64, most: u32) -> Vec<[f64; 2]> {
    let wave = |cycles: u32| {
        // Whole cycles fall away before the product is rounded to an angle.
        let (sin, cos) = (-TAU * (place * f64::from(cycles)).fract()).sin_cos();
        [cos, sin]
    };
    (0..=most).map(wave).collect()
}

/// The part of a signal's energy that comes out as an even grey where the signal has the pixel frequency, one cycle a pixel across
/// or down: |sum over samples of exp(-2 pi i p)|^2 / N^2, 1 / N on average for N independent samples of a period. Signals a
/// little finer or coarser come out as moire of so much energy; 0 without samples.
pub fn pixel_frequency(pattern: &Pattern) -> [f64; 2] {
    let samples = pattern.samples();
    [0, 1].map(|axis| {
        let sum = samples.iter().fold([0.0, 0.0], |[real, imaginary], sample| {
            let (sin, cos) = (TAU * f64::from(sample.place_px[axis])).sin_cos();
            [real + cos, imaginary + sin]
        });
        let count = samples.len().max(1) as f64;
        (sum[0] * sum[0] + sum[1] * sum[1]) / (count * count)
    })
}

fn product([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a * c - b * d, a * d + b * c]
}

impl Periodogram {
    /// Steps of the sum that `new` takes: samples times frequencies, of which half follow from the others.
    pub fn steps(sample_count: usize, reach: [u32; 2]) -> u64 {
        sample_count as u64 * (u64::from(reach[0]) * 2 + 1) * (u64::from(reach[1]) + 1)
    }

    /// The powers of the samples of `pattern` for which `is_meant` holds, up to `reach` cycles a period along x and y;
    /// 0 without samples.
    pub fn new(pattern: &Pattern, reach: [u32; 2], is_meant: impl Fn(&Sample) -> bool) -> Self {
        let period_px = pattern.period_px();
        let meant = pattern.placed().filter(|(_, sample)| is_meant(sample));
        let samples: Vec<[Vec<[f64; 2]>; 2]> = meant
            .map(|(pixel, sample)| {
                [0, 1].map(|axis| {
                    let place_px = f64::from(pixel[axis]) + f64::from(sample.place_px[axis]);
                    waves(place_px / f64::from(period_px[axis]), reach[axis])
                })
            })
            .collect();
        let [across, down] = reach.map(|reach| reach as usize);
        let width = 2 * across + 1;
        // Rows of frequencies from 0 down; those above have the same powers, turned around.
        let row = |v: usize| -> Vec<f32> {
            let mut sums = vec![[0.0f64; 2]; width];
            for [along_x, along_y] in &samples {
                for (u, wave) in along_x.iter().enumerate() {
                    let [cos, sin] = *wave;
                    for (index, wave) in [(across + u, [cos, sin]), (across - u, [cos, -sin])] {
                        let [real, imaginary] = product(wave, along_y[v]);
                        sums[index] = [sums[index][0] + real, sums[index][1] + imaginary];
                    }
                }
            }
            // Frequency 0 along x was added twice.
            sums[across] = sums[across].map(|part| part / 2.0);
            let count = samples.len().max(1) as f64;
            sums.iter().map(|[real, imaginary]| ((real * real + imaginary * imaginary) / count) as f32).collect()
        };
        let lower: Vec<Vec<f32>> = (0..=down).into_par_iter().map(row).collect();
        let upper = lower[1..].iter().rev().map(|row| row.iter().rev().copied().collect::<Vec<f32>>());
        let powers = upper.chain(lower.iter().cloned()).flatten().collect();
        Self { period_px, reach, size: reach.map(|reach| 2 * reach + 1), powers }
    }

    /// Numbers of frequencies along x and y: twice the reach and 1 for a pattern, the sides in px for a raster.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Row by row from the lowest frequency of both axes on; 0 is in the middle.
    pub fn powers(&self) -> &[f32] {
        &self.powers
    }

    /// Energy of a raster's frequencies that lie less than `cycles_per_px` from 0, without 0 itself. All together have the variance.
    pub fn energy_below(&self, cycles_per_px: f64) -> f64 {
        let values = f64::from(self.period_px[0]) * f64::from(self.period_px[1]);
        let low = self.by_distance().filter(|(distance, _)| *distance < cycles_per_px);
        low.map(|(_, power)| power).sum::<f64>() / values
    }

    /// Distances from 0, cycles a pixel, and powers of all frequencies but 0.
    fn by_distance(&self) -> impl Iterator<Item = (f64, f64)> {
        self.powers.iter().enumerate().filter_map(|(index, power)| {
            let at = [index as u32 % self.size[0], index as u32 / self.size[0]];
            let [across, down] = [0, 1]
                .map(|axis| (f64::from(at[axis]) - f64::from(self.reach[axis])) / f64::from(self.period_px[axis]));
            (at != self.reach).then(|| (across.hypot(down), f64::from(*power)))
        })
    }

    /// The power at a frequency in cycles a period, each within the reach.
    pub fn power(&self, frequency: [i32; 2]) -> f32 {
        let [column, row] = [0, 1].map(|axis| {
            let (cycles, reach) = (frequency[axis], self.reach[axis]);
            let index = i64::from(cycles) + i64::from(reach);
            assert!((0..i64::from(self.size[axis])).contains(&index), "{cycles} cycles of a reach of {reach}");
            index as usize
        });
        self.powers[row * self.size[0] as usize + column]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pcg::Pcg32;
    use proptest::prelude::*;

    fn everything(_: &Sample) -> bool {
        true
    }

    /// One sample a pixel: N at the multiples of a cycle a pixel and 0 elsewhere. Samples of one subset lie a period
    /// apart, and every whole frequency of theirs has power 1.
    #[test]
    fn a_regular_grid_has_impulses_at_multiples_of_its_inverse_spacing() {
        for sides in [[4, 4], [8, 6], [1, 5]] {
            let grid = Pattern::grid(sides);
            let found = Periodogram::new(&grid, [2 * sides[0], 2 * sides[1]], everything);
            let count = (sides[0] * sides[1]) as f32;
            let [across, down] = sides.map(|side| side as i32);
            for (u, v) in (-2 * across..=2 * across).flat_map(|u| (-2 * down..=2 * down).map(move |v| (u, v))) {
                let expected = if u % across == 0 && v % down == 0 { count } else { 0.0 };
                assert!((found.power([u, v]) - expected).abs() < 1e-9 * count, "{sides:?} at {u}, {v}");
            }
            let alone = Periodogram::new(&grid, sides, |sample| sample.subset == 0);
            assert!(alone.powers().iter().all(|power| (power - 1.0).abs() < 1e-6));
        }
    }

    /// A line of samples 1.5 px apart that fall into pixels of 1 px: impulses at every second of three px, not at the
    /// pixel's own frequency.
    #[test]
    fn a_spacing_that_is_no_whole_number_of_pixels_shows_as_itself() {
        let at = |pixel: u32, place: f32| ([pixel, 0], Sample { place_px: [place, 0.5], ..Sample::middle(pixel) });
        let pattern = Pattern::new([3, 1], &[], vec![at(0, 0.25), at(1, 0.75)]);
        let found = Periodogram::new(&pattern, [6, 0], everything);
        let powers: Vec<f32> = (0..=6).map(|u| found.power([u, 0])).collect();
        for (index, (power, expected)) in powers.iter().zip([2.0, 0.0, 2.0, 0.0, 2.0, 0.0, 2.0]).enumerate() {
            assert!((power - expected).abs() < 1e-9, "{index}: {powers:?}");
        }
    }

    /// Powers of independent samples are near an exponential distribution of mean 1 and variance 1, so the mean of n of
    /// them is 1 within four standard errors of 1 / sqrt(n); half of the frequencies are independent of each other.
    #[test]
    fn white_noise_is_flat_at_one() {
        let mut random = Pcg32::new(5, 0);
        let sample = |subset: u32| {
            let pixel = [random.below(8), random.below(8)];
            (pixel, Sample { place_px: [random.unit(), random.unit()], ..Sample::middle(subset) })
        };
        let pattern = Pattern::new([8, 8], &[], (0..256).map(sample).collect());
        let found = Periodogram::new(&pattern, [24, 24], everything);
        let mean = |meant: &dyn Fn(i32) -> bool| {
            let all = (-24..=24).flat_map(|u| (-24..=24).map(move |v| [u, v]));
            let powers: Vec<f64> = all
                .filter(|[u, v]| (*u, *v) != (0, 0) && meant(u * u + v * v))
                .map(|frequency| f64::from(found.power(frequency)))
                .collect();
            (powers.iter().sum::<f64>() / powers.len() as f64, powers.len() as f64 / 2.0)
        };
        let rings: [&dyn Fn(i32) -> bool; 3] = [&|_| true, &|radius| radius < 100, &|radius| radius > 400];
        for ring in rings {
            let (mean, independent) = mean(ring);
            assert!((mean - 1.0).abs() < 4.0 / independent.sqrt(), "{mean} of {independent}");
        }
        assert!((found.power([0, 0]) - 256.0).abs() < 1e-3);
    }

    proptest! {
        /// Mirrored at 0, and the same as the sum written plainly.
        #[test]
        fn it_is_the_sum_at_every_frequency(places in prop::collection::vec((0f32..1.0, 0f32..1.0), 1..9)) {
            let sample = |(index, (x, y)): (usize, (f32, f32))| {
                ([index as u32 % 3, 0], Sample { place_px: [x, y], ..Sample::middle(index as u32) })
            };
            let pattern = Pattern::new([3, 1], &[], places.into_iter().enumerate().map(sample).collect());
            let found = Periodogram::new(&pattern, [4, 3], everything);
            prop_assert_eq!(found.powers().len(), 9 * 7);
            for (u, v) in (-4..=4).flat_map(|u| (-3..=3).map(move |v| (u, v))) {
                let parts = pattern.placed().map(|([x, y], sample)| {
                    let across = (f64::from(x) + f64::from(sample.place_px[0])) / 3.0;
                    let down = f64::from(y) + f64::from(sample.place_px[1]);
                    -TAU * (f64::from(u) * across + f64::from(v) * down)
                });
                let [real, imaginary] =
                    parts.fold([0.0, 0.0], |[real, imaginary], angle| [real + angle.cos(), imaginary + angle.sin()]);
                let expected = (real * real + imaginary * imaginary) / pattern.samples().len() as f64;
                prop_assert!((f64::from(found.power([u, v])) - expected).abs() < 1e-5 * expected.max(1.0), "{u} {v}");
                prop_assert_eq!(found.power([u, v]), found.power([-u, -v]));
            }
            let count = pattern.samples().len() as f64;
            for (part, power) in pixel_frequency(&pattern).into_iter().zip([found.power([3, 0]), found.power([0, 1])]) {
                prop_assert!((part - f64::from(power) / count).abs() < 1e-6);
            }
        }
    }
}
