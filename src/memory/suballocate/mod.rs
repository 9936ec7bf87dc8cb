//! Ranges in a memory block: four strategies behind one trait, numbers only, testable anywhere.
//!
//! `Dedicated`: the block is one range. `Linear`: one range after the other, space returns when all of it does. `Tlsf`:
//! ranges of any order and lifetime, O(1) each way, neighbours merge. `Buddy`: halves of halves, sizes rounded to powers of two.

mod buddy;
mod dedicated;
mod linear;
mod tlsf;

pub use buddy::Buddy;
pub use dedicated::Dedicated;
pub use linear::Linear;
pub use tlsf::Tlsf;

/// Gives out ranges of one memory block.
///
/// Every byte is in one live range or free: `used_bytes + free_bytes` is the block's size at any time.
pub trait Suballocate: Send {
    /// The offset of a new range of `bytes` (at least 1) at a multiple of `alignment` (a power of two); None where it
    /// does not fit. An empty block takes anything up to its size.
    fn take(&mut self, bytes: u64, alignment: u64) -> Option<u64>;

    /// The range that `take` gave for `bytes` at `offset` is not used any more. True when the block is empty now.
    ///
    /// Panics where no such range is live, as far as the strategy keeps track of it.
    fn give_back(&mut self, offset: u64, bytes: u64) -> bool;

    /// Bytes of the live ranges.
    fn used_bytes(&self) -> u64;

    /// Bytes in no live range, whether or not the strategy can reach them.
    fn free_bytes(&self) -> u64;

    /// The greatest range that could be taken now, at the best of alignments.
    fn largest_free_bytes(&self) -> u64;

    /// Bytes that live ranges take beyond their own lengths, because the strategy rounds these up.
    fn padding_bytes(&self) -> u64 {
        0
    }

    /// Bytes that were left out before live ranges to align them, where nothing else may lie there.
    fn gap_bytes(&self) -> u64 {
        0
    }

    /// Bytes that came back and are taken again only when the block is empty.
    fn lost_bytes(&self) -> u64 {
        0
    }

    /// 1 - largest free range / all free bytes: 0 where what is free is in one piece, or nothing is.
    fn fragmentation(&self) -> f64 {
        match self.free_bytes() {
            0 => 0.0,
            free => 1.0 - self.largest_free_bytes() as f64 / free as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Choice;
    use crate::memory::Strategy as Allocation;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    const SIZE: u64 = 100_000;

    fn all(size_bytes: u64) -> impl Iterator<Item = (&'static str, Box<dyn Suballocate>)> {
        Allocation::ALL.iter().map(move |strategy| (strategy.name(), strategy.ranges(size_bytes)))
    }

    /// What a test does with a block.
    #[derive(Clone, Debug)]
    enum Step {
        Take {
            bytes: u64,
            alignment: u64,
        },
        /// Index of the live range to give back, modulo their number.
        GiveBack(usize),
    }

    fn steps() -> impl Strategy<Value = Vec<Step>> {
        let size = prop_oneof![1u64..64, 1u64..5000, 1u64..SIZE];
        let take = (size, 0u32..13).prop_map(|(bytes, power)| Step::Take { bytes, alignment: 1 << power });
        let give_back = any::<usize>().prop_map(Step::GiveBack);
        prop::collection::vec(prop_oneof![3 => take, 2 => give_back], 1..300)
    }

    /// Live ranges of the model, bytes by offset.
    type Model = BTreeMap<u64, u64>;

    fn require_as_modelled(name: &str, block: &dyn Suballocate, model: &Model) -> Result<(), TestCaseError> {
        let used: u64 = model.values().sum();
        prop_assert_eq!(block.used_bytes(), used, "{}", name);
        prop_assert_eq!(block.free_bytes(), SIZE - used, "{}", name);
        let unreachable = block.padding_bytes() + block.gap_bytes() + block.lost_bytes();
        prop_assert!(block.largest_free_bytes() + unreachable <= block.free_bytes(), "{}: {}", name, unreachable);
        prop_assert!((0.0..=1.0).contains(&block.fragmentation()), "{}", name);
        Ok(())
    }

    proptest! {
        #[test]
        fn every_strategy_agrees_with_a_map_of_live_ranges(steps in steps()) {
            for (name, mut block) in all(SIZE) {
                let mut model = Model::new();
                for step in &steps {
                    match *step {
                        Step::Take { bytes, alignment } => {
                            let largest = block.largest_free_bytes();
                            let Some(offset) = block.take(bytes, alignment) else { continue };
                            prop_assert!(bytes <= largest, "{} took more than its largest range", name);
                            prop_assert_eq!(offset % alignment, 0, "{}", name);
                            prop_assert!(offset + bytes <= SIZE, "{}", name);
                            let before = model.range(..offset + bytes).next_back();
                            let apart = before.is_none_or(|(start, length)| start + length <= offset);
                            prop_assert!(apart, "{}: {} bytes at {} overlap {:?}", name, bytes, offset, before);
                            model.insert(offset, bytes);
                        }
                        Step::GiveBack(which) if !model.is_empty() => {
                            let (&offset, &bytes) = model.iter().nth(which % model.len()).unwrap();
                            model.remove(&offset);
                            prop_assert_eq!(block.give_back(offset, bytes), model.is_empty(), "{}", name);
                        }
                        Step::GiveBack(_) => {}
                    }
                    require_as_modelled(name, block.as_ref(), &model)?;
                }
                while let Some((offset, bytes)) = model.pop_first() {
                    prop_assert_eq!(block.give_back(offset, bytes), model.is_empty(), "{}", name);
                }
                prop_assert_eq!((block.largest_free_bytes(), block.fragmentation()), (SIZE, 0.0), "{}", name);
                prop_assert_eq!(block.take(SIZE, 4096), Some(0), "{}: an empty block takes its whole size", name);
            }
        }
    }

    #[test]
    fn an_empty_block_takes_what_fits_and_nothing_more() {
        for size in [1, 31, 32, 33, 1000, 4097, 16 << 20, (16 << 20) + 1] {
            for (name, mut block) in all(size) {
                assert_eq!(block.take(size + 1, 1), None, "{name}");
                assert_eq!(block.take(u64::MAX, 1 << 40), None, "{name}");
                // Offset 0 has every alignment.
                assert_eq!(block.take(size, 1 << 40), Some(0), "{name} of {size}");
                assert_eq!(block.take(1, 1), None, "{name}");
                assert_eq!((block.free_bytes(), block.fragmentation()), (0, 0.0), "{name}");
                assert!(block.give_back(0, size), "{name}");
                assert_eq!(block.take(1, 256), Some(0), "{name}");
            }
        }
    }
}
