//! Bytes behind each buffer: NaN to who reads them, and looked at when the buffer goes.

use crate::memory::with_bytes;
use crate::modes::MODES;
use crate::tables::{self, Bound, DeviceTable, Known};
use crate::tail::{TAIL_BYTES, padded};
use ash::vk;

const TAIL: u8 = 0xff;

pub unsafe extern "system" fn create_buffer(
    device: vk::Device,
    info: *const vk::BufferCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    buffer: *mut vk::Buffer,
) -> vk::Result {
    let table = tables::device(device);
    // SAFETY: the next layer's function; the copy of the program's struct lives as long as the call.
    unsafe {
        let result = (table.next.fp_v1_0().create_buffer)(device, &padded(&*info), allocator, buffer);
        if result == vk::Result::SUCCESS {
            let asked_bytes = (*info).size;
            let nowhere =
                Bound { memory: vk::DeviceMemory::null(), offset: 0, asked_bytes, bytes: 0, is_shared: false };
            table.known().buffers.insert(*buffer, nowhere);
        }
        result
    }
}

pub unsafe extern "system" fn bind_buffer(
    device: vk::Device,
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    offset: vk::DeviceSize,
) -> vk::Result {
    let table = tables::device(device);
    // SAFETY: the next layer's functions with the program's arguments.
    let (result, bytes) = unsafe {
        let requirements = table.next.get_buffer_memory_requirements(buffer);
        ((table.next.fp_v1_0().bind_buffer_memory)(device, buffer, memory, offset), requirements.size)
    };
    if result == vk::Result::SUCCESS && MODES.padding {
        let asked_bytes = table.known().buffers.get(&buffer).map_or(0, |bound| bound.asked_bytes);
        let mut bound = Bound { memory, offset, asked_bytes, bytes, is_shared: false };
        bound.is_shared = shares(&mut table.known(), &bound);
        // Bytes that others share hold nothing to keep yet.
        with_bytes(&table, memory, offset + asked_bytes, TAIL_BYTES, |tail| tail.fill(TAIL));
        table.known().buffers.insert(buffer, bound);
    }
    result
}

pub unsafe extern "system" fn bind_image(
    device: vk::Device,
    image: vk::Image,
    memory: vk::DeviceMemory,
    offset: vk::DeviceSize,
) -> vk::Result {
    let table = tables::device(device);
    // SAFETY: as above.
    let (result, bytes) = unsafe {
        let requirements = table.next.get_image_memory_requirements(image);
        ((table.next.fp_v1_0().bind_image_memory)(device, image, memory, offset), requirements.size)
    };
    if result == vk::Result::SUCCESS && MODES.padding {
        let mut bound = Bound { memory, offset, asked_bytes: bytes, bytes, is_shared: false };
        bound.is_shared = shares(&mut table.known(), &bound);
        table.known().images.insert(image, bound);
    }
    result
}

/// Whether others lie in its bytes; then they share too.
fn shares(known: &mut Known, bound: &Bound) -> bool {
    let mut is_shared = false;
    for other in known.buffers.values_mut().chain(known.images.values_mut()) {
        let apart = other.memory != bound.memory
            || other.offset >= bound.offset + bound.bytes
            || bound.offset >= other.offset + other.bytes;
        if !apart {
            other.is_shared = true;
            is_shared = true;
        }
    }
    is_shared
}

pub unsafe extern "system" fn destroy_buffer(
    device: vk::Device,
    buffer: vk::Buffer,
    allocator: *const vk::AllocationCallbacks<'_>,
) {
    let table = tables::device(device);
    let bound = table.known().buffers.remove(&buffer);
    if let Some(bound) = bound.filter(|bound| bound.memory != vk::DeviceMemory::null() && !bound.is_shared) {
        require_untouched(&table, &bound);
    }
    // SAFETY: the next layer's function with the program's arguments.
    unsafe { (table.next.fp_v1_0().destroy_buffer)(device, buffer, allocator) };
}

pub unsafe extern "system" fn destroy_image(
    device: vk::Device,
    image: vk::Image,
    allocator: *const vk::AllocationCallbacks<'_>,
) {
    let table = tables::device(device);
    {
        let mut known = table.known();
        known.images.remove(&image);
        known.formats.remove(&image);
    }
    // SAFETY: as above.
    unsafe { (table.next.fp_v1_0().destroy_image)(device, image, allocator) };
}

fn require_untouched(table: &DeviceTable, bound: &Bound) {
    let first = with_bytes(table, bound.memory, bound.offset + bound.asked_bytes, TAIL_BYTES, |tail| {
        tail.iter().position(|byte| *byte != TAIL)
    });
    if let Some(first) = first {
        let bytes = bound.asked_bytes;
        crate::fail(&format!("a buffer of {bytes} bytes was written behind its end, {first} bytes from there on"));
    }
}

/// Fills of whole buffers end where the program's buffer does.
pub unsafe extern "system" fn fill(
    commands: vk::CommandBuffer,
    buffer: vk::Buffer,
    offset: vk::DeviceSize,
    size: vk::DeviceSize,
    data: u32,
) {
    let table = tables::device(commands);
    let asked_bytes = table.known().buffers.get(&buffer).map(|bound| bound.asked_bytes);
    let size = match asked_bytes {
        // A last part of a word is left out, as of whole buffers.
        Some(asked) if MODES.padding && size == vk::WHOLE_SIZE => (asked - offset) / 4 * 4,
        _ => size,
    };
    // SAFETY: the next layer's function with the program's arguments.
    unsafe { (table.next.fp_v1_0().cmd_fill_buffer)(commands, buffer, offset, size, data) };
}

/// Descriptors reach over the tail: what a driver keeps shaders from reading shows nothing. Shaders that ask for a buffer's length see the
/// tail too.
pub unsafe extern "system" fn update_sets(
    device: vk::Device,
    write_count: u32,
    writes: *const vk::WriteDescriptorSet<'_>,
    copy_count: u32,
    copies: *const vk::CopyDescriptorSet<'_>,
) {
    let table = tables::device(device);
    let next = table.next.fp_v1_0().update_descriptor_sets;
    // SAFETY: the program's structs; the copies live as long as the call.
    unsafe {
        if !MODES.padding || write_count == 0 {
            return next(device, write_count, writes, copy_count, copies);
        }
        let known = table.known();
        let mut writes = std::slice::from_raw_parts(writes, write_count as usize).to_vec();
        let mut kept = Vec::new();
        // A tail could make a descriptor of a uniform buffer too long.
        let has_tail = |write: &&mut vk::WriteDescriptorSet<'_>| {
            write.descriptor_type == vk::DescriptorType::STORAGE_BUFFER && !write.p_buffer_info.is_null()
        };
        for write in writes.iter_mut().filter(has_tail) {
            let infos = std::slice::from_raw_parts(write.p_buffer_info, write.descriptor_count as usize);
            let wide = |info: &vk::DescriptorBufferInfo| {
                let asked = known.buffers.get(&info.buffer).map(|bound| bound.asked_bytes);
                let is_whole = asked == Some(info.offset + info.range);
                vk::DescriptorBufferInfo { range: info.range + if is_whole { TAIL_BYTES } else { 0 }, ..*info }
            };
            let infos: Box<[vk::DescriptorBufferInfo]> = infos.iter().map(wide).collect();
            write.p_buffer_info = infos.as_ptr();
            kept.push(infos);
        }
        next(device, write_count, writes.as_ptr(), copy_count, copies);
    }
}
