//! The memory table: every resource with its bytes asked for and bound, its memory type, its lifetime, and the sums.
//! Made from plans; where resources were made, the ledger adds where each lies.

pub mod difference;
pub mod drawing;
mod rows;
mod text;
pub mod touched;
pub mod vma;

pub use rows::{ArenaPlace, ArenaRow, MemoryReport, MemoryRow, MemorySums, PassBytes, Waste};

use crate::error::Result;
use crate::gpu::{ImageDescription, marks};
use crate::memory::Tiling;
use crate::memory::kinds::{Kinds, Use};
use crate::memory::ledger::{BlockState, Entry, Snapshot};
use crate::plan::{Peak, Plan, Planned, PlannedArena, Requirements, Shape, Sharing};
use serde_json::Value;
use std::collections::BTreeMap;
use touched::TouchedReport;

/// The memory of one technique on one scene.
#[derive(Clone, Debug)]
pub struct MemoryTable {
    rows: Vec<MemoryRow>,
    peak: Peak,
    passes: Vec<PassBytes>,
    sharing: Sharing,
    /// Where it was made: what the driver was asked for, and each memory block.
    made: Option<(u64, Vec<BlockState>)>,
    /// None: nobody counted all that is touched.
    touched: Option<TouchedReport>,
}

impl MemoryTable {
    /// `scene` and `frame`: what is kept, and what a frame needs, with which of its resources share bytes. `snapshot`: the
    /// ledger, where the plans were made real.
    ///
    /// Errors: no memory type fits a resource (exit code 4).
    pub fn new(
        scene: &Plan,
        frame: &Plan,
        sharing: Sharing,
        requirements: Requirements<'_>,
        kinds: &Kinds,
        snapshot: Option<&Snapshot>,
    ) -> Result<Self> {
        let mut rows = Vec::new();
        for (plan, sharing) in [(scene, &Sharing::default()), (frame, &sharing)] {
            for index in 0..plan.resources.len() {
                rows.push(row(plan, sharing, index, requirements, kinds)?);
            }
        }
        let kept_bytes = rows[..scene.resources.len()].iter().map(|row| row.bound_bytes).sum();
        let bound: Vec<u64> = rows[scene.resources.len()..].iter().map(|row| row.bound_bytes).collect();
        let of_frames = |entry: &&Entry| entry.name != marks::NAME;
        for entry in snapshot.iter().flat_map(|snapshot| &snapshot.resources).filter(of_frames) {
            let index = rows.iter().position(|row| row.name == entry.name).unwrap_or_else(|| {
                // What no plan knows of is still somebody's.
                rows.push(unplanned(entry));
                rows.len() - 1
            });
            rows[index].memory_block = Some(entry.memory_block);
            rows[index].offset = Some(entry.offset);
        }
        let held = frame.held_bytes(&bound, kept_bytes, &sharing);
        let live = frame.live_bytes(&bound, kept_bytes);
        let passes = held.into_iter().zip(live).enumerate().map(|(pass, (held_bytes, live_bytes))| PassBytes {
            pass: frame.pass_name(pass).to_owned(),
            live_bytes,
            held_bytes,
        });
        Ok(Self {
            rows,
            peak: frame.peak(&bound, kept_bytes, &sharing),
            passes: passes.collect(),
            sharing,
            made: snapshot.map(|snapshot| (snapshot.memory_block_bytes, snapshot.blocks.clone())),
            touched: None,
        })
    }

    /// The same with what a frame has counted that it touched, by name.
    pub fn touched_as(mut self, counted: &BTreeMap<String, u64>) -> Self {
        for row in &mut self.rows {
            row.touched_bytes = counted.get(&row.name).copied();
        }
        self
    }

    /// The same with all that a frame touched, as its shaders counted: 0 bytes of what it did not touch at all, and None of what
    /// it touched in a way that nobody counts.
    pub fn with_touched(mut self, touched: TouchedReport) -> Self {
        let counted = touched.by_resource();
        for row in &mut self.rows {
            let bytes = counted.get(&row.name).copied().unwrap_or_default();
            row.touched_bytes = (!touched.is_unknown(&row.name)).then_some(bytes);
        }
        self.touched = Some(touched);
        self
    }

    fn planned_bytes(&self) -> u64 {
        self.rows.iter().map(|row| row.bytes).sum()
    }

    fn allocated_bytes(&self) -> u64 {
        self.rows.iter().map(|row| row.bound_bytes).sum()
    }

    /// Sums by group, of the resources that have `bytes`.
    fn groups(&self, bytes: impl Fn(&MemoryRow) -> Option<u64>) -> BTreeMap<String, u64> {
        let mut groups = BTreeMap::new();
        for row in &self.rows {
            if let Some(bytes) = bytes(row) {
                *groups.entry(row.group.clone()).or_insert(0) += bytes;
            }
        }
        groups
    }

    /// The sums, as a benchmark's row has them.
    pub fn sums(&self) -> MemorySums {
        // A sum is of those that were counted, and says how large they are: the others' share is not known.
        let counted = self.rows.iter().filter_map(|row| Some([row.touched_bytes?, row.bytes]));
        let counted = counted.reduce(|sum, row| [sum[0] + row[0], sum[1] + row[1]]);
        MemorySums {
            planned_bytes: self.planned_bytes(),
            allocated_bytes: Some(self.allocated_bytes()),
            aliased_bytes: Some(self.sharing.aliased_bytes()),
            peak_bytes: self.peak.bytes,
            peak_pass: Some(self.peak.pass.clone()),
            groups: Some(self.groups(|row| Some(row.bound_bytes))),
            touched_bytes: counted.map(|[touched, _]| touched),
            touched_of_bytes: counted.map(|[_, of]| of),
            touched_groups: counted.map(|_| self.groups(|row| row.touched_bytes)),
        }
    }

    fn waste(&self) -> Waste {
        let sum = |bytes: fn(&MemoryRow) -> u64| self.rows.iter().map(bytes).sum();
        let fullest = self.passes.iter().max_by_key(|pass| (pass.live_bytes, pass.held_bytes));
        Waste {
            // A driver may need less than the arithmetic has, of a depth buffer for one.
            padding_bytes: sum(|row| row.bound_bytes.saturating_sub(row.bytes)),
            alignment_bytes: sum(|row| row.alignment_waste_bytes),
            idle_bytes: fullest.map_or(0, |pass| pass.held_bytes - pass.live_bytes),
            free_bytes: self.made.as_ref().map(|(_, blocks)| blocks.iter().map(|block| block.free_bytes).sum()),
        }
    }

    /// The report's `memory`.
    pub fn report(&self) -> MemoryReport {
        MemoryReport {
            sums: self.sums(),
            arenas: self.sharing.arenas.iter().map(arena_row).collect(),
            passes: self.passes.clone(),
            waste: Some(self.waste()),
            resources: self.rows.clone(),
            memory_block_bytes: self.made.as_ref().map(|(bytes, _)| *bytes),
            memory_blocks: self.made.as_ref().map(|(_, blocks)| blocks.clone()),
            touched: self.touched.clone(),
        }
    }

    /// The same as JSON.
    pub fn json(&self) -> Value {
        serde_json::to_value(self.report()).expect("its keys are texts")
    }

    /// What a person reads: a line a resource, the sums, and how many bytes there are in each pass.
    pub fn text(&self) -> String {
        self.report().text()
    }
}

/// What a resource is, in words.
fn kind(shape: &Shape) -> String {
    match shape {
        Shape::Buffer { usage: Use::Device, .. } => "buffer".to_owned(),
        Shape::Buffer { usage, .. } => format!("buffer, {usage}"),
        Shape::Image(ImageDescription { extent, format, layer_count: Some(layers), .. }) => {
            format!("{format:?} {extent}, {layers} layers")
        }
        Shape::Image(ImageDescription { extent, format, depth: Some(depth), .. }) => {
            format!("{format:?} {extent}x{depth}")
        }
        Shape::Image(ImageDescription { extent, format, samples, .. }) if *samples > 1 => {
            format!("{format:?} {extent}, {samples} samples")
        }
        Shape::Image(ImageDescription { extent, format, level_count: 1, .. }) => format!("{format:?} {extent}"),
        Shape::Image(ImageDescription { extent, format, level_count, .. }) => {
            format!("{format:?} {extent}, {level_count} levels")
        }
    }
}

fn arena_row(arena: &PlannedArena) -> ArenaRow {
    ArenaRow {
        bytes: arena.bytes,
        alignment_bytes: arena.alignment_bytes,
        parts: arena.parts.len(),
        parts_bytes: arena.parts.iter().map(|part| part.bound_bytes).sum(),
        proven_optimal: arena.proven_optimal,
    }
}

/// What the ledger alone knows of.
fn unplanned(entry: &Entry) -> MemoryRow {
    MemoryRow {
        name: entry.name.clone(),
        group: entry.group.clone(),
        bytes: entry.bytes,
        bound_bytes: entry.bound_bytes,
        alignment_bytes: 1,
        alignment_waste_bytes: 0,
        memory_type: entry.memory_type,
        reason: entry.reason.into(),
        first_pass: None,
        last_pass: None,
        format: None,
        extent: None,
        layers: None,
        tiling: None,
        samples: None,
        touched_bytes: None,
        arena: None,
        memory_block: None,
        offset: None,
        usage: None,
        kind: String::new(),
    }
}

fn row(
    plan: &Plan,
    sharing: &Sharing,
    index: usize,
    requirements: Requirements<'_>,
    kinds: &Kinds,
) -> Result<MemoryRow> {
    let planned: &Planned = &plan.resources[index];
    let required = requirements.of(&planned.shape);
    let choice = kinds.choose(planned.shape.usage(), required.memory_type_bits);
    let choice = choice.map_err(|error| error.within(format!("planning {}", planned.name)))?;
    let lifetime = plan.lifetime(index);
    let pass_name = |pass: usize| plan.pass_name(pass).to_owned();
    let shares_with =
        || sharing.shares_with(index).into_iter().map(|other| plan.resources[other].name.clone()).collect();
    let image = match &planned.shape {
        Shape::Image(image) => Some(image),
        Shape::Buffer { .. } => None,
    };
    let is_linear = image.is_some() && required.tiling == Tiling::Linear;
    Ok(MemoryRow {
        name: planned.name.clone(),
        group: planned.group.to_owned(),
        bytes: planned.bytes(),
        bound_bytes: required.bound_bytes,
        alignment_bytes: required.alignment_bytes,
        alignment_waste_bytes: required.bound_bytes.next_multiple_of(required.alignment_bytes) - required.bound_bytes,
        memory_type: choice.type_index,
        reason: choice.reason.into(),
        first_pass: lifetime.as_ref().map(|lifetime| pass_name(lifetime.first)),
        last_pass: lifetime.as_ref().map(|lifetime| pass_name(lifetime.last)),
        format: image.map(|image| format!("{:?}", image.format)),
        extent: image.map(|image| match image.depth {
            None => image.extent.to_string(),
            Some(depth) => format!("{}x{depth}", image.extent),
        }),
        layers: image.and_then(|image| image.layer_count),
        tiling: is_linear.then(|| required.tiling.name().to_owned()),
        samples: image.map(|image| image.samples).filter(|samples| *samples > 1),
        touched_bytes: None,
        arena: sharing.part(index).map(|(arena, part)| ArenaPlace {
            index: arena,
            offset: part.offset,
            shares_with: shares_with(),
        }),
        memory_block: None,
        offset: None,
        usage: Some(match &planned.shape {
            Shape::Image(image) => image.usage.as_raw(),
            Shape::Buffer { flags, .. } => flags.as_raw(),
        }),
        kind: kind(&planned.shape) + if is_linear { ", linear" } else { "" },
    })
}
