//! Instance, choice of device, queue, enabled features; and what every other file of this room needs of them.

use super::calibration::Calibration;
use super::marks::Marks;
use super::pipeline_store::PipelineStore;
use super::request::DeviceRequest;
use super::{probe, validation};
use crate::caps::{Caps, HeapBudget, Identity};
use crate::error::{Error, Result};
use crate::memory::pool::Rules;
use crate::memory::{Memory, Tiling};
use ash::vk;
use std::ffi::{CStr, CString, c_char, c_void};
use std::sync::{Arc, Mutex};

/// Vulkan version that this program is written for.
pub const API: u32 = vk::API_VERSION_1_3;

const PORTABILITY_ENUMERATION: &CStr = ash::khr::portability_enumeration::NAME;

/// An open device with one queue, its memory and its validation log.
pub struct Gpu {
    pub caps: Caps,
    pub device: ash::Device,
    pub queue: vk::Queue,
    pub queue_family: u32,
    /// `DeviceRequest::robust`.
    pub is_robust: bool,
    /// `DeviceRequest::image_tiling`.
    pub image_tiling: Tiling,
    pub memory: Arc<Memory>,
    /// What frames touch; None without `DeviceRequest::touched`.
    pub marks: Option<Arc<Marks>>,
    /// Pipelines that were made before: a second renderer of the same settings compiles nothing.
    pub(super) pipelines: PipelineStore,
    names: Option<ash::ext::debug_utils::Device>,
    /// None: the device has no ray queries.
    structures: Option<ash::khr::acceleration_structure::Device>,
    /// None: its clock cannot be read beside the host's.
    calibration: Option<Calibration>,
    validation: Option<Validation>,
    pub(super) instance: ash::Instance,
    physical: vk::PhysicalDevice,
    /// Serialises submits: a queue is externally synchronised.
    pub(super) submit_lock: Mutex<()>,
    // The loaded library stays as long as anything that came from it.
    _entry: ash::Entry,
}

/// The layer's messenger, which collects messages while it lives. To be dropped before the instance.
struct Validation {
    functions: ash::ext::debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    log: Arc<validation::Log>,
}

impl Validation {
    fn listen(entry: &ash::Entry, instance: &ash::Instance, log: Arc<validation::Log>) -> Result<Self> {
        let functions = ash::ext::debug_utils::Instance::new(entry, instance);
        // SAFETY: the log lives in the same struct as the messenger and is dropped after it.
        let messenger = unsafe { functions.create_debug_utils_messenger(&log.messenger_info(), None) }
            .map_err(|result| Error::device(format!("creating the validation messenger: {result}")))?;
        Ok(Self { functions, messenger, log })
    }
}

impl Drop for Validation {
    fn drop(&mut self) {
        // SAFETY: the instance is alive, and nobody else knows the messenger.
        unsafe { self.functions.destroy_debug_utils_messenger(self.messenger, None) };
    }
}

/// A device that `devices` lists.
pub struct ListedDevice {
    pub caps: Caps,
    /// Why it cannot be used; empty where it can.
    pub missing: Vec<String>,
}

fn load_entry() -> Result<ash::Entry> {
    // SAFETY: loading the system's Vulkan loader runs its initialisers; there is no way to check a library beforehand.
    unsafe { ash::Entry::load() }.map_err(|error| {
        Error::no_device(format!("no Vulkan loader: {error}"))
            .note("Debian and Ubuntu: apt-get install libvulkan1 mesa-vulkan-drivers")
    })
}

fn create_instance(entry: &ash::Entry, validate: Option<&validation::Log>) -> Result<(ash::Instance, bool)> {
    // SAFETY: the entry is loaded; enumerating has no preconditions.
    let version = unsafe { entry.try_enumerate_instance_version() }.ok().flatten().unwrap_or(vk::API_VERSION_1_0);
    if version < API {
        return Err(Error::no_device(format!(
            "the Vulkan loader supports {}.{}; 1.3 is needed",
            vk::api_version_major(version),
            vk::api_version_minor(version)
        )));
    }
    // SAFETY: as above.
    let available = unsafe { entry.enumerate_instance_extension_properties(None) }.unwrap_or_default();
    let has_names = available.iter().any(|e| e.extension_name_as_c_str() == Ok(ash::ext::debug_utils::NAME));
    let application = vk::ApplicationInfo::default().application_name(c"quincunx").api_version(API);
    let mut extensions: Vec<*const c_char> = Vec::new();
    if has_names {
        extensions.push(ash::ext::debug_utils::NAME.as_ptr());
    }
    // Without being asked so, loaders hide drivers that stand on another interface, as MoltenVK does.
    let has_portability = available.iter().any(|e| e.extension_name_as_c_str() == Ok(PORTABILITY_ENUMERATION));
    let mut flags = vk::InstanceCreateFlags::empty();
    if has_portability {
        extensions.push(PORTABILITY_ENUMERATION.as_ptr());
        flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
    }
    let layers = [validation::LAYER.as_ptr()];
    let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enables);
    let mut messenger = validate.map(validation::Log::messenger_info);
    let mut info = vk::InstanceCreateInfo::default().application_info(&application).flags(flags);
    if validate.is_some() {
        // SAFETY: as above.
        let present = unsafe { entry.enumerate_instance_layer_properties() }.unwrap_or_default();
        if !present.iter().any(|layer| layer.layer_name_as_c_str() == Ok(validation::LAYER)) {
            return Err(Error::request("--validate: the layer VK_LAYER_KHRONOS_validation is not installed")
                .note("Debian and Ubuntu: apt-get install vulkan-validationlayers"));
        }
        info = info.enabled_layer_names(&layers).push_next(&mut features);
        if let Some(messenger) = messenger.as_mut() {
            info = info.push_next(messenger);
        }
    }
    info = info.enabled_extension_names(&extensions);
    // SAFETY: every pointer in `info` outlives the call.
    let instance = unsafe { entry.create_instance(&info, None) }.map_err(no_driver)?;
    Ok((instance, has_names))
}

fn no_driver(result: vk::Result) -> Error {
    let mut error = Error::no_device(format!("no Vulkan driver answers ({result})"));
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(value) = std::env::var_os(variable) {
            error = error.note(format!("{variable} is set to {}", value.to_string_lossy()));
        }
    }
    error.note("a software driver for any machine: apt-get install mesa-vulkan-drivers (Debian, Ubuntu)")
}

fn physical_devices(instance: &ash::Instance) -> Result<Vec<vk::PhysicalDevice>> {
    // SAFETY: a live instance.
    let devices = unsafe { instance.enumerate_physical_devices() }.map_err(no_driver)?;
    if devices.is_empty() {
        return Err(no_driver(vk::Result::ERROR_INITIALIZATION_FAILED));
    }
    Ok(devices)
}

/// What a device lacks of what this program cannot do without.
fn missing(instance: &ash::Instance, physical: vk::PhysicalDevice, caps: &Caps) -> Vec<String> {
    // SAFETY: a live instance and one of its physical devices.
    let version = unsafe { instance.get_physical_device_properties(physical) }.api_version;
    if version < API {
        return vec![format!("it speaks Vulkan {}, 1.3 is needed", caps.identity.api)];
    }
    let mut features13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut features13);
    // SAFETY: as above; 1.3 knows the chained struct.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    let mut missing = Vec::new();
    for (present, name) in [
        (features13.dynamic_rendering, "dynamicRendering"),
        (features13.synchronization2, "synchronization2"),
        (features13.maintenance4, "maintenance4"),
        (features13.shader_demote_to_helper_invocation, "shaderDemoteToHelperInvocation"),
    ] {
        if present == 0 {
            missing.push(format!("feature {name}"));
        }
    }
    if probe::queue_family(instance, physical).is_none() {
        missing.push("a queue that draws and computes".to_owned());
    }
    missing
}

/// Every device of every driver, with what it lacks.
pub fn list() -> Result<Vec<ListedDevice>> {
    let entry = load_entry()?;
    let (instance, _) = create_instance(&entry, None)?;
    let listed = physical_devices(&instance).map(|devices| {
        devices
            .into_iter()
            .map(|physical| {
                let caps = probe::caps(&instance, physical);
                let missing = missing(&instance, physical, &caps);
                ListedDevice { caps, missing }
            })
            .collect()
    });
    // SAFETY: nothing made from the instance is alive.
    unsafe { instance.destroy_instance(None) };
    listed
}

fn choose(instance: &ash::Instance, request: &DeviceRequest) -> Result<(vk::PhysicalDevice, Caps)> {
    let selector = request.selector.as_deref();
    let said = |physical| {
        let mut caps = probe::caps(instance, physical);
        request.pretense.inspect(|pretend| pretend(&mut caps));
        caps
    };
    let all: Vec<(usize, vk::PhysicalDevice, Caps)> = physical_devices(instance)?
        .into_iter()
        .enumerate()
        .map(|(index, physical)| (index, physical, said(physical)))
        .collect();
    let named = |(index, _, caps): &&(usize, _, Caps)| caps.identity.is_named(selector, *index);
    let mut fitting: Vec<_> = all.iter().filter(named).collect();
    fitting.sort_by_key(|(_, _, caps)| caps.identity.preference());
    let usable = fitting.iter().find(|(_, physical, caps)| missing(instance, *physical, caps).is_empty());
    if let Some((_, physical, caps)) = usable {
        return Ok((*physical, caps.clone()));
    }
    let lacking: Vec<_> =
        all.iter().map(|(_, physical, caps)| (&caps.identity, missing(instance, *physical, caps))).collect();
    Err(unfit(selector, &lacking))
}

/// The error where no device that `selector` names can be used. `all`: each with what it lacks, by index.
fn unfit(selector: Option<&str>, all: &[(&Identity, Vec<String>)]) -> Error {
    let has_named = all.iter().enumerate().any(|(index, (identity, _))| identity.is_named(selector, index));
    let error = Error::no_device(match selector {
        None => "no device can be used".to_owned(),
        Some(text) if has_named => format!("--device {text}: it cannot be used"),
        Some(text) if text.parse::<usize>().is_ok() => format!("--device {text}: no device has this index"),
        Some(text) => format!("--device {text}: no device's name or driver contains '{text}'"),
    });
    all.iter().enumerate().fold(error.note("there are:"), |error, (index, (identity, lacks))| {
        let verdict = if lacks.is_empty() { String::new() } else { format!(", which lacks {}", lacks.join(", ")) };
        error.note(format!("{index}: {} ({}){verdict}", identity.name, identity.driver_text()))
    })
}

impl Gpu {
    /// Opens the device that `request` names.
    ///
    /// Errors: no loader, driver or fitting device (exit code 3); the validation layer is missing (2).
    pub fn open(request: &DeviceRequest) -> Result<Arc<Self>> {
        let entry = load_entry()?;
        let log = request.validate.then(|| Arc::new(validation::Log::default()));
        let (instance, has_names) = create_instance(&entry, log.as_deref())?;
        // A clone, because the last entry to go unloads the library, and with it the function that destroys the instance.
        let opened = Self::open_on(entry.clone(), instance.clone(), has_names, log, request);
        if opened.is_err() {
            // SAFETY: `open_on` destroys what it made before it fails; `entry` still holds the library.
            unsafe { instance.destroy_instance(None) };
        }
        opened.map(Arc::new)
    }

    fn open_on(
        entry: ash::Entry,
        instance: ash::Instance,
        has_names: bool,
        log: Option<Arc<validation::Log>>,
        request: &DeviceRequest,
    ) -> Result<Self> {
        // First, for what is said while a device is opened.
        let validation = log.map(|log| Validation::listen(&entry, &instance, log)).transpose()?;
        let (physical, caps) = choose(&instance, request)?;
        let granule_bytes = request.touched.granule_bytes();
        granule_bytes.map_or(Ok(()), |_| probe::require_counting(&instance, physical, &caps))?;
        let queue_family = probe::queue_family(&instance, physical).expect("`choose` asked for it");
        let priorities = [1.0];
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&priorities)];
        let mut features13 = vk::PhysicalDeviceVulkan13Features::default()
            .dynamic_rendering(true)
            .synchronization2(true)
            .maintenance4(true)
            // What glslang makes of `discard`.
            .shader_demote_to_helper_invocation(true);
        let features = vk::PhysicalDeviceFeatures::default()
            // Every device has it.
            .robust_buffer_access(request.robust)
            .sampler_anisotropy(caps.features.sampler_anisotropy)
            .shader_storage_image_extended_formats(caps.features.storage_image_extended_formats)
            .fragment_stores_and_atomics(caps.features.fragment_stores_and_atomics)
            .vertex_pipeline_stores_and_atomics(granule_bytes.is_some())
            .depth_clamp(caps.features.depth_clamp)
            .occlusion_query_precise(caps.features.occlusion_query_precise)
            .sample_rate_shading(caps.features.sample_rate_shading)
            .pipeline_statistics_query(caps.features.pipeline_statistics)
            .geometry_shader(caps.features.geometry_shader)
            .shader_int64(caps.features.shader_int64_atomics);
        let mut features12 = vk::PhysicalDeviceVulkan12Features::default()
            // Every device of Vulkan 1.3 has it.
            .buffer_device_address(true)
            .shader_output_layer(caps.features.layer_from_vertex_shader)
            .shader_buffer_int64_atomics(caps.features.shader_int64_atomics);
        let mut structures = vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default().acceleration_structure(true);
        let mut ray_queries = vk::PhysicalDeviceRayQueryFeaturesKHR::default().ray_query(true);
        let mut barycentrics =
            vk::PhysicalDeviceFragmentShaderBarycentricFeaturesKHR::default().fragment_shader_barycentric(true);
        let extension_names = probe::used_extensions(&instance, physical, &caps);
        let extensions: Vec<*const c_char> = extension_names.iter().map(|name| name.as_ptr()).collect();
        let mut info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&features)
            .enabled_extension_names(&extensions)
            .push_next(&mut features12)
            .push_next(&mut features13);
        if caps.features.ray_query {
            info = info.push_next(&mut structures).push_next(&mut ray_queries);
        }
        if caps.features.fragment_shader_barycentric {
            info = info.push_next(&mut barycentrics);
        }
        // SAFETY: every pointer in `info` outlives the call; the features were found present.
        let created = unsafe { instance.create_device(physical, &info, None) };
        let mut device =
            created.map_err(|result| Error::device(format!("opening {}: {result}", caps.identity.name)))?;
        if let Some(hook) = request.hook {
            let get = instance.fp_v1_0().get_device_proc_addr;
            let handle = device.handle();
            // SAFETY: the same device, its functions passed through the hook, which keeps their signatures.
            device = unsafe {
                ash::Device::load_with(
                    |name| {
                        let own = get(handle, name.as_ptr()).map_or(std::ptr::null(), |f| f as *const c_void);
                        hook(name, own)
                    },
                    handle,
                )
            };
        }
        // SAFETY: the family and index were asked for above.
        let queue = unsafe { device.get_device_queue(queue_family, 0) };
        let names = has_names.then(|| ash::ext::debug_utils::Device::new(&instance, &device));
        let structures = caps.features.ray_query;
        let structures = structures.then(|| ash::khr::acceleration_structure::Device::new(&instance, &device));
        let has_both_clocks = extension_names.contains(&ash::ext::calibrated_timestamps::NAME);
        let calibration = has_both_clocks.then(|| Calibration::of(&entry, &instance, physical, &device)).flatten();
        let rules = Rules::new(&caps, request.strategy, request.budget_bytes, request.block_bytes);
        let memory = Arc::new(Memory::new(device.clone(), names.clone(), &caps, rules, request.recorder.clone()));
        let marks = granule_bytes.map(|bytes| Marks::new(&device, &memory, bytes)).transpose();
        // SAFETY: nothing else holds the device yet.
        let marks = marks.inspect_err(|_| unsafe { device.destroy_device(None) })?;
        Ok(Self {
            caps,
            device,
            queue,
            queue_family,
            is_robust: request.robust,
            image_tiling: request.image_tiling,
            memory,
            marks: marks.map(Arc::new),
            pipelines: PipelineStore::default(),
            names,
            structures,
            calibration,
            validation,
            instance,
            physical,
            submit_lock: Mutex::new(()),
            _entry: entry,
        })
    }

    /// Gives an object the name that tools and validation messages show.
    pub fn name<H: vk::Handle>(&self, handle: H, name: &str) {
        let (Some(names), Ok(text)) = (&self.names, CString::new(name)) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&text);
        // SAFETY: the handle is alive and belongs to this device. A refused name costs nothing but the name.
        let _ = unsafe { names.set_debug_utils_object_name(&info) };
    }

    /// Functions of acceleration structures. Panics where the device has no ray queries: their need is checked before.
    pub(super) fn structures(&self) -> &ash::khr::acceleration_structure::Device {
        self.structures.as_ref().expect("a device without ray queries is refused before")
    }

    /// The device's clock beside the host's; None where the device does not say both at once.
    pub fn calibration(&self) -> Option<&Calibration> {
        self.calibration.as_ref()
    }

    /// Opens (Some) or closes (None) a labelled section of a command buffer.
    pub(super) fn label(&self, buffer: vk::CommandBuffer, name: Option<&str>) {
        let Some(names) = &self.names else { return };
        match name.and_then(|name| CString::new(name).ok()) {
            // SAFETY: the command buffer is being recorded by the caller; labels are opened and closed in pairs.
            Some(text) => unsafe {
                names.cmd_begin_debug_utils_label(buffer, &vk::DebugUtilsLabelEXT::default().label_name(&text));
            },
            // SAFETY: as above.
            None => unsafe { names.cmd_end_debug_utils_label(buffer) },
        }
    }

    /// What it was opened from, for allocators of others.
    #[cfg(feature = "rivals")]
    pub fn chosen(&self) -> (&ash::Instance, vk::PhysicalDevice) {
        (&self.instance, self.physical)
    }

    /// What the driver itself says of its heaps now; None: it says nothing (VK_EXT_memory_budget).
    pub fn heap_budgets(&self) -> Option<Vec<HeapBudget>> {
        self.caps.features.memory_budget.then(|| probe::heap_budgets(&self.instance, self.physical))
    }

    /// The log that outlives the device, for what is said while it closes; None without `validate`.
    pub fn validation_log(&self) -> Option<Arc<validation::Log>> {
        self.validation.as_ref().map(|validation| validation.log.clone())
    }

    /// Whether the driver does with linear images of a format all that it does with optimal ones.
    pub(super) fn is_as_able_linear(&self, format: vk::Format) -> bool {
        // SAFETY: as in `image_properties`.
        let able = unsafe { self.instance.get_physical_device_format_properties(self.physical, format) };
        able.linear_tiling_features.contains(able.optimal_tiling_features)
    }

    /// What the driver makes of such an image at most; None: it makes none.
    pub(super) fn image_properties(&self, info: &vk::ImageCreateInfo<'_>) -> Option<vk::ImageFormatProperties> {
        // SAFETY: a live instance and the physical device that this device was made from.
        let properties = unsafe {
            self.instance.get_physical_device_image_format_properties(
                self.physical,
                info.format,
                info.image_type,
                info.tiling,
                info.usage,
                info.flags,
            )
        };
        properties.ok()
    }

    /// What the validation layer has said since the last call; empty without `validate`.
    pub fn take_validation_messages(&self) -> Vec<validation::Message> {
        self.validation.as_ref().map(|validation| validation.log.take()).unwrap_or_default()
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: resources hold this struct alive, so none is left; the order is the reverse of creation.
        unsafe {
            // A lost device cannot be waited for, and need not be.
            let _ = self.device.device_wait_idle();
            self.marks.iter().for_each(|marks| marks.close());
            self.memory.close();
            self.pipelines.close(&self.device);
            self.device.destroy_device(None);
            drop(self.validation.take());
            self.instance.destroy_instance(None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(name: &str, driver_info: &str) -> Identity {
        let text = str::to_owned;
        Identity {
            name: text(name),
            device_type: text("cpu"),
            driver: text("llvmpipe"),
            driver_info: text(driver_info),
            api: text("1.3.230"),
        }
    }

    #[test]
    fn an_unfit_device_is_answered_with_what_was_asked_for() {
        let (lava, swift) = (identity("llvmpipe (LLVM 15)", "Mesa 22.3.6"), identity("SwiftShader Device", ""));
        let all = [(&lava, Vec::new()), (&swift, vec!["feature maintenance4".to_owned()])];
        let list = "\n       there are:\n       0: llvmpipe (LLVM 15) (Mesa 22.3.6)\
                    \n       1: SwiftShader Device (llvmpipe), which lacks feature maintenance4";
        for (selector, first) in [
            (Some("nvidia"), "--device nvidia: no device's name or driver contains 'nvidia'"),
            (Some("2"), "--device 2: no device has this index"),
            (Some("swift"), "--device swift: it cannot be used"),
            (Some("1"), "--device 1: it cannot be used"),
            (None, "no device can be used"),
        ] {
            let error = unfit(selector, &all);
            assert_eq!((error.exit_code(), error.to_string()), (3, format!("{first}{list}")));
        }
        for (selector, named) in [("LLVMPIPE", [true, false]), ("22.3", [true, false]), ("1", [false, true])] {
            let found = [(0, &lava), (1, &swift)].map(|(index, identity)| identity.is_named(Some(selector), index));
            assert_eq!(found, named, "{selector}");
        }
    }
}
