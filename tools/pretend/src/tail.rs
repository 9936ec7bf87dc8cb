//! What is made of a buffer: one with a tail behind it.

use crate::modes::MODES;
use ash::vk;

pub const TAIL_BYTES: u64 = 4096;

/// The same buffer with a tail, and open to what overwrites it.
pub fn padded<'a>(info: &vk::BufferCreateInfo<'a>) -> vk::BufferCreateInfo<'a> {
    let usage =
        info.usage | if MODES.discard { vk::BufferUsageFlags::TRANSFER_DST } else { vk::BufferUsageFlags::empty() };
    vk::BufferCreateInfo { size: info.size + if MODES.padding { TAIL_BYTES } else { 0 }, usage, ..*info }
}
