//! The least placement, by branch and bound.
//!
//! Why this way: take a least placement with the least sum of offsets. Sorted by offset, each span lies directly on the
//! ones below it that it meets (else it could sink), so its offset is the height of the pile under it, aligned. It is
//! therefore enough to pile spans up in every order in which offsets do not descend; equal offsets go by index.
//! Branches are cut where the pile, with what must still come, is as high as the best placement known; the first of
//! those is greedy's. Steps are counted, not timed, so the same spans give the same placement on every machine.

use super::{Span, total_bytes};

/// Steps before the search gives up: about a second for 30 spans on a slow core.
const MOST_STEPS: u32 = 200_000;

struct Search<'a> {
    spans: &'a [Span],
    /// First and last moment of each span: passes in which something begins, counted from 0.
    moments: Vec<(usize, usize)>,
    lower_bound_bytes: u64,
    best: Vec<u64>,
    best_total: u64,
    /// Of the spans that are piled up.
    offsets: Vec<u64>,
    is_placed: Vec<bool>,
    /// Height of the pile at each moment.
    heights: Vec<u64>,
    /// Bytes still to come at each moment.
    waiting: Vec<u64>,
    steps_left: u32,
}

/// Offsets no worse than `known`, and whether no placement is better.
pub fn offsets(spans: &[Span], known: Vec<u64>, lower_bound_bytes: u64) -> (Vec<u64>, bool) {
    let mut begins: Vec<usize> = spans.iter().map(|span| span.first).collect();
    begins.sort_unstable();
    begins.dedup();
    // Between two beginnings nothing new comes: what meets, meets at a beginning.
    let moment = |pass: usize| begins.partition_point(|begin| *begin <= pass) - 1;
    let moments: Vec<(usize, usize)> = spans.iter().map(|span| (moment(span.first), moment(span.last))).collect();
    let mut waiting = vec![0; begins.len()];
    for (span, (first, last)) in spans.iter().zip(&moments) {
        waiting[*first..=*last].iter_mut().for_each(|bytes| *bytes += span.bytes);
    }
    let mut search = Search {
        spans,
        moments,
        lower_bound_bytes,
        best_total: total_bytes(spans, &known),
        best: known,
        offsets: vec![0; spans.len()],
        is_placed: vec![false; spans.len()],
        heights: vec![0; begins.len()],
        waiting,
        steps_left: MOST_STEPS,
    };
    search.descend(0, 0, 0);
    (search.best, search.steps_left > 0)
}

impl Search<'_> {
    /// Where a span would lie on the pile.
    fn offset(&self, index: usize) -> u64 {
        let (first, last) = self.moments[index];
        let height = self.heights[first..=last].iter().max().expect("a span has a moment");
        height.next_multiple_of(self.spans[index].alignment)
    }

    /// The height that every placement reaches which goes on from here, where nothing more comes below `floor`.
    fn bound(&self, floor: u64) -> u64 {
        let pile =
            |(height, waiting): (&u64, &u64)| if *waiting > 0 { (*height).max(floor) + waiting } else { *height };
        let piles = self.heights.iter().zip(&self.waiting).map(pile).max().unwrap_or(0);
        let top = |index| self.offset(index).max(floor) + self.spans[index].bytes;
        let tops = (0..self.spans.len()).filter(|index| !self.is_placed[*index]).map(top).max().unwrap_or(0);
        piles.max(tops)
    }

    /// Tries every span that may come next: at `floor` with an index from `next_index` on, or above it.
    fn descend(&mut self, placed_count: usize, floor: u64, next_index: usize) {
        if self.best_total == self.lower_bound_bytes || self.steps_left == 0 {
            return;
        }
        self.steps_left -= 1;
        let bound = self.bound(floor);
        if bound >= self.best_total {
            return;
        }
        if placed_count == self.spans.len() {
            // Everything is placed, so the bound is the height.
            self.best_total = bound;
            self.best.clone_from(&self.offsets);
            return;
        }
        let mut next: Vec<(u64, usize)> = (0..self.spans.len())
            .filter(|index| !self.is_placed[*index])
            .map(|index| (self.offset(index), index))
            .filter(|(offset, index)| (*offset, *index) >= (floor, next_index))
            .collect();
        // Low and large first: good placements early cut more branches.
        next.sort_by_key(|(offset, index)| (*offset, std::cmp::Reverse(self.spans[*index].bytes), *index));
        for (offset, index) in next {
            let (first, last) = self.moments[index];
            let below = self.heights[first..=last].to_vec();
            let bytes = self.spans[index].bytes;
            self.heights[first..=last].fill(offset + bytes);
            self.waiting[first..=last].iter_mut().for_each(|waiting| *waiting -= bytes);
            self.is_placed[index] = true;
            self.offsets[index] = offset;
            self.descend(placed_count + 1, offset, index + 1);
            self.is_placed[index] = false;
            self.waiting[first..=last].iter_mut().for_each(|waiting| *waiting += bytes);
            self.heights[first..=last].copy_from_slice(&below);
        }
    }
}
