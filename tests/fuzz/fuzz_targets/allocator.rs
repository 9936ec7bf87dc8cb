//! Any sequence of takes and gives on each strategy, beside a map of the ranges that are live.

#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use quincunx::choice::Choice;
use quincunx::memory::Strategy;
use quincunx::memory::suballocate::Suballocate;
use std::collections::BTreeMap;

#[derive(Arbitrary, Debug)]
struct Work {
    strategy: u8,
    /// Size of the block, before it is cut to what a heap may have.
    size: u64,
    size_bits: u8,
    steps: Vec<Step>,
}

#[derive(Arbitrary, Debug)]
enum Step {
    /// Small enough to leave room for others.
    Take {
        bytes: u16,
        alignment_bits: u8,
    },
    /// Anything, also more than there is.
    TakeAny {
        bytes: u64,
        alignment_bits: u8,
    },
    TakeLargest,
    /// Which of the live ranges, modulo their number.
    GiveBack(u8),
}

struct Block {
    block: Box<dyn Suballocate>,
    size: u64,
    live: BTreeMap<u64, u64>,
}

impl Block {
    fn take(&mut self, bytes: u64, alignment: u64) {
        let largest = self.block.largest_free_bytes();
        let Some(offset) = self.block.take(bytes, alignment) else {
            assert!(!self.live.is_empty() || bytes > self.size, "an empty block refused {bytes}");
            return;
        };
        assert!(bytes <= largest, "{bytes} taken where the largest range had {largest}");
        assert_eq!(offset % alignment, 0);
        let end = offset.checked_add(bytes).unwrap();
        assert!(end <= self.size);
        let before = self.live.range(..end).next_back();
        assert!(before.is_none_or(|(start, length)| start + length <= offset), "{bytes} at {offset} over {before:?}");
        self.live.insert(offset, bytes);
    }

    fn give_back(&mut self, offset: u64) {
        let bytes = self.live.remove(&offset).unwrap();
        assert_eq!(self.block.give_back(offset, bytes), self.live.is_empty());
    }

    fn check(&self) {
        let used: u64 = self.live.values().sum();
        assert_eq!((self.block.used_bytes(), self.block.free_bytes()), (used, self.size - used));
        assert!(self.block.largest_free_bytes() <= self.block.free_bytes());
        assert!((0.0..=1.0).contains(&self.block.fragmentation()));
    }
}

fuzz_target!(|work: Work| {
    // 2^40 bytes are more than any heap has.
    let size = (work.size & (u64::MAX >> (24 + work.size_bits % 40))).max(1);
    let strategy = Strategy::ALL[usize::from(work.strategy) % Strategy::ALL.len()];
    let block = strategy.ranges(size);
    let mut block = Block { block, size, live: BTreeMap::new() };
    for step in work.steps {
        match step {
            Step::Take { bytes, alignment_bits } => block.take(u64::from(bytes).max(1), 1 << (alignment_bits % 17)),
            Step::TakeAny { bytes, alignment_bits } => block.take(bytes.max(1), 1 << (alignment_bits % 64)),
            Step::TakeLargest => {
                let largest = block.block.largest_free_bytes();
                if largest > 0 {
                    block.take(largest, 1);
                }
            }
            Step::GiveBack(which) => {
                let count = block.live.len();
                if let Some(offset) = block.live.keys().nth(usize::from(which) % count.max(1)).copied() {
                    block.give_back(offset);
                }
            }
        }
        block.check();
    }
    while let Some((&offset, _)) = block.live.first_key_value() {
        block.give_back(offset);
    }
    assert_eq!((block.block.largest_free_bytes(), block.block.fragmentation()), (size, 0.0));
    assert_eq!(block.block.take(size, 1 << 12), Some(0), "an empty block takes its whole size");
});
