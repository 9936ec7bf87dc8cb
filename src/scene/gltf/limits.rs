//! How much a file may ask for: what bytes of it back, and some more that is free.
//!
//! A short file can name one accessor, one mesh or one picture thousands of times, so that each use is backed by bytes and
//! their sum is not. Time and memory follow the sum; a limit on it that grows with the file stops the short one and lets
//! the large one pass.

use crate::error::{Error, Result};
use crate::units::Bytes;

/// What a file spends of one kind of thing.
#[derive(Debug)]
pub struct Allowance {
    /// The name of the kind, in the plural.
    what: &'static str,
    spent: usize,
    limit: usize,
    backing: Bytes,
}

impl Allowance {
    /// `free` things for any file, and `per_byte` for each of `byte_count` bytes that back them.
    pub fn new(what: &'static str, free: usize, per_byte: usize, byte_count: usize) -> Self {
        let limit = free.saturating_add(per_byte.saturating_mul(byte_count));
        Self { what, spent: 0, limit, backing: Bytes(byte_count as u64) }
    }

    /// Takes `count` of it.
    ///
    /// Errors: that is more than is left (exit code 2).
    pub fn spend(&mut self, count: usize) -> Result<()> {
        self.spent = self.spent.saturating_add(count);
        if self.spent <= self.limit {
            return Ok(());
        }
        Err(Error::request(format!(
            "brings the file to {} {}; {} is the limit for a file with {} of data",
            self.spent, self.what, self.limit, self.backing
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_backed_and_what_is_free_can_be_spent_and_no_more() {
        let mut indices = Allowance::new("indices", 10, 2, 5);
        indices.spend(20).unwrap();
        let text = indices.spend(1).unwrap_err().to_string();
        assert!(text.contains("21 indices; 20 is the limit for a file with 5 B"), "{text}");
        let mut all = Allowance::new("indices", usize::MAX, 2, usize::MAX);
        all.spend(usize::MAX).unwrap();
        all.spend(1).unwrap();
    }
}
