//! Memory blocks: what they hold when they come, and who may map them.

use crate::modes::MODES;
use crate::tables::{self, DeviceTable, Memory};
use crate::types;
use ash::vk;
use std::ffi::c_void;

pub unsafe extern "system" fn allocate(
    device: vk::Device,
    info: *const vk::MemoryAllocateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    memory: *mut vk::DeviceMemory,
) -> vk::Result {
    let table = tables::device(device);
    // SAFETY: the next layer's function; the copy of the program's struct lives as long as the call.
    unsafe {
        let kind = (*info).memory_type_index;
        let of_driver = vk::MemoryAllocateInfo { memory_type_index: types::of_driver(kind), ..*info };
        let result = (table.next.fp_v1_0().allocate_memory)(device, &of_driver, allocator, memory);
        if result == vk::Result::SUCCESS {
            table.known().memories.insert(*memory, Memory { kind, mapped: None });
            if MODES.poison {
                let bytes = (*info).allocation_size;
                with_bytes(&table, *memory, 0, bytes, |bytes| bytes.fill(0xff));
            }
        }
        result
    }
}

pub unsafe extern "system" fn free(
    device: vk::Device,
    memory: vk::DeviceMemory,
    allocator: *const vk::AllocationCallbacks<'_>,
) {
    let table = tables::device(device);
    table.known().memories.remove(&memory);
    // SAFETY: the next layer's function with the program's arguments.
    unsafe { (table.next.fp_v1_0().free_memory)(device, memory, allocator) };
}

pub unsafe extern "system" fn map(
    device: vk::Device,
    memory: vk::DeviceMemory,
    offset: vk::DeviceSize,
    size: vk::DeviceSize,
    flags: vk::MemoryMapFlags,
    data: *mut *mut c_void,
) -> vk::Result {
    let table = tables::device(device);
    let mut known = table.known();
    let Some(held) = known.memories.get_mut(&memory) else { crate::fail("memory is mapped that was not allocated") };
    if !types::is_mappable(held.kind) {
        crate::fail(&format!("memory of type {} is mapped, which the host does not see or sees too late", held.kind));
    }
    // SAFETY: the next layer's function with the program's arguments.
    let result = unsafe { (table.next.fp_v1_0().map_memory)(device, memory, offset, size, flags, data) };
    if result == vk::Result::SUCCESS {
        if offset != 0 {
            crate::fail("a part of memory is mapped: this layer knows whole blocks only");
        }
        // SAFETY: the driver has just written it.
        held.mapped = Some(unsafe { *data } as usize);
    }
    result
}

/// Looks at a range of memory, mapped or not.
pub fn with_bytes<R>(
    table: &DeviceTable,
    memory: vk::DeviceMemory,
    offset: u64,
    bytes: u64,
    look: impl FnOnce(&mut [u8]) -> R,
) -> R {
    let mapped = table.known().memories.get(&memory).and_then(|memory| memory.mapped);
    let device = table.next.handle();
    let first = mapped.unwrap_or_else(|| {
        let mut data = std::ptr::null_mut();
        // SAFETY: software drivers' memory is the host's; nobody else has mapped this block.
        let result = unsafe {
            (table.next.fp_v1_0().map_memory)(device, memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty(), &mut data)
        };
        if result != vk::Result::SUCCESS {
            crate::fail(&format!("the driver's own memory cannot be looked at ({result:?}): it is no software driver"));
        }
        data as usize
    });
    // SAFETY: the range lies in the block, which nobody else touches now.
    let found = look(unsafe { std::slice::from_raw_parts_mut((first + offset as usize) as *mut u8, bytes as usize) });
    if mapped.is_none() {
        // SAFETY: mapped above.
        unsafe { (table.next.fp_v1_0().unmap_memory)(device, memory) };
    }
    found
}
