//! Ranges in a memory block: numbers only.

/// Ranges one after the other. Space comes back only when every range has: then the block is empty again.
#[derive(Clone, Debug)]
pub struct Linear {
    size_bytes: u64,
    next_byte: u64,
    live_count: u32,
}

impl Linear {
    pub fn new(size_bytes: u64) -> Self {
        Self { size_bytes, next_byte: 0, live_count: 0 }
    }

    /// The offset of a new range of `bytes` at a multiple of `alignment` (a power of two); None where it does not fit.
    pub fn take(&mut self, bytes: u64, alignment: u64) -> Option<u64> {
        let offset = self.next_byte.checked_next_multiple_of(alignment.max(1))?;
        let end = offset.checked_add(bytes)?;
        if end > self.size_bytes {
            return None;
        }
        self.next_byte = end;
        self.live_count += 1;
        Some(offset)
    }

    /// One range of `bytes` is not used any more. True when it was the last one.
    pub fn give_back(&mut self, bytes: u64) -> bool {
        assert!(
            self.live_count > 0 && bytes <= self.next_byte,
            "a range comes back to a block that it did not come from"
        );
        self.live_count -= 1;
        self.live_count == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ranges_never_overlap_and_are_aligned(requests in prop::collection::vec((1u64..5000, 0u32..12), 1..200)) {
            let mut linear = Linear::new(100_000);
            let mut taken: Vec<(u64, u64)> = Vec::new();
            for (bytes, power) in requests {
                if let Some(offset) = linear.take(bytes, 1 << power) {
                    prop_assert_eq!(offset % (1 << power), 0);
                    prop_assert!(offset + bytes <= 100_000);
                    prop_assert!(taken.iter().all(|(start, end)| offset >= *end || offset + bytes <= *start));
                    taken.push((offset, offset + bytes));
                }
            }
            let count = taken.len();
            for (index, (start, end)) in taken.into_iter().enumerate() {
                prop_assert_eq!(linear.give_back(end - start), index + 1 == count);
            }
        }
    }

    #[test]
    fn a_range_near_the_end_of_all_numbers_does_not_fit() {
        let mut linear = Linear::new(64);
        assert_eq!(linear.take(u64::MAX, 16), None);
        assert_eq!(linear.take(64, 16), Some(0));
        assert_eq!(linear.take(1, 1), None);
    }
}
