//! Memory types as a discrete GPU has them. All of them are the driver's one that device and host both see.

use crate::modes::MODES;
use crate::tables;
use crate::tail;
use ash::vk;
use vk::MemoryPropertyFlags as Flags;

/// Flags and heap of each type: before the coherent ones one that is not, as no driver has it, so that nobody takes it by luck.
const TYPES: [(Flags, u32); 5] = [
    (Flags::DEVICE_LOCAL, 0),
    (Flags::from_raw(Flags::HOST_VISIBLE.as_raw() | Flags::HOST_CACHED.as_raw()), 1),
    (Flags::from_raw(Flags::HOST_VISIBLE.as_raw() | Flags::HOST_COHERENT.as_raw()), 1),
    (Flags::from_raw(Flags::HOST_VISIBLE.as_raw() | Flags::HOST_COHERENT.as_raw() | Flags::HOST_CACHED.as_raw()), 1),
    (Flags::from_raw(Flags::DEVICE_LOCAL.as_raw() | Flags::HOST_VISIBLE.as_raw() | Flags::HOST_COHERENT.as_raw()), 2),
];
/// Images lie where the device alone sees them.
pub const OF_IMAGES: u32 = 0b10001;

/// What the device alone sees, and what it shares with the host.
const BAR_BYTES: u64 = 256 << 20;
/// What a device without hardware has.
const NULL_BYTES: u64 = 8 << 30;

fn is_discrete() -> bool {
    MODES.discrete || MODES.null
}

pub unsafe extern "system" fn memory_properties(
    physical: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceMemoryProperties,
) {
    let table = tables::of_physical(physical);
    // SAFETY: the next layer's function with the program's arguments, whose struct is written then.
    let properties = unsafe {
        (table.next.fp_v1_0().get_physical_device_memory_properties)(physical, properties);
        &mut *properties
    };
    if !is_discrete() {
        return;
    }
    let bytes = if MODES.null { NULL_BYTES } else { properties.memory_heaps[0].size };
    let heap = |size, flags| vk::MemoryHeap { size, flags };
    properties.memory_heap_count = 3;
    properties.memory_heaps[0] = heap(bytes, vk::MemoryHeapFlags::DEVICE_LOCAL);
    properties.memory_heaps[1] = heap(bytes, vk::MemoryHeapFlags::empty());
    properties.memory_heaps[2] = heap(BAR_BYTES.min(bytes), vk::MemoryHeapFlags::DEVICE_LOCAL);
    properties.memory_type_count = TYPES.len() as u32;
    for (kind, (property_flags, heap_index)) in properties.memory_types.iter_mut().zip(TYPES) {
        *kind = vk::MemoryType { property_flags, heap_index };
    }
}

/// The driver's type for one that the program sees.
pub fn of_driver(kind: u32) -> u32 {
    // Software drivers have one, or the first is the one that both see.
    if MODES.discrete { 0 } else { kind }
}

/// Whether the host may map it.
pub fn is_mappable(kind: u32) -> bool {
    !is_discrete() || TYPES[kind as usize].0.contains(Flags::HOST_VISIBLE | Flags::HOST_COHERENT)
}

/// SAFETY: what the next layer has written.
unsafe fn pretend(requirements: *mut vk::MemoryRequirements, is_image: bool) {
    if is_discrete() {
        // SAFETY: the caller's.
        unsafe { (*requirements).memory_type_bits = if is_image { OF_IMAGES } else { (1 << TYPES.len()) - 1 } };
    }
}

pub unsafe extern "system" fn buffer_requirements(
    device: vk::Device,
    buffer: vk::Buffer,
    requirements: *mut vk::MemoryRequirements,
) {
    let table = tables::device(device);
    // SAFETY: the next layer's function with the program's arguments.
    unsafe {
        (table.next.fp_v1_0().get_buffer_memory_requirements)(device, buffer, requirements);
        pretend(requirements, false);
    }
}

pub unsafe extern "system" fn image_requirements(
    device: vk::Device,
    image: vk::Image,
    requirements: *mut vk::MemoryRequirements,
) {
    let table = tables::device(device);
    // SAFETY: as above.
    unsafe {
        (table.next.fp_v1_0().get_image_memory_requirements)(device, image, requirements);
        pretend(requirements, true);
    }
}

pub unsafe extern "system" fn device_buffer_requirements(
    device: vk::Device,
    info: *const vk::DeviceBufferMemoryRequirements<'_>,
    requirements: *mut vk::MemoryRequirements2<'_>,
) {
    let table = tables::device(device);
    // SAFETY: as above; the copies of the program's structs live as long as the call.
    unsafe {
        let created = tail::padded(&*(*info).p_create_info);
        let info = vk::DeviceBufferMemoryRequirements { p_create_info: &created, ..*info };
        (table.next.fp_v1_3().get_device_buffer_memory_requirements)(device, &info, requirements);
        pretend(&mut (*requirements).memory_requirements, false);
    }
}

pub unsafe extern "system" fn device_image_requirements(
    device: vk::Device,
    info: *const vk::DeviceImageMemoryRequirements<'_>,
    requirements: *mut vk::MemoryRequirements2<'_>,
) {
    let table = tables::device(device);
    // SAFETY: as above.
    unsafe {
        (table.next.fp_v1_3().get_device_image_memory_requirements)(device, info, requirements);
        pretend(&mut (*requirements).memory_requirements, true);
    }
}
