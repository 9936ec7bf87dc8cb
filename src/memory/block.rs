//! One VkDeviceMemory, mapped once for as long as it lives where the host must see it.

use ash::prelude::VkResult;
use ash::vk;
use std::ptr::NonNull;

/// A memory block. Freed by hand, because freeing needs the device.
pub struct Block {
    pub handle: vk::DeviceMemory,
    mapped: Option<NonNull<u8>>,
}

// SAFETY: the pointer is only handed out with the ranges of the block; see `Allocation`.
unsafe impl Send for Block {}

impl Block {
    /// Shaders and builds may go by the address of a buffer in it.
    pub fn allocate(device: &ash::Device, type_index: u32, bytes: u64, mapped: bool) -> VkResult<Self> {
        let mut flags = vk::MemoryAllocateFlagsInfo::default().flags(vk::MemoryAllocateFlags::DEVICE_ADDRESS);
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(bytes)
            .memory_type_index(type_index)
            .push_next(&mut flags);
        // SAFETY: a live device and one of its memory types.
        let handle = unsafe { device.allocate_memory(&info, None) }?;
        let mut block = Self { handle, mapped: None };
        if mapped {
            // SAFETY: the memory is host-visible (the caller chose its type) and not mapped yet.
            match unsafe { device.map_memory(handle, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()) } {
                Ok(pointer) => block.mapped = NonNull::new(pointer.cast()),
                Err(result) => {
                    block.free(device);
                    return Err(result);
                }
            }
        }
        Ok(block)
    }

    /// Where the host sees byte `offset`.
    pub fn mapped_at(&self, offset: u64) -> Option<NonNull<u8>> {
        // SAFETY: ranges lie inside the block, so the pointer stays inside the mapping.
        self.mapped.map(|start| unsafe { start.add(offset as usize) })
    }

    /// Unmaps and frees. No range of the block may be in use.
    pub fn free(&mut self, device: &ash::Device) {
        // SAFETY: the caller's last range is gone; freeing unmaps.
        unsafe { device.free_memory(self.handle, None) };
        self.handle = vk::DeviceMemory::null();
    }
}
