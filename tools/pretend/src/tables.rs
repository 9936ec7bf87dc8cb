//! The next layer's functions, and what is known of the objects that were made through this one.

use ash::vk;
use ash::vk::Handle;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Functions of an instance.
pub struct InstanceTable {
    pub next: ash::Instance,
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
}

/// Functions of a device.
pub struct DeviceTable {
    pub next: ash::Device,
    pub get_device_proc_addr: vk::PFN_vkGetDeviceProcAddr,
    pub known: Mutex<Known>,
}

/// What was made on a device.
#[derive(Default)]
pub struct Known {
    pub memories: HashMap<vk::DeviceMemory, Memory>,
    pub buffers: HashMap<vk::Buffer, Bound>,
    /// Where they are bound, for who shares bytes with whom.
    pub images: HashMap<vk::Image, Bound>,
    pub formats: HashMap<vk::Image, vk::Format>,
    /// Names that the program gave them.
    pub modules: HashMap<vk::ShaderModule, String>,
}

pub struct Memory {
    /// Index into the types that the program sees.
    pub kind: u32,
    /// Where the program has mapped it.
    pub mapped: Option<usize>,
}

/// A buffer's or an image's bytes in memory.
#[derive(Clone, Copy)]
pub struct Bound {
    pub memory: vk::DeviceMemory,
    pub offset: u64,
    /// What the program asked for, of a buffer; then its tail follows.
    pub asked_bytes: u64,
    /// What it takes.
    pub bytes: u64,
    /// Others lie or lay in the same bytes.
    pub is_shared: bool,
}

static INSTANCES: Mutex<Option<HashMap<usize, Arc<InstanceTable>>>> = Mutex::new(None);
static DEVICES: Mutex<Option<HashMap<usize, Arc<DeviceTable>>>> = Mutex::new(None);

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What handles of one instance, or of one device, begin with: the loader's table.
fn key(handle: impl Handle) -> usize {
    // SAFETY: dispatchable handles point to an object whose first word is the loader's.
    unsafe { *(handle.as_raw() as *const usize) }
}

pub fn add_instance(instance: vk::Instance, table: InstanceTable) {
    held(&INSTANCES).get_or_insert_default().insert(key(instance), Arc::new(table));
}

pub fn add_device(device: vk::Device, table: DeviceTable) {
    held(&DEVICES).get_or_insert_default().insert(key(device), Arc::new(table));
}

/// None for the null instance.
pub fn instance(handle: impl Handle + Copy) -> Option<Arc<InstanceTable>> {
    if handle.as_raw() == 0 {
        return None;
    }
    held(&INSTANCES).as_ref()?.get(&key(handle)).cloned()
}

/// Functions of a physical device's instance.
pub fn of_physical(physical: vk::PhysicalDevice) -> Arc<InstanceTable> {
    instance(physical).unwrap_or_else(|| crate::fail("a physical device of an instance that was not made here"))
}

/// Functions of the device of this device, queue or command buffer.
pub fn device(handle: impl Handle) -> Arc<DeviceTable> {
    let found = held(&DEVICES).as_ref().and_then(|devices| devices.get(&key(handle)).cloned());
    found.unwrap_or_else(|| crate::fail("a device that was not made here"))
}

impl DeviceTable {
    pub fn known(&self) -> MutexGuard<'_, Known> {
        held(&self.known)
    }
}
