//! What a barrier lets the device drop is overwritten, with what is wrong wherever it is read: images by their undefined layout,
//! buffers that take over another's bytes by a queue family that is named (the program's own sign, src/gpu/access.rs; of
//! all other buffers it is the ignored one).

use crate::modes::MODES;
use crate::slice;
use crate::tables::{self, DeviceTable};
use ash::vk;

/// A depth in the middle of everything, and a stencil that nothing writes.
const DEPTH: vk::ClearDepthStencilValue = vk::ClearDepthStencilValue { depth: 0.7, stencil: 0xa5 };
const WORD: u32 = 0xaaaa_aaaa;
/// NaN, also in its upper half; and not all ones, which say "none" in many a buffer.
const NAN_WORD: u32 = 0x7fc5_a5a5;

const CLEARING: vk::PipelineStageFlags2 = vk::PipelineStageFlags2::ALL_TRANSFER;
const WRITING: vk::AccessFlags2 = vk::AccessFlags2::TRANSFER_WRITE;
const WRITABLE: vk::ImageLayout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;

pub unsafe extern "system" fn create_image(
    device: vk::Device,
    info: *const vk::ImageCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    image: *mut vk::Image,
) -> vk::Result {
    let table = tables::device(device);
    // SAFETY: the next layer's function; the copy of the program's struct lives as long as the call.
    unsafe {
        let mut usage = (*info).usage;
        if MODES.discard {
            usage |= vk::ImageUsageFlags::TRANSFER_DST;
        }
        let mut flags = (*info).flags;
        if MODES.placed_samples {
            flags &= !vk::ImageCreateFlags::SAMPLE_LOCATIONS_COMPATIBLE_DEPTH_EXT;
        }
        let info = vk::ImageCreateInfo { usage, flags, ..*info };
        let result = (table.next.fp_v1_0().create_image)(device, &info, allocator, image);
        if result == vk::Result::SUCCESS {
            table.known().formats.insert(*image, info.format);
        }
        result
    }
}

/// What a clear writes into an image of this format: NaN, or words without a meaning.
fn wrong_color(format: vk::Format) -> vk::ClearColorValue {
    use vk::Format as F;
    match format {
        F::R8_UINT
        | F::R16_UINT
        | F::R32_UINT
        | F::R32G32_UINT
        | F::R32G32B32A32_UINT
        | F::R16G16_UINT
        | F::R16G16B16A16_UINT => vk::ClearColorValue { uint32: [WORD; 4] },
        F::R16_SFLOAT
        | F::R16G16_SFLOAT
        | F::R16G16B16A16_SFLOAT
        | F::R32_SFLOAT
        | F::R32G32_SFLOAT
        | F::R32G32B32A32_SFLOAT => vk::ClearColorValue { float32: [f32::NAN; 4] },
        _ => vk::ClearColorValue { float32: [0.7; 4] },
    }
}

pub unsafe extern "system" fn barrier(commands: vk::CommandBuffer, info: *const vk::DependencyInfo<'_>) {
    let table = tables::device(commands);
    let next = table.next.fp_v1_3().cmd_pipeline_barrier2;
    // SAFETY: the program's structs; the copies live as long as the calls, which are recorded where the program records.
    unsafe {
        let images: &[vk::ImageMemoryBarrier2<'_>] =
            slice((*info).p_image_memory_barriers, (*info).image_memory_barrier_count);
        let buffers: &[vk::BufferMemoryBarrier2<'_>] =
            slice((*info).p_buffer_memory_barriers, (*info).buffer_memory_barrier_count);
        if !MODES.discard || !(images.iter().any(is_dropped_image) || buffers.iter().any(is_dropped_buffer)) {
            return next(commands, info);
        }
        let (mut images_before, mut buffers_before) = (images.to_vec(), buffers.to_vec());
        for barrier in images_before.iter_mut().filter(|barrier| is_dropped_image(barrier)) {
            *barrier = barrier.dst_stage_mask(CLEARING).dst_access_mask(WRITING).new_layout(WRITABLE);
        }
        for barrier in buffers_before.iter_mut().filter(|barrier| is_dropped_buffer(barrier)) {
            *barrier = barrier.dst_stage_mask(CLEARING).dst_access_mask(WRITING);
        }
        // Who had the bytes before was another resource: the program's own memory barrier makes its next use wait, and not ours.
        let before_us = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(CLEARING)
            .dst_access_mask(WRITING)];
        next(commands, &vk::DependencyInfo::default().memory_barriers(&before_us));
        let changed = vk::DependencyInfo {
            p_image_memory_barriers: images_before.as_ptr(),
            p_buffer_memory_barriers: buffers_before.as_ptr(),
            ..*info
        };
        next(commands, &changed);
        overwrite(&table, commands, images, buffers);
        let images_after: Vec<_> = images
            .iter()
            .filter(|barrier| is_dropped_image(barrier))
            .map(|barrier| barrier.src_stage_mask(CLEARING).src_access_mask(WRITING).old_layout(WRITABLE))
            .collect();
        let buffers_after: Vec<_> = buffers
            .iter()
            .filter(|barrier| is_dropped_buffer(barrier))
            .map(|barrier| barrier.src_stage_mask(CLEARING).src_access_mask(WRITING))
            .collect();
        let after =
            vk::DependencyInfo::default().image_memory_barriers(&images_after).buffer_memory_barriers(&buffers_after);
        next(commands, &after);
    }
}

/// # Safety
///
/// `commands` is recorded outside rendering, and what is dropped may be written.
unsafe fn overwrite(
    table: &DeviceTable,
    commands: vk::CommandBuffer,
    images: &[vk::ImageMemoryBarrier2<'_>],
    buffers: &[vk::BufferMemoryBarrier2<'_>],
) {
    for barrier in images.iter().filter(|barrier| is_dropped_image(barrier)) {
        let (image, ranges) = (barrier.image, [barrier.subresource_range]);
        // SAFETY: the caller's promise.
        unsafe {
            if barrier.subresource_range.aspect_mask.contains(vk::ImageAspectFlags::COLOR) {
                let format = table.known().formats.get(&image).copied().unwrap_or_default();
                table.next.cmd_clear_color_image(commands, image, WRITABLE, &wrong_color(format), &ranges);
            } else {
                table.next.cmd_clear_depth_stencil_image(commands, image, WRITABLE, &DEPTH, &ranges);
            }
        }
    }
    for barrier in buffers.iter().filter(|barrier| is_dropped_buffer(barrier)) {
        let asked_bytes = table.known().buffers.get(&barrier.buffer).map_or(0, |bound| bound.asked_bytes);
        if asked_bytes >= 4 {
            // SAFETY: as above.
            unsafe { table.next.cmd_fill_buffer(commands, barrier.buffer, 0, asked_bytes / 4 * 4, NAN_WORD) };
        }
    }
}

fn is_dropped_image(barrier: &vk::ImageMemoryBarrier2<'_>) -> bool {
    barrier.old_layout == vk::ImageLayout::UNDEFINED
}

fn is_dropped_buffer(barrier: &vk::BufferMemoryBarrier2<'_>) -> bool {
    barrier.src_queue_family_index != vk::QUEUE_FAMILY_IGNORED
        && barrier.src_queue_family_index == barrier.dst_queue_family_index
}
