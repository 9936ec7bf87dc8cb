//! A counter around vkAllocateMemory and vkFreeMemory, which can also refuse.

use super::watched::{Watched, watched_device};
use ash::vk;
use ash::vk::Handle;
use quincunx::gpu::DeviceRequest;
use quincunx::memory::Strategy;
use quincunx::scene;
use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};
use std::mem::transmute;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What went past the hook. A hook is a plain function, so there is one counter in the process, and one test at a time.
pub struct Counter {
    allocate: Option<vk::PFN_vkAllocateMemory>,
    free: Option<vk::PFN_vkFreeMemory>,
    /// Bytes of each live allocation, by its handle.
    pub live: BTreeMap<u64, u64>,
    pub bytes_ever: u64,
    /// Greatest sum of live allocations.
    pub most_bytes: u64,
    /// Allocations still to come before one is refused; None: none is.
    pub until_refusal: Option<u32>,
}

impl Counter {
    pub const NEW: Self =
        Self { allocate: None, free: None, live: BTreeMap::new(), bytes_ever: 0, most_bytes: 0, until_refusal: None };

    /// Whether this allocation is the one to refuse.
    fn refuses(&mut self) -> bool {
        let refused = self.until_refusal == Some(0);
        self.until_refusal = self.until_refusal.and_then(|count| count.checked_sub(1));
        refused
    }
}

static COUNTER: Mutex<Counter> = Mutex::new(Counter::NEW);
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

pub fn counter() -> MutexGuard<'static, Counter> {
    COUNTER.lock().unwrap_or_else(PoisonError::into_inner)
}

pub fn live_bytes() -> u64 {
    counter().live.values().sum()
}

unsafe extern "system" fn counted_allocate(
    device: vk::Device,
    info: *const vk::MemoryAllocateInfo<'_>,
    callbacks: *const vk::AllocationCallbacks<'_>,
    memory: *mut vk::DeviceMemory,
) -> vk::Result {
    if counter().refuses() {
        return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
    }
    let allocate = counter().allocate.expect("the hook stored it");
    // SAFETY: the driver's own function with the caller's arguments.
    let result = unsafe { allocate(device, info, callbacks, memory) };
    if result == vk::Result::SUCCESS {
        // SAFETY: both pointers are valid in a call that succeeded.
        let (bytes, handle) = unsafe { ((*info).allocation_size, (*memory).as_raw()) };
        let mut counter = counter();
        counter.bytes_ever += bytes;
        assert!(counter.live.insert(handle, bytes).is_none(), "a live handle was given out again");
        counter.most_bytes = counter.most_bytes.max(counter.live.values().sum());
    }
    result
}

unsafe extern "system" fn counted_free(
    device: vk::Device,
    memory: vk::DeviceMemory,
    callbacks: *const vk::AllocationCallbacks<'_>,
) {
    let free = counter().free.expect("the hook stored it");
    if memory != vk::DeviceMemory::null() {
        assert!(counter().live.remove(&memory.as_raw()).is_some(), "freed what was not allocated");
    }
    // SAFETY: the driver's own function with the caller's arguments.
    unsafe { free(device, memory, callbacks) };
}

pub fn hook(name: &CStr, own: *const c_void) -> *const c_void {
    if own.is_null() {
        return own;
    }
    let mut counter = counter();
    match name.to_bytes() {
        b"vkAllocateMemory" => {
            // SAFETY: the pointer is the function of that name.
            counter.allocate = Some(unsafe { transmute::<*const c_void, vk::PFN_vkAllocateMemory>(own) });
            counted_allocate as vk::PFN_vkAllocateMemory as *const c_void
        }
        b"vkFreeMemory" => {
            // SAFETY: as above.
            counter.free = Some(unsafe { transmute::<*const c_void, vk::PFN_vkFreeMemory>(own) });
            counted_free as vk::PFN_vkFreeMemory as *const c_void
        }
        _ => own,
    }
}

/// Waits until no other test counts, and begins at nothing.
pub fn begin() -> MutexGuard<'static, ()> {
    let one = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    *counter() = Counter::NEW;
    one
}

/// A watched device with the counter between.
pub fn counted_device(strategy: Strategy) -> DeviceRequest {
    DeviceRequest { strategy, hook: Some(hook), ..watched_device() }
}

/// Runs `test` on a counted device and requires that everything is given back at its end.
pub fn counted(strategy: Strategy, spec: &str, test: impl FnOnce(&Watched)) {
    let _one = begin();
    let request = counted_device(strategy);
    let watched = Watched::with_request(&request, scene::load(spec, 1).unwrap());
    test(&watched);
    drop(watched);
    assert_eq!(live_bytes(), 0, "bytes that nobody gave back");
    assert!(counter().bytes_ever > 0, "the hook saw nothing");
}
