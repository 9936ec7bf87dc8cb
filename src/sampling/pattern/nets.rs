//! Places, lenses and times of one scrambled Sobol sequence over the pixels of a period: aligned stretches of it are
//! nets, so that a pixel's samples are as well spread as all of them. `deep_shading` has them as its tuples (Clarberg
//! and Munkberg 2014, section 4.2).

use super::{Dimension, Pattern, Sample};
use crate::sampling::sobol;

impl Pattern {
    /// `samples` at each pixel of the period, with time and lens; each is a subset of its own, and they count pixel by
    /// pixel.
    ///
    /// `run`: another part of the sequence for each set of samples that a picture sums. A single sample of the first
    /// run lies in the middle of its pixel.
    pub fn nets(period_px: [u32; 2], samples: u32, seed: u32, run: u32) -> Self {
        let count = period_px[0] * period_px[1] * samples;
        let pair = |index: u32, purpose: u32| {
            let seed = sobol::pair_seed(sobol::pixel_seed([0, 0], seed), purpose);
            sobol::pair(run.wrapping_mul(count).wrapping_add(index), seed)
        };
        let sample = |subset: u32| {
            let place_px = if count == 1 && run == 0 { [0.5, 0.5] } else { pair(subset, 0) };
            let [lens_u, lens_v] = pair(subset, 1);
            let [time, _] = pair(subset, 2);
            let cell = subset / samples;
            let further = Sample::further([time, lens_u, lens_v]);
            ([cell % period_px[0], cell / period_px[0]], Sample { place_px, further, subset })
        };
        Self::new(period_px, &[Dimension::Time, Dimension::LensU, Dimension::LensV], (0..count).map(sample).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What each pixel holds is a net by itself: of eight samples, one in each eighth of its width, height and time.
    #[test]
    fn samples_of_a_pixel_are_evenly_spread() {
        let pattern = Pattern::nets([2, 2], 8, 7, 1);
        for pixel in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let numbers: [fn(&Sample) -> f32; 3] =
                [|sample| sample.place_px[0], |sample| sample.place_px[1], |sample| sample.further[0]];
            for number in numbers {
                let mut eighths: Vec<u32> =
                    pattern.samples_of(pixel).iter().map(|sample| (number(sample) * 8.0) as u32).collect();
                eighths.sort_unstable();
                assert_eq!(eighths, (0..8).collect::<Vec<_>>());
            }
        }
        assert_ne!(pattern, Pattern::nets([2, 2], 8, 7, 2));
        assert_eq!(Pattern::nets([1, 1], 1, 7, 0).samples()[0].place_px, [0.5; 2]);
    }

    /// Each purpose has pairs of its own, and each run a stretch of its own.
    #[test]
    fn numbers_are_those_of_the_sequence() {
        let pair = |index, purpose| sobol::pair(index, sobol::pair_seed(sobol::pixel_seed([0, 0], 7), purpose));
        for (index, sample) in (3 * 32..).zip(Pattern::nets([2, 2], 8, 7, 3).samples()) {
            assert_eq!(sample.place_px, pair(index, 0));
            assert_eq!([sample.further[1], sample.further[2]], pair(index, 1));
            assert_eq!(sample.further[0], pair(index, 2)[0]);
        }
    }
}
