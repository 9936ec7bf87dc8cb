//! Two-level segregated fit (Masmano, Ripoll, Crespo and Real 2004): ranges of any order and lifetime.
//!
//! Free ranges stand in lists by size class: the first level is the power of two, the second divides it into 32 equal
//! steps. A bit for each list that is not empty finds a list in two steps, and any range of a class above the wanted
//! size fits (good fit). A range that comes back merges with its free neighbours at once, so two free ranges never
//! touch.
//!
//! Why this way: the paper keeps its headers inside the memory that it manages. Device memory is not ours to write, so
//! the headers lie in a table on the host, and offsets are found by a hash map.

use super::Suballocate;
use std::collections::HashMap;

/// log2 of the steps between two powers of two (the paper's SLI; it advises 4 or 5).
const STEP_BITS: u32 = 5;
const STEPS: usize = 1 << STEP_BITS;
/// Sizes below `STEPS` share the first row, one list a byte; then a row for each power of two.
const ROWS: usize = 64 - STEP_BITS as usize + 1;

/// Index of a range in the table.
type Index = u32;

/// A range, free or live, with its neighbours in the block and, where it is free, in its list.
#[derive(Clone, Debug)]
struct Range {
    offset: u64,
    bytes: u64,
    is_free: bool,
    before: Option<Index>,
    behind: Option<Index>,
    list_before: Option<Index>,
    list_behind: Option<Index>,
}

/// Row and step of the class that holds ranges of `bytes`.
fn class_of(bytes: u64) -> (usize, usize) {
    if bytes < STEPS as u64 {
        return (0, bytes as usize);
    }
    let power = bytes.ilog2();
    let step = (bytes >> (power - STEP_BITS)) as usize - STEPS;
    ((power - STEP_BITS + 1) as usize, step)
}

/// The first class in which every range holds `bytes`; None beyond the last class.
fn class_above(bytes: u64) -> Option<(usize, usize)> {
    if bytes < STEPS as u64 {
        return Some(class_of(bytes));
    }
    let step_bytes = 1u64 << (bytes.ilog2() - STEP_BITS);
    bytes.checked_add(step_bytes - 1).map(class_of)
}

/// Good fit in constant time.
#[derive(Clone, Debug)]
pub struct Tlsf {
    size_bytes: u64,
    used_bytes: u64,
    ranges: Vec<Range>,
    /// Entries of `ranges` that are not in use.
    spare: Vec<Index>,
    /// Live ranges by offset.
    live: HashMap<u64, Index>,
    /// A bit for each row with a free range.
    rows: u64,
    /// A bit for each step of a row with a free range.
    steps: [u32; ROWS],
    heads: Box<[[Option<Index>; STEPS]; ROWS]>,
}

impl Tlsf {
    /// One free range of `size_bytes`, at least 1.
    pub fn new(size_bytes: u64) -> Self {
        let mut tlsf = Self {
            size_bytes,
            used_bytes: 0,
            ranges: Vec::new(),
            spare: Vec::new(),
            live: HashMap::new(),
            rows: 0,
            steps: [0; ROWS],
            heads: Box::new([[None; STEPS]; ROWS]),
        };
        let whole = tlsf.add(0, size_bytes, None, None);
        tlsf.enlist(whole);
        tlsf
    }

    fn range(&mut self, index: Index) -> &mut Range {
        &mut self.ranges[index as usize]
    }

    fn add(&mut self, offset: u64, bytes: u64, before: Option<Index>, behind: Option<Index>) -> Index {
        let range = Range { offset, bytes, is_free: false, before, behind, list_before: None, list_behind: None };
        let index = match self.spare.pop() {
            Some(index) => {
                *self.range(index) = range;
                index
            }
            None => {
                self.ranges.push(range);
                self.ranges.len() as Index - 1
            }
        };
        if let Some(before) = before {
            self.range(before).behind = Some(index);
        }
        if let Some(behind) = behind {
            self.range(behind).before = Some(index);
        }
        index
    }

    /// Puts a range at the head of its class's list.
    fn enlist(&mut self, index: Index) {
        let (row, step) = class_of(self.range(index).bytes);
        let head = self.heads[row][step].replace(index);
        let range = self.range(index);
        (range.is_free, range.list_before, range.list_behind) = (true, None, head);
        if let Some(head) = head {
            self.range(head).list_before = Some(index);
        }
        self.rows |= 1 << row;
        self.steps[row] |= 1 << step;
    }

    /// Takes a range out of its class's list.
    fn delist(&mut self, index: Index) {
        let Range { bytes, list_before, list_behind, .. } = *self.range(index);
        let (row, step) = class_of(bytes);
        match list_before {
            Some(before) => self.range(before).list_behind = list_behind,
            None => self.heads[row][step] = list_behind,
        }
        if let Some(behind) = list_behind {
            self.range(behind).list_before = list_before;
        }
        if self.heads[row][step].is_none() {
            self.steps[row] &= !(1 << step);
            if self.steps[row] == 0 {
                self.rows &= !(1 << row);
            }
        }
        self.range(index).is_free = false;
    }

    /// A free range of a class in which every range holds `bytes`.
    fn find(&self, bytes: u64) -> Option<Index> {
        let (row, step) = class_above(bytes)?;
        let steps = self.steps[row] & (!0 << step);
        if steps != 0 {
            return self.heads[row][steps.trailing_zeros() as usize];
        }
        let rows = self.rows & (!0 << (row + 1));
        if rows == 0 {
            return None;
        }
        let row = rows.trailing_zeros() as usize;
        self.heads[row][self.steps[row].trailing_zeros() as usize]
    }

    /// Where `bytes` would begin in a free range; None where they do not fit.
    fn start_in(&self, index: Index, bytes: u64, alignment: u64) -> Option<u64> {
        let range = &self.ranges[index as usize];
        let start = range.offset.checked_next_multiple_of(alignment)?;
        (start.checked_add(bytes)? <= range.offset + range.bytes).then_some(start)
    }

    /// Merges a range with the one behind it, which is removed.
    fn merge_behind(&mut self, index: Index, behind: Index) {
        let Range { bytes, behind: next, .. } = *self.range(behind);
        self.range(index).bytes += bytes;
        self.range(index).behind = next;
        if let Some(next) = next {
            self.range(next).before = Some(index);
        }
        self.spare.push(behind);
    }

    fn free_neighbour(&self, index: Option<Index>) -> Option<Index> {
        index.filter(|index| self.ranges[*index as usize].is_free)
    }
}

impl Suballocate for Tlsf {
    fn take(&mut self, bytes: u64, alignment: u64) -> Option<u64> {
        let fitting = |index: Option<Index>| Some((index?, self.start_in(index?, bytes, alignment)?));
        // Most ranges begin where they may; else one with room to align in; else one of the wanted size's own class,
        // whose ranges may or may not be large enough.
        let (row, step) = class_of(bytes);
        let (index, start) = fitting(self.find(bytes))
            .or_else(|| fitting(self.find(bytes.checked_add(alignment - 1)?)))
            .or_else(|| fitting(self.heads[row][step]))?;
        self.delist(index);
        let Range { offset, bytes: whole, before, behind, .. } = *self.range(index);
        if start > offset {
            let gap = self.add(offset, start - offset, before, Some(index));
            self.enlist(gap);
        }
        let rest = offset + whole - (start + bytes);
        if rest > 0 {
            let rest = self.add(start + bytes, rest, Some(index), behind);
            self.enlist(rest);
        }
        let range = self.range(index);
        (range.offset, range.bytes) = (start, bytes);
        self.live.insert(start, index);
        self.used_bytes += bytes;
        Some(start)
    }

    fn give_back(&mut self, offset: u64, bytes: u64) -> bool {
        let index = self.live.remove(&offset).expect("a range comes back to a block that it did not come from");
        assert_eq!(self.range(index).bytes, bytes, "a range comes back with another length");
        self.used_bytes -= bytes;
        let mut merged = index;
        if let Some(behind) = self.free_neighbour(self.ranges[index as usize].behind) {
            self.delist(behind);
            self.merge_behind(index, behind);
        }
        if let Some(before) = self.free_neighbour(self.ranges[index as usize].before) {
            self.delist(before);
            self.merge_behind(before, index);
            merged = before;
        }
        self.enlist(merged);
        self.used_bytes == 0
    }

    fn used_bytes(&self) -> u64 {
        self.used_bytes
    }

    fn free_bytes(&self) -> u64 {
        self.size_bytes - self.used_bytes
    }

    /// The greatest of the last list: not in constant time, and only asked for by reports of memory.
    fn largest_free_bytes(&self) -> u64 {
        let Some(row) = self.rows.checked_ilog2() else { return 0 };
        let mut next = self.heads[row as usize][self.steps[row as usize].ilog2() as usize];
        let mut largest = 0;
        while let Some(index) = next {
            let range = &self.ranges[index as usize];
            largest = largest.max(range.bytes);
            next = range.list_behind;
        }
        largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    impl Tlsf {
        /// Every range in order, and that the table is whole: no gap, no overlap, no two free neighbours.
        fn require_whole(&self) -> usize {
            let first = self
                .ranges
                .iter()
                .enumerate()
                .find(|(index, range)| range.before.is_none() && !self.spare.contains(&(*index as Index)));
            let (mut next, mut end, mut count, mut was_free) = (first.map(|(index, _)| index as Index), 0, 0, false);
            while let Some(index) = next {
                let range = &self.ranges[index as usize];
                assert_eq!(range.offset, end);
                assert!(!(was_free && range.is_free), "two free ranges touch at {end}");
                assert!(range.bytes > 0);
                (next, end, count, was_free) = (range.behind, end + range.bytes, count + 1, range.is_free);
            }
            assert_eq!(end, self.size_bytes);
            assert_eq!(count + self.spare.len(), self.ranges.len());
            count
        }
    }

    proptest! {
        #[test]
        fn free_neighbours_merge_and_an_empty_block_is_one_range(
            sizes in prop::collection::vec((1u64..3000, 0u32..9), 1..60),
            order in prop::collection::vec(any::<prop::sample::Index>(), 60),
        ) {
            let mut tlsf = Tlsf::new(65_536);
            let mut live: Vec<(u64, u64)> = sizes
                .into_iter()
                .filter_map(|(bytes, power)| Some((tlsf.take(bytes, 1 << power)?, bytes)))
                .collect();
            for which in order {
                tlsf.require_whole();
                if live.is_empty() {
                    break;
                }
                let (offset, bytes) = live.swap_remove(which.index(live.len()));
                prop_assert_eq!(tlsf.give_back(offset, bytes), live.is_empty());
            }
            prop_assert_eq!(tlsf.require_whole(), 1);
        }

        #[test]
        fn a_class_above_holds_the_size(bytes in 1u64..1 << 62) {
            // The least size of the class is the first that no smaller class takes.
            prop_assert!(class_above(bytes).unwrap() >= class_of(bytes));
            prop_assert!(class_of(bytes + bytes / 16 + 1) >= class_above(bytes).unwrap());
            prop_assert!(class_of(bytes) <= class_of(bytes + 1));
        }
    }

    #[test]
    fn a_range_that_is_taken_whole_leaves_none_behind() {
        let mut tlsf = Tlsf::new(8192);
        let [first, second] = [4096; 2].map(|bytes| tlsf.take(bytes, 4096).unwrap());
        assert_eq!((first, second, tlsf.require_whole()), (0, 4096, 2));
        tlsf.give_back(first, 4096);
        assert_eq!((tlsf.take(4096, 256), tlsf.require_whole()), (Some(first), 2));
        assert_eq!(tlsf.take(1, 1), None);
    }

    #[test]
    fn a_hole_is_taken_again_at_once() {
        let mut tlsf = Tlsf::new(1 << 20);
        let offsets: Vec<u64> = (0..8).map(|_| tlsf.take(4096, 256).unwrap()).collect();
        assert!(!tlsf.give_back(offsets[3], 4096));
        assert_eq!(tlsf.take(4096, 4096), Some(offsets[3]));
        assert!(!tlsf.give_back(offsets[5], 4096));
        let [free, largest] = [(1 << 20) - 7 * 4096, (1 << 20) - 8 * 4096].map(f64::from);
        assert!((tlsf.fragmentation() - (1.0 - largest / free)).abs() < 1e-12);
    }
}
