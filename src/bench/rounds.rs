//! Rounds: every probe once, in the same order, again and again. A B A B.

use super::stats::{median, paired_ratio};
use crate::error::Result;
use crate::gpu::recorded::Recorded;
use crate::interrupt;

/// Something whose time is taken.
pub trait Probe {
    /// Runs it once: milliseconds of its parts, always the same number of them, at least one.
    ///
    /// Errors: the device fails (exit code 4).
    fn measure(&self) -> Result<Vec<f64>>;
}

/// Runs what was recorded with a submit a pass: milliseconds of its last pass, as a probe of one part.
///
/// Errors: the device fails (exit code 4).
pub fn last_pass(recorded: &Recorded) -> Result<Vec<f64>> {
    let frame = recorded.run()?;
    let pass = frame.passes.last().expect("a pass was recorded");
    let ns = pass.figure_ns(recorded.clock()).expect("a submit a pass has a wall time a pass");
    Ok(vec![ns as f64 / 1e6])
}

/// What the rounds found of one probe.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    /// A list of parts for each round, in milliseconds.
    rounds: Vec<Vec<f64>>,
}

impl Samples {
    /// Milliseconds of each round, all parts together.
    pub fn totals_ms(&self) -> Vec<f64> {
        self.rounds.iter().map(|parts| parts.iter().sum()).collect()
    }

    /// Median milliseconds of each part.
    pub fn part_medians_ms(&self) -> Vec<f64> {
        let part_count = self.rounds.first().map_or(0, Vec::len);
        (0..part_count)
            .map(|part| {
                let samples: Vec<f64> = self.rounds.iter().map(|parts| parts[part]).collect();
                median(&samples)
            })
            .collect()
    }
}

/// How many rounds there are.
#[derive(Clone, Copy, Debug)]
pub struct Length {
    /// At least one.
    pub least: usize,
    /// There are more, up to `MOST_TIMES` as many, until the interval of each probe's ratio to the first one is at most this part of
    /// the ratio wide; None: no more.
    pub until_interval: Option<f64>,
}

/// What is not told by so many times the rounds will not be.
pub const MOST_TIMES: usize = 10;

impl Length {
    fn is_enough(&self, rounds: usize, samples: &[Samples]) -> bool {
        let Some(widest) = self.until_interval else { return rounds >= self.least };
        let (first, others) = samples.split_first().expect("at least one probe");
        let first = first.totals_ms();
        let is_told = |probe: &Samples| {
            let ratio = paired_ratio(&probe.totals_ms(), &first);
            ratio.interval.is_some_and(|[low, high]| high - low <= widest * ratio.mean)
        };
        rounds >= MOST_TIMES * self.least || rounds >= self.least && others.iter().all(is_told)
    }
}

/// One round to warm up, which is not kept, then as many as `length` says. `progress` is called with the measurements done, and of
/// how many, as far as that is known.
///
/// Errors: the device fails (exit code 4); interrupted (130): unfinished rounds are worth nothing.
pub fn run(probes: &[&dyn Probe], length: Length, progress: &mut dyn FnMut(usize, usize)) -> Result<Vec<Samples>> {
    let mut samples = vec![Samples::default(); probes.len()];
    for round in 0.. {
        let all = (length.least.max(round) + 1) * probes.len();
        for (index, probe) in probes.iter().enumerate() {
            interrupt::check()?;
            let parts = probe.measure()?;
            if round > 0 {
                samples[index].rounds.push(parts);
            }
            progress(round * probes.len() + index + 1, all);
        }
        if round > 0 && length.is_enough(round, &samples) {
            break;
        }
    }
    Ok(samples)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::{Cell, RefCell};

    struct Noted<'a> {
        name: char,
        log: &'a RefCell<String>,
    }

    impl Probe for Noted<'_> {
        fn measure(&self) -> Result<Vec<f64>> {
            self.log.borrow_mut().push(self.name);
            Ok(vec![self.log.borrow().len() as f64, 1.0])
        }
    }

    #[test]
    fn probes_take_turns_and_the_first_turn_is_not_kept() {
        let log = RefCell::new(String::new());
        let (a, b) = (Noted { name: 'a', log: &log }, Noted { name: 'b', log: &log });
        let mut last = (0, 0);
        let length = Length { least: 3, until_interval: None };
        let samples = run(&[&a, &b], length, &mut |done, all| last = (done, all)).unwrap();
        assert_eq!(*log.borrow(), "abababab");
        assert_eq!(last, (8, 8));
        assert_eq!(samples[0].totals_ms(), [4.0, 6.0, 8.0]);
        assert_eq!(samples[1].part_medians_ms(), [6.0, 1.0]);
    }

    /// Takes what its list says, again and again.
    struct Listed {
        ms: &'static [f64],
        next: Cell<usize>,
    }

    impl Probe for Listed {
        fn measure(&self) -> Result<Vec<f64>> {
            let index = self.next.get();
            self.next.set(index + 1);
            Ok(vec![self.ms[index % self.ms.len()]])
        }
    }

    #[test]
    fn rounds_go_on_until_ratios_are_told() {
        let rounds = |ms: &'static [f64], until_interval: Option<f64>| {
            let of = |ms| Listed { ms, next: Cell::default() };
            let (steady, other) = (of(&[2.0]), of(ms));
            let length = Length { least: 3, until_interval };
            run(&[&steady, &other], length, &mut |_, _| ()).unwrap()[1].totals_ms().len()
        };
        assert_eq!([rounds(&[3.0], Some(0.03)), rounds(&[3.0], None), rounds(&[1.0, 9.0], None)], [3, 3, 3]);
        assert_eq!(rounds(&[1.0, 9.0], Some(0.03)), 30, "noise is not told");
        let some = rounds(&[3.0, 3.1, 2.9], Some(0.03));
        assert!((4..30).contains(&some), "{some}");
    }
}
