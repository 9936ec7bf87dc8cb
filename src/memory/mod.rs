//! The only room that calls vkAllocateMemory: which type, which memory block, which range, and whose it is.
//!
//! A resource asks with its name, its group and its requirements; it gets an `Allocation`, a range in a memory block,
//! which returns itself when dropped. The ledger keeps every byte's owner while it lives.

pub mod alias;
pub mod block;
pub mod kinds;
pub mod ledger;
pub mod suballocate;

use crate::error::{Error, Result};
use crate::gpu::Caps;
use crate::units::Bytes;
use ash::vk;
use block::Block;
use kinds::{Kinds, Use};
use ledger::{Entry, Ledger};
use std::ffi::CString;
use std::sync::{Arc, Mutex, MutexGuard};
use suballocate::Linear;

/// How resources come by their memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strategy {
    /// One memory block for each resource.
    Dedicated,
    /// Ranges one after the other in shared memory blocks; a block returns whole, when its last range does.
    #[default]
    Linear,
}

/// Size of a shared memory block. Resources of at least half of it get a memory block of their own.
pub const LINEAR_BLOCK_BYTES: u64 = 16 << 20;

/// Buffers and linear images on one side, optimally tiled images on the other: the two sides never share a memory
/// block, so bufferImageGranularity can never be violated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tiling {
    Linear,
    Optimal,
}

/// What a resource asks for.
pub struct Request<'a> {
    /// Full name: `interleaved_deferred.gather.irradiance`.
    pub name: &'a str,
    /// Row of the memory table: `scene.textures`.
    pub group: &'a str,
    /// Bytes asked for by arithmetic; the driver's requirement may be larger.
    pub bytes: u64,
    pub requirements: vk::MemoryRequirements,
    pub usage: Use,
    pub tiling: Tiling,
}

/// A range in a memory block; returns itself when dropped.
pub struct Allocation {
    memory: Arc<Memory>,
    block: u32,
    range_bytes: u64,
    entry: u64,
    pub handle: vk::DeviceMemory,
    pub offset: u64,
    /// Where the host sees the range; None where it cannot.
    pub mapped: Option<std::ptr::NonNull<u8>>,
}

// SAFETY: the pointer leads into memory that lives as long as the block, which the allocation keeps alive; who writes
// through it holds the buffer mutably.
unsafe impl Send for Allocation {}
// SAFETY: as above; shared references only read.
unsafe impl Sync for Allocation {}

/// Memory blocks, the choice of types, and the ledger of one device.
pub struct Memory {
    device: ash::Device,
    names: Option<ash::ext::debug_utils::Device>,
    kinds: Kinds,
    strategy: Strategy,
    max_allocation_bytes: u64,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    blocks: Vec<Option<Shared>>,
    ledger: Ledger,
}

/// A memory block and who may still join it.
struct Shared {
    block: Block,
    tiling: Tiling,
    ranges: Linear,
    dedicated: bool,
}

impl Memory {
    /// `names`: where memory blocks get the names that tools show.
    pub fn new(
        device: ash::Device,
        names: Option<ash::ext::debug_utils::Device>,
        caps: &Caps,
        strategy: Strategy,
    ) -> Self {
        Self {
            device,
            names,
            kinds: Kinds::new(caps),
            strategy,
            max_allocation_bytes: caps.limits.max_allocation_bytes,
            state: Mutex::new(State::default()),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A panic while the lock was held leaves numbers that are still consistent: each step is a single push or take.
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Finds or makes room for one resource.
    ///
    /// Errors: no memory type fits, the driver refuses, or one allocation may not be that large (exit code 4).
    pub fn allocate(self: &Arc<Self>, request: &Request<'_>) -> Result<Allocation> {
        let choice = self.kinds.choose(request.usage, request.requirements.memory_type_bits);
        let choice = choice.map_err(|error| error.within(format!("allocating {}", request.name)))?;
        let size = request.requirements.size;
        let mut state = self.state();
        if size > self.max_allocation_bytes {
            return Err(self
                .refused(&state, request, choice.type_index, "one allocation may not be that large here")
                .note(format!("the device allows {} an allocation", Bytes(self.max_allocation_bytes))));
        }
        let shared = self.strategy == Strategy::Linear && size < LINEAR_BLOCK_BYTES / 2;
        let found = shared.then(|| {
            state.blocks.iter_mut().enumerate().find_map(|(index, slot)| {
                let slot = slot.as_mut()?;
                let block = &slot.block;
                let fits = block.type_index == choice.type_index && block.is_mapped() == choice.mapped;
                if slot.dedicated || slot.tiling != request.tiling || !fits {
                    return None;
                }
                Some((index, slot.ranges.take(size, request.requirements.alignment)?))
            })
        });
        let (index, offset) = match found.flatten() {
            Some(found) => found,
            None => {
                let block_bytes = if shared { LINEAR_BLOCK_BYTES } else { size };
                let block = Block::allocate(&self.device, choice.type_index, block_bytes, choice.mapped)
                    .map_err(|result| self.refused(&state, request, choice.type_index, &result.to_string()))?;
                let mut ranges = Linear::new(block_bytes);
                let offset =
                    ranges.take(size, request.requirements.alignment).expect("a new block holds its first range");
                let block = Shared { block, tiling: request.tiling, ranges, dedicated: !shared };
                let free = state.blocks.iter().position(Option::is_none);
                let index = free.unwrap_or_else(|| {
                    state.blocks.push(None);
                    state.blocks.len() - 1
                });
                state.ledger.block_made(block_bytes);
                self.name(&block.block, index);
                state.blocks[index] = Some(block);
                (index, offset)
            }
        };
        let block = &state.blocks[index].as_ref().expect("found or made above").block;
        let (handle, mapped) = (block.handle, block.mapped_at(offset));
        let entry = state.ledger.enter(Entry {
            name: request.name.to_owned(),
            group: request.group.to_owned(),
            bytes: request.bytes,
            bound_bytes: size,
            memory_block: index as u32,
            offset,
            memory_type: choice.type_index,
            reason: choice.reason,
        });
        Ok(Allocation { memory: self.clone(), block: index as u32, range_bytes: size, entry, handle, offset, mapped })
    }

    fn name(&self, block: &Block, index: usize) {
        let (Some(names), Ok(text)) = (&self.names, CString::new(format!("memory_block.{index}"))) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(block.handle).object_name(&text);
        // SAFETY: the memory was just made from this device. A refused name costs nothing but the name.
        let _ = unsafe { names.set_debug_utils_object_name(&info) };
    }

    fn refused(&self, state: &State, request: &Request<'_>, type_index: u32, why: &str) -> Error {
        let mut error = Error::device(format!(
            "allocating {} ({}, {}, type {type_index}): {why}",
            request.name,
            Bytes(request.requirements.size),
            request.usage
        ));
        let owners = state.ledger.greatest(3);
        if !owners.is_empty() {
            let held = state.ledger.bound_bytes();
            error = error.note(format!("{} are held, most of them by {}", Bytes(held), owners.join(", ")));
        }
        error
    }

    /// What is held now and was held at the peak.
    pub fn snapshot(&self) -> ledger::Snapshot {
        self.state().ledger.snapshot()
    }

    /// Called once, when the device closes: the ledger must be empty by then.
    pub(crate) fn close(&self) {
        let state = self.state();
        let leaked = state.ledger.greatest(usize::MAX);
        // A panic on its way out drops things in an order of its own; a second panic would hide the first.
        if !std::thread::panicking() {
            assert!(leaked.is_empty(), "the device closes and the ledger is not empty: {}", leaked.join(", "));
        }
    }
}

impl Drop for Allocation {
    fn drop(&mut self) {
        let mut state = self.memory.state();
        state.ledger.leave(self.entry);
        let slot = &mut state.blocks[self.block as usize];
        let shared = slot.as_mut().expect("an allocation keeps its block");
        if shared.ranges.give_back(self.range_bytes) {
            let bytes = shared.block.bytes;
            shared.block.free(&self.memory.device);
            *slot = None;
            state.ledger.block_freed(bytes);
        }
    }
}
