//! The memory table: every resource with its bytes asked for and bound, its memory type, its lifetime, and the sums.
//! Made from plans; where resources were made, the ledger adds where each lies.

use crate::error::Result;
use crate::gpu::ImageDescription;
use crate::memory::kinds::{Kinds, Use};
use crate::memory::ledger::{BlockState, Snapshot};
use crate::plan::{Peak, Plan, Planned, PlannedArena, Requirements, Shape, Sharing};
use crate::units::Bytes;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

/// One resource.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    name: String,
    group: String,
    shape: Option<Shape>,
    /// Bytes asked for, by arithmetic.
    bytes: u64,
    /// Bytes that the driver requires.
    bound_bytes: u64,
    alignment_bytes: u64,
    memory_type: u32,
    reason: &'static str,
    /// First and last pass; None: kept from frame to frame.
    passes: Option<[String; 2]>,
    /// Memory block and offset, where it was made.
    place: Option<(u32, u64)>,
    /// Arena, and offset in it.
    shared: Option<(usize, u64)>,
    /// Resources that lie in some of the same bytes in other passes.
    shares_with: Vec<String>,
    /// Bytes that a frame has touched; None where they were not counted.
    touched_bytes: Option<u64>,
}

impl Row {
    /// Lost between its end and the next multiple of its alignment.
    fn waste_bytes(&self) -> u64 {
        self.bound_bytes.next_multiple_of(self.alignment_bytes) - self.bound_bytes
    }
}

/// The memory of one technique on one scene.
#[derive(Clone, Debug)]
pub struct MemoryTable {
    rows: Vec<Row>,
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
            let place = Some((entry.memory_block, entry.offset));
            match rows.iter_mut().find(|row| row.name == entry.name) {
                Some(row) => row.place = place,
                // What no plan knows of is still somebody's.
                None => rows.push(Row {
                    name: entry.name.clone(),
                    group: entry.group.clone(),
                    shape: None,
                    bytes: entry.bytes,
                    bound_bytes: entry.bound_bytes,
                    alignment_bytes: 1,
                    memory_type: entry.memory_type,
                    reason: entry.reason,
                    passes: None,
                    place,
                    shared: None,
                    shares_with: Vec::new(),
                    touched_bytes: None,
                }),
            }
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
    fn groups(&self, bytes: impl Fn(&Row) -> Option<u64>) -> BTreeMap<&str, u64> {
        let mut groups = BTreeMap::new();
        for row in &self.rows {
            if let Some(bytes) = bytes(row) {
                *groups.entry(row.group.as_str()).or_insert(0) += bytes;
            }
        }
        groups
    }

    /// The sums, as a benchmark's row has them.
    pub fn sums(&self) -> Value {
        let mut sums = json!({
            "planned_bytes": self.planned_bytes(),
            "allocated_bytes": self.allocated_bytes(),
            "aliased_bytes": self.sharing.aliased_bytes(),
            "peak_bytes": self.peak.bytes,
            "peak_pass": self.peak.pass,
            "groups": self.groups(|row| Some(row.bound_bytes)),
        });
        // A sum is of those that were counted, and says how large they are: the others' share is not known.
        let counted = self.rows.iter().filter_map(|row| Some([row.touched_bytes?, row.bytes]));
        if let Some([touched, of]) = counted.reduce(|sum, row| [sum[0] + row[0], sum[1] + row[1]]) {
            sums["touched_bytes"] = json!(touched);
            sums["touched_of_bytes"] = json!(of);
            sums["touched_groups"] = json!(self.groups(|row| row.touched_bytes));
        }
        sums
    }

    /// The report's `memory`.
    pub fn json(&self) -> Value {
        let mut document = self.sums();
        document["arenas"] = self.sharing.arenas.iter().map(arena_json).collect();
        document["resources"] = self.rows.iter().map(row_json).collect();
        if let Some((bytes, blocks)) = &self.made {
            document["memory_block_bytes"] = json!(bytes);
            document["memory_blocks"] = json!(blocks);
        }
        document
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
            let lives = match &row.passes {
                None => "every frame".to_owned(),
                Some([first, last]) if first == last => short(first).to_owned(),
                Some([first, last]) => format!("{} to {}", short(first), short(last)),
            };
            let lives = match row.shared {
                Some((_, offset)) => format!("{lives}, shared from {offset}"),
                None => lives,
            };
            writeln!(
                text,
                "{:<widest$}  {:>12} {:>12} {:>6} {:>6} {:>5}  {:<34} {lives}",
                row.name,
                row.bytes,
                row.bound_bytes,
                row.alignment_bytes,
                row.waste_bytes(),
                row.memory_type,
                what(row),
            )?;
        }
        let mut reasons: Vec<(u32, &str)> = self.rows.iter().map(|row| (row.memory_type, row.reason)).collect();
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

fn what(row: &Row) -> String {
    match &row.shape {
        None => String::new(),
        Some(Shape::Buffer { usage: Use::Device, .. }) => "buffer".to_owned(),
        Some(Shape::Buffer { usage, .. }) => format!("buffer, {usage}"),
        Some(Shape::Image(ImageDescription { extent, format, layer_count: Some(layers), .. })) => {
            format!("{format:?} {extent}, {layers} layers")
        }
        Some(Shape::Image(ImageDescription { extent, format, samples, .. })) if *samples > 1 => {
            format!("{format:?} {extent}, {samples} samples")
        }
        Some(Shape::Image(ImageDescription { extent, format, level_count: 1, .. })) => format!("{format:?} {extent}"),
        Some(Shape::Image(ImageDescription { extent, format, level_count, .. })) => {
            format!("{format:?} {extent}, {level_count} levels")
        }
    }
}

fn row_json(row: &Row) -> Value {
    let mut document = json!({
        "name": row.name,
        "group": row.group,
        "bytes": row.bytes,
        "bound_bytes": row.bound_bytes,
        "alignment_bytes": row.alignment_bytes,
        "alignment_waste_bytes": row.waste_bytes(),
        "memory_type": row.memory_type,
        "reason": row.reason,
        "first_pass": row.passes.as_ref().map(|[first, _]| first),
        "last_pass": row.passes.as_ref().map(|[_, last]| last),
    });
    if let Some(Shape::Image(ImageDescription { extent, format, layer_count, samples, .. })) = row.shape {
        document["format"] = json!(format!("{format:?}"));
        document["extent"] = json!(extent.to_string());
        if let Some(layers) = layer_count {
            document["layers"] = json!(layers);
        }
        if samples > 1 {
            document["samples"] = json!(samples);
        }
    }
    if let Some(bytes) = row.touched_bytes {
        document["touched_bytes"] = json!(bytes);
    }
    if let Some((arena, offset)) = row.shared {
        document["arena"] = json!({ "index": arena, "offset": offset, "shares_with": row.shares_with });
    }
    if let Some((memory_block, offset)) = row.place {
        document["memory_block"] = json!(memory_block);
        document["offset"] = json!(offset);
    }
    document
}

fn arena_json(arena: &PlannedArena) -> Value {
    let parts_bytes: u64 = arena.parts.iter().map(|part| part.bound_bytes).sum();
    json!({
        "bytes": arena.bytes,
        "alignment_bytes": arena.alignment_bytes,
        "parts": arena.parts.len(),
        "parts_bytes": parts_bytes,
        "proven_optimal": arena.proven_optimal,
    })
}

fn row(plan: &Plan, sharing: &Sharing, index: usize, requirements: Requirements<'_>, kinds: &Kinds) -> Result<Row> {
    let planned: &Planned = &plan.resources[index];
    let required = requirements.of(&planned.shape);
    let choice = kinds.choose(planned.shape.usage(), required.memory_type_bits);
    let choice = choice.map_err(|error| error.within(format!("planning {}", planned.name)))?;
    let passes = plan
        .lifetime(index)
        .map(|lifetime| [lifetime.first, lifetime.last].map(|pass| plan.pass_name(pass).to_owned()));
    Ok(Row {
        name: planned.name.clone(),
        group: planned.group.to_owned(),
        shape: Some(planned.shape),
        bytes: planned.bytes(),
        bound_bytes: required.bound_bytes,
        alignment_bytes: required.alignment_bytes,
        memory_type: choice.type_index,
        reason: choice.reason,
        passes,
        place: None,
        shared: sharing.part(index).map(|(arena, part)| (arena, part.offset)),
        shares_with: sharing.shares_with(index).into_iter().map(|other| plan.resources[other].name.clone()).collect(),
        touched_bytes: None,
    })
}
