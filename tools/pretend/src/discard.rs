//! What a barrier from an undefined layout lets the device drop is overwritten, with what is wrong wherever it is read.

use crate::modes::MODES;
use crate::tables;
use ash::vk;

/// A depth in the middle of everything, and a stencil that nothing writes.
const DEPTH: vk::ClearDepthStencilValue = vk::ClearDepthStencilValue { depth: 0.7, stencil: 0xa5 };
const WORD: u32 = 0xaaaa_aaaa;

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
        let info = vk::ImageCreateInfo { usage, ..*info };
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
        let images = match (*info).image_memory_barrier_count {
            0 => &[],
            count => std::slice::from_raw_parts((*info).p_image_memory_barriers, count as usize),
        };
        let is_dropped = |barrier: &&vk::ImageMemoryBarrier2<'_>| barrier.old_layout == vk::ImageLayout::UNDEFINED;
        if !MODES.discard || !images.iter().any(|barrier| is_dropped(&barrier)) {
            return next(commands, info);
        }
        let writable = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let before: Vec<_> = images
            .iter()
            .map(|barrier| match is_dropped(&barrier) {
                true => barrier
                    .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
                    .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                    .new_layout(writable),
                false => *barrier,
            })
            .collect();
        let changed = vk::DependencyInfo { p_image_memory_barriers: before.as_ptr(), ..*info };
        next(commands, &changed);
        for barrier in images.iter().filter(is_dropped) {
            let (image, ranges) = (barrier.image, [barrier.subresource_range]);
            if barrier.subresource_range.aspect_mask.contains(vk::ImageAspectFlags::COLOR) {
                let format = table.known().formats.get(&image).copied().unwrap_or_default();
                table.next.cmd_clear_color_image(commands, image, writable, &wrong_color(format), &ranges);
            } else {
                table.next.cmd_clear_depth_stencil_image(commands, image, writable, &DEPTH, &ranges);
            }
        }
        let after: Vec<_> = images
            .iter()
            .filter(is_dropped)
            .map(|barrier| {
                barrier
                    .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
                    .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                    .old_layout(writable)
            })
            .collect();
        next(commands, &vk::DependencyInfo::default().image_memory_barriers(&after));
    }
}
