//! How shaders come to the buffers of lists and colours (`--list-access`): through descriptors, which a device lets reach so far
//! (maxStorageBufferRange) and the validation layers follow, or by the buffers' addresses, however long they are. Shaders'
//! half: reach.glsl.

use super::choices::Choices;
use super::plan::{
    ADDRESSES, BEGIN_BYTES, BEGINS, COLOR_BYTES, COLORS, LENGTHS, LINEAR, LINEAR_COUNT, NODE_BYTES, NODES,
    ROW_ID_BYTES, ZMAX,
};
use super::space::ShadingSpace;
use super::{NAME, full};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::ReachBlock;
use crate::gpu::{Access, Bound, Buffer, Caps, Gpu, upload};
use crate::plan::{Plan, Resources};
use crate::settings::Values;
use crate::techniques::Inputs;
use std::sync::Arc;

/// An address of a sample has a bit beside it.
const MOST_SAMPLES: u64 = 1 << 31;

const MOST_ENTRIES: u64 = 1 << 32;

/// The lists' longest buffer.
fn longest_bytes(samples: u64, space: &ShadingSpace, is_compacted: bool) -> u64 {
    let a_pixel = if is_compacted { LINEAR_COUNT * ROW_ID_BYTES } else { BEGIN_BYTES };
    (samples * NODE_BYTES.max(COLOR_BYTES)).max(space.extent.pixel_count() * a_pixel)
}

/// `--list-access`, `auto` resolved: whether addresses are taken for lists of `samples` in a set.
pub fn is_by_address(values: &Values, caps: &Caps, samples: u64, space: &ShadingSpace, is_compacted: bool) -> bool {
    match values.text("list-access") {
        "descriptors" => false,
        "addresses" => true,
        _ => longest_bytes(samples, space, is_compacted) > caps.limits.max_storage_buffer_range_bytes,
    }
}

/// Errors: descriptors do not reach (exit code 4), or indices of 32 bits do not (exit code 2).
pub fn require_fitting(choices: &Choices, inputs: &Inputs<'_>) -> Result<()> {
    let (samples, space) = (choices.samples_of(inputs.view.extent), &choices.space);
    let range = inputs.caps.limits.max_storage_buffer_range_bytes;
    let longest = longest_bytes(samples, space, choices.is_compacted);
    if !choices.is_by_address && longest > range {
        return Err(Error::memory(format!(
            "--list-access descriptors: the lists' longest buffer has {longest} bytes, and this device binds {range} at once"
        ))
        .within(NAME)
        .note("--list-access addresses reaches all of it"));
    }
    let entries = space.extent.pixel_count() * if choices.is_compacted { LINEAR_COUNT } else { 1 };
    if samples > MOST_SAMPLES || entries > MOST_ENTRIES {
        return Err(Error::request(format!(
            "{samples} samples in a set and {entries} entries of shading space: indices reach {MOST_SAMPLES} and {MOST_ENTRIES}"
        ))
        .within(NAME)
        .note("a smaller --size, --spp (--accumulate sums sets up) or --shading-scale, or --compaction off, would fit"));
    }
    Ok(())
}

/// What it is called in the report.
pub fn name(is_by_address: bool) -> &'static str {
    if is_by_address { "addresses" } else { "descriptors" }
}

/// After those buffers.
pub fn plan(plan: &mut Plan, is_by_address: bool) {
    plan.buffer("frame", full("reach"), size_of::<ReachBlock>() as u64);
    if is_by_address {
        for name in [BEGINS, NODES, COLORS, LINEAR, ADDRESSES, ZMAX, LENGTHS] {
            plan.addressed(&full(name));
        }
    }
}

/// The addresses, where shaders find them.
pub struct Reach {
    block: Buffer,
}

impl Reach {
    /// `buffers`: those of the lists and their colours, by their names in the plan.
    ///
    /// Errors: memory for the upload (exit code 4).
    pub fn new<'a>(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        is_by_address: bool,
        buffers: impl Iterator<Item = &'a Buffer>,
    ) -> Result<Self> {
        let mut addresses: ReachBlock = bytemuck::Zeroable::zeroed();
        for buffer in buffers.filter(|_| is_by_address) {
            let of = [
                (BEGINS, &mut addresses.begins),
                (NODES, &mut addresses.nodes),
                (COLORS, &mut addresses.colors),
                (LINEAR, &mut addresses.linear),
                (ADDRESSES, &mut addresses.addresses),
                (ZMAX, &mut addresses.zmax),
                (LENGTHS, &mut addresses.lengths),
            ];
            let found = of.into_iter().find(|(name, _)| full(name) == buffer.name);
            let (_, words) = found.unwrap_or_else(|| panic!("{} is no buffer of lists", buffer.name));
            let address = buffer.address();
            *words = [address as u32, (address >> 32) as u32];
        }
        let block = resources.buffer(&full("reach"));
        upload::buffer(gpu, &block, bytemuck::bytes_of(&addresses), Access::ComputeRead | Access::GraphicsRead)?;
        Ok(Self { block })
    }

    pub fn bound(&self) -> (&'static str, Bound<'_>) {
        ("Reach", Bound::Buffer(&self.block))
    }
}
