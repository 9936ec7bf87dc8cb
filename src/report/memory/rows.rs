//! What a report says of memory.

use super::touched::TouchedReport;
use crate::memory::ledger::BlockState;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;

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
    /// `linear`, of an image whose texels lie row by row; None of every other one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tiling: Option<String>,
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
    /// Bits of VkBufferUsageFlags, or of VkImageUsageFlags where it has a format; None in reports of before it was written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub usage: Option<u32>,
    /// Its kind in words, for tables; JSON does not have it.
    #[serde(skip)]
    pub kind: String,
}

impl MemoryRow {
    /// In which passes it lives, each called as `name` calls it.
    pub fn lives_in(&self, name: fn(&str) -> &str) -> String {
        match (&self.first_pass, &self.last_pass) {
            (Some(first), Some(last)) if first == last => name(first).to_owned(),
            (Some(first), Some(last)) => format!("{} to {}", name(first), name(last)),
            _ => "every frame".to_owned(),
        }
    }
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

/// How many bytes there are in a pass.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PassBytes {
    /// Its full name.
    pub pass: String,
    /// Bound bytes of what lives in it, and of what is kept.
    pub live_bytes: u64,
    /// The same, and of what lives in other passes and shares no bytes.
    pub held_bytes: u64,
}

/// Bytes that nothing uses, by reason.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Waste {
    /// Bound beyond what was asked for, because the driver requires it.
    pub padding_bytes: u64,
    /// Between the ends of resources and the next multiple of their alignment.
    pub alignment_bytes: u64,
    /// Held where most bytes live by what does not live there.
    pub idle_bytes: u64,
    /// In memory blocks, and no resource's; None where nothing was made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free_bytes: Option<u64>,
}

/// A report's `memory`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemoryReport {
    #[serde(flatten)]
    pub sums: MemorySums,
    pub arenas: Vec<ArenaRow>,
    /// In the order of the passes; none in reports of before it was written.
    #[serde(default)]
    pub passes: Vec<PassBytes>,
    /// None in reports of before it was written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waste: Option<Waste>,
    /// The scene's resources, then the frame's, then what no plan knows of.
    pub resources: Vec<MemoryRow>,
    /// Bytes that vkAllocateMemory was asked for; None where nothing was made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_block_bytes: Option<u64>,
    /// None where nothing was made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_blocks: Option<Vec<BlockState>>,
    /// None without `--touched`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touched: Option<TouchedReport>,
}
