//! Bytes from device to host, after a frame's fence: level 0 of an image, all layers, or a buffer.
//!
//! The copy runs in a submit of its own, so that it is in no frame's time.

use super::access::AccessSet;
use super::commands::Submits;
use super::image::texel_bytes;
use super::{Access, Buffer, Commands, Gpu, Image};
use crate::error::Result;
use crate::memory::kinds::Use;
use ash::vk;
use std::sync::Arc;

/// Ledger group of the memory that copies land in; it is held only while the bytes are fetched.
pub const GROUP: &str = "readback";

fn landing(gpu: &Arc<Gpu>, name: &str, bytes: u64) -> Result<Buffer> {
    Buffer::new(gpu, &format!("readback.{name}"), GROUP, bytes, vk::BufferUsageFlags::TRANSFER_DST, Use::Readback)
        .map_err(|error| error.note("a smaller --size would need less"))
}

/// The bytes of level 0, row-major without gaps, layer after layer. `last`: how the frame touched it last. The image is left as it was.
pub fn image(gpu: &Arc<Gpu>, source: &Image, last: Access) -> Result<Vec<u8>> {
    let extent = source.description.extent;
    let texels = extent.pixel_count() * u64::from(source.description.layers());
    let bytes = texels * u64::from(texel_bytes(source.description.format));
    let landing = landing(gpu, &source.name, bytes)?;
    let mut cmd = Commands::begin(gpu, "readback", Submits::One)?;
    // The frame's fence was waited for; the left side is there for the layout and for visibility.
    cmd.assume(source.from(last).to(Access::TransferRead));
    let region = vk::BufferImageCopy::default().image_subresource(source.whole_level(0)).image_extent(vk::Extent3D {
        width: extent.width,
        height: extent.height,
        depth: 1,
    });
    // SAFETY: both are alive until the fence; the landing buffer holds all texels.
    unsafe {
        let layout = Access::TransferRead.layout();
        gpu.device.cmd_copy_image_to_buffer(cmd.buffer(), source.handle, layout, landing.handle, &[region]);
    }
    cmd.barriers([source.from(Access::TransferRead).to(last)]);
    host_can_read(&cmd, &landing);
    cmd.finish()?.run()?;
    Ok(landing.mapped().to_vec())
}

/// The first `bytes` of a buffer. `last`: how the frame touched it last.
pub fn buffer(gpu: &Arc<Gpu>, source: &Buffer, bytes: u64, last: impl Into<AccessSet>) -> Result<Vec<u8>> {
    let landing = landing(gpu, &source.name, bytes)?;
    let mut cmd = Commands::begin(gpu, "readback", Submits::One)?;
    cmd.assume(source.from(last).to(Access::TransferRead));
    let region = vk::BufferCopy { src_offset: 0, dst_offset: 0, size: bytes };
    // SAFETY: both are alive until the fence; the region lies in both.
    unsafe { gpu.device.cmd_copy_buffer(cmd.buffer(), source.handle, landing.handle, &[region]) };
    host_can_read(&cmd, &landing);
    cmd.finish()?.run()?;
    Ok(landing.mapped()[..bytes as usize].to_vec())
}

/// A fence alone does not make device writes visible to the host.
fn host_can_read(cmd: &Commands, landing: &Buffer) {
    let barrier = [vk::BufferMemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::HOST)
        .dst_access_mask(vk::AccessFlags2::HOST_READ)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .buffer(landing.handle)
        .size(vk::WHOLE_SIZE)];
    let info = vk::DependencyInfo::default().buffer_memory_barriers(&barrier);
    // SAFETY: the buffer is being recorded and the landing buffer is alive.
    unsafe { cmd.gpu().device.cmd_pipeline_barrier2(cmd.buffer(), &info) };
}
