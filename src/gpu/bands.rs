//! Frames cut into pieces, so that no submit takes a device longer than it may.
//!
//! Drivers abort submits that run for seconds, and the whole device is lost with them: Windows after two by default. A
//! frame's passes, and bands of the workgroups of its dispatches, are command buffers of their own, as many of which go
//! into a submit as took its time the last time. A band's workgroups have the numbers that they have in the whole
//! dispatch: the picture is the same to the bit.

use std::ops::Range;
use std::time::Duration;

/// Bands of one dispatch at most: where a band takes the two seconds of a watchdog, the dispatch takes four minutes.
const MOST_BANDS: u32 = 128;

/// The first workgroup and the number of workgroups, on each axis, of every band of a dispatch: rows of them, or columns where there is
/// one row.
pub fn bands(groups: [u32; 3]) -> impl Iterator<Item = ([u32; 3], [u32; 3])> {
    let axis = [1, 0, 2].into_iter().find(|axis| groups[*axis] > 1).unwrap_or(1);
    let all = groups[axis];
    let band = all.div_ceil(MOST_BANDS).max(1);
    (0..all.div_ceil(band)).map(move |index| {
        let mut first = [0; 3];
        let mut count = groups;
        first[axis] = index * band;
        count[axis] = band.min(all - first[axis]);
        (first, count)
    })
}

/// What each piece of a frame took in the runs before.
pub struct Estimates {
    limit: Duration,
    /// Nanoseconds; None: it has not run yet.
    pieces_ns: Vec<Option<f64>>,
}

impl Estimates {
    /// `limit`: what a submit may take.
    pub fn new(limit: Duration, piece_count: usize) -> Self {
        Self { limit, pieces_ns: vec![None; piece_count] }
    }

    /// Where a submit ends that begins with the piece `first`, before `end`: one piece at least, and one alone until it
    /// is known what it takes.
    pub fn end_of_submit(&self, first: usize, end: usize) -> usize {
        let limit_ns = self.limit.as_nanos() as f64;
        let mut sum_ns = 0.0;
        for piece in first..end {
            let Some(ns) = self.pieces_ns[piece] else { return piece.max(first + 1) };
            sum_ns += ns;
            if sum_ns > limit_ns {
                return piece.max(first + 1);
            }
        }
        end
    }

    /// How many times all pieces fit into a submit; once until it is known what they take.
    pub fn runs_of_submit(&self) -> u32 {
        let sum_ns: Option<f64> = self.pieces_ns.iter().copied().sum();
        sum_ns.map_or(1, |sum_ns| ((self.limit.as_nanos() as f64 / sum_ns.max(1.0)) as u32).max(1))
    }

    /// These pieces took so long in one submit: each its part of what was expected of them.
    pub fn learn(&mut self, pieces: Range<usize>, took: Duration) {
        let took_ns = took.as_nanos() as f64;
        let expected: Option<f64> = self.pieces_ns[pieces.clone()].iter().copied().sum();
        let even = took_ns / pieces.len() as f64;
        for known in &mut self.pieces_ns[pieces] {
            *known = Some(match (*known, expected) {
                (Some(ns), Some(expected)) if expected > 0.0 => ns * (took_ns / expected),
                _ => even,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::{prop_assert, proptest};

    proptest! {
        /// Every workgroup once, in as few bands as allowed.
        #[test]
        fn bands_are_the_whole_dispatch(x in 1u32..9, y in 1u32..700, z in 1u32..4) {
            for groups in [[x, y, z], [y, x, z], [y, 1, 1], [1, 1, z]] {
                let mut covered = vec![0u32; groups.iter().product::<u32>() as usize];
                let mut count = 0;
                for (first, size) in bands(groups) {
                    count += 1;
                    for z in first[2]..first[2] + size[2] {
                        for y in first[1]..first[1] + size[1] {
                            for x in first[0]..first[0] + size[0] {
                                covered[((z * groups[1] + y) * groups[0] + x) as usize] += 1;
                            }
                        }
                    }
                }
                prop_assert!(covered.iter().all(|times| *times == 1));
                prop_assert!(count <= MOST_BANDS);
            }
        }
    }

    /// A device that takes the same time for a piece in every run: once pieces have run, no submit is longer than the
    /// limit, except for a single piece that is; and none is much shorter than it need be.
    #[test]
    fn submits_come_as_near_to_the_limit_as_pieces_let_them() {
        let takes_ms = [3, 1, 1, 1, 50, 2, 2, 2, 2, 2, 0, 9, 1];
        let took = |pieces: Range<usize>| Duration::from_millis(takes_ms[pieces].iter().sum());
        let mut estimates = Estimates::new(Duration::from_millis(10), takes_ms.len());
        let mut submits: Vec<Vec<Range<usize>>> = Vec::new();
        for _ in 0..3 {
            let mut of_run = Vec::new();
            let mut at = 0;
            while at < takes_ms.len() {
                let end = estimates.end_of_submit(at, takes_ms.len());
                estimates.learn(at..end, took(at..end));
                of_run.push(at..end);
                at = end;
            }
            submits.push(of_run);
        }
        assert_eq!(submits[0].len(), takes_ms.len(), "pieces that nobody knows go alone");
        assert_eq!(submits[1], [0..4, 4..5, 5..11, 11..13]);
        assert_eq!(submits[2], submits[1]);
        assert_eq!(estimates.runs_of_submit(), 1);
        let roomy = Estimates { limit: Duration::from_millis(200), pieces_ns: estimates.pieces_ns.clone() };
        assert_eq!(roomy.runs_of_submit(), 2, "of 76 ms each");
        assert_eq!(Estimates::new(Duration::from_secs(1), 3).runs_of_submit(), 1);
        // It slows down by four: what went together goes apart.
        estimates.learn(0..4, Duration::from_millis(24));
        assert_eq!(estimates.end_of_submit(0, takes_ms.len()), 1);
        assert_eq!(estimates.end_of_submit(1, takes_ms.len()), 3);
    }
}
