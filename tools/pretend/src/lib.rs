//! A Vulkan layer between a program and a driver: it changes what memory holds and what devices say, never what a right program draws.
//! Two modes change shaders as far as other compilers may, which moves last bits: a right program's picture is the same
//! to the eye.
//!
//! QUINCUNX_PRETEND names the modes, with commas between (modes.rs). What a wrong program does is said on standard error, and ends it.

mod discard;
mod features;
mod limits;
mod link;
mod memory;
mod modes;
mod null;
mod padding;
mod rewrite;
mod samples;
mod shaders;
mod statistics;
mod tables;
mod tail;
mod types;

use ash::vk;
use std::ffi::{CStr, c_char};

/// A function of ours as the loader hands it out: by its name, whichever its type is.
macro_rules! function {
    ($pointer:expr, $type:ty) => {
        // SAFETY: only a change of what a function pointer is called; the loader calls it by its true type.
        Some(unsafe { std::mem::transmute::<$type, unsafe extern "system" fn()>($pointer) })
    };
}

use function;

/// What this layer has of the functions of instances and physical devices.
fn of_instances(name: &[u8]) -> vk::PFN_vkVoidFunction {
    match name {
        b"vkGetInstanceProcAddr" => function!(get_instance_proc_addr, vk::PFN_vkGetInstanceProcAddr),
        b"vkCreateInstance" => function!(link::create_instance, vk::PFN_vkCreateInstance),
        b"vkCreateDevice" => function!(link::create_device, vk::PFN_vkCreateDevice),
        b"vkGetPhysicalDeviceProperties" => function!(limits::properties, vk::PFN_vkGetPhysicalDeviceProperties),
        b"vkGetPhysicalDeviceProperties2" => function!(limits::properties2, vk::PFN_vkGetPhysicalDeviceProperties2),
        b"vkGetPhysicalDeviceFeatures2" => function!(features::features2, vk::PFN_vkGetPhysicalDeviceFeatures2),
        b"vkEnumerateDeviceExtensionProperties" => {
            function!(features::extensions, vk::PFN_vkEnumerateDeviceExtensionProperties)
        }
        b"vkGetPhysicalDeviceMemoryProperties" => {
            function!(types::memory_properties, vk::PFN_vkGetPhysicalDeviceMemoryProperties)
        }
        _ => of_devices(name),
    }
}

/// What it has of those of devices.
fn of_devices(name: &[u8]) -> vk::PFN_vkVoidFunction {
    if statistics::FILE.is_some()
        && let Some(watched) = statistics::function(name)
    {
        return Some(watched);
    }
    if modes::MODES.null
        && let Some(made) = null::function(name)
    {
        return Some(made);
    }
    if modes::MODES.placed_samples {
        match name {
            b"vkCreateGraphicsPipelines" => {
                return function!(samples::create_graphics_pipelines, vk::PFN_vkCreateGraphicsPipelines);
            }
            b"vkCmdSetSampleLocationsEXT" => return function!(samples::set, vk::PFN_vkCmdSetSampleLocationsEXT),
            _ => {}
        }
    }
    match name {
        b"vkGetDeviceProcAddr" => function!(get_device_proc_addr, vk::PFN_vkGetDeviceProcAddr),
        b"vkAllocateMemory" => function!(memory::allocate, vk::PFN_vkAllocateMemory),
        b"vkFreeMemory" => function!(memory::free, vk::PFN_vkFreeMemory),
        b"vkMapMemory" => function!(memory::map, vk::PFN_vkMapMemory),
        b"vkGetBufferMemoryRequirements" => {
            function!(types::buffer_requirements, vk::PFN_vkGetBufferMemoryRequirements)
        }
        b"vkGetImageMemoryRequirements" => function!(types::image_requirements, vk::PFN_vkGetImageMemoryRequirements),
        b"vkGetDeviceBufferMemoryRequirements" => {
            function!(types::device_buffer_requirements, vk::PFN_vkGetDeviceBufferMemoryRequirements)
        }
        b"vkGetDeviceImageMemoryRequirements" => {
            function!(types::device_image_requirements, vk::PFN_vkGetDeviceImageMemoryRequirements)
        }
        b"vkCreateBuffer" => function!(padding::create_buffer, vk::PFN_vkCreateBuffer),
        b"vkDestroyBuffer" => function!(padding::destroy_buffer, vk::PFN_vkDestroyBuffer),
        b"vkBindBufferMemory" => function!(padding::bind_buffer, vk::PFN_vkBindBufferMemory),
        b"vkBindImageMemory" => function!(padding::bind_image, vk::PFN_vkBindImageMemory),
        b"vkDestroyImage" => function!(padding::destroy_image, vk::PFN_vkDestroyImage),
        b"vkUpdateDescriptorSets" => function!(padding::update_sets, vk::PFN_vkUpdateDescriptorSets),
        b"vkCmdFillBuffer" => function!(padding::fill, vk::PFN_vkCmdFillBuffer),
        b"vkCreateImage" => function!(discard::create_image, vk::PFN_vkCreateImage),
        b"vkCreateShaderModule" => function!(shaders::create_shader_module, vk::PFN_vkCreateShaderModule),
        b"vkCmdPipelineBarrier2" => function!(discard::barrier, vk::PFN_vkCmdPipelineBarrier2),
        _ => None,
    }
}

unsafe extern "system" fn get_instance_proc_addr(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the loader's strings end with a zero.
    let text = unsafe { CStr::from_ptr(name) };
    of_instances(text.to_bytes()).or_else(|| {
        let next = tables::instance(instance)?.get_instance_proc_addr;
        // SAFETY: the next layer's function with the loader's arguments.
        unsafe { next(instance, name) }
    })
}

unsafe extern "system" fn get_device_proc_addr(device: vk::Device, name: *const c_char) -> vk::PFN_vkVoidFunction {
    // SAFETY: as above.
    let text = unsafe { CStr::from_ptr(name) };
    of_devices(text.to_bytes()).or_else(|| {
        let next = tables::device(device).get_device_proc_addr;
        // SAFETY: as above.
        unsafe { next(device, name) }
    })
}

/// What the loader and a layer tell each other first (vk_layer.h's VkNegotiateLayerInterface).
#[repr(C)]
pub struct Negotiation {
    kind: i32,
    next: *const std::ffi::c_void,
    version: u32,
    get_instance_proc_addr: Option<vk::PFN_vkGetInstanceProcAddr>,
    get_device_proc_addr: Option<vk::PFN_vkGetDeviceProcAddr>,
    get_physical_device_proc_addr: Option<vk::PFN_vkGetInstanceProcAddr>,
}

/// # Safety
///
/// The loader's struct.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn vkNegotiateLoaderLayerInterfaceVersion(negotiation: *mut Negotiation) -> vk::Result {
    // SAFETY: the loader owns it and waits.
    let negotiation = unsafe { &mut *negotiation };
    if negotiation.version < 2 {
        return vk::Result::ERROR_INITIALIZATION_FAILED;
    }
    negotiation.version = 2;
    negotiation.get_instance_proc_addr = Some(get_instance_proc_addr);
    negotiation.get_device_proc_addr = Some(get_device_proc_addr);
    negotiation.get_physical_device_proc_addr = None;
    vk::Result::SUCCESS
}

/// Ends the program, which has done what no device need bear.
fn fail(what: &str) -> ! {
    eprintln!("pretend: {what}");
    std::process::abort()
}

/// A list of the program's.
///
/// # Safety
///
/// As many as `count`, where that is not 0.
unsafe fn slice<'a, T>(first: *const T, count: u32) -> &'a [T] {
    match count {
        0 => &[],
        // SAFETY: the caller's promise.
        count => unsafe { std::slice::from_raw_parts(first, count as usize) },
    }
}
