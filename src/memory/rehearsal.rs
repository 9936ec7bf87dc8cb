//! Memory without a device: needs placed one after the other as `Memory` places them, so that a plan is refused by the numbers,
//! and in the words, of a device.

use super::kinds::Kinds;
use super::ledger::{Entry, Ledger};
use super::pool::{Ask, Place, Pool, Rules};
use super::{Request, asked, refused};
use crate::error::Result;

pub struct Rehearsal<'a> {
    kinds: &'a Kinds,
    pool: Pool,
    ledger: Ledger,
    /// Bytes of the memory blocks.
    held_bytes: u64,
    most_bytes: u64,
}

impl<'a> Rehearsal<'a> {
    pub fn new(rules: Rules, kinds: &'a Kinds) -> Self {
        Self { kinds, pool: Pool::new(rules), ledger: Ledger::default(), held_bytes: 0, most_bytes: 0 }
    }

    /// Greatest sum of the memory blocks so far, bytes.
    pub fn most_bytes(&self) -> u64 {
        self.most_bytes
    }

    /// A resource that stays.
    ///
    /// Errors: as `Memory::allocate`, the driver's own left out (exit code 4).
    pub fn place(&mut self, request: &Request<'_>) -> Result<()> {
        self.take(request, false).map(drop)
    }

    /// An arena: a memory block of its own that stays.
    ///
    /// Errors: as `place`.
    pub fn place_arena(&mut self, request: &Request<'_>) -> Result<()> {
        self.take(request, true).map(drop)
    }

    /// What is given back at once: a copy on its way.
    ///
    /// Errors: as `place`.
    pub fn pass_by(&mut self, request: &Request<'_>) -> Result<()> {
        let (ask, place, entry) = self.take(request, false)?;
        self.ledger.leave(entry);
        self.held_bytes -= self.pool.give_back(place.block, place.offset, ask.bytes).unwrap_or(0);
        Ok(())
    }

    fn take(&mut self, request: &Request<'_>, alone: bool) -> Result<(Ask, Place, u64)> {
        let Request { name, group, bytes, ref requirements, usage, tiling } = *request;
        let choice = self.kinds.choose(usage, requirements.memory_type_bits);
        let choice = choice.map_err(|error| error.within(format!("allocating {name}")))?;
        let ask = Ask { alone, ..asked(requirements, &choice, tiling) };
        let place = self.pool.place(&ask);
        let place = place.map_err(|misfit| refused(&self.ledger, &self.pool, &ask, name, usage, misfit))?;
        self.held_bytes += place.new_block_bytes.unwrap_or(0);
        self.most_bytes = self.most_bytes.max(self.held_bytes);
        let entry = self.ledger.enter(Entry {
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
        Ok((ask, place, entry))
    }
}
