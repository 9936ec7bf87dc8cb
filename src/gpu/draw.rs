//! Draws of indexed triangles: streams of vertices, indices, and which of them are drawn. All inside rendering.

use super::marks::shape::Part;
use super::{Buffer, Commands};
use ash::vk;
use std::ops::Range;

const INDEX_BYTES: u64 = 4;

impl Commands {
    /// Binds streams of vertices, the first at 0.
    pub fn bind_streams(&self, streams: &[&Buffer]) {
        let handles: Vec<_> = streams.iter().map(|stream| stream.handle).collect();
        let offsets = vec![0; handles.len()];
        // SAFETY: the buffer is being recorded; the streams outlive the recorded frame.
        unsafe { self.gpu().device.cmd_bind_vertex_buffers(self.buffer(), 0, &handles, &offsets) };
        self.notes.bind_streams(streams.iter().filter_map(|stream| stream.marked.clone()).collect());
    }

    /// Binds indices of 32 bits.
    pub fn bind_indices(&self, indices: &Buffer) {
        // SAFETY: the buffer is being recorded; the indices outlive the recorded frame.
        unsafe { self.gpu().device.cmd_bind_index_buffer(self.buffer(), indices.handle, 0, vk::IndexType::UINT32) };
        if let Some(marked) = &indices.marked {
            self.notes.bind_indices(marked.clone());
        }
    }

    /// Draws what `indices` of the bound ones say, each with `vertex_offset` added to it, once for each of `instances`.
    ///
    /// # Safety
    /// Every such index has its vertex in the bound streams.
    pub unsafe fn draw_indexed(&self, indices: Range<u32>, vertex_offset: i32, instances: Range<u32>) {
        let (index_count, instance_count) = (indices.len() as u32, instances.len() as u32);
        let [begin, end] = [indices.start, indices.end].map(|index| INDEX_BYTES * u64::from(index));
        for _ in instances.clone() {
            self.note(&self.notes.indices(), false, Part::Bytes(begin..end));
        }
        let device = &self.gpu().device;
        // SAFETY: the buffer is being recorded inside rendering; as to the indices, the caller vouches for them.
        unsafe {
            let (first, first_instance) = (indices.start, instances.start);
            device.cmd_draw_indexed(self.buffer(), index_count, instance_count, first, vertex_offset, first_instance);
        }
    }
}
