//! Baseline `--shading indirect-gbuffer`: Liktor and Dachsbacher 2012, "Decoupled Deferred Shading for Hardware Rasterization",
//! which Clarberg and Munkberg 2014 compare the memory with (section 6). What is shaded is named as by the lists, a triangle at a
//! pixel of shading space, and found again in a cache while triangles are drawn; of each there is one entry in a compact geometry
//! buffer, to which samples point, and a compute shader shades the entries.
//! reads   the scene, visibility.spids
//! writes  indirect.pointers  buffer, 4 B a sample; indirect.cache  buffer, 4 B an entry of it (`--shading-cache`);
//!         indirect.places, .normals, .base_colors, .radiances  buffers, 16 B a shading sample each; shade.colors  8 B
//!
//! There are as many entries as samples, because each sample makes one at most: the worst case fits, and nothing can overflow.
//!
//! Our reading, where the papers leave a choice or drivers none
//! - samples ask the cache after visibility is known, a pixel's one after the other: theirs ask while triangles are drawn, and
//!   entries of what is covered later stay, of which it is unknown how many there are before they are drawn
//! - the cache is one of all samples, their first kind; its words are samples, whose SPIDs are the keys, so that no thread waits
//!   for another: lanes of a subgroup that did would wait forever. Where eight places in a row are taken, one forgets what it
//!   had: what is asked for again is shaded again, and counted (`shading_samples_forgotten`)
//! - an entry has floats, 64 bytes, so that its colour has the bits of the lists'
//! - samples that shading space has no place for have entries of their own

mod compact;
pub mod gbuffer;
pub mod memoise;
pub mod shade;

use super::choices::Choices;
use super::counters::FrameCounts;
use super::entries::order::EntryOrder;
use super::entries::sort::Sort;
use super::pass_inputs::{DrawInputs, ShadingEdges};
use super::scales::SCALES;
use super::stereo;
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::resources::{
    CACHE, CACHE_BYTES, COLOR_BYTES, COLORS, COUNTERS, ENTRIES, ENTRY_BYTES, NAME, ORDER, ORDER_BYTES, POINTER_BYTES,
    POINTERS, SPIDS, full,
};
use crate::techniques::deep_shading::visibility::samples::Samples;
use crate::units::Extent;
use compact::Entries;
use gbuffer::Gbuffer;
use memoise::Memoise;
use shade::Shade;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Pointers, cache, entries, and their colours, for `samples`.
pub fn plan(plan: &mut Plan, choices: &Choices, samples: u64) {
    plan.buffer("indirect_frame_buffer", full(POINTERS), samples * POINTER_BYTES);
    plan.buffer("shading_cache", full(CACHE), choices.cache_entries * CACHE_BYTES);
    for (name, _) in ENTRIES {
        plan.buffer("compact_geometry_buffer", full(name), samples * ENTRY_BYTES);
    }
    plan.buffer("compact_geometry_buffer", full(COLORS), samples * COLOR_BYTES);
}

/// Plans the passes that touch its resources, after visibility and up to the resolve.
pub fn plan_passes(plan: &mut Plan, choices: &Choices) {
    let touch = |name: &str, access| (full(name), access);
    let memoised = [
        touch(SPIDS, Access::ComputeSample),
        touch(CACHE, Access::TransferWrite),
        touch(CACHE, Access::ComputeWrite),
        touch(POINTERS, Access::ComputeWrite),
        touch(COLORS, Access::ComputeWrite),
        touch(COUNTERS, Access::ComputeWrite),
    ];
    plan.pass(full(memoise::PASS), memoised);
    super::entries::plan_sort(plan);
    let made = ENTRIES.map(|(name, _)| touch(name, Access::ComputeWrite)).into_iter();
    let scales = choices.blur_pixels.map(|_| touch(SCALES, Access::ComputeRead));
    let read = super::entries::read().into_iter().chain(scales).chain([touch(COLORS, Access::ComputeRead)]);
    plan.pass(full(gbuffer::PASS), made.chain(read));
    let mut shaded: Vec<_> = ENTRIES.map(|(name, _)| touch(name, Access::ComputeRead)).into();
    shaded.extend(choices.maps.iter().filter_map(|maps| maps.read_by(NAME, Access::ComputeSample)));
    shaded.extend([touch(COLORS, Access::ComputeWrite), touch(COUNTERS, Access::ComputeWrite)]);
    plan.pass(full("indirect.shade"), shaded);
    let resolved = [
        touch(SPIDS, Access::ComputeSample),
        touch(POINTERS, Access::ComputeRead),
        touch(COLORS, Access::ComputeRead),
        touch(COUNTERS, Access::ComputeWrite),
    ];
    plan.pass(full("resolve"), resolved.into_iter().chain(stereo::resolved(choices)));
}

/// Bytes that a frame touches of buffers that are as long as the worst case; what is cleared is touched whole and not listed.
pub fn touched_bytes(counted: &FrameCounts) -> BTreeMap<String, u64> {
    let entries = counted.entry_count();
    let of = |(name, _): (&str, &str)| (full(name), entries * ENTRY_BYTES);
    let others = [(full(COLORS), entries * COLOR_BYTES), (full(ORDER), entries * ORDER_BYTES)];
    ENTRIES.map(of).into_iter().chain(others).collect()
}

/// Samples' way from what they see to colours, by a compact geometry buffer.
pub struct Indirect {
    pub compact: Entries,
    memoise: Memoise,
    gbuffer: Gbuffer,
    shade: Shade,
}

impl Indirect {
    /// `frame`: its extent.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        frame: Extent,
    ) -> Result<Self> {
        Ok(Self {
            memoise: Memoise::new(gpu, choices)?,
            gbuffer: Gbuffer::new(gpu, scene, choices)?,
            shade: Shade::new(gpu, choices, frame)?,
            compact: Entries::new(resources),
        })
    }

    /// All but the colours.
    pub fn buffers(&self) -> impl Iterator<Item = &Buffer> {
        let Entries { pointers, cache, entries } = &self.compact;
        entries.iter().chain([pointers, cache])
    }

    /// Nothing has touched the colours; `sort` brings entries into `order`.
    pub fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        seen: Edge<'_, Samples>,
        (sort, order): (&Sort, &EntryOrder),
        edges: ShadingEdges<'_>,
    ) -> Result<()> {
        let (colors, counters) = (edges.colors.resource, edges.counters.resource);
        self.memoise.record(cmd, inputs.bound, seen, &self.compact, colors, edges.counters)?;
        let [waiting, counted] = [colors, counters].map(|buffer| buffer.from(Access::ComputeWrite));
        sort.record(cmd, inputs.bound, order, waiting, counted)?;
        let waiting = colors.from(Access::ComputeRead);
        self.gbuffer.record(cmd, inputs, order, &self.compact, waiting)?;
        let edges = ShadingEdges { colors: waiting, counters: counted, ..edges };
        self.shade.record(cmd, inputs.bound, self.compact.from(Access::ComputeWrite), edges)
    }
}
