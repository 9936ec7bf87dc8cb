//! An arena: a memory block of its own in which several resources share bytes, each in its own passes.
//!
//! Where the parts lie is decided elsewhere (`alias::place`), because only a plan knows lifetimes. Buffers and optimal
//! images may both be in an arena: the caller that places them aligns them to bufferImageGranularity at least.

use super::ledger::{ArenaEntry, Entry};
use super::pool::Ask;
use super::{Allocation, Arena, Made, Memory, Request, Source, Tiling};
use crate::error::{Error, Result};
use crate::memory::kinds::Use;
use ash::vk;
use std::sync::Arc;

impl Memory {
    /// Makes a memory block of `bytes` (at least 1) for parts whose alignments are at most `alignment` (a power of two),
    /// in the best type for `usage` among those that `memory_type_bits` allows: the types that every part allows.
    ///
    /// Errors: as `allocate` (exit code 4).
    pub fn arena(
        self: &Arc<Self>,
        name: &str,
        group: &str,
        bytes: u64,
        alignment: u64,
        memory_type_bits: u32,
        usage: Use,
    ) -> Result<Arc<Arena>> {
        assert!(bytes > 0 && alignment.is_power_of_two(), "{name}: {bytes} bytes aligned to {alignment}");
        let choice = self.kinds.choose(usage, memory_type_bits);
        let choice = choice.map_err(|error| error.within(format!("allocating {name}")))?;
        let (type_index, mapped) = (choice.type_index, choice.mapped);
        let ask = Ask { bytes, alignment, type_index, mapped, tiling: Tiling::Linear, alone: true };
        let mut state = self.state();
        let made = self.make(&mut state, &ask, name, usage)?;
        let entry = state.ledger.enter_arena(ArenaEntry {
            name: name.to_owned(),
            group: group.to_owned(),
            bytes,
            memory_block: made.place.block,
            memory_type: type_index,
            parts_bytes: 0,
        });
        self.record_take(entry, &ask, name);
        state.asks.insert(entry, ask);
        Ok(Arc::new(Arena { memory: self.clone(), entry, ask, usage, reason: choice.reason, made }))
    }
}

impl Arena {
    /// The whole arena's size.
    pub fn bytes(&self) -> u64 {
        self.ask.bytes
    }

    /// The bytes from `offset` (in the arena) on, for one resource, even if another resource holds them too. A part
    /// that is not aligned as it asks, lies beyond the arena's end or is for another use is a programmer's mistake.
    ///
    /// Errors: the resource may not be in the arena's memory type (exit code 4).
    pub fn part(self: &Arc<Self>, request: &Request<'_>, offset: u64) -> Result<Allocation> {
        let Request {
            name,
            group,
            bytes,
            requirements: vk::MemoryRequirements { size, alignment, memory_type_bits },
            ..
        } = *request;
        let type_index = self.ask.type_index;
        assert!(request.usage == self.usage, "{name} is {}, its arena {}", request.usage, self.usage);
        assert!(
            alignment <= self.ask.alignment && offset.is_multiple_of(alignment),
            "{name} at {offset} is not aligned to {alignment} in an arena of {}",
            self.ask.alignment
        );
        let end = offset.checked_add(size);
        assert!(
            end.is_some_and(|end| end <= self.ask.bytes),
            "{name}: {size} bytes at {offset} end beyond the arena's {}",
            self.ask.bytes
        );
        if memory_type_bits & (1 << type_index) == 0 {
            return Err(Error::device(format!(
                "allocating {name}: the driver does not allow it in its arena's memory type {type_index} (mask \
                 {memory_type_bits:#b})"
            )));
        }
        let Made { place, handle, mapped } = &self.made;
        let entry = self.memory.state().ledger.enter(Entry {
            name: name.to_owned(),
            group: group.to_owned(),
            bytes,
            bound_bytes: size,
            memory_block: place.block,
            offset,
            memory_type: type_index,
            reason: self.reason,
            arena: Some(self.entry),
        });
        // SAFETY: the part lies inside the arena, so the pointer stays inside the mapping.
        let mapped = mapped.map(|start| unsafe { start.add(offset as usize) });
        let (memory, source) = (self.memory.clone(), Source::Part { _arena: self.clone() });
        Ok(Allocation { memory, entry, source, handle: *handle, offset, mapped })
    }
}
