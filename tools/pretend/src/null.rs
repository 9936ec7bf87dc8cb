//! A driver without hardware, such as RADV with RADV_FORCE_FAMILY: it makes devices, layouts and pipelines, and so runs its compiler, but has
//! neither memory nor images nor fences.
//!
//! What it lacks is made here, from the host's memory or from numbers; commands and submits are dropped. Shaders' results are zeros, then.

use ash::vk;
use ash::vk::Handle;
use std::alloc::Layout;
use std::collections::HashMap;
use std::ffi::c_void;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

/// Where memory blocks begin, as devices see it: nobody follows an address.
const FIRST_ADDRESS: u64 = 1 << 32;
const ALIGNMENT: u64 = 4096;
/// What an acceleration structure takes, and what building it takes, for each of its triangles or instances.
const STRUCTURE_BYTES: u64 = 256;

/// A handle that the driver never sees.
fn made<T: Handle>() -> T {
    static LAST: AtomicU64 = AtomicU64::new(0);
    T::from_raw(LAST.fetch_add(1, Ordering::Relaxed) + 1)
}

/// Which function takes a driver's place, of devices.
pub fn function(name: &[u8]) -> vk::PFN_vkVoidFunction {
    use crate::function as f;
    match name {
        // Commands return nothing, and their callers clear the arguments away.
        name if name.starts_with(b"vkCmd") => f!(nothing, extern "system" fn()),
        b"vkDestroyImage"
        | b"vkDestroyImageView"
        | b"vkDestroyFence"
        | b"vkDestroyQueryPool"
        | b"vkDestroyAccelerationStructureKHR"
        | b"vkUnmapMemory"
        | b"vkGetImageSparseMemoryRequirements"
        | b"vkUpdateDescriptorSets" => f!(nothing, extern "system" fn()),
        b"vkBindBufferMemory" => f!(bind_buffer, vk::PFN_vkBindBufferMemory),
        b"vkBindImageMemory"
        | b"vkBeginCommandBuffer"
        | b"vkEndCommandBuffer"
        | b"vkResetFences"
        | b"vkWaitForFences"
        | b"vkGetFenceStatus"
        | b"vkQueueSubmit2"
        | b"vkQueueWaitIdle"
        | b"vkDeviceWaitIdle"
        | b"vkSetDebugUtilsObjectNameEXT" => f!(success, extern "system" fn() -> vk::Result),
        b"vkCreateImage" => f!(create_image, vk::PFN_vkCreateImage),
        b"vkCreateImageView" => f!(create_handle, CreateHandle),
        b"vkCreateFence" => f!(create_handle, CreateHandle),
        b"vkCreateQueryPool" => f!(create_handle, CreateHandle),
        b"vkCreateAccelerationStructureKHR" => f!(create_structure, vk::PFN_vkCreateAccelerationStructureKHR),
        b"vkAllocateMemory" => f!(allocate, vk::PFN_vkAllocateMemory),
        b"vkFreeMemory" => f!(free, vk::PFN_vkFreeMemory),
        b"vkMapMemory" => f!(map, vk::PFN_vkMapMemory),
        b"vkGetImageMemoryRequirements" => f!(image_requirements, vk::PFN_vkGetImageMemoryRequirements),
        b"vkGetDeviceImageMemoryRequirements" => {
            f!(device_image_requirements, vk::PFN_vkGetDeviceImageMemoryRequirements)
        }
        b"vkGetImageMemoryRequirements2" => f!(image_requirements2, vk::PFN_vkGetImageMemoryRequirements2),
        b"vkGetQueryPoolResults" => f!(query_results, vk::PFN_vkGetQueryPoolResults),
        b"vkGetBufferDeviceAddress" => f!(buffer_address, vk::PFN_vkGetBufferDeviceAddress),
        b"vkGetAccelerationStructureDeviceAddressKHR" => {
            f!(structure_address, vk::PFN_vkGetAccelerationStructureDeviceAddressKHR)
        }
        b"vkGetAccelerationStructureBuildSizesKHR" => {
            f!(structure_sizes, vk::PFN_vkGetAccelerationStructureBuildSizesKHR)
        }
        _ => None,
    }
}

extern "system" fn nothing() {}

extern "system" fn success() -> vk::Result {
    vk::Result::SUCCESS
}

/// Any function that makes an object from a description: its handle is a number.
type CreateHandle = unsafe extern "system" fn(vk::Device, *const c_void, *const c_void, *mut u64) -> vk::Result;

unsafe extern "system" fn create_handle(
    _: vk::Device,
    _: *const c_void,
    _: *const c_void,
    handle: *mut u64,
) -> vk::Result {
    // SAFETY: the caller's place for it.
    unsafe { *handle = made::<vk::Fence>().as_raw() };
    vk::Result::SUCCESS
}

/// What was made here, by handle.
#[derive(Default)]
struct Made {
    memories: HashMap<vk::DeviceMemory, Block>,
    /// Bytes that each takes.
    images: HashMap<vk::Image, u64>,
    /// Where buffers and acceleration structures lie, as devices see it.
    buffers: HashMap<vk::Buffer, vk::DeviceAddress>,
    structures: HashMap<vk::AccelerationStructureKHR, vk::DeviceAddress>,
    /// Bytes of all memory blocks that there were: the next one lies behind them.
    address: u64,
}

/// The host's bytes.
struct Block {
    first: *mut u8,
    layout: Layout,
    address: vk::DeviceAddress,
}

// SAFETY: who has the block has its bytes.
unsafe impl Send for Block {}

static MADE: LazyLock<Mutex<Made>> = LazyLock::new(Mutex::default);

fn known() -> MutexGuard<'static, Made> {
    MADE.lock().unwrap_or_else(PoisonError::into_inner)
}

unsafe extern "system" fn allocate(
    _: vk::Device,
    info: *const vk::MemoryAllocateInfo<'_>,
    _: *const vk::AllocationCallbacks<'_>,
    memory: *mut vk::DeviceMemory,
) -> vk::Result {
    // SAFETY: the program's struct.
    let bytes = unsafe { (*info).allocation_size } as usize;
    let Ok(layout) = Layout::from_size_align(bytes.max(1), ALIGNMENT as usize) else {
        return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
    };
    // SAFETY: not of no size.
    let first = unsafe { std::alloc::alloc_zeroed(layout) };
    if first.is_null() {
        return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
    }
    let handle = made();
    let mut known = known();
    let address = FIRST_ADDRESS + known.address;
    known.address += (bytes as u64).next_multiple_of(ALIGNMENT);
    known.memories.insert(handle, Block { first, layout, address });
    // SAFETY: the program's place for it.
    unsafe { *memory = handle };
    vk::Result::SUCCESS
}

unsafe extern "system" fn free(_: vk::Device, memory: vk::DeviceMemory, _: *const vk::AllocationCallbacks<'_>) {
    if let Some(block) = known().memories.remove(&memory) {
        // SAFETY: allocated above with this layout.
        unsafe { std::alloc::dealloc(block.first, block.layout) };
    }
}

unsafe extern "system" fn map(
    _: vk::Device,
    memory: vk::DeviceMemory,
    offset: vk::DeviceSize,
    _: vk::DeviceSize,
    _: vk::MemoryMapFlags,
    data: *mut *mut c_void,
) -> vk::Result {
    let first = known().memories.get(&memory).map(|block| block.first);
    let Some(first) = first else { crate::fail("memory is mapped that was not allocated") };
    // SAFETY: the offset lies in the block, and the place is the program's.
    unsafe { *data = first.add(offset as usize).cast() };
    vk::Result::SUCCESS
}

/// Bytes of a texel, of the formats that the program may take and at most of others.
fn texel_bytes(format: vk::Format) -> u64 {
    use vk::Format as F;
    match format {
        F::R8_UNORM | F::R8_UINT | F::S8_UINT => 1,
        F::R8G8_UNORM | F::R16_UINT | F::R16_SFLOAT | F::D16_UNORM => 2,
        F::R8G8B8A8_UNORM | F::R8G8B8A8_SRGB | F::R16G16_SFLOAT | F::R16G16_UINT => 4,
        F::R32_UINT | F::R32_SFLOAT | F::D32_SFLOAT | F::A2B10G10R10_UNORM_PACK32 | F::B10G11R11_UFLOAT_PACK32 => 4,
        F::R16G16B16A16_SFLOAT | F::R16G16B16A16_UINT | F::R32G32_UINT | F::R32G32_SFLOAT | F::D32_SFLOAT_S8_UINT => 8,
        _ => 16,
    }
}

/// As many texels as there are, without gaps.
fn bytes_of(info: &vk::ImageCreateInfo<'_>) -> u64 {
    let vk::Extent3D { width, height, depth } = info.extent;
    let levels: u64 = (0..info.mip_levels)
        .map(|level| [width, height, depth].map(|side| u64::from((side >> level).max(1))).iter().product::<u64>())
        .sum();
    let bytes = levels * u64::from(info.array_layers) * u64::from(info.samples.as_raw()) * texel_bytes(info.format);
    bytes.next_multiple_of(ALIGNMENT)
}

fn requirements_of(size: u64) -> vk::MemoryRequirements {
    vk::MemoryRequirements { size, alignment: ALIGNMENT, memory_type_bits: crate::types::OF_IMAGES }
}

unsafe extern "system" fn create_image(
    _: vk::Device,
    info: *const vk::ImageCreateInfo<'_>,
    _: *const vk::AllocationCallbacks<'_>,
    image: *mut vk::Image,
) -> vk::Result {
    let handle = made();
    // SAFETY: the program's struct, and its place for the handle.
    unsafe {
        known().images.insert(handle, bytes_of(&*info));
        *image = handle;
    }
    vk::Result::SUCCESS
}

unsafe extern "system" fn image_requirements(
    _: vk::Device,
    image: vk::Image,
    requirements: *mut vk::MemoryRequirements,
) {
    let bytes = known().images.get(&image).copied();
    let Some(bytes) = bytes else { crate::fail("an image is asked about that was not made") };
    // SAFETY: the program's place for it.
    unsafe { *requirements = requirements_of(bytes) };
}

/// Validation layers ask so.
unsafe extern "system" fn image_requirements2(
    device: vk::Device,
    info: *const vk::ImageMemoryRequirementsInfo2<'_>,
    requirements: *mut vk::MemoryRequirements2<'_>,
) {
    // SAFETY: the caller's structs.
    unsafe { image_requirements(device, (*info).image, &mut (*requirements).memory_requirements) };
}

unsafe extern "system" fn device_image_requirements(
    _: vk::Device,
    info: *const vk::DeviceImageMemoryRequirements<'_>,
    requirements: *mut vk::MemoryRequirements2<'_>,
) {
    // SAFETY: the program's structs.
    unsafe { (*requirements).memory_requirements = requirements_of(bytes_of(&*(*info).p_create_info)) };
}

/// Zeros, and that they are there.
unsafe extern "system" fn query_results(
    _: vk::Device,
    _: vk::QueryPool,
    _: u32,
    _: u32,
    bytes: usize,
    data: *mut c_void,
    _: vk::DeviceSize,
    _: vk::QueryResultFlags,
) -> vk::Result {
    // SAFETY: the program's bytes.
    unsafe { data.cast::<u8>().write_bytes(0, bytes) };
    vk::Result::SUCCESS
}

unsafe extern "system" fn bind_buffer(
    _: vk::Device,
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    offset: vk::DeviceSize,
) -> vk::Result {
    let mut known = known();
    let Some(block) = known.memories.get(&memory) else { crate::fail("a buffer is bound to memory that is not there") };
    let address = block.address + offset;
    known.buffers.insert(buffer, address);
    vk::Result::SUCCESS
}

unsafe extern "system" fn buffer_address(
    _: vk::Device,
    info: *const vk::BufferDeviceAddressInfo<'_>,
) -> vk::DeviceAddress {
    // SAFETY: the program's struct.
    let buffer = unsafe { (*info).buffer };
    let address = known().buffers.get(&buffer).copied();
    address.unwrap_or_else(|| crate::fail("a buffer's address is asked before it is bound"))
}

unsafe extern "system" fn create_structure(
    _: vk::Device,
    info: *const vk::AccelerationStructureCreateInfoKHR<'_>,
    _: *const vk::AllocationCallbacks<'_>,
    structure: *mut vk::AccelerationStructureKHR,
) -> vk::Result {
    let handle = made();
    let mut known = known();
    // SAFETY: the program's struct, and its place for the handle.
    unsafe {
        let address = known.buffers.get(&(*info).buffer).map_or(0, |address| address + (*info).offset);
        known.structures.insert(handle, address);
        *structure = handle;
    }
    vk::Result::SUCCESS
}

unsafe extern "system" fn structure_address(
    _: vk::Device,
    info: *const vk::AccelerationStructureDeviceAddressInfoKHR<'_>,
) -> vk::DeviceAddress {
    // SAFETY: the program's struct.
    let structure = unsafe { (*info).acceleration_structure };
    known().structures.get(&structure).copied().unwrap_or_default()
}

unsafe extern "system" fn structure_sizes(
    _: vk::Device,
    _: vk::AccelerationStructureBuildTypeKHR,
    info: *const vk::AccelerationStructureBuildGeometryInfoKHR<'_>,
    counts: *const u32,
    sizes: *mut vk::AccelerationStructureBuildSizesInfoKHR<'_>,
) {
    // SAFETY: the program's structs: as many counts as geometries.
    unsafe {
        let counts = std::slice::from_raw_parts(counts, (*info).geometry_count as usize);
        let bytes = counts.iter().map(|count| u64::from(*count)).sum::<u64>().max(1) * STRUCTURE_BYTES;
        (*sizes).acceleration_structure_size = bytes;
        (*sizes).build_scratch_size = bytes;
        (*sizes).update_scratch_size = bytes;
    }
}
