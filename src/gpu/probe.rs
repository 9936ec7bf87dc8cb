//! A physical device's answers, looked up once, as `Caps`.

use crate::caps::{
    Caps, ConservativeRules, Features, Formats, Heap, HeapBudget, Identity, Limits, MemoryType, SampleLocationRules,
};
use crate::error::{Error, Result};
use ash::vk;
use std::ffi::CStr;

/// What ray queries need: the second asks for the third.
pub const RAY_QUERY_EXTENSIONS: [&CStr; 3] =
    [ash::khr::ray_query::NAME, ash::khr::acceleration_structure::NAME, ash::khr::deferred_host_operations::NAME];

/// Queue family used here: the first that draws, computes and copies.
pub fn queue_family(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<u32> {
    // SAFETY: a live instance and one of its physical devices.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let needed = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    families.iter().position(|family| family.queue_flags.contains(needed)).map(|index| index as u32)
}

/// What the driver of a device that has VK_EXT_memory_budget says of its heaps now.
pub fn heap_budgets(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Vec<HeapBudget> {
    let mut budget = vk::PhysicalDeviceMemoryBudgetPropertiesEXT::default();
    let mut memory = vk::PhysicalDeviceMemoryProperties2::default().push_next(&mut budget);
    // SAFETY: a live instance and one of its physical devices, which has the extension.
    unsafe { instance.get_physical_device_memory_properties2(physical, &mut memory) };
    let heap_count = memory.memory_properties.memory_heap_count as usize;
    let heaps = budget.heap_budget.into_iter().zip(budget.heap_usage).take(heap_count);
    heaps.map(|(budget_bytes, usage_bytes)| HeapBudget { budget_bytes, usage_bytes }).collect()
}

/// Names of the device's extensions.
pub fn extensions(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Vec<String> {
    // SAFETY: a live instance and one of its physical devices.
    let properties = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
    properties
        .iter()
        .filter_map(|property| property.extension_name_as_c_str().ok())
        .map(|name| name.to_string_lossy().into_owned())
        .collect()
}

/// Extensions that a device of these caps is opened with.
pub fn used_extensions(instance: &ash::Instance, physical: vk::PhysicalDevice, caps: &Caps) -> Vec<&'static CStr> {
    let mut used = Vec::new();
    if caps.features.ray_query {
        used.extend(RAY_QUERY_EXTENSIONS);
    }
    if caps.conservative.is_some() {
        used.push(ash::ext::conservative_rasterization::NAME);
    }
    if caps.features.fragment_shader_barycentric {
        used.push(ash::khr::fragment_shader_barycentric::NAME);
    }
    if caps.sample_locations.is_some() {
        used.push(ash::ext::sample_locations::NAME);
    }
    let there = extensions(instance, physical);
    // A device that has the first wants it enabled; the second is a second look at its clock.
    let further = [ash::khr::portability_subset::NAME, ash::ext::calibrated_timestamps::NAME];
    used.extend(further.into_iter().filter(|name| there.iter().any(|has| name.to_str() == Ok(has.as_str()))));
    used
}

fn formats(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Formats {
    use vk::FormatFeatureFlags as Flags;
    let has = |format, flags| {
        // SAFETY: a live instance and one of its physical devices.
        let properties = unsafe { instance.get_physical_device_format_properties(physical, format) };
        properties.optimal_tiling_features.contains(flags)
    };
    let samples = |format, usage| {
        let (kind, tiling, flags) = (vk::ImageType::TYPE_2D, vk::ImageTiling::OPTIMAL, vk::ImageCreateFlags::empty());
        // SAFETY: as above.
        let found = unsafe {
            instance.get_physical_device_image_format_properties(physical, format, kind, tiling, usage, flags)
        };
        found.map_or(Vec::new(), |properties| counts(properties.sample_counts))
    };
    // As multisampled images are used here: drawn into, and fetched by shaders.
    let color = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED;
    let depth = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED;
    Formats {
        float_depth: has(vk::Format::D32_SFLOAT, Flags::DEPTH_STENCIL_ATTACHMENT | Flags::SAMPLED_IMAGE),
        float_depth_linear: has(vk::Format::D32_SFLOAT, Flags::SAMPLED_IMAGE_FILTER_LINEAR),
        float_depth_with_stencil: has(vk::Format::D32_SFLOAT_S8_UINT, Flags::DEPTH_STENCIL_ATTACHMENT),
        float_color_blend: has(vk::Format::R32G32B32A32_SFLOAT, Flags::COLOR_ATTACHMENT_BLEND),
        fixed_pair_color: has(vk::Format::R16G16_UNORM, Flags::COLOR_ATTACHMENT),
        fixed_pair_blend: has(vk::Format::R16G16_UNORM, Flags::COLOR_ATTACHMENT_BLEND),
        fixed_quad_sampled: has(vk::Format::R16G16B16A16_UNORM, Flags::SAMPLED_IMAGE),
        float_color_sample_counts: samples(vk::Format::R32G32B32A32_SFLOAT, color),
        half_color_sample_counts: samples(vk::Format::R16G16B16A16_SFLOAT, color),
        float_depth_sample_counts: samples(vk::Format::D32_SFLOAT, depth),
    }
}

/// The numbers of samples a pixel in a set of flags, rising.
fn counts(flags: vk::SampleCountFlags) -> Vec<u32> {
    (0..7).map(|bit| 1 << bit).filter(|count| flags.as_raw() & count != 0).collect()
}

fn conservative(instance: &ash::Instance, physical: vk::PhysicalDevice) -> ConservativeRules {
    let mut conservative = vk::PhysicalDeviceConservativeRasterizationPropertiesEXT::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut conservative);
    // SAFETY: a live instance and one of its physical devices, which has the extension of the chained struct.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    ConservativeRules {
        overestimation_px: conservative.primitive_overestimation_size,
        most_extra_px: conservative.max_extra_primitive_overestimation_size,
        extra_step_px: conservative.extra_primitive_overestimation_size_granularity,
        draws_degenerate_triangles: conservative.degenerate_triangles_rasterized != 0,
    }
}

fn sample_locations(instance: &ash::Instance, physical: vk::PhysicalDevice) -> SampleLocationRules {
    let mut locations = vk::PhysicalDeviceSampleLocationsPropertiesEXT::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut locations);
    // SAFETY: a live instance and one of its physical devices, which has the extension of the chained struct.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    SampleLocationRules {
        sample_counts: counts(locations.sample_location_sample_counts),
        sub_pixel_bits: locations.sample_location_sub_pixel_bits,
        range_px: locations.sample_location_coordinate_range,
    }
}

/// Everything that `Caps` holds.
pub fn caps(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Caps {
    let mut vulkan12 = vk::PhysicalDeviceVulkan12Properties::default();
    let mut subgroup = vk::PhysicalDeviceSubgroupProperties::default();
    let mut maintenance3 = vk::PhysicalDeviceMaintenance3Properties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default()
        .push_next(&mut vulkan12)
        .push_next(&mut subgroup)
        .push_next(&mut maintenance3);
    // SAFETY: a live instance and one of its physical devices; the chained structs outlive the call.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    let core = properties.properties;
    let mut features12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut structures = vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default();
    let mut ray_queries = vk::PhysicalDeviceRayQueryFeaturesKHR::default();
    let mut barycentrics = vk::PhysicalDeviceFragmentShaderBarycentricFeaturesKHR::default();
    let mut features2 = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut features12)
        .push_next(&mut structures)
        .push_next(&mut ray_queries)
        .push_next(&mut barycentrics);
    // SAFETY: as above.
    unsafe { instance.get_physical_device_features2(physical, &mut features2) };
    let features = features2.features;
    // SAFETY: as above.
    let memory = unsafe { instance.get_physical_device_memory_properties(physical) };
    let extensions = extensions(instance, physical);
    let has = |name: &str| extensions.iter().any(|extension| extension == name);
    let limits = core.limits;
    let version = core.api_version;
    let text = |name: Result<&CStr, std::ffi::FromBytesUntilNulError>| {
        name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    };
    // A queue family that writes no timestamps says so with zero valid bits.
    // SAFETY: as above.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let timestamp_bits =
        queue_family(instance, physical).map_or(0, |family| families[family as usize].timestamp_valid_bits);
    Caps {
        identity: Identity {
            name: text(core.device_name_as_c_str()),
            device_type: match core.device_type {
                vk::PhysicalDeviceType::CPU => "cpu",
                vk::PhysicalDeviceType::DISCRETE_GPU => "discrete-gpu",
                vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated-gpu",
                vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual-gpu",
                _ => "other",
            }
            .to_owned(),
            driver: text(vulkan12.driver_name_as_c_str()),
            driver_info: text(vulkan12.driver_info_as_c_str()),
            api: format!(
                "{}.{}.{}",
                vk::api_version_major(version),
                vk::api_version_minor(version),
                vk::api_version_patch(version)
            ),
        },
        limits: Limits {
            max_image_side_px: limits.max_image_dimension2_d,
            max_viewport_px: limits.max_viewport_dimensions,
            max_framebuffer_px: [limits.max_framebuffer_width, limits.max_framebuffer_height],
            max_image_layers: limits.max_image_array_layers,
            max_volume_side_px: limits.max_image_dimension3_d,
            max_storage_buffer_range_bytes: u64::from(limits.max_storage_buffer_range),
            max_uniform_buffer_range_bytes: u64::from(limits.max_uniform_buffer_range),
            max_push_constant_bytes: limits.max_push_constants_size,
            max_workgroup_invocations: limits.max_compute_work_group_invocations,
            max_workgroup_size: limits.max_compute_work_group_size,
            max_workgroup_count: limits.max_compute_work_group_count,
            max_shared_memory_bytes: limits.max_compute_shared_memory_size,
            max_sampled_images_per_stage: limits.max_per_stage_descriptor_sampled_images,
            max_storage_buffers_per_stage: limits.max_per_stage_descriptor_storage_buffers,
            max_storage_images_per_stage: limits.max_per_stage_descriptor_storage_images,
            max_bound_descriptor_sets: limits.max_bound_descriptor_sets,
            max_color_attachments: limits.max_color_attachments,
            max_allocation_count: limits.max_memory_allocation_count,
            max_allocation_bytes: maintenance3.max_memory_allocation_size,
            buffer_image_granularity_bytes: limits.buffer_image_granularity,
            non_coherent_atom_bytes: limits.non_coherent_atom_size,
            min_storage_buffer_offset_bytes: limits.min_storage_buffer_offset_alignment,
            max_sampler_anisotropy: limits.max_sampler_anisotropy,
            sub_pixel_bits: limits.sub_pixel_precision_bits,
            max_framebuffer_layers: limits.max_framebuffer_layers,
            max_geometry_vertices: limits.max_geometry_output_vertices,
            max_geometry_components: limits.max_geometry_total_output_components,
            subgroup_size: subgroup.subgroup_size,
            timestamp_period_ns: if timestamp_bits == 0 { 0.0 } else { limits.timestamp_period },
            timestamp_bits,
            framebuffer_sample_counts: counts(limits.framebuffer_color_sample_counts),
        },
        features: Features {
            geometry_shader: features.geometry_shader != 0,
            layer_from_vertex_shader: features12.shader_output_layer != 0,
            fragment_stores_and_atomics: features.fragment_stores_and_atomics != 0,
            depth_clamp: features.depth_clamp != 0,
            occlusion_query_precise: features.occlusion_query_precise != 0,
            sample_rate_shading: features.sample_rate_shading != 0,
            fragment_shader_barycentric: has("VK_KHR_fragment_shader_barycentric")
                && barycentrics.fragment_shader_barycentric != 0,
            sampler_anisotropy: features.sampler_anisotropy != 0,
            storage_image_extended_formats: features.shader_storage_image_extended_formats != 0,
            shader_float16: features12.shader_float16 != 0,
            shader_int64_atomics: features.shader_int64 != 0 && features12.shader_buffer_int64_atomics != 0,
            pipeline_statistics: features.pipeline_statistics_query != 0,
            ray_query: RAY_QUERY_EXTENSIONS.iter().all(|name| has(&name.to_string_lossy()))
                && ray_queries.ray_query != 0
                && structures.acceleration_structure != 0
                && features12.buffer_device_address != 0,
            memory_budget: has("VK_EXT_memory_budget"),
        },
        formats: formats(instance, physical),
        conservative: has("VK_EXT_conservative_rasterization").then(|| conservative(instance, physical)),
        sample_locations: has("VK_EXT_sample_locations").then(|| sample_locations(instance, physical)),
        heaps: memory
            .memory_heaps_as_slice()
            .iter()
            .map(|heap| Heap { bytes: heap.size, device_local: heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL) })
            .collect(),
        memory_types: memory
            .memory_types_as_slice()
            .iter()
            .map(|kind| MemoryType {
                heap: kind.heap_index,
                device_local: kind.property_flags.contains(vk::MemoryPropertyFlags::DEVICE_LOCAL),
                host_visible: kind.property_flags.contains(vk::MemoryPropertyFlags::HOST_VISIBLE),
                host_coherent: kind.property_flags.contains(vk::MemoryPropertyFlags::HOST_COHERENT),
                host_cached: kind.property_flags.contains(vk::MemoryPropertyFlags::HOST_CACHED),
                lazily_allocated: kind.property_flags.contains(vk::MemoryPropertyFlags::LAZILY_ALLOCATED),
            })
            .collect(),
        layout: None,
    }
}

/// Errors: shaders of a stage cannot write what they count (exit code 3).
pub fn require_counting(instance: &ash::Instance, physical: vk::PhysicalDevice, caps: &Caps) -> Result<()> {
    // SAFETY: a live instance and one of its physical devices.
    let features = unsafe { instance.get_physical_device_features(physical) };
    let wanted = [
        (features.fragment_stores_and_atomics, "fragmentStoresAndAtomics"),
        (features.vertex_pipeline_stores_and_atomics, "vertexPipelineStoresAndAtomics"),
    ];
    match wanted.into_iter().find(|(present, _)| *present == 0) {
        Some((_, name)) => {
            let why = format!("--touched: {} lacks {name}, by which shaders count", caps.identity.name);
            Err(Error::no_device(why).note("--device takes another one; `quincunx devices` lists them"))
        }
        None => Ok(()),
    }
}
