//! Transfers inside a recorded frame: filling and copying whole buffers. The caller states the barriers.

use super::{Buffer, Commands};
use ash::vk;

impl Commands {
    /// Fills a buffer, made with TRANSFER_DST, with a 32-bit word; its length is a multiple of 4 bytes.
    pub fn fill_buffer(&mut self, target: &Buffer, word: u32) {
        assert!(target.bytes.is_multiple_of(4), "{}: {} bytes are no words of 4", target.name, target.bytes);
        // SAFETY: the buffer is being recorded, outside rendering; the target outlives the recorded frame.
        unsafe { self.gpu().device.cmd_fill_buffer(self.buffer(), target.handle, 0, target.bytes, word) };
    }

    /// Copies the whole of `source`, made with TRANSFER_SRC, to the start of `target`, made with TRANSFER_DST.
    pub fn copy_buffer(&mut self, source: &Buffer, target: &Buffer) {
        let size = source.bytes;
        assert!(size <= target.bytes, "{}: {size} bytes into {} of {}", source.name, target.bytes, target.name);
        let region = vk::BufferCopy { src_offset: 0, dst_offset: 0, size };
        // SAFETY: as above; the region lies in both.
        unsafe { self.gpu().device.cmd_copy_buffer(self.buffer(), source.handle, target.handle, &[region]) };
    }
}
