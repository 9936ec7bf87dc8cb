//! Drawn machines: how much two passes gain over one, at which pattern more, and which block is regretted least.

use super::case::Case;
use super::machine::Machine;
use super::stage::{cost, total};
use crate::error::Result;
use crate::interrupt;
use crate::report::spread::median;
use crate::techniques::interleaved_deferred::split_method::{Form, Split, StorageKind};
use crate::units::Extent;
use serde::Serialize;

/// Patterns whose gains are compared, those of the paper's sections 3.3 and 5.
const PATTERNS: [[u32; 2]; 2] = [[2, 2], [4, 4]];

/// What is asked for.
pub struct Request<'a> {
    pub extent: Extent,
    pub blocks: &'a [[u32; 2]],
    pub form: Form,
    pub storage: StorageKind,
    pub workgroup: [u32; 2],
    pub machines: u64,
    pub seed: u64,
}

/// What a machine came to, at each of `PATTERNS`.
#[derive(Clone, Debug, Serialize)]
pub struct Drawn {
    pub machine: Machine,
    /// Cost of one pass in parts of that of two with the best block, split and gather together.
    pub gains: [f64; 2],
    /// Cost of two passes with each block in parts of that of the best.
    pub regrets: [Vec<f64>; 2],
}

/// All machines; `step` is told of each.
///
/// Errors: a block or a size cannot be (exit code 2); interrupted (130).
pub fn drawn(request: &Request<'_>, step: &mut dyn FnMut(u64)) -> Result<Vec<Drawn>> {
    let case = |split, pattern, block| {
        let Request { extent, form, storage, workgroup, .. } = *request;
        Case { extent, split, pattern, block, form, storage, workgroup }.checked()
    };
    let mut all = Vec::new();
    for number in 0..request.machines {
        interrupt::check()?;
        let machine = Machine::drawn(request.seed, number);
        let of = |case: Case| {
            let found = case.counted(&machine);
            cost(&total(&found.split), &machine) + cost(&total(&found.gather), &machine)
        };
        let (mut gains, mut regrets) = ([0.0; 2], [Vec::new(), Vec::new()]);
        for (index, pattern) in PATTERNS.into_iter().enumerate() {
            let one = of(case(Split::OnePass, pattern, pattern)?);
            let two = request.blocks.iter().map(|block| Ok(of(case(Split::TwoPass, pattern, *block)?)));
            let two = two.collect::<Result<Vec<f64>>>()?;
            let best = two.iter().copied().fold(f64::INFINITY, f64::min);
            gains[index] = one / best;
            regrets[index] = two.iter().map(|cost| cost / best).collect();
        }
        all.push(Drawn { machine, gains, regrets });
        step(number + 1);
    }
    Ok(all)
}

/// What all of them say.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    pub machines: usize,
    /// Share of the machines on which two passes cost less than one, at 2x2 and at 4x4.
    pub two_passes_win: [f64; 2],
    /// Share on which the gain of two passes is larger at 4x4 than at 2x2.
    pub gain_grows: f64,
    /// The least, the median and the greatest gain at each pattern.
    pub gains: [[f64; 3]; 2],
    /// Mean regret of each block at each pattern: cost in parts of the best block's, less one.
    pub mean_regrets: [Vec<f64>; 2],
}

impl Summary {
    /// `all`: at least one.
    pub fn of(all: &[Drawn]) -> Self {
        let count = all.len() as f64;
        let share = |is: &dyn Fn(&Drawn) -> bool| all.iter().filter(|one| is(one)).count() as f64 / count;
        let gains = |index: usize| {
            let mut gains: Vec<f64> = all.iter().map(|one| one.gains[index]).collect();
            gains.sort_by(f64::total_cmp);
            [gains[0], median(&gains), gains[gains.len() - 1]]
        };
        let blocks = all[0].regrets[0].len();
        let regret =
            |index: usize, block: usize| all.iter().map(|one| one.regrets[index][block] - 1.0).sum::<f64>() / count;
        Self {
            machines: all.len(),
            two_passes_win: [0, 1].map(|index| share(&|one| one.gains[index] > 1.0)),
            gain_grows: share(&|one| one.gains[1] > one.gains[0]),
            gains: [0, 1].map(gains),
            mean_regrets: [0, 1].map(|index| (0..blocks).map(|block| regret(index, block)).collect()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_says_the_same_and_a_summary_adds_up() {
        let request = Request {
            extent: Extent::new(64, 32),
            blocks: &[[8, 8], [16, 16]],
            form: Form::Pull,
            storage: StorageKind::Image,
            workgroup: [16, 16],
            machines: 6,
            seed: 1,
        };
        let mut steps = Vec::new();
        let all = drawn(&request, &mut |done| steps.push(done)).unwrap();
        assert_eq!((all.len(), steps), (6, vec![1, 2, 3, 4, 5, 6]));
        let again = drawn(&request, &mut |_| {}).unwrap();
        for (one, other) in all.iter().zip(&again) {
            assert_eq!((one.gains, &one.regrets), (other.gains, &other.regrets));
            // The best block is regretted by none.
            assert!(one.regrets.iter().all(|regrets| regrets.iter().copied().fold(f64::INFINITY, f64::min) == 1.0));
        }
        let summary = Summary::of(&all);
        let wins = all.iter().filter(|one| one.gains[0] > 1.0).count() as f64;
        assert_eq!((summary.machines, summary.two_passes_win[0]), (6, wins / 6.0));
        assert!(summary.gains.iter().all(|[least, median, most]| least <= median && median <= most));
    }
}
