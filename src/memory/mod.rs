//! The only module that calls vkAllocateMemory: it decides memory type, memory block and range, and keeps the owners.
//!
//! A resource asks with its name, its group and its requirements; it gets an `Allocation`, a range in a memory block,
//! which returns itself when dropped. Resources that share bytes get theirs from an `Arena`. `pool` decides in numbers,
//! this file makes it real, and the ledger keeps every byte's owner while it lives.

pub mod alias;
mod arena;
pub mod block;
pub mod kinds;
pub mod ledger;
pub mod pool;
pub mod refusal;
pub mod rehearsal;
mod request;
pub mod suballocate;
pub mod touched;
pub mod trace;

use crate::caps::Caps;
use crate::error::{Error, Result};
use crate::units::Bytes;
use ash::vk;
use block::Block;
use kinds::{Choice, Kinds, Use};
use ledger::{Entry, Ledger};
use pool::{Ask, Misfit, Place, Pool, Rules};
use refusal::Refusal;
pub use request::{Request, Strategy, Tiling};
use std::collections::BTreeMap;
use std::ffi::CString;
use std::sync::{Arc, Mutex, MutexGuard};
use trace::Recorder;

/// A range in a memory block; returns itself when dropped.
pub struct Allocation {
    memory: Arc<Memory>,
    entry: u64,
    source: Source,
    pub handle: vk::DeviceMemory,
    pub offset: u64,
    /// Where the host sees the range; None where it cannot.
    pub mapped: Option<std::ptr::NonNull<u8>>,
}

/// Whose range it is.
enum Source {
    /// A range of its own.
    Range { block: u32, bytes: u64 },
    /// A part of an arena, which stays as long as any of its parts.
    Part { _arena: Arc<Arena> },
}

// SAFETY: the pointer leads into memory that lives as long as the block, which the allocation keeps alive; who writes
// through it holds the buffer mutably.
unsafe impl Send for Allocation {}
// SAFETY: as above; shared references only read.
unsafe impl Sync for Allocation {}

/// A memory block for parts that share its bytes. It returns when the last part and the last handle are dropped.
pub struct Arena {
    memory: Arc<Memory>,
    entry: u64,
    ask: Ask,
    usage: Use,
    reason: &'static str,
    made: Made,
}

// SAFETY: the mapped pointer leads into the arena's own block; it is only handed out with a part, see `Allocation`.
unsafe impl Send for Arena {}
// SAFETY: as above.
unsafe impl Sync for Arena {}

/// Memory blocks, the choice of types, and the ledger of one device.
pub struct Memory {
    device: ash::Device,
    names: Option<ash::ext::debug_utils::Device>,
    kinds: Kinds,
    /// None: nobody wants to know.
    recorder: Option<Arc<Recorder>>,
    state: Mutex<State>,
}

struct State {
    pool: Pool,
    /// What the pool's memory blocks are on the device.
    blocks: BTreeMap<u32, Block>,
    ledger: Ledger,
    /// What each owner of bytes asked for, by its key in the ledger.
    asks: BTreeMap<u64, Ask>,
    refusal: Option<Refusal>,
}

/// A place that is there on the device too.
struct Made {
    place: Place,
    handle: vk::DeviceMemory,
    mapped: Option<std::ptr::NonNull<u8>>,
}

impl Memory {
    /// `names`: where memory blocks get the names that tools show. `rules`: those of `caps`. `recorder`: keeps what is asked
    /// for and comes back.
    pub fn new(
        device: ash::Device,
        names: Option<ash::ext::debug_utils::Device>,
        caps: &Caps,
        rules: Rules,
        recorder: Option<Arc<Recorder>>,
    ) -> Self {
        let state = State {
            pool: Pool::new(rules),
            blocks: BTreeMap::new(),
            ledger: Ledger::default(),
            asks: BTreeMap::new(),
            refusal: None,
        };
        Self { device, names, kinds: Kinds::new(caps), recorder, state: Mutex::new(state) }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A panic while the lock was held leaves numbers that are still consistent: each step is a single push or take.
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// These requirements in numbers, with the memory type that the use gets.
    ///
    /// Errors: no memory type fits (exit code 4).
    pub fn ask(&self, requirements: &vk::MemoryRequirements, usage: Use, tiling: Tiling) -> Result<Ask> {
        Ok(asked(requirements, &self.kinds.choose(usage, requirements.memory_type_bits)?, tiling))
    }

    /// Finds or makes room for one resource.
    ///
    /// Errors: no memory type fits, the budget or the heap is spent, one memory block may not be that large, or the driver
    /// refuses (exit code 4).
    pub fn allocate(self: &Arc<Self>, request: &Request<'_>) -> Result<Allocation> {
        let Request { name, group, bytes, ref requirements, usage, tiling } = *request;
        let choice = self.kinds.choose(usage, requirements.memory_type_bits);
        let choice = choice.map_err(|error| error.within(format!("allocating {name}")))?;
        let ask = asked(requirements, &choice, tiling);
        let mut state = self.state();
        let Made { place, handle, mapped } = self.make(&mut state, &ask, name, usage)?;
        let entry = state.ledger.enter(Entry {
            name: name.to_owned(),
            group: group.to_owned(),
            bytes,
            bound_bytes: ask.bytes,
            memory_block: place.block,
            offset: place.offset,
            memory_type: ask.type_index,
            reason: choice.reason,
            arena: None,
        });
        self.record_take(entry, &ask, name);
        state.asks.insert(entry, ask);
        let source = Source::Range { block: place.block, bytes: ask.bytes };
        Ok(Allocation { memory: self.clone(), entry, source, handle, offset: place.offset, mapped })
    }

    /// Decides and makes. Nothing is left behind where either fails.
    fn make(&self, state: &mut State, ask: &Ask, name: &str, usage: Use) -> Result<Made> {
        state.refusal = None;
        let place = state.pool.place(ask).map_err(|misfit| refuse(state, ask, name, usage, misfit))?;
        if let Some(block_bytes) = place.new_block_bytes {
            match Block::allocate(&self.device, ask.type_index, block_bytes, ask.mapped) {
                Ok(block) => {
                    state.ledger.block_made(block_bytes);
                    self.name(&block, place.block);
                    state.blocks.insert(place.block, block);
                }
                Err(result) => {
                    state.pool.give_back(place.block, place.offset, ask.bytes);
                    return Err(Error::memory(format!("{}: {result}", allocating(ask, name, usage))).note(held(
                        &state.ledger,
                        &state.pool,
                        ask.type_index,
                    )));
                }
            }
        }
        let block = &state.blocks[&place.block];
        Ok(Made { place, handle: block.handle, mapped: block.mapped_at(place.offset) })
    }

    fn record_take(&self, entry: u64, ask: &Ask, name: &str) {
        if let Some(recorder) = &self.recorder {
            recorder.take(entry, ask, name);
        }
    }

    fn record_give(&self, entry: u64) {
        if let Some(recorder) = &self.recorder {
            recorder.give(entry);
        }
    }

    fn give_back(&self, state: &mut State, block: u32, offset: u64, bytes: u64) {
        if let Some(block_bytes) = state.pool.give_back(block, offset, bytes) {
            let mut block = state.blocks.remove(&block).expect("the pool's blocks are the device's");
            block.free(&self.device);
            state.ledger.block_freed(block_bytes);
        }
    }

    fn name(&self, block: &Block, index: u32) {
        let (Some(names), Ok(text)) = (&self.names, CString::new(format!("memory_block.{index}"))) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(block.handle).object_name(&text);
        // SAFETY: the memory was just made from this device. A refused name costs nothing but the name.
        let _ = unsafe { names.set_debug_utils_object_name(&info) };
    }

    /// What is held now and was held at the peak.
    pub fn snapshot(&self) -> ledger::Snapshot {
        let state = self.state();
        state.ledger.snapshot(state.pool.states())
    }

    /// What the budget or a heap has just refused, once; None where the last request was not refused by them.
    pub fn take_refusal(&self) -> Option<Refusal> {
        self.state().refusal.take()
    }

    /// Called once, when the device closes: the ledger must be empty by then.
    pub(crate) fn close(&self) {
        let leaked = self.state().ledger.all_owners();
        // A panic on its way out drops things in an order of its own; a second panic would hide the first.
        if !std::thread::panicking() {
            assert!(leaked.is_empty(), "the device closes and the ledger is not empty: {}", leaked.join(", "));
        }
    }
}

fn asked(requirements: &vk::MemoryRequirements, choice: &Choice, tiling: Tiling) -> Ask {
    let Choice { type_index, mapped, .. } = *choice;
    Ask { bytes: requirements.size, alignment: requirements.alignment, type_index, mapped, tiling, alone: false }
}

fn allocating(ask: &Ask, name: &str, usage: Use) -> String {
    format!("allocating {name} ({}, {usage}, type {})", Bytes(ask.bytes), ask.type_index)
}

/// What the heap of this memory type holds, and for which resources.
fn held(ledger: &Ledger, pool: &Pool, type_index: u32) -> String {
    let groups = ledger.greatest_groups(3, |other| pool.share_a_heap(other, type_index));
    if groups.is_empty() {
        return "nothing else is held".to_owned();
    }
    let bytes = Bytes(pool.held_bytes(type_index));
    format!("{bytes} are held in memory blocks, most of it by {}", groups.join(", "))
}

fn refuse(state: &mut State, ask: &Ask, name: &str, usage: Use, misfit: Misfit) -> Error {
    if let Misfit::Spent { .. } = misfit {
        let owners: BTreeMap<u64, &str> = state.ledger.names().collect();
        let named = |(key, ask): (&u64, &Ask)| (owners[key].to_owned(), *ask);
        let held_now = state.asks.iter().map(named).collect();
        let rules = state.pool.rules().clone();
        state.refusal = Some(Refusal { rules, held: held_now, name: name.to_owned(), ask: *ask });
    }
    refused(&state.ledger, &state.pool, ask, name, usage, misfit)
}

/// The error for a resource that fits nowhere, with what holds how many bytes.
fn refused(ledger: &Ledger, pool: &Pool, ask: &Ask, name: &str, usage: Use, misfit: Misfit) -> Error {
    let what = allocating(ask, name, usage);
    match misfit {
        Misfit::TooLarge { most_bytes } => {
            Error::memory(format!("{what}: the device makes memory blocks of at most {}", Bytes(most_bytes)))
        }
        Misfit::TooMany { most } => Error::memory(format!(
            "{what}: the device makes at most {most} memory blocks (maxMemoryAllocationCount), and that many \
             exist already"
        ))
        .note("--allocation linear, tlsf and buddy put several resources into one"),
        Misfit::Spent { limit_bytes, held_bytes, is_budget } => {
            let limit = if is_budget { "the budget" } else { "the heap" };
            let spent = if held_bytes > 0 { "spent" } else { "too small for it" };
            Error::memory(format!("{what}: {limit} of {} is {spent}", Bytes(limit_bytes))).note(held(
                ledger,
                pool,
                ask.type_index,
            ))
        }
    }
}

impl Drop for Allocation {
    fn drop(&mut self) {
        let mut state = self.memory.state();
        state.ledger.leave(self.entry);
        // A part holds no bytes of its own; its arena goes after this lock, when the fields do.
        if let Source::Range { block, bytes } = self.source {
            state.asks.remove(&self.entry);
            self.memory.record_give(self.entry);
            self.memory.give_back(&mut state, block, self.offset, bytes);
        }
    }
}

impl Drop for Arena {
    fn drop(&mut self) {
        let mut state = self.memory.state();
        state.ledger.leave_arena(self.entry);
        state.asks.remove(&self.entry);
        self.memory.record_give(self.entry);
        self.memory.give_back(&mut state, self.made.place.block, self.made.place.offset, self.ask.bytes);
    }
}
