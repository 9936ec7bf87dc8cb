//! The binary buddy system (Knuth 1997, section 2.5): a block is halved until a half is just large enough; two halves that
//! are both free are one again.
//!
//! A range takes the least power of two that holds it, so that a range and its neighbours are found by arithmetic alone, and
//! nothing is remembered of what is live. What that rounds up is out of reach until the range comes back (`padding_bytes`).
//!
//! Why this way: the textbook's block is a power of two long. A memory block may have any length, so the tree is that of the
//! next power of two, and its nodes end where the block ends; a half that would begin behind the end is not there, and counts
//! as free where halves are joined.

use super::Suballocate;
use std::collections::BTreeSet;

/// log2 of the least node: most alignments of resources are 256 bytes or less, and smaller nodes would only be joined again.
const LEAST_ORDER: u32 = 8;

/// Halves of halves; a node of order k is 2^k bytes long, or ends with the block.
#[derive(Clone, Debug)]
pub struct Buddy {
    size_bytes: u64,
    used_bytes: u64,
    /// Bytes of the nodes of live ranges.
    taken_bytes: u64,
    /// Offsets of the free nodes, for each order from `LEAST_ORDER` to the whole block's.
    free: Vec<BTreeSet<u64>>,
}

/// The least order whose nodes hold `bytes`; None beyond 2^63.
fn order_of(bytes: u64) -> Option<u32> {
    Some(bytes.checked_next_power_of_two()?.ilog2().max(LEAST_ORDER))
}

impl Buddy {
    /// One free node of `size_bytes`, at least 1 and at most 2^63.
    pub fn new(size_bytes: u64) -> Self {
        let root = order_of(size_bytes).expect("no memory block is longer than 2^63 bytes");
        let mut free = vec![BTreeSet::new(); (root - LEAST_ORDER + 1) as usize];
        free[(root - LEAST_ORDER) as usize].insert(0);
        Self { size_bytes, used_bytes: 0, taken_bytes: 0, free }
    }

    fn root(&self) -> u32 {
        LEAST_ORDER + self.free.len() as u32 - 1
    }

    fn free(&mut self, order: u32) -> &mut BTreeSet<u64> {
        &mut self.free[(order - LEAST_ORDER) as usize]
    }

    /// How long a node is: all but the one at the block's end are 2^order.
    fn node_bytes(&self, offset: u64, order: u32) -> u64 {
        (self.size_bytes - offset).min(1 << order)
    }

    /// The free node that `bytes` at a multiple of `alignment` is cut from: the first of the least order that has one.
    fn find(&self, bytes: u64, alignment: u64) -> Option<(u64, u32)> {
        let aligned = alignment.ilog2();
        (order_of(bytes)?..=self.root()).find_map(|order| {
            let free = &self.free[(order - LEAST_ORDER) as usize];
            // Nodes of large orders are aligned; of smaller ones a few are, the one at the start always.
            let found = if order >= aligned { free.first() } else { free.iter().find(|at| **at % alignment == 0) };
            // Only the last node of the block is shorter than others, and it is first where it is alone.
            found.filter(|at| self.node_bytes(**at, order) >= bytes).map(|at| (*at, order))
        })
    }
}

impl Suballocate for Buddy {
    fn take(&mut self, bytes: u64, alignment: u64) -> Option<u64> {
        let (offset, mut order) = self.find(bytes, alignment)?;
        self.free(order).remove(&offset);
        let wanted = order_of(bytes)?;
        while order > wanted {
            order -= 1;
            let half = offset + (1 << order);
            if half < self.size_bytes {
                self.free(order).insert(half);
            }
        }
        self.used_bytes += bytes;
        self.taken_bytes += self.node_bytes(offset, wanted);
        Some(offset)
    }

    fn give_back(&mut self, mut offset: u64, bytes: u64) -> bool {
        let order = order_of(bytes).filter(|order| *order <= self.root() && offset.is_multiple_of(1 << order));
        let came_from_here = bytes <= self.used_bytes && offset < self.size_bytes;
        let mut order =
            order.filter(|_| came_from_here).expect("a range comes back to a block that it did not come from");
        self.used_bytes -= bytes;
        self.taken_bytes -= self.node_bytes(offset, order);
        while order < self.root() {
            let other = offset ^ (1 << order);
            if other < self.size_bytes && !self.free(order).remove(&other) {
                break;
            }
            offset = offset.min(other);
            order += 1;
        }
        assert!(self.free(order).insert(offset), "a range comes back twice");
        self.used_bytes == 0
    }

    fn used_bytes(&self) -> u64 {
        self.used_bytes
    }

    fn free_bytes(&self) -> u64 {
        self.size_bytes - self.used_bytes
    }

    fn largest_free_bytes(&self) -> u64 {
        let nodes = self.free.iter().zip(LEAST_ORDER..);
        let longest = nodes.filter_map(|(free, order)| Some(self.node_bytes(*free.first()?, order)));
        // The node at the block's end may be shorter than one of a smaller order.
        longest.max().unwrap_or(0)
    }

    fn padding_bytes(&self) -> u64 {
        self.taken_bytes - self.used_bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn free_nodes(buddy: &Buddy) -> Vec<(u64, u64)> {
        let nodes = buddy.free.iter().zip(LEAST_ORDER..);
        let mut all: Vec<(u64, u64)> =
            nodes.flat_map(|(free, order)| free.iter().map(move |at| (*at, buddy.node_bytes(*at, order)))).collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn sizes_are_rounded_to_powers_of_two_and_halves_that_are_free_are_one() {
        let mut buddy = Buddy::new(4096);
        assert_eq!((buddy.take(513, 1), buddy.take(1, 1), buddy.take(1024, 1)), (Some(0), Some(1024), Some(2048)));
        // 1024 for 513, 256 for 1.
        assert_eq!((buddy.used_bytes(), buddy.padding_bytes()), (1538, 511 + 255));
        assert_eq!(free_nodes(&buddy), [(1280, 256), (1536, 512), (3072, 1024)]);
        assert_eq!(buddy.largest_free_bytes(), 1024);
        assert_eq!(buddy.take(1025, 1), None);
        assert!(!buddy.give_back(1024, 1));
        assert_eq!(
            free_nodes(&buddy),
            [(1024, 1024), (3072, 1024)],
            "halves of halves are joined, other halves are not"
        );
        assert!(!buddy.give_back(0, 513));
        assert_eq!(free_nodes(&buddy), [(0, 2048), (3072, 1024)]);
        assert!(buddy.give_back(2048, 1024));
        assert_eq!((free_nodes(&buddy), buddy.padding_bytes()), (vec![(0, 4096)], 0));
    }

    #[test]
    fn a_block_of_any_length_ends_its_last_nodes() {
        let mut buddy = Buddy::new(5000);
        assert_eq!((buddy.take(4096, 1), buddy.largest_free_bytes()), (Some(0), 904));
        assert_eq!((buddy.take(905, 1), buddy.take(904, 1), buddy.padding_bytes()), (None, Some(4096), 0));
        assert!(!buddy.give_back(0, 4096));
        assert!(buddy.give_back(4096, 904));
        assert_eq!(free_nodes(&buddy), [(0, 5000)]);
    }

    /// A small range at a large alignment takes no more than it needs.
    #[test]
    fn alignment_takes_no_bytes() {
        let mut buddy = Buddy::new(1 << 16);
        let offsets: Vec<u64> = (0..4).map(|_| buddy.take(256, 16384).unwrap()).collect();
        assert_eq!((offsets, buddy.padding_bytes()), (vec![0, 16384, 32768, 49152], 0));
        assert_eq!((buddy.take(256, 16384), buddy.take(8192, 256)), (None, Some(8192)));
    }

    #[test]
    #[should_panic(expected = "comes back")]
    fn a_range_that_comes_back_twice_is_seen() {
        let mut buddy = Buddy::new(4096);
        let [first, _] = [256; 2].map(|bytes| buddy.take(bytes, 1).unwrap());
        buddy.give_back(first, 256);
        buddy.give_back(first, 256);
    }

    proptest! {
        /// Live nodes and free ones are the block, without a gap, and no two free halves of one node stand apart.
        #[test]
        fn nodes_are_the_block(
            size in 1u64..40_000,
            sizes in prop::collection::vec((1u64..3000, 0u32..13), 1..60),
            order in prop::collection::vec(any::<prop::sample::Index>(), 60),
        ) {
            let mut buddy = Buddy::new(size);
            let mut live: Vec<(u64, u64)> =
                sizes.into_iter().filter_map(|(bytes, power)| Some((buddy.take(bytes, 1 << power)?, bytes))).collect();
            for which in order {
                let taken = live.iter().map(|(at, bytes)| (*at, buddy.node_bytes(*at, order_of(*bytes).unwrap())));
                let mut all: Vec<(u64, u64)> = taken.chain(free_nodes(&buddy)).collect();
                all.sort_unstable();
                let end = all.iter().try_fold(0, |end, (at, bytes)| (*at == end).then_some(end + bytes));
                prop_assert_eq!(end, Some(size), "{:?}", all);
                let asked: u64 = live.iter().map(|(_, bytes)| bytes).sum();
                let free: u64 = free_nodes(&buddy).iter().map(|(_, bytes)| bytes).sum();
                prop_assert_eq!(buddy.padding_bytes(), size - asked - free);
                for (orders, power) in buddy.free.iter().zip(LEAST_ORDER..buddy.root()) {
                    prop_assert!(orders.iter().all(|at| !orders.contains(&(at ^ (1 << power)))), "{:?}", all);
                }
                if live.is_empty() {
                    break;
                }
                let (offset, bytes) = live.swap_remove(which.index(live.len()));
                prop_assert_eq!(buddy.give_back(offset, bytes), live.is_empty());
            }
            if live.is_empty() {
                prop_assert_eq!(free_nodes(&buddy), vec![(0, size)]);
            }
        }
    }
}
