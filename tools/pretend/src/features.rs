//! What a device has that Vulkan leaves optional.

use crate::modes::MODES;
use crate::{samples, tables};
use ash::vk;
use std::ffi::c_char;

pub unsafe extern "system" fn features2(physical: vk::PhysicalDevice, features: *mut vk::PhysicalDeviceFeatures2<'_>) {
    let table = tables::of_physical(physical);
    // SAFETY: the next layer's function with the program's arguments; then every struct of the program's chain is of the kind that it
    // says.
    unsafe {
        (table.next.fp_v1_1().get_physical_device_features2)(physical, features);
        if !MODES.least_limits {
            return;
        }
        (*features).features =
            vk::PhysicalDeviceFeatures { robust_buffer_access: vk::TRUE, ..vk::PhysicalDeviceFeatures::default() };
        let mut next = (*features).p_next as *mut vk::BaseOutStructure<'_>;
        while !next.is_null() {
            match (*next).s_type {
                vk::StructureType::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES => {
                    let features = &mut *next.cast::<vk::PhysicalDeviceVulkan12Features<'_>>();
                    features.shader_output_layer = vk::FALSE;
                    features.shader_output_viewport_index = vk::FALSE;
                    features.shader_buffer_int64_atomics = vk::FALSE;
                    features.draw_indirect_count = vk::FALSE;
                    features.shader_float16 = vk::FALSE;
                }
                vk::StructureType::PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR => {
                    (*next.cast::<vk::PhysicalDeviceRayQueryFeaturesKHR<'_>>()).ray_query = vk::FALSE;
                }
                _ => {}
            }
            next = (*next).p_next;
        }
    }
}

/// None, with the least that there may be; one more, where samples are placed.
pub unsafe extern "system" fn extensions(
    physical: vk::PhysicalDevice,
    layer: *const c_char,
    count: *mut u32,
    properties: *mut vk::ExtensionProperties,
) -> vk::Result {
    if MODES.least_limits && layer.is_null() {
        // SAFETY: the program's number.
        unsafe { *count = 0 };
        return vk::Result::SUCCESS;
    }
    let next = tables::of_physical(physical).next.fp_v1_0().enumerate_device_extension_properties;
    // SAFETY: the next layer's function with the program's arguments, whose list has the length that it says.
    unsafe {
        if !MODES.placed_samples || !layer.is_null() {
            return next(physical, layer, count, properties);
        }
        let room = *count;
        if !properties.is_null() && room > 0 {
            *count = room - 1;
        }
        let result = next(physical, layer, count, properties);
        if !properties.is_null() {
            if room == *count {
                return vk::Result::INCOMPLETE;
            }
            *properties.add(*count as usize) = samples::extension();
        }
        *count += 1;
        result
    }
}
