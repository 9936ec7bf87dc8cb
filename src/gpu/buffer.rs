//! A buffer: handle, description, allocation.

use super::access::AccessSet;
use super::marks::Marked;
use super::{Berth, Gpu};
use crate::error::{Error, Result};
use crate::memory::kinds::Use;
use crate::memory::{Allocation, Request, Tiling};
use ash::vk;
use std::mem::ManuallyDrop;
use std::sync::Arc;

/// A buffer with its memory; both end when it is dropped, which must be after the fence of its last frame.
pub struct Buffer {
    gpu: Arc<Gpu>,
    pub handle: vk::Buffer,
    pub name: String,
    /// Bytes asked for.
    pub bytes: u64,
    /// Last accesses of the resource that had its bytes before it in the frame.
    pub(super) takes_over: AccessSet,
    /// Where it is counted what touches it; None: nobody counts.
    pub(super) marked: Option<Arc<Marked>>,
    allocation: ManuallyDrop<Allocation>,
}

impl Buffer {
    /// Makes a buffer of `bytes` (at least 1) and binds memory for `usage`.
    ///
    /// Errors: the driver or the memory refuses (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        group: &str,
        bytes: u64,
        flags: vk::BufferUsageFlags,
        usage: Use,
    ) -> Result<Self> {
        Self::at(gpu, name, group, bytes, flags, usage, Berth::Own)
    }

    /// The same, with its bytes from `berth`.
    ///
    /// Errors: as `new`.
    pub fn at(
        gpu: &Arc<Gpu>,
        name: &str,
        group: &str,
        bytes: u64,
        flags: vk::BufferUsageFlags,
        usage: Use,
        berth: Berth<'_>,
    ) -> Result<Self> {
        assert!(bytes > 0, "{name}: a buffer of no bytes does not exist in Vulkan");
        let info = vk::BufferCreateInfo::default().size(bytes).usage(flags);
        // SAFETY: a live device; the info has no pointers.
        let handle = unsafe { gpu.device.create_buffer(&info, None) }
            .map_err(|result| Error::device(format!("creating buffer {name} ({bytes} bytes): {result}")))?;
        // SAFETY: the buffer was made from this device.
        let requirements = unsafe { gpu.device.get_buffer_memory_requirements(handle) };
        let request = Request { name, group, bytes, requirements, usage, tiling: Tiling::Linear };
        let bound = berth.allocate(&gpu.memory, &request).and_then(|allocation| {
            // SAFETY: fresh memory of an allowed type, in bounds, bound once.
            unsafe { gpu.device.bind_buffer_memory(handle, allocation.handle, allocation.offset) }
                .map_err(|result| Error::device(format!("binding buffer {name}: {result}")))?;
            Ok((allocation, gpu.marks.as_ref().map(|marks| marks.buffer(name, bytes)).transpose()?))
        });
        match bound {
            Ok((allocation, marked)) => {
                gpu.name(handle, name);
                let (name, allocation) = (name.to_owned(), ManuallyDrop::new(allocation));
                Ok(Self { gpu: gpu.clone(), handle, name, bytes, takes_over: berth.takes_over(), marked, allocation })
            }
            Err(error) => {
                // SAFETY: never used.
                unsafe { gpu.device.destroy_buffer(handle, None) };
                Err(error)
            }
        }
    }

    /// What the driver requires of memory for such a buffer, without making one.
    pub fn requirements(gpu: &Gpu, bytes: u64, flags: vk::BufferUsageFlags) -> vk::MemoryRequirements {
        let info = vk::BufferCreateInfo::default().size(bytes).usage(flags);
        let query = vk::DeviceBufferMemoryRequirements::default().create_info(&info);
        let mut found = vk::MemoryRequirements2::default();
        // SAFETY: a live device with maintenance4; the info outlives the call.
        unsafe { gpu.device.get_device_buffer_memory_requirements(&query, &mut found) };
        found.memory_requirements
    }

    /// Where shaders and builds find it, which was made with SHADER_DEVICE_ADDRESS.
    pub fn address(&self) -> u64 {
        let info = vk::BufferDeviceAddressInfo::default().buffer(self.handle);
        // SAFETY: a live buffer with memory, of a live device with the feature.
        unsafe { self.gpu.device.get_buffer_device_address(&info) }
    }

    /// The same, for shaders that will read and write there.
    ///
    /// Errors: what they touch there could not be counted, and is to be (exit code 2).
    pub fn address_for_shaders(&self) -> Result<u64> {
        let address = self.address();
        match (&self.gpu.marks, &self.marked) {
            (Some(marks), Some(marked)) => marks.at_address(marked, address).map(|()| address),
            _ => Ok(address),
        }
    }

    /// The host's view of the buffer. Panics where the buffer was not made for `Upload` or `Readback`.
    pub fn mapped(&self) -> &[u8] {
        let start = self.allocation.mapped.expect("only buffers for upload or readback are mapped");
        // SAFETY: mapped, coherent, `bytes` long; the device writes it only before a fence that the caller waited for.
        unsafe { std::slice::from_raw_parts(start.as_ptr(), self.bytes as usize) }
    }

    /// The host's view of the buffer, to write. The device must not be reading it.
    pub fn mapped_mut(&mut self) -> &mut [u8] {
        let start = self.allocation.mapped.expect("only buffers for upload or readback are mapped");
        // SAFETY: as in `mapped`, and `self` is borrowed mutably.
        unsafe { std::slice::from_raw_parts_mut(start.as_ptr(), self.bytes as usize) }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: the frame's fence was waited for; the memory goes after the handle, and is taken out once.
        unsafe {
            self.gpu.device.destroy_buffer(self.handle, None);
            ManuallyDrop::drop(&mut self.allocation);
        }
    }
}
