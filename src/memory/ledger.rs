//! Who owns how many bytes, now and at the peak: numbers and names only.

use crate::units::Bytes;
use serde::Serialize;
use std::collections::BTreeMap;

/// One resource's place. `bound_bytes - bytes` is padding that the driver asks for.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    pub name: String,
    pub group: String,
    /// Asked for, by arithmetic.
    pub bytes: u64,
    /// What the driver requires.
    pub bound_bytes: u64,
    pub memory_block: u32,
    pub offset: u64,
    pub memory_type: u32,
    pub reason: &'static str,
}

/// The ledger at one moment.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Snapshot {
    /// In order of entering.
    pub resources: Vec<Entry>,
    /// Sum of the live memory blocks: what vkAllocateMemory was asked for and has not got back.
    pub memory_block_bytes: u64,
    /// Greatest sum of `bound_bytes` so far.
    pub peak_bytes: u64,
    /// Everything that vkAllocateMemory was ever asked for.
    pub requested_bytes_ever: u64,
}

impl Snapshot {
    /// Sum of `bytes`.
    pub fn asked_bytes(&self) -> u64 {
        self.resources.iter().map(|entry| entry.bytes).sum()
    }

    /// Sum of `bound_bytes`.
    pub fn bound_bytes(&self) -> u64 {
        self.resources.iter().map(|entry| entry.bound_bytes).sum()
    }

    /// `bound_bytes` of each group.
    pub fn groups(&self) -> BTreeMap<String, u64> {
        let mut groups = BTreeMap::new();
        for entry in &self.resources {
            *groups.entry(entry.group.clone()).or_insert(0) += entry.bound_bytes;
        }
        groups
    }
}

/// Every live resource.
#[derive(Debug, Default)]
pub struct Ledger {
    entries: BTreeMap<u64, Entry>,
    next: u64,
    bound_bytes: u64,
    peak_bytes: u64,
    memory_block_bytes: u64,
    requested_bytes_ever: u64,
}

impl Ledger {
    /// Writes a resource in; the number is its key.
    pub fn enter(&mut self, entry: Entry) -> u64 {
        self.bound_bytes += entry.bound_bytes;
        self.peak_bytes = self.peak_bytes.max(self.bound_bytes);
        self.next += 1;
        self.entries.insert(self.next, entry);
        self.next
    }

    /// Strikes a resource out.
    pub fn leave(&mut self, key: u64) {
        let entry = self.entries.remove(&key).expect("a resource leaves the ledger once");
        self.bound_bytes -= entry.bound_bytes;
    }

    pub fn block_made(&mut self, bytes: u64) {
        self.memory_block_bytes += bytes;
        self.requested_bytes_ever += bytes;
    }

    pub fn block_freed(&mut self, bytes: u64) {
        self.memory_block_bytes -= bytes;
    }

    pub fn bound_bytes(&self) -> u64 {
        self.bound_bytes
    }

    /// The `count` greatest owners, as `name (size)`.
    pub fn greatest(&self, count: usize) -> Vec<String> {
        let mut entries: Vec<&Entry> = self.entries.values().collect();
        entries.sort_by_key(|entry| std::cmp::Reverse(entry.bound_bytes));
        entries.iter().take(count).map(|entry| format!("{} ({})", entry.name, Bytes(entry.bound_bytes))).collect()
    }

    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            resources: self.entries.values().cloned().collect(),
            memory_block_bytes: self.memory_block_bytes,
            peak_bytes: self.peak_bytes,
            requested_bytes_ever: self.requested_bytes_ever,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str, bytes: u64, bound_bytes: u64) -> Entry {
        let (name, group) = (name.to_owned(), "test".to_owned());
        Entry { name, group, bytes, bound_bytes, memory_block: 0, offset: 0, memory_type: 0, reason: "" }
    }

    #[test]
    fn the_peak_stays_when_owners_leave() {
        let mut ledger = Ledger::default();
        let first = ledger.enter(entry("first", 100, 128));
        let second = ledger.enter(entry("second", 200, 256));
        ledger.leave(first);
        let third = ledger.enter(entry("third", 10, 64));
        let snapshot = ledger.snapshot();
        assert_eq!((snapshot.asked_bytes(), snapshot.bound_bytes(), snapshot.peak_bytes), (210, 320, 384));
        assert_eq!(ledger.greatest(1), ["second (256 B)"]);
        ledger.leave(second);
        ledger.leave(third);
        assert_eq!(ledger.snapshot().bound_bytes(), 0);
    }
}
