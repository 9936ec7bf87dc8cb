//! Which memory block, and where in it: the numbers of `Memory`, without a device.
//!
//! The pool decides before the driver is asked: what would pass a heap's size or the budget is refused here, because
//! drivers such as lavapipe grant more than their heaps hold.

use super::ledger::BlockState;
use super::suballocate::Suballocate;
use super::{Strategy, Tiling};
use crate::caps::Caps;

/// Greatest size of a shared memory block (`--memory-block auto`).
pub const SHARED_BLOCK_BYTES: u64 = 16 << 20;
/// Resources of at least this part of the greatest shared memory block get one of their own. Of shared ones a resource may
/// leave as much unused at the end as it is large: a texture of 1024 x 1024 with its levels is a little more than a third of
/// a shared block, and two in each left a third of all that was allocated unused.
const OWN_BLOCK_PART: u64 = 4;
/// Size of the first shared memory block of its kind.
const FIRST_BLOCK_BYTES: u64 = 1 << 20;

/// Size of a new shared memory block beside `sibling_count` others of its kind, for a resource of `bytes`, where a heap or
/// a budget has `left_bytes` and no shared one is larger than `most_bytes`. Each is twice as large as the one before, so that a small scene is not held in large,
/// nearly empty blocks; and at most an eighth of what is left, so that a few half-empty ones do not spend a small budget.
fn shared_block_bytes(sibling_count: usize, bytes: u64, left_bytes: u64, most_bytes: u64) -> u64 {
    let grown = FIRST_BLOCK_BYTES << sibling_count.min(16);
    let wanted = grown.max((4 * bytes).next_power_of_two()).min(most_bytes);
    (left_bytes / 8).checked_ilog2().map_or(0, |power| 1 << power).min(wanted)
}

/// Memory that a resource needs, as numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ask {
    pub bytes: u64,
    /// A power of two.
    pub alignment: u64,
    pub type_index: u32,
    /// The host must see it.
    pub mapped: bool,
    pub tiling: Tiling,
    /// A memory block of its own, whatever the strategy.
    pub alone: bool,
}

/// Where it goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub block: u32,
    pub offset: u64,
    /// The memory block must be made first, of so many bytes.
    pub new_block_bytes: Option<u64>,
}

/// Why it goes nowhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misfit {
    /// One memory block may not be that large.
    TooLarge { most_bytes: u64 },
    /// There are as many memory blocks as the device makes.
    TooMany { most: u32 },
    /// The heap's share of the budget, or the heap, is spent.
    Spent { limit_bytes: u64, held_bytes: u64, is_budget: bool },
}

/// What cuts a new memory block of so many bytes.
pub type Cut = fn(u64) -> Box<dyn Suballocate>;

/// Limits that a pool keeps.
#[derive(Clone, Debug)]
pub struct Rules {
    strategy: Strategy,
    /// What cuts shared memory blocks; None: the strategy.
    cut: Option<Cut>,
    /// Greatest size of a shared memory block, a power of two.
    block_bytes: u64,
    /// For each heap; None: its size alone.
    budget_bytes: Option<u64>,
    heap_bytes: Vec<u64>,
    heap_of_type: Vec<usize>,
    max_allocation_bytes: u64,
    max_allocation_count: u32,
}

impl Rules {
    /// `budget_bytes`: what memory blocks in one heap may sum up to; None: the heap's size. `block_bytes`: the greatest size
    /// of a shared memory block, a power of two; None: `SHARED_BLOCK_BYTES`.
    pub fn new(caps: &Caps, strategy: Strategy, budget_bytes: Option<u64>, block_bytes: Option<u64>) -> Self {
        Self {
            strategy,
            cut: None,
            block_bytes: block_bytes.unwrap_or(SHARED_BLOCK_BYTES),
            budget_bytes,
            heap_bytes: caps.heaps.iter().map(|heap| heap.bytes).collect(),
            heap_of_type: caps.memory_types.iter().map(|kind| kind.heap as usize).collect(),
            max_allocation_bytes: caps.limits.max_allocation_bytes,
            max_allocation_count: caps.limits.max_allocation_count,
        }
    }

    /// Shared memory blocks are cut by another's ranges.
    #[cfg(feature = "rivals")]
    pub fn cut_by(self, cut: Cut) -> Self {
        Self { cut: Some(cut), ..self }
    }

    /// One memory type in one heap, which is the only limit.
    #[cfg(test)]
    pub fn of_one_heap(strategy: Strategy, heap_bytes: u64) -> Self {
        let (heap_bytes, heap_of_type) = (vec![heap_bytes], vec![0]);
        Self {
            strategy,
            cut: None,
            block_bytes: SHARED_BLOCK_BYTES,
            budget_bytes: None,
            heap_bytes,
            heap_of_type,
            max_allocation_bytes: u64::MAX,
            max_allocation_count: u32::MAX,
        }
    }
}

/// Bytes of memory blocks in which nothing lives and that nothing can take now, by why.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unusable {
    /// Live ranges were rounded up by so much.
    pub padding_bytes: u64,
    /// Left out to align ranges.
    pub gap_bytes: u64,
    /// Came back, and are taken again only when their memory block is empty.
    pub lost_bytes: u64,
}

/// A memory block's numbers.
struct Ranges {
    type_index: u32,
    mapped: bool,
    tiling: Tiling,
    bytes: u64,
    /// Others may join.
    is_shared: bool,
    ranges: Box<dyn Suballocate>,
}

/// Memory blocks and what is left of the heaps.
pub struct Pool {
    rules: Rules,
    blocks: Vec<Option<Ranges>>,
    /// Sum of the memory blocks of each heap.
    held_bytes: Vec<u64>,
}

impl Ranges {
    /// Whether `ask` is of the block's kind and shares.
    fn may_join(&self, ask: &Ask) -> bool {
        let same = self.type_index == ask.type_index && self.mapped == ask.mapped && self.tiling == ask.tiling;
        self.is_shared && same
    }
}

impl Pool {
    pub fn new(rules: Rules) -> Self {
        let held_bytes = vec![0; rules.heap_bytes.len()];
        Self { rules, blocks: Vec::new(), held_bytes }
    }

    pub fn rules(&self) -> &Rules {
        &self.rules
    }

    /// Takes a range in a memory block that is there, or in a new one. Buffers and optimal images never share a memory
    /// block, so that no two of them are nearer than bufferImageGranularity.
    pub fn place(&mut self, ask: &Ask) -> Result<Place, Misfit> {
        if ask.bytes > self.rules.max_allocation_bytes {
            return Err(Misfit::TooLarge { most_bytes: self.rules.max_allocation_bytes });
        }
        let is_shared =
            !ask.alone && self.rules.strategy.shares_blocks() && ask.bytes < self.rules.block_bytes / OWN_BLOCK_PART;
        if is_shared && let Some(place) = self.join(ask) {
            return Ok(place);
        }
        let heap = self.heap_of(ask.type_index);
        let heap_bytes = self.rules.heap_bytes[heap];
        let limit_bytes = self.rules.budget_bytes.map_or(heap_bytes, |budget| budget.min(heap_bytes));
        let held_bytes = self.held_bytes[heap];
        let left = limit_bytes.saturating_sub(held_bytes);
        let shared_bytes = shared_block_bytes(self.sibling_count(ask), ask.bytes, left, self.rules.block_bytes);
        let is_shared = is_shared && ask.bytes < shared_bytes / 2;
        let bytes = if is_shared { shared_bytes } else { ask.bytes };
        if bytes > left {
            return Err(Misfit::Spent { limit_bytes, held_bytes, is_budget: limit_bytes < heap_bytes });
        }
        let most = self.rules.max_allocation_count;
        if self.blocks.iter().flatten().count() >= most as usize {
            return Err(Misfit::TooMany { most });
        }
        let mut ranges = match self.rules.cut {
            _ if !is_shared => Strategy::Dedicated.ranges(bytes),
            None => self.rules.strategy.ranges(bytes),
            Some(cut) => cut(bytes),
        };
        let offset = ranges.take(ask.bytes, ask.alignment).expect("an empty block takes what is not larger");
        let Ask { type_index, mapped, tiling, .. } = *ask;
        let block = Ranges { type_index, mapped, tiling, bytes, is_shared, ranges };
        self.held_bytes[heap] += bytes;
        let index = match self.blocks.iter().position(Option::is_none) {
            Some(free) => {
                self.blocks[free] = Some(block);
                free
            }
            None => {
                self.blocks.push(Some(block));
                self.blocks.len() - 1
            }
        };
        Ok(Place { block: index as u32, offset, new_block_bytes: Some(bytes) })
    }

    fn heap_of(&self, type_index: u32) -> usize {
        self.rules.heap_of_type[type_index as usize]
    }

    /// Both memory types lie in one heap.
    pub fn share_a_heap(&self, type_index: u32, other: u32) -> bool {
        self.heap_of(type_index) == self.heap_of(other)
    }

    /// Sum of the memory blocks in the heap of this memory type.
    pub fn held_bytes(&self, type_index: u32) -> u64 {
        self.held_bytes[self.heap_of(type_index)]
    }

    fn join(&mut self, ask: &Ask) -> Option<Place> {
        self.blocks.iter_mut().enumerate().find_map(|(index, slot)| {
            let block = slot.as_mut().filter(|block| block.may_join(ask))?;
            let offset = block.ranges.take(ask.bytes, ask.alignment)?;
            Some(Place { block: index as u32, offset, new_block_bytes: None })
        })
    }

    /// Shared memory blocks that `ask` may join, were there room.
    fn sibling_count(&self, ask: &Ask) -> usize {
        self.blocks.iter().flatten().filter(|block| block.may_join(ask)).count()
    }

    /// A range of `place` is not used any more. The memory block's bytes, where it was the last one: it ends now.
    pub fn give_back(&mut self, block: u32, offset: u64, bytes: u64) -> Option<u64> {
        let slot = &mut self.blocks[block as usize];
        let ranges = slot.as_mut().expect("a range keeps its memory block");
        if !ranges.ranges.give_back(offset, bytes) {
            return None;
        }
        let (type_index, block_bytes) = (ranges.type_index, ranges.bytes);
        *slot = None;
        let heap = self.heap_of(type_index);
        self.held_bytes[heap] -= block_bytes;
        Some(block_bytes)
    }

    /// The sum of all memory blocks.
    pub fn unusable(&self) -> Unusable {
        let blocks = self.blocks.iter().flatten();
        blocks.fold(Unusable::default(), |sum, Ranges { ranges, .. }| Unusable {
            padding_bytes: sum.padding_bytes + ranges.padding_bytes(),
            gap_bytes: sum.gap_bytes + ranges.gap_bytes(),
            lost_bytes: sum.lost_bytes + ranges.lost_bytes(),
        })
    }

    /// Every memory block as it is now.
    pub fn states(&self) -> Vec<BlockState> {
        let state = |(index, slot): (usize, &Option<Ranges>)| {
            let Ranges { type_index, bytes, ranges, .. } = slot.as_ref()?;
            Some(BlockState {
                index: index as u32,
                memory_type: *type_index,
                bytes: *bytes,
                used_bytes: ranges.used_bytes(),
                free_bytes: ranges.free_bytes(),
                largest_free_bytes: ranges.largest_free_bytes(),
                fragmentation: ranges.fragmentation(),
            })
        };
        self.blocks.iter().enumerate().filter_map(state).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Choice;
    use crate::memory::Strategy;
    use proptest::prelude::{any, prop, prop_assert, prop_assert_eq, prop_oneof, proptest};
    use proptest::strategy::Strategy as Made;
    use std::collections::BTreeMap;

    const MIB: u64 = 1 << 20;

    fn rules(strategy: Strategy, budget_bytes: Option<u64>) -> Rules {
        // Type 0 lies in heap 0, types 1 and 2 in heap 1.
        Rules {
            strategy,
            cut: None,
            block_bytes: SHARED_BLOCK_BYTES,
            budget_bytes,
            heap_bytes: vec![256 * MIB, 64 * MIB],
            heap_of_type: vec![0, 1, 1],
            max_allocation_bytes: 128 * MIB,
            max_allocation_count: u32::MAX,
        }
    }

    fn ask(bytes: u64) -> Ask {
        Ask { bytes, alignment: 256, type_index: 0, mapped: false, tiling: Tiling::Linear, alone: false }
    }

    fn asks() -> impl Made<Value = Vec<(Ask, bool)>> {
        let bytes = prop_oneof![1..4096u64, 1..MIB, 1..12 * MIB];
        let one = (bytes, 0u32..13, 0u32..3, any::<bool>(), 0u32..10, any::<bool>()).prop_map(
            |(bytes, power, type_index, is_image, alone, keep)| {
                let tiling = if is_image { Tiling::Optimal } else { Tiling::Linear };
                let alone = alone == 0;
                (Ask { bytes, alignment: 1 << power, type_index, mapped: type_index == 2, tiling, alone }, keep)
            },
        );
        prop::collection::vec(one, 1..80)
    }

    proptest! {
        /// A model of every live range, and of what each heap holds.
        #[test]
        fn ranges_are_apart_tilings_never_mix_and_no_heap_passes_its_limit(
            asks in asks(),
            budget in prop::option::of(1..80 * MIB),
        ) {
            for &strategy in Strategy::ALL {
                let mut pool = Pool::new(rules(strategy, budget));
                let mut live: Vec<(Ask, Place)> = Vec::new();
                let mut blocks: BTreeMap<u32, u64> = BTreeMap::new();
                for (ask, keep) in &asks {
                    let place = match pool.place(ask) {
                        Ok(place) => place,
                        Err(misfit) => {
                            let Misfit::Spent { limit_bytes, held_bytes, is_budget } = misfit else {
                                panic!("no ask is that large: {misfit:?}")
                            };
                            prop_assert!(held_bytes + ask.bytes > limit_bytes);
                            prop_assert!(!is_budget || Some(limit_bytes) == budget);
                            continue;
                        }
                    };
                    if let Some(bytes) = place.new_block_bytes {
                        prop_assert!(blocks.insert(place.block, bytes).is_none(), "a live block was made again");
                    }
                    prop_assert_eq!(place.offset % ask.alignment, 0);
                    prop_assert!(place.offset + ask.bytes <= blocks[&place.block]);
                    for (other, theirs) in live.iter().filter(|(_, theirs)| theirs.block == place.block) {
                        prop_assert!(!ask.alone && !other.alone, "somebody joined a block of its own");
                        let behind = place.offset >= theirs.offset + other.bytes;
                        prop_assert!(behind || place.offset + ask.bytes <= theirs.offset, "two ranges overlap");
                        prop_assert_eq!(ask.tiling, other.tiling, "within bufferImageGranularity of each other");
                        prop_assert_eq!((ask.type_index, ask.mapped), (other.type_index, other.mapped));
                    }
                    live.push((*ask, place));
                    let heap_sum = |types: &[u32]| -> u64 {
                        pool.states().iter().filter(|one| types.contains(&one.memory_type)).map(|one| one.bytes).sum()
                    };
                    let limit = budget.unwrap_or(u64::MAX);
                    prop_assert!(heap_sum(&[0]) <= limit.min(256 * MIB) && heap_sum(&[1, 2]) <= limit.min(64 * MIB));
                    prop_assert_eq!(heap_sum(&[0, 1, 2]), blocks.values().sum::<u64>());
                    if !keep {
                        let (ask, place) = live.swap_remove(live.len() / 2);
                        let freed = pool.give_back(place.block, place.offset, ask.bytes);
                        let is_last = live.iter().all(|(_, theirs)| theirs.block != place.block);
                        prop_assert_eq!(freed.is_some(), is_last);
                        if is_last {
                            prop_assert_eq!(freed, blocks.remove(&place.block));
                        }
                    }
                }
                for (ask, place) in live {
                    pool.give_back(place.block, place.offset, ask.bytes);
                }
                prop_assert_eq!(pool.states().len(), 0);
                prop_assert!(pool.held_bytes.iter().all(|held| *held == 0));
            }
        }
    }

    #[test]
    fn where_little_is_left_shared_blocks_are_small_and_large_resources_take_what_they_need() {
        for strategy in Strategy::ALL.iter().copied().filter(|strategy| strategy.shares_blocks()) {
            let mut pool = Pool::new(rules(strategy, Some(20 * MIB)));
            let mut place = |bytes| pool.place(&ask(bytes)).map(|place| place.new_block_bytes);
            // Four times as much is wanted; an eighth of 20 MiB, rounded down to a power of two, is given.
            assert_eq!(place(MIB - 1000), Ok(Some(2 * MIB)));
            assert_eq!(place(MIB), Ok(None), "the shared block has room");
            assert_eq!(place(7 * MIB), Ok(Some(7 * MIB)));
            assert_eq!(place(10 * MIB), Ok(Some(10 * MIB)));
            let spent = |held: u64| Misfit::Spent { limit_bytes: 20 * MIB, held_bytes: held * MIB, is_budget: true };
            assert_eq!(place(3 * MIB), Err(spent(19)));
            assert_eq!(place(MIB), Ok(Some(MIB)), "to the last byte");
            // What lies behind the first resource, the second one's power of two has not left to others.
            let last = if strategy == Strategy::Buddy { Err(spent(20)) } else { Ok(None) };
            assert_eq!(place(100), last);
            // The other heap has a limit of its own.
            assert!(pool.place(&Ask { type_index: 1, ..ask(3 * MIB) }).is_ok());
        }
        assert_eq!(
            [1 << 40, 128 * MIB, 127 * MIB, 8, 7, 0].map(|left| shared_block_bytes(4, 1, left, 16 * MIB)),
            [16 * MIB, 16 * MIB, 8 * MIB, 1, 0, 0]
        );
        // The first of its kind is small, the fifth is full-grown; a resource takes at most a quarter of a new one.
        assert_eq!(
            [0, 1, 4, 9].map(|siblings| shared_block_bytes(siblings, 1, 1 << 40, 16 * MIB) / MIB),
            [1, 2, 16, 16]
        );
        assert_eq!(shared_block_bytes(0, 3 * MIB, 1 << 40, 16 * MIB), 16 * MIB);
        assert_eq!([0, 9].map(|siblings| shared_block_bytes(siblings, 1, 1 << 40, MIB / 4)), [MIB / 4; 2]);
    }

    /// Textures of any one size, many of them, leave little of what is allocated unused.
    #[test]
    fn many_resources_of_one_size_fill_their_memory_blocks() {
        for strategy in Strategy::ALL.iter().copied().filter(|strategy| strategy.shares_blocks()) {
            // Pictures of 2048, 1024, 512 and 64 texels a side with their levels, and sizes that divide a block badly.
            for bytes in [22_369_664, 5_592_448, 1_398_144, 22_016, 9 * MIB, 4 * MIB, 4 * MIB - 256, 13 * MIB / 4] {
                let mut pool = Pool::new(Rules::of_one_heap(strategy, 1 << 40));
                for _ in 0..200 {
                    pool.place(&Ask { tiling: Tiling::Optimal, ..ask(bytes) }).unwrap();
                }
                let is_rounded = strategy == Strategy::Buddy && bytes < SHARED_BLOCK_BYTES / OWN_BLOCK_PART;
                let (used, held) =
                    (200 * if is_rounded { bytes.next_power_of_two() } else { bytes }, pool.held_bytes(0));
                assert!(
                    held <= used / 4 * 5 + SHARED_BLOCK_BYTES,
                    "{strategy:?}: {held} for {used} in parts of {bytes}"
                );
            }
        }
    }

    /// `--memory-block`: how large shared memory blocks become, and from which size on a resource has one of its own.
    #[test]
    fn shared_memory_blocks_are_as_large_as_they_may_be() {
        for (block, count, own) in [(MIB / 4, 16, MIB / 16), (MIB, 4, MIB / 4), (64 * MIB, 3, 16 * MIB)] {
            let mut pool = Pool::new(Rules { block_bytes: block, ..Rules::of_one_heap(Strategy::Tlsf, 1 << 40) });
            for _ in 0..64 {
                pool.place(&ask(MIB / 16 - 256)).unwrap();
            }
            // 1 + 2 + 4 MiB hold the 4 MiB where blocks may grow.
            let sizes: Vec<u64> = pool.states().iter().map(|state| state.bytes).collect();
            assert_eq!((sizes.len(), *sizes.iter().max().unwrap()), (count, block.min(4 * MIB)), "{sizes:?}");
            assert_eq!(pool.place(&ask(own)).unwrap().new_block_bytes, Some(own));
        }
    }

    #[test]
    fn the_heap_is_the_limit_where_the_budget_is_larger_or_absent() {
        for budget in [None, Some(1 << 40)] {
            let mut pool = Pool::new(rules(Strategy::Dedicated, budget));
            for _ in 0..2 {
                pool.place(&ask(100 * MIB)).unwrap();
            }
            let spent = Misfit::Spent { limit_bytes: 256 * MIB, held_bytes: 200 * MIB, is_budget: false };
            assert_eq!(pool.place(&ask(100 * MIB)), Err(spent));
            assert_eq!(pool.place(&ask(129 * MIB)), Err(Misfit::TooLarge { most_bytes: 128 * MIB }));
        }
    }

    #[test]
    fn no_more_memory_blocks_are_made_than_the_device_allows() {
        let few = Rules { max_allocation_count: 3, ..rules(Strategy::Dedicated, None) };
        let mut pool = Pool::new(few);
        let places: Vec<Place> = (0..3).map(|_| pool.place(&ask(MIB)).unwrap()).collect();
        assert_eq!(pool.place(&ask(MIB)), Err(Misfit::TooMany { most: 3 }));
        pool.give_back(places[1].block, places[1].offset, MIB);
        pool.place(&ask(MIB)).unwrap();
        // Ranges of one block are one.
        let mut pool = Pool::new(Rules { max_allocation_count: 1, ..rules(Strategy::Linear, None) });
        for _ in 0..3 {
            pool.place(&ask(1024)).unwrap();
        }
    }
}
