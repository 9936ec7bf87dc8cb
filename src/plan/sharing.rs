//! Sharing: which transient resources lie in the same bytes, and whose bytes each takes over. Arithmetic over lifetimes
//! (`memory::alias`) and what the driver asks for.

use super::{Plan, Requirements};
use crate::caps::{Caps, Limits};
use crate::gpu::AccessSet;
use crate::memory::alias::{self, Mode, Placement, Span};
use crate::memory::kinds::Use;
use crate::settings::Values;
use std::collections::BTreeMap;

/// A resource's part of an arena.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Index into `Plan::resources`.
    pub resource: usize,
    /// In the arena.
    pub offset: u64,
    pub bound_bytes: u64,
    /// Resources that held some of its bytes before it, by index.
    pub predecessors: Vec<usize>,
    /// How those were touched last: the left side of its first barrier.
    pub takes_over: AccessSet,
}

/// Memory that several resources share.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlannedArena {
    /// At most what its parts would take apart from each other.
    pub bytes: u64,
    pub alignment_bytes: u64,
    pub memory_type_bits: u32,
    pub parts: Vec<Part>,
    /// No placement is smaller.
    pub proven_optimal: bool,
}

impl PlannedArena {
    /// Bytes that its parts would take if they shared none.
    fn parts_bytes(&self) -> u64 {
        self.parts.iter().map(|part| part.bound_bytes).sum()
    }
}

/// The arenas of a frame: none with `--alias off`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sharing {
    pub arenas: Vec<PlannedArena>,
}

impl Sharing {
    /// As `--alias` says.
    pub fn of(plan: &Plan, requirements: Requirements<'_>, caps: &Caps, values: &Values) -> Self {
        let mode = values.choice("alias");
        Self::new(plan, requirements, &caps.limits, mode)
    }

    /// `limits`: bufferImageGranularity, to which every part is aligned, because buffers and images lie side by side in an
    /// arena, and how long one block of memory may be.
    pub fn new(plan: &Plan, requirements: Requirements<'_>, limits: &Limits, mode: Mode) -> Self {
        if mode == Mode::Off {
            return Self::default();
        }
        let granularity_bytes = limits.buffer_image_granularity_bytes.max(1);
        // Resources of different memory types cannot share.
        let mut by_type: BTreeMap<u32, Vec<(usize, Span)>> = BTreeMap::new();
        for (index, planned) in plan.resources.iter().enumerate() {
            let Some(lifetime) = plan.lifetime(index) else { continue };
            assert!(planned.shape.usage() == Use::Device, "{}: the host keeps what it sees", planned.name);
            let required = requirements.of(&planned.shape);
            let span = Span {
                bytes: required.bound_bytes,
                alignment: required.alignment_bytes.max(granularity_bytes),
                first: lifetime.first,
                last: lifetime.last,
            };
            by_type.entry(required.memory_type_bits).or_default().push((index, span));
        }
        let arenas = by_type.into_iter().map(|(bits, members)| arena(plan, bits, &members, mode));
        // A coarse granularity may take more between parts than they share, and what no block holds may lie in several.
        let is_worth_it =
            |arena: &PlannedArena| arena.bytes <= arena.parts_bytes() && arena.bytes <= limits.max_allocation_bytes;
        Self { arenas: arenas.filter(is_worth_it).collect() }
    }

    /// Name of an arena among those of `technique`.
    pub fn arena_name(&self, technique: &str, index: usize) -> String {
        if index == 0 { format!("{technique}.shared") } else { format!("{technique}.shared.{index}") }
    }

    /// The part of a resource, and which arena it is of; None where its bytes are its own.
    pub fn part(&self, resource: usize) -> Option<(usize, &Part)> {
        self.arenas.iter().enumerate().find_map(|(index, arena)| {
            arena.parts.iter().find(|part| part.resource == resource).map(|part| (index, part))
        })
    }

    /// Resources that lie in some of the same bytes, by index.
    pub fn shares_with(&self, resource: usize) -> Vec<usize> {
        let Some((arena, own)) = self.part(resource) else { return Vec::new() };
        let meets = |part: &&Part| {
            part.resource != resource
                && part.offset < own.offset + own.bound_bytes
                && own.offset < part.offset + part.bound_bytes
        };
        self.arenas[arena].parts.iter().filter(meets).map(|part| part.resource).collect()
    }

    /// Bytes that sharing saves.
    pub fn aliased_bytes(&self) -> u64 {
        self.arenas.iter().map(|arena| arena.parts_bytes() - arena.bytes).sum()
    }
}

fn arena(plan: &Plan, memory_type_bits: u32, members: &[(usize, Span)], mode: Mode) -> PlannedArena {
    let spans: Vec<Span> = members.iter().map(|(_, span)| *span).collect();
    let placement = alias::place(&spans, mode);
    let before = alias::predecessors(&spans, &placement);
    let Placement { offsets, total_bytes, proven_optimal, .. } = placement;
    let parts = members
        .iter()
        .zip(offsets)
        .zip(before)
        .map(|(((resource, span), offset), before)| {
            let predecessors: Vec<usize> = before.into_iter().map(|index| members[index].0).collect();
            let takes_over = predecessors
                .iter()
                .fold(AccessSet::UNTOUCHED, |known, resource| known.union(plan.last_accesses(*resource)));
            Part { resource: *resource, offset, bound_bytes: span.bytes, predecessors, takes_over }
        })
        .collect();
    let alignment_bytes = spans.iter().map(|span| span.alignment).max().unwrap_or(1);
    PlannedArena { bytes: total_bytes, alignment_bytes, memory_type_bits, parts, proven_optimal }
}
