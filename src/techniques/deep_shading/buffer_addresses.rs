//! How shaders reach buffers that have an entry a sample, or more (`--list-access`): lists and colours, what a
//! reconstruction keeps, a compact geometry buffer. Through descriptors, whose range a device limits
//! (maxStorageBufferRange) and the validation layers check, or by the buffers' addresses, however long they are.
//! Shaders' half: buffer_addresses.glsl.

use super::choices::Choices;
use crate::error::{Error, Result};
use crate::gpu::shader::structs::BufferAddressBlock;
use crate::gpu::{Access, Bound, Buffer, Gpu, upload};
use crate::plan::{Plan, Resources};
use crate::techniques::Inputs;
use crate::techniques::deep_shading::choices::{longest_bytes, sample_bytes, space_entries};
use crate::techniques::deep_shading::resources;
use crate::techniques::deep_shading::resources::{
    ADDRESSES, BEGIN_BYTES, BEGINS, COLORS, LENGTHS, LINEAR, NAME, NODES, ROW_ID_BYTES, ZMAX, full,
};
use crate::units::Bytes;
use bytemuck::Zeroable;
use std::sync::Arc;

/// Entries of a buffer. An address of a sample, and a pointer to one more than its index, have a bit beside them; and SPIR-V
/// reads what a buffer is indexed by as a signed number.
const MOST_ENTRIES: u64 = (1 << 31) - 1;

/// Errors: descriptors do not reach, or the device has no memory block as long as a buffer (exit code 4); indices of 32 bits do
/// not reach (exit code 2); each with what does.
pub fn require_fitting(choices: &Choices, inputs: &Inputs<'_>) -> Result<()> {
    let (size, set) = (inputs.view.extent, choices.table.samples);
    let (samples, most_bytes) = (choices.samples_of(size), inputs.caps.limits.max_allocation_bytes);
    let most_samples = MOST_ENTRIES.min(most_bytes / sample_bytes(choices).max(1));
    if samples > most_samples {
        let what = format!("--spp {set} at {size}: {samples} samples in a set");
        let advice = match most_samples / (samples / u64::from(set)) {
            0 => "a smaller --size is within reach".to_owned(),
            most => format!("--spp {most} is within reach at this size; --accumulate sums sets of them up"),
        };
        let error = match samples > MOST_ENTRIES {
            true => Error::request(format!("{what}, and indices reach {MOST_ENTRIES}")),
            false => Error::memory(format!(
                "{what} of {} bytes a buffer, and this device makes memory blocks of at most {}",
                sample_bytes(choices),
                Bytes(most_bytes)
            )),
        };
        return Err(error.within(NAME).note(advice));
    }
    let entries = space_entries(choices);
    if entries > MOST_ENTRIES {
        let space = choices.space.extent;
        let why =
            format!("shading space of {space}: its lists have {entries} entries, and indices reach {MOST_ENTRIES}");
        let advice = match choices.lists.is_compacted {
            true => "--compaction off has one entry a pixel; a smaller --shading-scale or --guard-band, fewer pixels",
            false => "a smaller --shading-scale or --guard-band has fewer pixels",
        };
        return Err(Error::request(why).within(NAME).note(advice));
    }
    let rows_bytes = entries * ROW_ID_BYTES.max(BEGIN_BYTES);
    if rows_bytes > most_bytes {
        let space = choices.space.extent;
        return Err(Error::memory(format!(
            "shading space of {space}: its lists have a buffer of {}, and this device makes memory blocks of at most {}",
            Bytes(rows_bytes),
            Bytes(most_bytes)
        ))
        .within(NAME)
        .note("a smaller --shading-scale or --guard-band has fewer pixels, --compaction off a sixteenth of the entries"));
    }
    let (longest, range) = (longest_bytes(choices, size), inputs.caps.limits.max_storage_buffer_range_bytes);
    if !choices.is_by_address && longest > range {
        return Err(Error::memory(format!(
            "--list-access descriptors: the longest buffer has {longest} bytes, and this device binds {range} at once"
        ))
        .within(NAME)
        .note("--list-access addresses reaches all of it"));
    }
    Ok(())
}

/// The buffers, by their names in the plan, and where in `block` shaders find the address of each.
pub(super) fn addresses(block: &mut BufferAddressBlock) -> [(&'static str, &mut [u32; 2]); 17] {
    let [places, normals, base_colors, radiances] = resources::ENTRIES.map(|(name, _)| name);
    [
        (BEGINS, &mut block.begins),
        (NODES, &mut block.nodes),
        (COLORS, &mut block.colors),
        (LINEAR, &mut block.linear),
        (ADDRESSES, &mut block.addresses),
        (ZMAX, &mut block.zmax),
        (LENGTHS, &mut block.lengths),
        (resources::POINTERS, &mut block.pointers),
        (resources::CACHE, &mut block.cache),
        (places, &mut block.entry_places),
        (normals, &mut block.entry_normals),
        (base_colors, &mut block.entry_base_colors),
        (radiances, &mut block.entry_radiances),
        (resources::SAMPLE_COLORS, &mut block.sample_colors),
        (resources::SAMPLE_VECTORS, &mut block.sample_vectors),
        (resources::LAYER_MEANS, &mut block.layer_means),
        (resources::ORDER, &mut block.entry_order),
    ]
}

/// After those buffers.
pub fn plan(plan: &mut Plan, is_by_address: bool) {
    plan.buffer("frame", full("reach"), size_of::<BufferAddressBlock>() as u64);
    if is_by_address {
        for (name, _) in addresses(&mut BufferAddressBlock::zeroed()) {
            plan.addressed(&full(name));
        }
    }
}

/// The addresses, where shaders find them.
pub struct BufferAddresses {
    block: Buffer,
}

impl BufferAddresses {
    /// `buffers`: all that the frame has of them.
    ///
    /// Errors: memory for the upload (exit code 4); what is touched is to be counted, and buffers share bytes (2).
    pub fn new<'a>(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        is_by_address: bool,
        buffers: impl Iterator<Item = &'a Buffer>,
    ) -> Result<Self> {
        let mut found = BufferAddressBlock::zeroed();
        for buffer in buffers.filter(|_| is_by_address) {
            let own = addresses(&mut found).into_iter().find(|(name, _)| full(name) == buffer.name);
            let (_, words) = own.unwrap_or_else(|| panic!("{} has no place in the block", buffer.name));
            let address = buffer.address_for_shaders()?;
            *words = [address as u32, (address >> 32) as u32];
        }
        let block = resources.buffer(&full("reach"));
        upload::buffer(gpu, &block, bytemuck::bytes_of(&found), Access::ComputeRead | Access::GraphicsRead)?;
        Ok(Self { block })
    }

    pub fn bound(&self) -> (&'static str, Bound<'_>) {
        ("BufferAddresses", Bound::Buffer(&self.block))
    }
}
