//! Ranges one after the other: two numbers of state, and nothing to search.

use super::Suballocate;

/// Ranges one after the other. Space comes back only when every range has: then the block is empty again.
#[derive(Clone, Debug)]
pub struct Linear {
    size_bytes: u64,
    next_byte: u64,
    live_count: u32,
    used_bytes: u64,
    /// Left out to align ranges since the block was empty.
    gap_bytes: u64,
}

impl Linear {
    pub fn new(size_bytes: u64) -> Self {
        Self { size_bytes, next_byte: 0, live_count: 0, used_bytes: 0, gap_bytes: 0 }
    }
}

impl Suballocate for Linear {
    fn take(&mut self, bytes: u64, alignment: u64) -> Option<u64> {
        let offset = self.next_byte.checked_next_multiple_of(alignment)?;
        let end = offset.checked_add(bytes)?;
        if end > self.size_bytes {
            return None;
        }
        self.gap_bytes += offset - self.next_byte;
        self.next_byte = end;
        self.live_count += 1;
        self.used_bytes += bytes;
        Some(offset)
    }

    fn give_back(&mut self, offset: u64, bytes: u64) -> bool {
        let came_from_here = self.live_count > 0 && bytes <= self.used_bytes && offset + bytes <= self.next_byte;
        assert!(came_from_here, "a range comes back to a block that it did not come from");
        self.live_count -= 1;
        self.used_bytes -= bytes;
        let is_empty = self.live_count == 0;
        if is_empty {
            (self.next_byte, self.gap_bytes) = (0, 0);
        }
        is_empty
    }

    fn used_bytes(&self) -> u64 {
        self.used_bytes
    }

    fn free_bytes(&self) -> u64 {
        self.size_bytes - self.used_bytes
    }

    /// What lies behind the last range: holes that others left are out of reach.
    fn largest_free_bytes(&self) -> u64 {
        self.size_bytes - self.next_byte
    }

    fn gap_bytes(&self) -> u64 {
        self.gap_bytes
    }

    fn lost_bytes(&self) -> u64 {
        self.next_byte - self.used_bytes - self.gap_bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_out_of_reach_until_the_block_is_empty() {
        let mut linear = Linear::new(64);
        assert_eq!((linear.take(10, 1), linear.take(16, 16)), (Some(0), Some(16)));
        assert!(!linear.give_back(0, 10));
        assert_eq!((linear.free_bytes(), linear.largest_free_bytes()), (48, 32));
        assert_eq!((linear.gap_bytes(), linear.lost_bytes()), (6, 10));
        assert_eq!(linear.take(48, 1), None);
        assert!(linear.give_back(16, 16));
        assert_eq!((linear.gap_bytes(), linear.lost_bytes()), (0, 0));
        assert_eq!(linear.take(48, 1), Some(0));
    }
}
