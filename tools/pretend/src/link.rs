//! The chain of layers: instances and devices are made by the next one (vk_layer.h).

use crate::modes::MODES;
use crate::tables::{self, DeviceTable, InstanceTable, Known};
use crate::{samples, slice, statistics};
use ash::vk;
use std::ffi::c_void;
use std::sync::Mutex;

const INSTANCE: i32 = 47;
const DEVICE: i32 = 48;
const LINK: i32 = 0;

#[repr(C)]
struct Link<F> {
    next: *mut Link<F>,
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    /// For devices: vkGetDeviceProcAddr.
    other: F,
}

#[repr(C)]
struct LinkInfo<F> {
    kind: i32,
    next: *const c_void,
    function: i32,
    link: *mut Link<F>,
}

/// The link of this layer in a chain of structs, taken out: the next layer finds its own.
///
/// SAFETY: the loader's chain.
unsafe fn take_link<F: Copy>(mut chain: *const c_void, kind: i32) -> Option<(vk::PFN_vkGetInstanceProcAddr, F)> {
    while !chain.is_null() {
        let info = chain as *mut LinkInfo<F>;
        // SAFETY: every struct of a chain begins with its kind and the next one; those of this kind are the loader's, with a link where
        // the function says so.
        unsafe {
            if (*info).kind == kind && (*info).function == LINK {
                let link = (*info).link;
                (*info).link = (*link).next;
                return Some(((*link).get_instance_proc_addr, (*link).other));
            }
            chain = (*info).next;
        }
    }
    None
}

pub unsafe extern "system" fn create_instance(
    info: *const vk::InstanceCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    instance: *mut vk::Instance,
) -> vk::Result {
    // SAFETY: the loader's chain, whose functions are called as they are declared.
    unsafe {
        let Some((get, _)) = take_link::<*const c_void>((*info).p_next, INSTANCE) else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        let Some(create) = get(vk::Instance::null(), c"vkCreateInstance".as_ptr()) else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        let create: vk::PFN_vkCreateInstance = std::mem::transmute(create);
        let result = create(info, allocator, instance);
        if result == vk::Result::SUCCESS {
            let entry = ash::StaticFn { get_instance_proc_addr: get };
            let next = ash::Instance::load(&entry, *instance);
            tables::add_instance(*instance, InstanceTable { next, get_instance_proc_addr: get });
        }
        result
    }
}

pub unsafe extern "system" fn create_device(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    device: *mut vk::Device,
) -> vk::Result {
    // SAFETY: as above.
    unsafe {
        let Some((_, get)) = take_link::<vk::PFN_vkGetDeviceProcAddr>((*info).p_next, DEVICE) else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        let table = tables::of_physical(physical);
        let mut features = (*info).p_enabled_features.as_ref().copied();
        if MODES.contract.is_some() {
            // What the rewritten shaders compute in.
            let Some(features) = &mut features else {
                crate::fail("contract: a device without enabled features of Vulkan 1.0, where shaderFloat64 would go");
            };
            features.shader_float64 = vk::TRUE;
        }
        let p_enabled_features = features.as_ref().map_or(std::ptr::null(), |features| features as *const _);
        let info = vk::DeviceCreateInfo { p_enabled_features, ..*info };
        let plain = samples::without_it(slice(info.pp_enabled_extension_names, info.enabled_extension_count));
        let info = match MODES.placed_samples {
            true => info.enabled_extension_names(&plain),
            false => info,
        };
        let (mut names, mut feature) = Default::default();
        let info = match statistics::FILE.is_some() {
            true => statistics::with_statistics(&info, &mut names, &mut feature),
            false => info,
        };
        let result = (table.next.fp_v1_0().create_device)(physical, &info, allocator, device);
        if result == vk::Result::SUCCESS {
            let handle = *device;
            let next = ash::Device::load_with(
                |name| get(handle, name.as_ptr()).map_or(std::ptr::null(), |function| function as *const c_void),
                handle,
            );
            tables::add_device(
                handle,
                DeviceTable { next, get_device_proc_addr: get, known: Mutex::new(Known::default()) },
            );
        }
        result
    }
}
