//! What a driver's compiler says of each shader that it makes (VK_KHR_pipeline_executable_properties), as lines of JSON in the file that
//! QUINCUNX_PRETEND_STATISTICS names. The program needs to know nothing of it but to name its shader modules.

use crate::slice;
use crate::tables::{self, DeviceTable};
use ash::vk;
use ash::vk::Handle;
use std::ffi::{CStr, c_void};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::LazyLock;

pub static FILE: LazyLock<Option<PathBuf>> =
    LazyLock::new(|| std::env::var_os("QUINCUNX_PRETEND_STATISTICS").map(PathBuf::from));

/// Which function is watched, of devices.
pub fn function(name: &[u8]) -> vk::PFN_vkVoidFunction {
    use crate::function as f;
    match name {
        b"vkSetDebugUtilsObjectNameEXT" => f!(set_name, vk::PFN_vkSetDebugUtilsObjectNameEXT),
        b"vkCreateComputePipelines" => f!(create_compute, vk::PFN_vkCreateComputePipelines),
        b"vkCreateGraphicsPipelines" => f!(create_graphics, vk::PFN_vkCreateGraphicsPipelines),
        _ => None,
    }
}

/// The same device with what makes statistics. The pointers of the result live as long as the arguments.
pub fn with_statistics<'a>(
    info: &vk::DeviceCreateInfo<'a>,
    names: &'a mut Vec<*const std::ffi::c_char>,
    feature: &'a mut vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR<'_>,
) -> vk::DeviceCreateInfo<'a> {
    // SAFETY: the program's names, as many as it says.
    names.extend_from_slice(unsafe { slice(info.pp_enabled_extension_names, info.enabled_extension_count) });
    names.push(ash::khr::pipeline_executable_properties::NAME.as_ptr());
    feature.pipeline_executable_info = vk::TRUE;
    feature.p_next = info.p_next.cast_mut();
    vk::DeviceCreateInfo {
        p_next: std::ptr::from_mut(feature).cast(),
        enabled_extension_count: names.len() as u32,
        pp_enabled_extension_names: names.as_ptr(),
        ..*info
    }
}

/// Names of modules are kept; the driver, which may not know the object, hears of none.
unsafe extern "system" fn set_name(device: vk::Device, info: *const vk::DebugUtilsObjectNameInfoEXT<'_>) -> vk::Result {
    // SAFETY: the program's struct, whose name ends with a zero where there is one.
    unsafe {
        if (*info).object_type == vk::ObjectType::SHADER_MODULE && !(*info).p_object_name.is_null() {
            let name = CStr::from_ptr((*info).p_object_name).to_string_lossy().into_owned();
            let module = vk::ShaderModule::from_raw((*info).object_handle);
            tables::device(device).known().modules.insert(module, name);
        }
    }
    vk::Result::SUCCESS
}

unsafe extern "system" fn create_compute(
    device: vk::Device,
    _: vk::PipelineCache,
    count: u32,
    infos: *const vk::ComputePipelineCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    let table = tables::device(device);
    // SAFETY: the program's structs, and its places for as many pipelines; the next layer's function.
    unsafe {
        let infos = std::slice::from_raw_parts(infos, count as usize);
        let create = table.next.fp_v1_0().create_compute_pipelines;
        let make = |infos: *const _| create(device, NO_CACHE, count, infos, allocator, pipelines);
        captured(&table, infos, |info| &mut info.flags, make, |index, info| (*pipelines.add(index), vec![info.stage]))
    }
}

unsafe extern "system" fn create_graphics(
    device: vk::Device,
    _: vk::PipelineCache,
    count: u32,
    infos: *const vk::GraphicsPipelineCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    let table = tables::device(device);
    // SAFETY: as above, and as many stages as each struct says.
    unsafe {
        let infos = std::slice::from_raw_parts(infos, count as usize);
        let create = table.next.fp_v1_0().create_graphics_pipelines;
        let make = |infos: *const _| create(device, NO_CACHE, count, infos, allocator, pipelines);
        captured(
            &table,
            infos,
            |info| &mut info.flags,
            make,
            |index, info| {
                let stages = std::slice::from_raw_parts(info.p_stages, info.stage_count as usize);
                (*pipelines.add(index), stages.to_vec())
            },
        )
    }
}

/// Without a cache every pipeline is compiled.
const NO_CACHE: vk::PipelineCache = vk::PipelineCache::null();

/// Makes pipelines of copies of `infos` that ask for statistics, and writes these. `made`: the pipeline of an index, and
/// its stages.
fn captured<'a, T: Copy>(
    table: &DeviceTable,
    infos: &[T],
    flags: fn(&mut T) -> &mut vk::PipelineCreateFlags,
    make: impl FnOnce(*const T) -> vk::Result,
    made: impl Fn(usize, &T) -> (vk::Pipeline, Vec<vk::PipelineShaderStageCreateInfo<'a>>),
) -> vk::Result {
    let mut infos = infos.to_vec();
    infos.iter_mut().for_each(|info| *flags(info) |= vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR);
    let result = make(infos.as_ptr());
    if result == vk::Result::SUCCESS {
        for (index, info) in infos.iter().enumerate() {
            let (pipeline, stages) = made(index, info);
            // SAFETY: just made, with statistics.
            unsafe { say(table, pipeline, &stages) };
        }
    }
    result
}

/// A line for each executable of a pipeline: the modules in it, and its statistics by the names that the driver gives them.
unsafe fn say(table: &DeviceTable, pipeline: vk::Pipeline, stages: &[vk::PipelineShaderStageCreateInfo<'_>]) {
    let Some(path) = FILE.as_ref() else { return };
    let device = table.next.handle();
    let get = |name: &CStr| {
        // SAFETY: the next layer's function with a name that ends with a zero.
        unsafe { (table.get_device_proc_addr)(device, name.as_ptr()) }.map_or(std::ptr::null(), |f| f as *const c_void)
    };
    let functions = ash::khr::pipeline_executable_properties::DeviceFn::load(get);
    let mut text = String::new();
    // SAFETY: a live pipeline that was made to have statistics; arrays are as long as the driver has said.
    unsafe {
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        let mut count = 0;
        let ask = functions.get_pipeline_executable_properties_khr;
        let mut result = ask(device, &info, &mut count, std::ptr::null_mut());
        let mut executables = vec![vk::PipelineExecutablePropertiesKHR::default(); count as usize];
        if result == vk::Result::SUCCESS {
            result = ask(device, &info, &mut count, executables.as_mut_ptr());
        }
        if result != vk::Result::SUCCESS {
            crate::fail(&format!("the driver does not say what its pipelines are made of ({result:?})"));
        }
        for (index, executable) in executables.iter().enumerate() {
            let info = vk::PipelineExecutableInfoKHR::default().pipeline(pipeline).executable_index(index as u32);
            let mut count = 0;
            let ask = functions.get_pipeline_executable_statistics_khr;
            let mut result = ask(device, &info, &mut count, std::ptr::null_mut());
            let mut statistics = vec![vk::PipelineExecutableStatisticKHR::default(); count as usize];
            if result == vk::Result::SUCCESS {
                result = ask(device, &info, &mut count, statistics.as_mut_ptr());
            }
            if result != vk::Result::SUCCESS {
                crate::fail(&format!("the driver has no statistics of a pipeline ({result:?})"));
            }
            let known = table.known();
            let modules: Vec<&str> = stages
                .iter()
                .filter(|stage| executable.stages.contains(stage.stage))
                .filter_map(|stage| known.modules.get(&stage.module).map(String::as_str))
                .collect();
            let _ = write!(text, "{{\"shader\": {:?}, \"subgroup\": {}", modules.join(" + "), executable.subgroup_size);
            for statistic in &statistics {
                let name = CStr::from_ptr(statistic.name.as_ptr()).to_string_lossy();
                if statistic.format == vk::PipelineExecutableStatisticFormatKHR::UINT64 {
                    let _ = write!(text, ", {name:?}: {}", statistic.value.u64);
                }
            }
            text.push_str("}\n");
        }
    }
    // One write: programs run side by side.
    let written = std::fs::OpenOptions::new()
        .append(true)
        .create(true)
        .open(path)
        .and_then(|mut file| file.write_all(text.as_bytes()));
    if let Err(error) = written {
        crate::fail(&format!("{}: {error}", path.display()));
    }
}
