//! Bytes from host to device, once: through a staging buffer, with a barrier that makes them readable.

use super::access::AccessSet;
use super::commands::Submits;
use super::{Access, Barrier, Buffer, Commands, Gpu, Image};
use crate::error::Result;
use crate::memory::kinds::Use;
use ash::vk;
use std::sync::Arc;

/// Ledger group of staging memory, which is gone before the first frame.
pub const GROUP: &str = "upload";

/// The staging buffer's flags.
pub const STAGING: vk::BufferUsageFlags = vk::BufferUsageFlags::TRANSFER_SRC;

/// The staging buffer's name.
pub fn staging_name(target: &str) -> String {
    format!("upload.{target}")
}

fn staging(gpu: &Arc<Gpu>, target: &str, bytes: u64, fill: impl FnOnce(&mut [u8])) -> Result<Buffer> {
    let mut staging = Buffer::new(gpu, &staging_name(target), GROUP, bytes, STAGING, Use::Upload)?;
    fill(&mut staging.mapped_mut()[..bytes as usize]);
    Ok(staging)
}

/// Fills the start of `target` with `bytes` and leaves it readable by `readers`.
pub fn buffer(gpu: &Arc<Gpu>, target: &Buffer, bytes: &[u8], readers: impl Into<AccessSet>) -> Result<()> {
    buffer_with(gpu, target, bytes.len() as u64, readers, |staging| staging.copy_from_slice(bytes))
}

/// The same with `bytes` bytes that `fill` writes in place, without a copy of them on the host.
pub fn buffer_with(
    gpu: &Arc<Gpu>,
    target: &Buffer,
    bytes: u64,
    readers: impl Into<AccessSet>,
    fill: impl FnOnce(&mut [u8]),
) -> Result<()> {
    assert!(bytes <= target.bytes, "{}: {bytes} bytes into {}", target.name, target.bytes);
    if bytes == 0 {
        return Ok(());
    }
    let staging = staging(gpu, &target.name, bytes, fill)?;
    let mut cmd = Commands::begin(gpu, "upload", Submits::One)?;
    cmd.barriers([target.discard(Access::TransferWrite)]);
    cmd.copy_buffer(&staging, target);
    make_readable(&mut cmd, readers, |last, reader| target.from(last).to(reader));
    cmd.finish()?.run()?;
    Ok(())
}

/// Leaves what was copied readable by each of `readers`, by barriers that `to` makes from the last access and the next.
fn make_readable(cmd: &mut Commands, readers: impl Into<AccessSet>, to: impl Fn(AccessSet, Access) -> Barrier) {
    let mut last = AccessSet::from(Access::TransferWrite);
    for reader in readers.into().iter() {
        cmd.barriers([to(last, reader)]);
        last = last.after(reader);
    }
}

/// Fills the levels of `target` with what `fill` writes: finest first and one after the other, each with its layers. Leaves
/// it readable by `readers`, which have one layout.
pub fn image(
    gpu: &Arc<Gpu>,
    target: &Image,
    readers: impl Into<AccessSet>,
    fill: impl FnOnce(&mut [u8]),
) -> Result<()> {
    let staging = staging(gpu, &target.name, target.description.bytes(), fill)?;
    let mut cmd = Commands::begin(gpu, "upload", Submits::One)?;
    cmd.barriers([target.discard(Access::TransferWrite)]);
    cmd.copy_to_image(&staging, target);
    make_readable(&mut cmd, readers, |last, reader| target.from(last).to(reader));
    cmd.finish()?.run()?;
    Ok(())
}
