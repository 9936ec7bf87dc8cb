//! One range is the whole block: for resources that are large, or that must lie apart.

use super::Suballocate;

/// A block that holds one range at a time, from its start.
#[derive(Clone, Debug)]
pub struct Dedicated {
    size_bytes: u64,
    used_bytes: u64,
}

impl Dedicated {
    pub fn new(size_bytes: u64) -> Self {
        Self { size_bytes, used_bytes: 0 }
    }
}

impl Suballocate for Dedicated {
    fn take(&mut self, bytes: u64, _alignment: u64) -> Option<u64> {
        if self.used_bytes > 0 || bytes > self.size_bytes {
            return None;
        }
        self.used_bytes = bytes;
        Some(0)
    }

    fn give_back(&mut self, offset: u64, bytes: u64) -> bool {
        assert!(offset == 0 && bytes == self.used_bytes, "a range comes back to a block that it did not come from");
        self.used_bytes = 0;
        true
    }

    fn used_bytes(&self) -> u64 {
        self.used_bytes
    }

    fn free_bytes(&self) -> u64 {
        self.size_bytes - self.used_bytes
    }

    /// Nothing beside a live range: the rest is out of reach until it comes back.
    fn largest_free_bytes(&self) -> u64 {
        if self.used_bytes > 0 { 0 } else { self.size_bytes }
    }

    fn lost_bytes(&self) -> u64 {
        self.free_bytes() - self.largest_free_bytes()
    }
}
