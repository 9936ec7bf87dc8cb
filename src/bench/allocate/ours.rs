//! This program's own allocator as a player: its numbers alone, and with a device's memory behind them.

use super::play::{Accounted, Player, State};
use crate::caps::Caps;
use crate::error::Result;
use crate::gpu::Gpu;
use crate::memory::kinds::Use;
use crate::memory::pool::{Ask, Misfit, Pool, Rules, Unusable};
use crate::memory::{Allocation, Arena, Memory, Request};
use crate::units::Bytes;
use ash::vk;
use std::sync::Arc;

/// The pool's numbers.
pub struct Numbers {
    pool: Pool,
    held_bytes: u64,
    /// Memory block, offset and bytes.
    live: Vec<Option<(u32, u64, u64)>>,
}

impl Numbers {
    pub fn new(rules: Rules, slot_count: usize) -> Self {
        Self { pool: Pool::new(rules), held_bytes: 0, live: vec![None; slot_count] }
    }
}

fn words(misfit: Misfit) -> String {
    match misfit {
        Misfit::TooLarge { most_bytes } => format!("a memory block has at most {}", Bytes(most_bytes)),
        Misfit::TooMany { most } => format!("there are {most} memory blocks already (maxMemoryAllocationCount)"),
        Misfit::Spent { limit_bytes, .. } => format!("the heap of {} is spent", Bytes(limit_bytes)),
    }
}

impl Player for Numbers {
    fn take(&mut self, slot: usize, ask: &Ask) -> std::result::Result<(), String> {
        let place = self.pool.place(ask).map_err(words)?;
        self.held_bytes += place.new_block_bytes.unwrap_or(0);
        self.live[slot] = Some((place.block, place.offset, ask.bytes));
        Ok(())
    }

    fn give(&mut self, slot: usize) {
        let (block, offset, bytes) = self.live[slot].take().expect("a script gives what it took");
        self.held_bytes -= self.pool.give_back(block, offset, bytes).unwrap_or(0);
    }
}

impl Accounted for Numbers {
    fn held_bytes(&self) -> u64 {
        self.held_bytes
    }

    fn state(&self, _live_bytes: u64) -> State {
        let blocks = self.pool.states();
        let Unusable { padding_bytes, gap_bytes, lost_bytes } = self.pool.unusable();
        State {
            memory_blocks: blocks.len() as u64,
            bytes: self.held_bytes,
            free_bytes: blocks.iter().map(|block| block.free_bytes).sum(),
            largest_free_bytes: blocks.iter().map(|block| block.largest_free_bytes).max().unwrap_or(0),
            padding_bytes,
            gap_bytes,
            lost_bytes,
        }
    }
}

/// A live allocation of a device: it returns when dropped.
enum Held {
    Range(#[expect(dead_code, reason = "dropped")] Allocation),
    Whole(#[expect(dead_code, reason = "dropped")] Arc<Arena>),
}

/// Memory blocks on a device, with a ledger of who has them.
pub struct OnDevice {
    live: Vec<Option<Held>>,
    memory: Arc<Memory>,
}

impl OnDevice {
    pub fn new(gpu: &Gpu, caps: &Caps, rules: Rules, slot_count: usize) -> Self {
        let memory = Arc::new(Memory::new(gpu.device.clone(), None, caps, rules, None));
        Self { live: (0..slot_count).map(|_| None).collect(), memory }
    }

    fn held(&self, ask: &Ask) -> Result<Held> {
        const NAME: &str = "bench.allocate";
        let Ask { bytes, alignment, type_index, mapped, tiling, alone } = *ask;
        let memory_type_bits = 1 << type_index;
        let usage = if mapped { Use::Upload } else { Use::Device };
        if alone {
            return self.memory.arena(NAME, "bench", bytes, alignment, memory_type_bits, usage).map(Held::Whole);
        }
        let requirements = vk::MemoryRequirements { size: bytes, alignment, memory_type_bits };
        self.memory
            .allocate(&Request { name: NAME, group: "bench", bytes, requirements, usage, tiling })
            .map(Held::Range)
    }
}

impl Player for OnDevice {
    fn take(&mut self, slot: usize, ask: &Ask) -> std::result::Result<(), String> {
        self.live[slot] = Some(self.held(ask).map_err(|error| error.message().to_owned())?);
        Ok(())
    }

    fn give(&mut self, slot: usize) {
        self.live[slot] = None;
    }
}
