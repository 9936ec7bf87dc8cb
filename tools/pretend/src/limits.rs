//! What a device says that it is and how far it goes.

use crate::modes::MODES;
use crate::{samples, tables};
use ash::vk;

pub unsafe extern "system" fn properties(physical: vk::PhysicalDevice, properties: *mut vk::PhysicalDeviceProperties) {
    let table = tables::of_physical(physical);
    // SAFETY: the next layer's function with the program's arguments, whose struct is written then.
    unsafe {
        (table.next.fp_v1_0().get_physical_device_properties)(physical, properties);
        pretend(&mut *properties);
    }
}

pub unsafe extern "system" fn properties2(
    physical: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceProperties2<'_>,
) {
    let table = tables::of_physical(physical);
    // SAFETY: as above.
    unsafe {
        (table.next.fp_v1_1().get_physical_device_properties2)(physical, properties);
        pretend(&mut (*properties).properties);
        if MODES.placed_samples {
            samples::describe((*properties).p_next as *mut vk::BaseOutStructure<'_>);
        }
    }
}

fn pretend(properties: &mut vk::PhysicalDeviceProperties) {
    if MODES.gpu {
        properties.device_type = vk::PhysicalDeviceType::DISCRETE_GPU;
        let name = b"Pretended GPU\0";
        for (to, from) in properties.device_name.iter_mut().zip(name) {
            *to = *from as std::ffi::c_char;
        }
    }
    if MODES.least_limits {
        least(&mut properties.limits);
    }
}

/// Table "Required Limits" of Vulkan 1.3, of the limits that the program asks for; those of optional features without them.
fn least(limits: &mut vk::PhysicalDeviceLimits) {
    limits.max_image_dimension1_d = 4096;
    limits.max_image_dimension2_d = 4096;
    limits.max_image_array_layers = 256;
    limits.max_uniform_buffer_range = 16_384;
    limits.max_storage_buffer_range = 1 << 27;
    limits.max_push_constants_size = 128;
    limits.max_memory_allocation_count = 4096;
    limits.buffer_image_granularity = 131_072;
    limits.max_bound_descriptor_sets = 4;
    limits.max_per_stage_descriptor_samplers = 16;
    limits.max_per_stage_descriptor_uniform_buffers = 12;
    limits.max_per_stage_descriptor_storage_buffers = 4;
    limits.max_per_stage_descriptor_sampled_images = 16;
    limits.max_per_stage_descriptor_storage_images = 4;
    limits.max_geometry_output_vertices = 0;
    limits.max_geometry_total_output_components = 0;
    limits.max_compute_shared_memory_size = 16_384;
    limits.max_compute_work_group_count = [65_535; 3];
    limits.max_compute_work_group_invocations = 128;
    limits.max_compute_work_group_size = [128, 128, 64];
    limits.sub_pixel_precision_bits = limits.sub_pixel_precision_bits.min(8);
    limits.max_draw_indirect_count = 1;
    limits.max_sampler_anisotropy = 1.0;
    limits.max_viewport_dimensions = [4096; 2];
    limits.min_storage_buffer_offset_alignment = 256;
    limits.non_coherent_atom_size = 256;
    limits.max_framebuffer_width = 4096;
    limits.max_framebuffer_height = 4096;
    limits.max_framebuffer_layers = 256;
    limits.max_color_attachments = 4;
    limits.timestamp_compute_and_graphics = 0;
}
