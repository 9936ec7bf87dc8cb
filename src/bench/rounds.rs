//! Rounds: every probe once, in the same order, again and again. A B A B.

use super::stats::median;
use crate::error::Result;
use crate::interrupt;

/// Something whose time is taken.
pub trait Probe {
    /// Runs it once: milliseconds of its parts, always the same number of them, at least one.
    ///
    /// Errors: the device fails (exit code 4).
    fn measure(&self) -> Result<Vec<f64>>;
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

/// One round to warm up, which is not kept, then `repeat` rounds. `progress` is called with the measurements done, and
/// of how many.
///
/// Errors: the device fails (exit code 4); interrupted (130): unfinished rounds are worth nothing.
pub fn run(probes: &[&dyn Probe], repeat: usize, progress: &mut dyn FnMut(usize, usize)) -> Result<Vec<Samples>> {
    let mut samples = vec![Samples::default(); probes.len()];
    let all = (repeat + 1) * probes.len();
    for round in 0..=repeat {
        for (index, probe) in probes.iter().enumerate() {
            interrupt::check()?;
            let parts = probe.measure()?;
            if round > 0 {
                samples[index].rounds.push(parts);
            }
            progress(round * probes.len() + index + 1, all);
        }
    }
    Ok(samples)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

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
        let samples = run(&[&a, &b], 3, &mut |done, all| last = (done, all)).unwrap();
        assert_eq!(*log.borrow(), "abababab");
        assert_eq!(last, (8, 8));
        assert_eq!(samples[0].totals_ms(), [4.0, 6.0, 8.0]);
        assert_eq!(samples[1].part_medians_ms(), [6.0, 1.0]);
    }
}
