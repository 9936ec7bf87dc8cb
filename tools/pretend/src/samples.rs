//! Placed samples (VK_EXT_sample_locations) of a driver that lacks them: it is offered, four a pixel, and what a program says of it is checked
//! and taken out. So they lie where Vulkan's standard has them, wherever they were placed.

use crate::{slice, tables};
use ash::vk;
use std::ffi::{CStr, c_char};

const COUNT: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_4;
/// Steps of a pixel at which places lie, as of most devices.
const STEPS: f32 = 16.0;

/// The extension as a device lists it.
pub fn extension() -> vk::ExtensionProperties {
    let mut listed = vk::ExtensionProperties::default().spec_version(1);
    for (to, from) in listed.extension_name.iter_mut().zip(ash::ext::sample_locations::NAME.to_bytes_with_nul()) {
        *to = *from as c_char;
    }
    listed
}

/// Fills the program's struct of the chain that begins at `next`, if there is one.
///
/// # Safety
///
/// Every struct of the chain is of the kind that it says.
pub unsafe fn describe(mut next: *mut vk::BaseOutStructure<'_>) {
    while !next.is_null() {
        // SAFETY: the caller's promise.
        unsafe {
            if (*next).s_type == vk::StructureType::PHYSICAL_DEVICE_SAMPLE_LOCATIONS_PROPERTIES_EXT {
                let found = &mut *next.cast::<vk::PhysicalDeviceSampleLocationsPropertiesEXT<'_>>();
                found.sample_location_sample_counts = COUNT;
                found.max_sample_location_grid_size = vk::Extent2D { width: 1, height: 1 };
                found.sample_location_coordinate_range = [0.0, 1.0 - 1.0 / STEPS];
                found.sample_location_sub_pixel_bits = STEPS.log2() as u32;
                found.variable_sample_locations = vk::FALSE;
            }
            next = (*next).p_next;
        }
    }
}

/// Names of extensions without it.
///
/// # Safety
///
/// They end with a zero.
pub unsafe fn without_it(names: &[*const c_char]) -> Vec<*const c_char> {
    // SAFETY: the caller's promise.
    let is_it = |name: &*const c_char| unsafe { CStr::from_ptr(*name) } == ash::ext::sample_locations::NAME;
    names.iter().copied().filter(|name| !is_it(name)).collect()
}

pub unsafe extern "system" fn create_graphics_pipelines(
    device: vk::Device,
    cache: vk::PipelineCache,
    count: u32,
    infos: *const vk::GraphicsPipelineCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    let next = tables::device(device).next.fp_v1_0().create_graphics_pipelines;
    // SAFETY: the program's structs, and its places for as many pipelines; the next layer's function.
    unsafe {
        for (index, info) in slice(infos, count).iter().enumerate() {
            let result = without_places(info, |info| next(device, cache, 1, info, allocator, pipelines.add(index)));
            if result != vk::Result::SUCCESS {
                return result;
            }
        }
    }
    vk::Result::SUCCESS
}

/// Hands `make` a pipeline whose samples are not placed. One whose samples are must have four, and let commands place them.
///
/// # Safety
///
/// The program's struct, with what it points to.
unsafe fn without_places(
    info: &vk::GraphicsPipelineCreateInfo<'_>,
    make: impl FnOnce(*const vk::GraphicsPipelineCreateInfo<'_>) -> vk::Result,
) -> vk::Result {
    // SAFETY: the caller's promise; this program chains nothing else there.
    let (samples, states, placed) = unsafe {
        let (samples, dynamic) = (&*info.p_multisample_state, &*info.p_dynamic_state);
        let placed = samples.p_next.cast::<vk::PipelineSampleLocationsStateCreateInfoEXT<'_>>();
        (samples, slice(dynamic.p_dynamic_states, dynamic.dynamic_state_count), placed.as_ref())
    };
    let Some(placed) = placed else { return make(info) };
    let kept: Vec<vk::DynamicState> =
        states.iter().filter(|state| **state != vk::DynamicState::SAMPLE_LOCATIONS_EXT).copied().collect();
    let is_right = placed.s_type == vk::StructureType::PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT
        && placed.sample_locations_enable == vk::TRUE
        && samples.rasterization_samples == COUNT
        && kept.len() + 1 == states.len();
    if !is_right {
        crate::fail("a pipeline's samples are placed otherwise than four of them by commands");
    }
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&kept);
    let multisample = vk::PipelineMultisampleStateCreateInfo { p_next: std::ptr::null(), ..*samples };
    make(&vk::GraphicsPipelineCreateInfo { p_multisample_state: &multisample, p_dynamic_state: &dynamic, ..*info })
}

/// Four places, each at a sixteenth of a pixel.
pub unsafe extern "system" fn set(_: vk::CommandBuffer, info: *const vk::SampleLocationsInfoEXT<'_>) {
    // SAFETY: the program's struct, with as many places as it says.
    let (info, places) = unsafe { (&*info, slice((*info).p_sample_locations, (*info).sample_locations_count)) };
    let is_step = |place: f32| (0.0..1.0).contains(&place) && (place * STEPS).fract() == 0.0;
    let are_right = places.iter().all(|place| is_step(place.x) && is_step(place.y));
    let grid = info.sample_location_grid_size;
    if info.sample_locations_per_pixel != COUNT
        || places.len() != 4
        || [grid.width, grid.height] != [1, 1]
        || !are_right
    {
        let places: Vec<[f32; 2]> = places.iter().map(|place| [place.x, place.y]).collect();
        crate::fail(&format!("samples are placed at {places:?}, for a grid of {}x{}", grid.width, grid.height));
    }
}
