//! The bytes that each resource owns, now and at the peak: numbers and names only.
//!
//! Two sums, never mixed: bound bytes count every resource, held bytes count an arena once, however many resources lie
//! in the same bytes of it.

use crate::units::Bytes;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One resource's place. `bound_bytes - bytes` is padding that the driver asks for.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    pub name: String,
    pub group: String,
    /// Asked for, by arithmetic.
    pub bytes: u64,
    /// Bytes that the driver requires.
    pub bound_bytes: u64,
    pub memory_block: u32,
    /// In the memory block, also where the resource is a part of an arena.
    pub offset: u64,
    pub memory_type: u32,
    pub reason: &'static str,
    /// Key of the arena that it is a part of; None: the bytes are its own.
    #[serde(skip)]
    pub arena: Option<u64>,
}

/// A memory block whose bytes several resources may share.
#[derive(Clone, Debug, Serialize)]
pub struct ArenaEntry {
    pub name: String,
    pub group: String,
    pub bytes: u64,
    pub memory_block: u32,
    pub memory_type: u32,
    /// Sum of its parts' `bound_bytes` now; more than `bytes` where they share.
    pub parts_bytes: u64,
}

impl ArenaEntry {
    /// Bytes that its parts would take in addition if they shared none.
    fn aliased_bytes(&self) -> u64 {
        self.parts_bytes.saturating_sub(self.bytes)
    }
}

/// One memory block's ranges. An arena counts as one range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BlockState {
    /// As in `Entry::memory_block`.
    pub index: u32,
    pub memory_type: u32,
    pub bytes: u64,
    pub used_bytes: u64,
    pub free_bytes: u64,
    pub largest_free_bytes: u64,
    /// 1 - largest free range / all free bytes; 0 where nothing is free.
    pub fragmentation: f64,
}

/// The ledger at one moment.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Snapshot {
    /// Resources in the order in which they were entered.
    pub resources: Vec<Entry>,
    /// Arenas in the order in which they were entered.
    pub arenas: Vec<ArenaEntry>,
    /// Memory blocks by index.
    pub blocks: Vec<BlockState>,
    /// Sum of the live memory blocks: what vkAllocateMemory was asked for and was not freed since.
    pub memory_block_bytes: u64,
    /// Greatest sum of held bytes so far.
    pub peak_bytes: u64,
    /// Everything that vkAllocateMemory was ever asked for.
    pub requested_bytes_ever: u64,
}

impl Snapshot {
    /// Sum of `bytes`.
    pub fn asked_bytes(&self) -> u64 {
        self.resources.iter().map(|entry| entry.bytes).sum()
    }

    /// Sum of `bound_bytes`: before sharing.
    pub fn bound_bytes(&self) -> u64 {
        self.resources.iter().map(|entry| entry.bound_bytes).sum()
    }

    /// Bytes that are bound now: as `bound_bytes`, but an arena counts once.
    pub fn held_bytes(&self) -> u64 {
        let own = self.resources.iter().filter(|entry| entry.arena.is_none()).map(|entry| entry.bound_bytes);
        own.chain(self.arenas.iter().map(|arena| arena.bytes)).sum()
    }

    /// Bytes that sharing saves: the sum of the parts of arenas, less the bytes of the arenas.
    pub fn aliased_bytes(&self) -> u64 {
        self.arenas.iter().map(ArenaEntry::aliased_bytes).sum()
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

/// An owner of bytes: a resource, or an arena for all of its parts.
struct Owner<'a> {
    name: &'a str,
    group: &'a str,
    bytes: u64,
    memory_type: u32,
}

/// Every live resource and arena.
#[derive(Debug, Default)]
pub struct Ledger {
    entries: BTreeMap<u64, Entry>,
    arenas: BTreeMap<u64, ArenaEntry>,
    next: u64,
    held_bytes: u64,
    peak_bytes: u64,
    memory_block_bytes: u64,
    requested_bytes_ever: u64,
}

impl Ledger {
    fn hold(&mut self, bytes: u64) {
        self.held_bytes += bytes;
        self.peak_bytes = self.peak_bytes.max(self.held_bytes);
    }

    /// Writes a resource in; the number is its key.
    pub fn enter(&mut self, entry: Entry) -> u64 {
        match entry.arena {
            None => self.hold(entry.bound_bytes),
            Some(arena) => self.arena(arena).parts_bytes += entry.bound_bytes,
        }
        self.next += 1;
        self.entries.insert(self.next, entry);
        self.next
    }

    /// Strikes a resource out.
    pub fn leave(&mut self, key: u64) {
        let entry = self.entries.remove(&key).expect("a resource leaves the ledger once");
        match entry.arena {
            None => self.held_bytes -= entry.bound_bytes,
            Some(arena) => self.arena(arena).parts_bytes -= entry.bound_bytes,
        }
    }

    /// Writes an arena without parts in; the number is its key.
    pub fn enter_arena(&mut self, arena: ArenaEntry) -> u64 {
        self.hold(arena.bytes);
        self.next += 1;
        self.arenas.insert(self.next, arena);
        self.next
    }

    /// Strikes an arena out. Its parts are gone.
    pub fn leave_arena(&mut self, key: u64) {
        let arena = self.arenas.remove(&key).expect("an arena leaves the ledger once");
        self.held_bytes -= arena.bytes;
    }

    fn arena(&mut self, key: u64) -> &mut ArenaEntry {
        self.arenas.get_mut(&key).expect("parts keep their arena")
    }

    pub fn block_made(&mut self, bytes: u64) {
        self.memory_block_bytes += bytes;
        self.requested_bytes_ever += bytes;
    }

    pub fn block_freed(&mut self, bytes: u64) {
        self.memory_block_bytes -= bytes;
    }

    /// All that holds bytes of its own, by key.
    fn owners(&self) -> BTreeMap<u64, Owner<'_>> {
        let own = self.entries.iter().filter(|(_, entry)| entry.arena.is_none()).map(|(key, entry)| {
            let Entry { name, group, bound_bytes: bytes, memory_type, .. } = entry;
            (*key, Owner { name, group, bytes: *bytes, memory_type: *memory_type })
        });
        let arenas = self.arenas.iter().map(|(key, arena)| {
            let ArenaEntry { name, group, bytes, memory_type, .. } = arena;
            (*key, Owner { name, group, bytes: *bytes, memory_type: *memory_type })
        });
        own.chain(arenas).collect()
    }

    /// Names of all that holds bytes of its own, by key.
    pub fn names(&self) -> impl Iterator<Item = (u64, &str)> {
        self.owners().into_iter().map(|(key, owner)| (key, owner.name))
    }

    /// All that holds bytes of its own, as `name (size)`.
    pub fn all_owners(&self) -> Vec<String> {
        self.owners().values().map(|owner| format!("{} ({})", owner.name, Bytes(owner.bytes))).collect()
    }

    /// The `count` groups that hold most in memory types that `is_meant`, as `group (size)`.
    pub fn greatest_groups(&self, count: usize, is_meant: impl Fn(u32) -> bool) -> Vec<String> {
        let mut groups: BTreeMap<&str, u64> = BTreeMap::new();
        for owner in self.owners().values().filter(|owner| is_meant(owner.memory_type)) {
            *groups.entry(owner.group).or_insert(0) += owner.bytes;
        }
        let mut groups: Vec<(&str, u64)> = groups.into_iter().collect();
        groups.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
        groups.iter().take(count).map(|(group, bytes)| format!("{group} ({})", Bytes(*bytes))).collect()
    }

    /// `blocks`: the memory blocks at this moment.
    pub fn snapshot(&self, blocks: Vec<BlockState>) -> Snapshot {
        Snapshot {
            resources: self.entries.values().cloned().collect(),
            arenas: self.arenas.values().cloned().collect(),
            blocks,
            memory_block_bytes: self.memory_block_bytes,
            peak_bytes: self.peak_bytes,
            requested_bytes_ever: self.requested_bytes_ever,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str, bytes: u64, bound_bytes: u64, arena: Option<u64>) -> Entry {
        let (name, group) = (name.to_owned(), "test".to_owned());
        Entry { name, group, bytes, bound_bytes, memory_block: 0, offset: 0, memory_type: 0, reason: "", arena }
    }

    #[test]
    fn the_peak_stays_when_owners_leave() {
        let mut ledger = Ledger::default();
        let first = ledger.enter(entry("first", 100, 128, None));
        let second = ledger.enter(entry("second", 200, 256, None));
        ledger.leave(first);
        let third = ledger.enter(entry("third", 10, 64, None));
        let snapshot = ledger.snapshot(Vec::new());
        assert_eq!((snapshot.asked_bytes(), snapshot.bound_bytes(), snapshot.peak_bytes), (210, 320, 384));
        assert_eq!(ledger.all_owners(), ["second (256 B)", "third (64 B)"]);
        assert_eq!(ledger.greatest_groups(3, |_| true), ["test (320 B)"]);
        ledger.leave(second);
        ledger.leave(third);
        assert_eq!(ledger.snapshot(Vec::new()).bound_bytes(), 0);
    }

    #[test]
    fn an_arena_counts_once_however_many_share_it() {
        let mut ledger = Ledger::default();
        let (name, group) = ("arena".to_owned(), "aliased".to_owned());
        let arena = ArenaEntry { name, group, bytes: 100, memory_block: 0, memory_type: 0, parts_bytes: 0 };
        let arena = ledger.enter_arena(arena);
        assert_eq!(ledger.snapshot(Vec::new()).aliased_bytes(), 0);
        let parts = [90, 60, 30].map(|bytes| ledger.enter(entry("part", bytes, bytes, Some(arena))));
        let own = ledger.enter(entry("own", 7, 8, None));
        let snapshot = ledger.snapshot(Vec::new());
        assert_eq!((snapshot.bound_bytes(), snapshot.held_bytes(), snapshot.aliased_bytes()), (188, 108, 80));
        assert_eq!(snapshot.peak_bytes, 108);
        assert_eq!(ledger.greatest_groups(1, |_| true), ["aliased (100 B)"]);
        assert_eq!(ledger.greatest_groups(1, |memory_type| memory_type > 0), [] as [String; 0]);
        parts.into_iter().chain([own]).for_each(|key| ledger.leave(key));
        assert_eq!(ledger.all_owners(), ["arena (100 B)"]);
        ledger.leave_arena(arena);
        assert_eq!((ledger.snapshot(Vec::new()).held_bytes(), ledger.all_owners().len()), (0, 0));
    }
}
