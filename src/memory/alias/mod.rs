//! Lifetimes to shared offsets: resources that never live in the same pass may lie in the same bytes. Numbers only.
//!
//! This is dynamic storage allocation with all requests known beforehand. It is NP-hard, frames are small: a greedy
//! answer (`greedy.rs`), and an exact one by branch and bound (`optimal.rs`). A pass is one moment: a resource whose last
//! pass is another's first one lives beside it.

use crate::choice::choices;
pub use span::Span;
use span::{one_after_the_other, total_bytes};
mod greedy;
mod optimal;
mod span;

choices! {
    /// How hard to look for bytes to share (`--alias`).
    #[derive(Default)]
    pub enum Mode {
        /// The best of a few orders.
        "greedy" => Greedy,
        /// The least sum, or the best found when a fixed number of steps is spent.
        "optimal" => Optimal,
        /// Nobody shares.
        #[default]
        "off" => Off,
    }
}

/// Where each span lies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placement {
    /// First byte of each span, in the order of the spans.
    pub offsets: Vec<u64>,
    /// The greatest end: what the shared memory must hold.
    pub total_bytes: u64,
    /// The greatest sum of bytes alive in one pass: no placement is smaller.
    pub lower_bound_bytes: u64,
    /// No placement is smaller than this one: it meets the bound, or the search went through all others.
    pub proven_optimal: bool,
}

/// Places every span so that no two that meet in time overlap in bytes. The same spans give the same placement.
///
/// Panics where a span ends before it begins, or an alignment is no power of two.
pub fn place(spans: &[Span], mode: Mode) -> Placement {
    for (index, span) in spans.iter().enumerate() {
        assert!(span.first <= span.last, "span {index} ends before it begins: {span:?}");
        assert!(span.alignment.is_power_of_two(), "span {index}: the alignment is no power of two: {span:?}");
    }
    let lower_bound_bytes = lower_bound_bytes(spans);
    let (offsets, is_searched_through) = match mode {
        Mode::Off => (one_after_the_other(spans), false),
        Mode::Greedy => (greedy::offsets(spans), false),
        Mode::Optimal => optimal::offsets(spans, greedy::offsets(spans)),
    };
    let total_bytes = total_bytes(spans, &offsets);
    let proven_optimal = is_searched_through || total_bytes == lower_bound_bytes;
    Placement { offsets, total_bytes, lower_bound_bytes, proven_optimal }
}

/// For each span, those that ended before it began and held some of its bytes: their accesses must end before it
/// writes. In ascending order.
///
/// All of them, not only the last: a barrier after one of two earlier owners does not wait for the other.
pub fn predecessors(spans: &[Span], placement: &Placement) -> Vec<Vec<usize>> {
    assert_eq!(spans.len(), placement.offsets.len(), "a placement of other spans");
    let range = |index: usize| (placement.offsets[index], placement.offsets[index] + spans[index].bytes);
    (0..spans.len())
        .map(|index| {
            let (start, end) = range(index);
            let held_before = |other: &usize| {
                let (other_start, other_end) = range(*other);
                spans[*other].last < spans[index].first && other_start.max(start) < other_end.min(end)
            };
            (0..spans.len()).filter(held_before).collect()
        })
        .collect()
}

fn lower_bound_bytes(spans: &[Span]) -> u64 {
    // The sum of live bytes only rises where a span begins.
    let alive = |pass: usize| {
        spans.iter().filter(|span| (span.first..=span.last).contains(&pass)).map(|span| span.bytes).sum::<u64>()
    };
    spans.iter().map(|span| alive(span.first)).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn spans(most: usize, most_bytes: u64, most_power: u32) -> impl Strategy<Value = Vec<Span>> {
        let span = (1..=most_bytes, 0..=most_power, 0usize..10, 0usize..5).prop_map(|(bytes, power, first, length)| {
            Span { bytes, alignment: 1 << power, first, last: first + length }
        });
        prop::collection::vec(span, 0..=most)
    }

    fn require_possible(spans: &[Span], placement: &Placement) -> Result<(), TestCaseError> {
        prop_assert_eq!(placement.offsets.len(), spans.len());
        for (index, (span, offset)) in spans.iter().zip(&placement.offsets).enumerate() {
            prop_assert_eq!(offset % span.alignment, 0, "alignment of {}", index);
            prop_assert!(offset + span.bytes <= placement.total_bytes);
            for (other, other_offset) in spans.iter().zip(&placement.offsets).take(index) {
                let apart = offset + span.bytes <= *other_offset || other_offset + other.bytes <= *offset;
                prop_assert!(
                    !span.meets(other) || apart,
                    "{:?} at {} and {:?} at {}",
                    span,
                    offset,
                    other,
                    other_offset
                );
            }
        }
        prop_assert!(placement.total_bytes >= placement.lower_bound_bytes);
        Ok(())
    }

    /// Whether the spans from `offsets.len()` on fit below `total`, every offset tried.
    fn fits_below(spans: &[Span], offsets: &mut Vec<u64>, total: u64) -> bool {
        let Some(span) = spans.get(offsets.len()) else { return true };
        for offset in (0..=total.saturating_sub(span.bytes)).step_by(span.alignment as usize) {
            let apart = spans.iter().zip(offsets.iter()).all(|(other, start)| {
                !span.meets(other) || offset + span.bytes <= *start || start + other.bytes <= offset
            });
            if apart && offset + span.bytes <= total {
                offsets.push(offset);
                let fits = fits_below(spans, offsets, total);
                offsets.pop();
                if fits {
                    return true;
                }
            }
        }
        false
    }

    proptest! {
        #[test]
        fn spans_that_meet_never_overlap_and_harder_looking_never_costs_bytes(spans in spans(14, 5000, 8)) {
            let [off, greedy, optimal] = [Mode::Off, Mode::Greedy, Mode::Optimal].map(|mode| place(&spans, mode));
            for placement in [&off, &greedy, &optimal] {
                require_possible(&spans, placement)?;
            }
            prop_assert!(greedy.total_bytes <= off.total_bytes);
            prop_assert!(optimal.total_bytes <= greedy.total_bytes);
            prop_assert_eq!(&place(&spans, Mode::Optimal), &optimal, "the same spans, the same placement");
            prop_assert!(predecessors(&spans, &off).iter().all(Vec::is_empty));
        }

        #[test]
        fn no_placement_is_smaller_than_an_optimal_one(spans in spans(5, 7, 2)) {
            let optimal = place(&spans, Mode::Optimal);
            prop_assert!(optimal.proven_optimal);
            if optimal.total_bytes > 0 {
                prop_assert!(!fits_below(&spans, &mut Vec::new(), optimal.total_bytes - 1), "{:?}", optimal);
            }
        }

        #[test]
        fn predecessors_are_all_earlier_owners_of_a_byte(spans in spans(12, 40, 2)) {
            let placement = place(&spans, Mode::Greedy);
            let found = predecessors(&spans, &placement);
            // Byte by byte: who wrote it before.
            for (index, span) in spans.iter().enumerate() {
                let mut owners: Vec<usize> = (0..spans.len())
                    .filter(|other| {
                        let start = placement.offsets[*other];
                        let held = |byte: u64| (start..start + spans[*other].bytes).contains(&byte);
                        let own = placement.offsets[index];
                        spans[*other].last < span.first && (own..own + span.bytes).any(held)
                    })
                    .collect();
                owners.sort_unstable();
                prop_assert_eq!(&found[index], &owners);
            }
        }
    }

    fn span(bytes: u64, first: usize, last: usize) -> Span {
        Span { bytes, alignment: 1, first, last }
    }

    #[test]
    fn a_chain_of_passes_needs_two_neighbours_at_once() {
        let chain: Vec<Span> = (0..6).map(|pass| span(100, pass, pass + 1)).collect();
        let off = place(&chain, Mode::Off);
        assert_eq!((off.total_bytes, off.lower_bound_bytes, off.proven_optimal), (600, 200, false));
        let greedy = place(&chain, Mode::Greedy);
        assert_eq!((greedy.total_bytes, greedy.proven_optimal), (200, true));
        let before = predecessors(&chain, &greedy);
        assert_eq!((&before[2][..], &before[4][..]), (&[0][..], &[0, 2][..]));
    }

    #[test]
    fn nothing_takes_no_bytes() {
        for mode in [Mode::Off, Mode::Greedy, Mode::Optimal] {
            let placement = place(&[], mode);
            assert_eq!((placement.total_bytes, placement.proven_optimal), (0, true));
        }
    }

    #[test]
    fn a_search_that_is_too_large_ends_and_does_not_claim_a_proof() {
        // Sizes without a common measure in long overlapping chains: more orders than anyone tries.
        let spans: Vec<Span> = (0..60u64)
            .map(|index| {
                let first = (index as usize * 7) % 40;
                Span {
                    bytes: 1000 + index * index * 37 % 911,
                    alignment: 256,
                    first,
                    last: first + 3 + index as usize % 9,
                }
            })
            .collect();
        let optimal = place(&spans, Mode::Optimal);
        assert!(optimal.total_bytes <= place(&spans, Mode::Greedy).total_bytes);
        assert_eq!(optimal, place(&spans, Mode::Optimal));
        assert!(optimal.total_bytes > optimal.lower_bound_bytes && !optimal.proven_optimal, "{optimal:?}");
    }

    #[test]
    fn the_search_finds_what_greedy_orders_miss() {
        // Found by trying random spans; the least placement was confirmed by trying every offset.
        let missed = (0..2000u64).find_map(|seed| {
            let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
            let mut next = |below: u64| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 33) % below
            };
            let spans: Vec<Span> = (0..9)
                .map(|_| {
                    let first = next(8) as usize;
                    span(1 + next(9), first, first + next(4) as usize)
                })
                .collect();
            let [greedy, optimal] = [Mode::Greedy, Mode::Optimal].map(|mode| place(&spans, mode));
            assert!(optimal.proven_optimal);
            (optimal.total_bytes < greedy.total_bytes).then_some(())
        });
        assert!(missed.is_some(), "greedy was never beaten: the search is not tested");
    }
}
