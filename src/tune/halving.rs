//! Successive halving (Jamieson and Talwalkar 2016, "Non-stochastic Best Arm Identification and Hyperparameter Optimization"): all
//! candidates are measured a little, the better ones more and more often. Here a rung keeps a quarter and measures twice as many rounds,
//! so that each rung costs half of the one before.

use crate::bench::stats::median;
use crate::error::Result;
use serde::Serialize;
use std::collections::BTreeMap;

/// A rung keeps one of so many.
const KEPT_OF: usize = 4;
/// Rounds of the first rung, and of no other.
pub const FIRST_ROUNDS: usize = 1;

/// The one who measures.
pub trait Trial {
    /// Times of candidates in parts of the baseline's of the same round, one for each of `rounds`: of those that can be measured, and for
    /// which there is time.
    ///
    /// Errors: the device fails (exit code 4); interrupted (130).
    fn ratios(&mut self, candidates: &[usize], rounds: usize) -> Result<Vec<(usize, Vec<f64>)>>;
}

/// What a rung came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rung {
    /// Those that were measured.
    pub candidates: usize,
    /// Rounds of each.
    pub rounds: usize,
    /// Those that go on.
    pub kept: usize,
    /// Time of the fastest in parts of the baseline's: the median of all its rounds so far.
    pub best_ratio: f64,
}

/// The fastest few of `drawn`, the fastest first, at most `finalists` of them, and how they were found. `known`: ratios of rounds that
/// were measured before. None are found where nothing could be measured.
///
/// Errors: as `Trial::ratios`.
pub fn halve(
    drawn: &[usize],
    finalists: usize,
    known: &mut BTreeMap<usize, Vec<f64>>,
    trial: &mut dyn Trial,
) -> Result<(Vec<usize>, Vec<Rung>)> {
    let unknown: Vec<usize> = drawn.iter().copied().filter(|place| !known.contains_key(place)).collect();
    known.extend(trial.ratios(&unknown, FIRST_ROUNDS)?);
    let mut left: Vec<usize> = drawn.iter().copied().filter(|place| known.contains_key(place)).collect();
    let (mut rungs, mut rounds, mut measured) = (Vec::new(), FIRST_ROUNDS, left.len());
    while !left.is_empty() {
        left.sort_by(|a, b| median(&known[a]).total_cmp(&median(&known[b])));
        let candidates = left.len();
        let is_last = candidates <= finalists;
        left.truncate(finalists.max(candidates.div_ceil(KEPT_OF)));
        rungs.push(Rung { candidates: measured, rounds, kept: left.len(), best_ratio: median(&known[&left[0]]) });
        if is_last {
            break;
        }
        rounds *= 2;
        let found = trial.ratios(&left, rounds)?;
        measured = found.len();
        // Those for which there was no time keep what they have.
        for (place, ratios) in found {
            known.entry(place).or_default().extend(ratios);
        }
        if measured == 0 {
            break;
        }
    }
    left.truncate(finalists);
    Ok((left, rungs))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pcg::Pcg32;

    /// Candidates of known times, measured with noise.
    struct Noisy {
        true_ratios: Vec<f64>,
        noise: f32,
        pcg: Pcg32,
        measured: usize,
        /// Measurements for which there is time.
        most: usize,
    }

    impl Noisy {
        fn new(true_ratios: Vec<f64>, noise: f32, seed: u64) -> Self {
            Self { true_ratios, noise, pcg: Pcg32::new(seed, 1), measured: 0, most: usize::MAX }
        }
    }

    impl Trial for Noisy {
        fn ratios(&mut self, candidates: &[usize], rounds: usize) -> Result<Vec<(usize, Vec<f64>)>> {
            let mut found = Vec::new();
            for place in candidates {
                if self.measured + rounds > self.most {
                    break;
                }
                self.measured += rounds;
                let sample = |pcg: &mut Pcg32| 1.0 + f64::from(pcg.between(-self.noise, self.noise));
                let ratios = (0..rounds).map(|_| self.true_ratios[*place] * sample(&mut self.pcg)).collect();
                found.push((*place, ratios));
            }
            Ok(found)
        }
    }

    /// Times like those of a sweep: a few factors, each of which costs some percent more than the best.
    fn grid() -> Vec<f64> {
        let mut ratios = Vec::new();
        for split in [1.0, 1.1, 1.4, 2.0, 3.5] {
            for block in [1.0, 1.02, 1.08, 1.3] {
                for texels in [1.0, 1.05, 1.2, 1.5] {
                    for workgroup in [1.0, 1.01, 1.15] {
                        ratios.push(0.5 * split * block * texels * workgroup);
                    }
                }
            }
        }
        ratios
    }

    #[test]
    fn what_it_finds_is_within_a_tenth_of_the_best_although_times_are_noisy() {
        let all: Vec<usize> = (0..grid().len()).collect();
        let (mut worst, mut measured) = (1.0_f64, 0);
        for seed in 0..50 {
            let mut trial = Noisy::new(grid(), 0.1, seed);
            let (found, rungs) = halve(&all, 4, &mut BTreeMap::new(), &mut trial).unwrap();
            assert_eq!(found.len(), 4);
            worst = worst.max(grid()[found[0]] / 0.5);
            measured = trial.measured;
            let sizes: Vec<[usize; 3]> = rungs.iter().map(|rung| [rung.candidates, rung.rounds, rung.kept]).collect();
            assert_eq!(sizes, [[240, 1, 60], [60, 2, 15], [15, 4, 4], [4, 8, 4]]);
        }
        assert!(worst < 1.1, "{worst}");
        assert_eq!(measured, 240 + 120 + 60 + 32);
    }

    #[test]
    fn without_noise_the_fastest_is_first() {
        let ratios = vec![0.9, 0.3, 0.8, 0.7, 0.31, 0.6];
        let mut trial = Noisy::new(ratios, 0.0, 1);
        let mut known = [(4, vec![0.31])].into();
        let (found, rungs) = halve(&[0, 1, 2, 3, 4, 5], 2, &mut known, &mut trial).unwrap();
        assert_eq!((found, rungs[0].candidates), (vec![1, 4], 6));
        // What was known was not measured again in the first rung.
        assert_eq!(known[&4].len(), 1 + 2);
    }

    #[test]
    fn where_time_is_over_the_best_so_far_is_found() {
        let mut trial = Noisy { most: 3, ..Noisy::new(vec![0.9, 0.5, 0.7, 0.1], 0.0, 1) };
        let (found, rungs) = halve(&[0, 1, 2, 3], 1, &mut BTreeMap::new(), &mut trial).unwrap();
        // The last one was never measured.
        assert_eq!((found, rungs.len()), (vec![1], 1));
        let mut none = Noisy { most: 0, ..Noisy::new(vec![0.9], 0.0, 1) };
        assert_eq!(halve(&[0], 1, &mut BTreeMap::new(), &mut none).unwrap(), (vec![], vec![]));
    }
}
