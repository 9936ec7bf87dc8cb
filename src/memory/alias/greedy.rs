//! Best fit in a few orders: each span takes the smallest gap between those that are placed and meet it, else the room
//! above them. The best order wins; a tie goes to the earlier one.

use super::Span;
use crate::memory::alias::span::{one_after_the_other, total_bytes};
use std::cmp::Reverse;

/// A key for each span, by which it is placed; the least goes first, ties in the order given.
type Order = fn(&Span) -> (Reverse<u128>, Reverse<u64>, usize);

fn duration(span: &Span) -> u64 {
    (span.last - span.first + 1) as u64
}

const ORDERS: [Order; 5] = [
    // As given. With it the answer is never larger than without sharing: each span lies at or below its place there.
    |_| (Reverse(0), Reverse(0), 0),
    |span| (Reverse(u128::from(span.bytes)), Reverse(duration(span)), span.first),
    |span| (Reverse(u128::from(span.bytes) * u128::from(duration(span))), Reverse(span.bytes), span.first),
    |span| (Reverse(u128::from(duration(span))), Reverse(span.bytes), span.first),
    |span| (Reverse(0), Reverse(0), span.first),
];

/// First byte of each span.
pub fn offsets(spans: &[Span]) -> Vec<u64> {
    let tries = ORDERS.iter().map(|order| {
        let mut indices: Vec<usize> = (0..spans.len()).collect();
        indices.sort_by_key(|index| order(&spans[*index]));
        best_fit(spans, &indices)
    });
    tries.min_by_key(|offsets| total_bytes(spans, offsets)).unwrap_or_else(|| one_after_the_other(spans))
}

fn best_fit(spans: &[Span], order: &[usize]) -> Vec<u64> {
    let mut offsets = vec![0; spans.len()];
    for (count, &index) in order.iter().enumerate() {
        let span = &spans[index];
        let mut taken: Vec<(u64, u64)> = order[..count]
            .iter()
            .filter(|other| spans[**other].meets(span))
            .map(|other| (offsets[*other], offsets[*other] + spans[*other].bytes))
            .collect();
        taken.sort_unstable();
        let mut end = 0u64;
        // The gap's size and where the span would lie in it.
        let mut best: Option<(u64, u64)> = None;
        for (start, taken_end) in taken {
            let offset = end.next_multiple_of(span.alignment);
            let gap = start.saturating_sub(end);
            if offset + span.bytes <= start && best.is_none_or(|(smallest, _)| gap < smallest) {
                best = Some((gap, offset));
            }
            end = end.max(taken_end);
        }
        offsets[index] = best.map_or(end.next_multiple_of(span.alignment), |(_, offset)| offset);
    }
    offsets
}
