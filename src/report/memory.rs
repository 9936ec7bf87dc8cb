//! The memory table: every resource with its bytes asked for and bound, its memory type, its lifetime, and the sums.
//! Made from plans; where resources were made, the ledger adds where each lies.

use crate::error::Result;
use crate::gpu::ImageDescription;
use crate::memory::kinds::{Kinds, Use};
use crate::memory::ledger::{BlockState, Entry, Snapshot};
use crate::plan::{Peak, Plan, Planned, PlannedArena, Requirements, Shape, Sharing};
use crate::units::Bytes;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::Write;

/// One resource.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MemoryRow {
    /// `technique.pass.resource`, or `scene.resource`.
    pub name: String,
    /// What it is for, such as `gbuffer`.
    pub group: String,
    /// Bytes asked for, by arithmetic.
    pub bytes: u64,
    /// Bytes that the driver requires.
    pub bound_bytes: u64,
    /// Bytes; a power of two.
    pub alignment_bytes: u64,
    /// Bytes lost between its end and the next multiple of its alignment.
    pub alignment_waste_bytes: u64,
    /// Index of its memory type.
    pub memory_type: u32,
    /// Why that type.
    pub reason: Cow<'static, str>,
    /// First pass that touches it; None, and null in JSON: it is kept from frame to frame.
    pub first_pass: Option<String>,
    /// Last pass that touches it; None as `first_pass`.
    pub last_pass: Option<String>,
    /// Vulkan's name of the format; None of buffers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub format: Option<String>,
    /// `WIDTHxHEIGHT`, pixels; None of buffers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extent: Option<String>,
    /// Layers; None of buffers and of images without layers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layers: Option<u32>,
    /// Samples a pixel, 2 or more; None of all that has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u32>,
    /// Bytes that a frame has touched; None where they were not counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touched_bytes: Option<u64>,
    /// Where it lies among others; None where its bytes are its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arena: Option<ArenaPlace>,
    /// Index of its memory block; None where it was planned alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_block: Option<u32>,
    /// Bytes from the memory block's start; None where it was planned alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<u64>,
    /// Its kind in words, for tables; JSON does not have it.
    #[serde(skip)]
    pub kind: String,
}

/// The place of a resource that shares bytes with others.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArenaPlace {
    /// Index into `MemoryReport::arenas`.
    pub index: usize,
    /// Bytes from the arena's start.
    pub offset: u64,
    /// Names of resources that lie in some of the same bytes in other passes.
    pub shares_with: Vec<String>,
}

/// A range whose parts share bytes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArenaRow {
    pub bytes: u64,
    /// Bytes; a power of two.
    pub alignment_bytes: u64,
    /// How many resources lie in it.
    pub parts: usize,
    /// Sum of their bound bytes.
    pub parts_bytes: u64,
    /// Whether no placement is smaller.
    pub proven_optimal: bool,
}

/// The sums of a table, all in bytes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MemorySums {
    /// Asked for by the technique.
    pub planned_bytes: u64,
    /// Required by the driver; None in rows of before it was written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub allocated_bytes: Option<u64>,
    /// Saved by sharing; None as `allocated_bytes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aliased_bytes: Option<u64>,
    /// The most alive at once.
    pub peak_bytes: u64,
    /// Pass in which that is; None as `allocated_bytes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_pass: Option<String>,
    /// Bound bytes by group; None as `allocated_bytes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub groups: Option<BTreeMap<String, u64>>,
    /// Touched by the last frame, of the resources that it counts; None where it counts none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touched_bytes: Option<u64>,
    /// Planned bytes of the same resources.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touched_of_bytes: Option<u64>,
    /// Touched bytes by group.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touched_groups: Option<BTreeMap<String, u64>>,
}

/// A report's `memory`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemoryReport {
    #[serde(flatten)]
    pub sums: MemorySums,
    pub arenas: Vec<ArenaRow>,
    /// The scene's resources, then the frame's, then what no plan knows of.
    pub resources: Vec<MemoryRow>,
    /// Bytes that vkAllocateMemory was asked for; None where nothing was made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_block_bytes: Option<u64>,
    /// None where nothing was made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_blocks: Option<Vec<BlockState>>,
}

/// The memory of one technique on one scene.
#[derive(Clone, Debug)]
pub struct MemoryTable {
    rows: Vec<MemoryRow>,
    peak: Peak,
    sharing: Sharing,
    /// Where it was made: what the driver was asked for, and each memory block.
    made: Option<(u64, Vec<BlockState>)>,
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
        for entry in snapshot.iter().flat_map(|snapshot| &snapshot.resources) {
            let index = rows.iter().position(|row| row.name == entry.name).unwrap_or_else(|| {
                // What no plan knows of is still somebody's.
                rows.push(unplanned(entry));
                rows.len() - 1
            });
            rows[index].memory_block = Some(entry.memory_block);
            rows[index].offset = Some(entry.offset);
        }
        Ok(Self {
            rows,
            peak: frame.peak(&bound, kept_bytes, &sharing),
            sharing,
            made: snapshot.map(|snapshot| (snapshot.memory_block_bytes, snapshot.blocks.clone())),
        })
    }

    /// The same with what a frame has counted that it touched, by name.
    pub fn touched_as(mut self, counted: &BTreeMap<String, u64>) -> Self {
        for row in &mut self.rows {
            row.touched_bytes = counted.get(&row.name).copied();
        }
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

    /// The report's `memory`.
    pub fn report(&self) -> MemoryReport {
        MemoryReport {
            sums: self.sums(),
            arenas: self.sharing.arenas.iter().map(arena_row).collect(),
            resources: self.rows.clone(),
            memory_block_bytes: self.made.as_ref().map(|(bytes, _)| *bytes),
            memory_blocks: self.made.as_ref().map(|(_, blocks)| blocks.clone()),
        }
    }

    /// The same as JSON.
    pub fn json(&self) -> Value {
        serde_json::to_value(self.report()).expect("its keys are texts")
    }

    /// What a person reads: a line a resource, then the sums.
    pub fn text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text).expect("writing to a string");
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let widest = self.rows.iter().map(|row| row.name.len()).max().unwrap_or(0);
        writeln!(
            text,
            "{:<widest$}  {:>12} {:>12} {:>6} {:>6} {:>5}  {:<34} lives in",
            "resource", "asked, B", "bound, B", "align", "waste", "type", "what"
        )?;
        for row in &self.rows {
            let lives = match (&row.first_pass, &row.last_pass) {
                (Some(first), Some(last)) if first == last => short(first).to_owned(),
                (Some(first), Some(last)) => format!("{} to {}", short(first), short(last)),
                _ => "every frame".to_owned(),
            };
            let lives = match &row.arena {
                Some(arena) => format!("{lives}, shared from {}", arena.offset),
                None => lives,
            };
            writeln!(
                text,
                "{:<widest$}  {:>12} {:>12} {:>6} {:>6} {:>5}  {:<34} {lives}",
                row.name,
                row.bytes,
                row.bound_bytes,
                row.alignment_bytes,
                row.alignment_waste_bytes,
                row.memory_type,
                row.kind,
            )?;
        }
        let mut reasons: Vec<(u32, &str)> = self.rows.iter().map(|row| (row.memory_type, &*row.reason)).collect();
        reasons.sort_unstable();
        reasons.dedup();
        writeln!(text)?;
        for (memory_type, reason) in reasons {
            writeln!(text, "type {memory_type}: {reason}")?;
        }
        for (group, bytes) in self.groups(|row| Some(row.bound_bytes)) {
            writeln!(text, "{group:<18} {}", Bytes(bytes))?;
        }
        writeln!(
            text,
            "{} planned, {} allocated, {} of it saved by sharing, peak {} in {}",
            Bytes(self.planned_bytes()),
            Bytes(self.allocated_bytes()),
            Bytes(self.sharing.aliased_bytes()),
            Bytes(self.peak.bytes),
            short(&self.peak.pass)
        )
    }
}

/// A pass without its technique.
fn short(pass: &str) -> &str {
    pass.split_once('.').map_or(pass, |(_, rest)| rest)
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
        samples: None,
        touched_bytes: None,
        arena: None,
        memory_block: None,
        offset: None,
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
        samples: image.map(|image| image.samples).filter(|samples| *samples > 1),
        touched_bytes: None,
        arena: sharing.part(index).map(|(arena, part)| ArenaPlace {
            index: arena,
            offset: part.offset,
            shares_with: shares_with(),
        }),
        memory_block: None,
        offset: None,
        kind: kind(&planned.shape),
    })
}
