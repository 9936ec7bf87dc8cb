//! Transfers inside a recorded frame: filling and copying whole resources. The caller states the barriers.

use super::marks::shape::Part;
use super::{Access, Buffer, Commands, Image};
use ash::vk;

impl Commands {
    /// Fills a buffer, made with TRANSFER_DST, with a 32-bit word; its length is a multiple of 4 bytes.
    pub fn fill_buffer(&mut self, target: &Buffer, word: u32) {
        assert!(target.bytes.is_multiple_of(4), "{}: {} bytes are no words of 4", target.name, target.bytes);
        // SAFETY: the buffer is being recorded, outside rendering; the target outlives the recorded frame.
        unsafe { self.gpu().device.cmd_fill_buffer(self.buffer(), target.handle, 0, target.bytes, word) };
        self.note(&target.marked, true, Part::All);
    }

    /// Copies the whole of `source`, made with TRANSFER_SRC, to the start of `target`, made with TRANSFER_DST.
    pub fn copy_buffer(&mut self, source: &Buffer, target: &Buffer) {
        let size = source.bytes;
        assert!(size <= target.bytes, "{}: {size} bytes into {} of {}", source.name, target.bytes, target.name);
        let region = vk::BufferCopy { src_offset: 0, dst_offset: 0, size };
        // SAFETY: as above; the region lies in both.
        unsafe { self.gpu().device.cmd_copy_buffer(self.buffer(), source.handle, target.handle, &[region]) };
        self.note(&source.marked, false, Part::All);
        self.note(&target.marked, true, Part::Bytes(0..size));
    }

    /// Copies the start of `source`, made with TRANSFER_SRC, into all of `target`: its levels one after the other, finest first,
    /// each with its layers.
    pub fn copy_to_image(&mut self, source: &Buffer, target: &Image) {
        let description = &target.description;
        let (needed, held) = (description.bytes(), source.bytes);
        assert!(needed <= held, "{}: {held} bytes into {} of {needed}", source.name, target.name);
        let texel_bytes = u64::from(super::image::texel_bytes(description.format));
        let mut offset = 0;
        let regions: Vec<_> = (0..description.level_count)
            .map(|level| {
                let width = (description.extent.width >> level).max(1);
                let height = (description.extent.height >> level).max(1);
                let region = vk::BufferImageCopy::default()
                    .buffer_offset(offset)
                    .image_subresource(target.whole_level(level))
                    .image_extent(vk::Extent3D { width, height, depth: description.slices() });
                offset += u64::from(width)
                    * u64::from(height)
                    * u64::from(description.layers() * description.slices())
                    * texel_bytes;
                region
            })
            .collect();
        let (from, to, layout) = (source.handle, target.handle, Access::TransferWrite.layout());
        // SAFETY: as above; the regions lie in both.
        unsafe { self.gpu().device.cmd_copy_buffer_to_image(self.buffer(), from, to, layout, &regions) };
        self.note(&source.marked, false, Part::Bytes(0..needed));
        self.note(&target.marked, true, Part::All);
    }
}
