//! Where a resource's bytes come from: bytes of its own, or a part of an arena that others had before it in the frame.

use super::access::AccessSet;
use crate::error::Result;
use crate::memory::{Allocation, Arena, Memory, Request};
use std::sync::Arc;

/// Where to bind a resource.
#[derive(Clone, Copy)]
pub enum Berth<'a> {
    Own,
    /// From `offset` on in the arena. `takes_over`: the last accesses of the resources that lay there, which the first
    /// barrier waits for.
    Part {
        arena: &'a Arc<Arena>,
        offset: u64,
        takes_over: AccessSet,
    },
}

impl Berth<'_> {
    /// Errors: as `Memory::allocate`, `Arena::part` (exit code 4).
    pub(super) fn allocate(&self, memory: &Arc<Memory>, request: &Request<'_>) -> Result<Allocation> {
        match self {
            Self::Own => memory.allocate(request),
            Self::Part { arena, offset, .. } => arena.part(request, *offset),
        }
    }

    pub(super) fn takes_over(&self) -> AccessSet {
        match self {
            Self::Own => AccessSet::UNTOUCHED,
            Self::Part { takes_over, .. } => *takes_over,
        }
    }
}
