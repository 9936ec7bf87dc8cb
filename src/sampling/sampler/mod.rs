//! Samplers: ways to spread points over a basis pattern that repeats, and over time and the lens.
//!
//! Keller and Heidrich 2001, section 2.2, relax points until they are blue noise. The others are what it is compared with,
//! and what came after it. Some spread points over the whole basis; those that count by pixels give each pixel the same
//! number, and need a basis of whole pixels.
//!
//! No number here comes from a function that machines round differently: sums, products, quotients and roots alone, so
//! that a seed makes the same bytes everywhere.

mod blue_noise_errors;
mod gradient_noise;
mod jittered;
mod mask;
mod over;
mod random;
pub mod recurrence;
mod relaxed;
mod sobol;
mod swaps;
mod torus;

use super::side::Side;
use crate::choice::choices;
use crate::error::{Error, Result};
use over::{Over, PixelGrid, part};
pub use over::{Places, Points};

choices! {
    /// How the samples of a basis pattern are spread (`--sampler`).
    pub enum Sampler {
        /// Blue noise by relaxation over the basis, which tiles.
        "relaxed" => Relaxed,
        /// One scrambled Sobol sequence, pixel by pixel.
        "sobol" => Sobol,
        /// The sequence of the generalised golden ratio (Roberts 2018), pixel by pixel.
        "r2" => R2,
        /// One place in each of equal cells.
        "jittered" => Jittered,
        /// Independent.
        "random" => Random,
        /// The same sequence in all pixels, turned by interleaved gradient noise (Jimenez 2014).
        "ign" => Ign,
        /// The same sequence in all pixels, turned by masks of blue noise (Ulichney 1993).
        "void-and-cluster" => VoidAndCluster,
        /// A Sobol sequence for each pixel, exchanged until errors of neighbours differ (Heitz and others 2019).
        "blue-errors" => BlueErrors,
    }
}

impl Sampler {
    /// Whether each pixel of a basis has the same number of samples, so that the basis has whole sides.
    pub fn counts_by_pixels(self) -> bool {
        matches!(self, Self::Ign | Self::VoidAndCluster | Self::BlueErrors)
    }

    /// `count` points of `dimensions` numbers, at least 2, over a basis of these sides.
    ///
    /// Those of `Places::Counted`, and of samplers that count by pixels, stand pixel by pixel, row-major.
    ///
    /// Errors: a sampler that counts by pixels has sides that are not whole, or a count that is not the same for every
    /// pixel (exit code 2).
    pub fn points(self, sides: [Side; 2], count: u32, dimensions: usize, seed: u32, places: Places) -> Result<Points> {
        let over = Over { sides_px: sides.map(Side::length_px), count, dimensions, seed };
        let pixels = PixelGrid::of(sides, count);
        assert!(pixels.is_some() || places != Places::Counted, "{count} over {sides:?}");
        if self.counts_by_pixels() && pixels.is_none() {
            let [width, height] = over.sides_px;
            let why = format!(
                "--sampler {}: it gives every pixel the same number of samples, and {count} over {width}x{height} pixels are no such number",
                self.name()
            );
            return Err(Error::request(why)
                .note("a basis of whole pixels and a whole number of samples a pixel work, as do relaxed and sobol"));
        }
        // The others take the basis for one cell.
        let grid = pixels.unwrap_or(PixelGrid { sides: [1, 1], samples: count });
        let mut points = match self {
            Self::Relaxed => relaxed::points(&over, pixels, places),
            Self::Random => random::points(&over, pixels, places),
            Self::Sobol => sobol::points(&over, &grid),
            Self::R2 => recurrence::points(&over, &grid),
            Self::Jittered => jittered::points(&over, &grid),
            Self::Ign => gradient_noise::points(&over, &grid),
            Self::VoidAndCluster => mask::points(&over, &grid),
            Self::BlueErrors => blue_noise_errors::points(&over, &grid),
        };
        if places == Places::Middles {
            for point in &mut points {
                for (along, side_px) in point.iter_mut().zip(over.sides_px) {
                    *along = part(((*along * side_px).floor() + 0.5) / side_px);
                }
            }
        }
        Ok(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Choice;
    use proptest::prelude::*;

    proptest! {
        /// Whatever spreads them: as many points as asked for, each number in its range.
        #[test]
        fn points_are_as_many_as_asked_for(
            index in 0..Sampler::ALL.len(), sides in (1u32..5, 1u32..5), samples in 1u32..7, dimensions in 2usize..9,
            seed in any::<u32>(),
        ) {
            let (sampler, sides) = (Sampler::ALL[index], [sides.0, sides.1].map(|side| Side::new(side, 1)));
            let count = samples * sides[0].pixels * sides[1].pixels;
            let points = sampler.points(sides, count, dimensions, seed, Places::Spread).unwrap();
            prop_assert_eq!(points.len(), count as usize);
            for point in &points {
                prop_assert_eq!(point.len(), dimensions);
                prop_assert!(point.iter().all(|number| (0.0..1.0).contains(number)), "{:?}", point);
            }
            // Those that go by pixels give each the same number, and all do where they are asked to.
            let counted = sampler.points(sides, count, dimensions, seed, Places::Counted).unwrap();
            let by_pixels = !matches!(sampler, Sampler::Relaxed | Sampler::Random);
            for points in [Some(&counted), by_pixels.then_some(&points)].into_iter().flatten() {
                let mut counts = vec![0; (sides[0].pixels * sides[1].pixels) as usize];
                for (index, point) in points.iter().enumerate() {
                    let [x, y] = [0, 1].map(|axis| (point[axis] * f64::from(sides[axis].pixels)) as u32);
                    let pixel = (y * sides[0].pixels + x) as usize;
                    prop_assert_eq!(pixel, index / samples as usize, "{}: {:?}", sampler.name(), point);
                    counts[pixel] += 1;
                }
                prop_assert!(counts.iter().all(|count| *count == samples), "{}: {:?}", sampler.name(), counts);
            }
        }
    }

    #[test]
    fn what_counts_by_pixels_refuses_other_counts() {
        for sampler in Sampler::ALL {
            for (sides, count) in [([Side::new(5, 2), Side::new(2, 1)], 20), ([Side::new(2, 1); 2], 7)] {
                match sampler.points(sides, count, 2, 1, Places::Spread) {
                    Ok(points) => assert!(!sampler.counts_by_pixels() && points.len() == count as usize),
                    Err(error) => {
                        assert!(sampler.counts_by_pixels());
                        assert!(error.to_string().contains(sampler.name()), "{error}");
                    }
                }
            }
        }
    }

    /// The error of a mean over time and place falls faster than that of independent samples wherever points are spread.
    #[test]
    fn all_but_random_ones_are_spread_in_every_dimension() {
        let rms = |sampler: Sampler, places: Places, axis: usize| {
            let error = |seed: u32| {
                let points = sampler.points([Side::new(2, 1); 2], 64, 3, seed, places).unwrap();
                let below = points.iter().filter(|point| point[axis] < 0.37).count();
                (below as f64 / 64.0 - 0.37).powi(2)
            };
            ((0..24).map(error).sum::<f64>() / 24.0).sqrt()
        };
        for sampler in Sampler::ALL {
            for (axis, places) in (0..3).flat_map(|axis| [(axis, Places::Spread), (axis, Places::Counted)]) {
                let (rms, independent) = (rms(*sampler, places, axis), (0.37f64 * 0.63 / 64.0).sqrt());
                let is_random = *sampler == Sampler::Random;
                let bound = if is_random { 1.5 } else { 0.75 } * independent;
                assert!(rms < bound && (!is_random || rms > 0.6 * independent), "{} {axis}: {rms}", sampler.name());
            }
        }
    }
}
