//! A device whose n-th submit or wait fails: a gate before the driver's own functions. What goes past the gate is counted
//! by `counted`.

use super::counted;
use super::watched::watched_device;
use ash::vk;
use quincunx::gpu::DeviceRequest;
use std::ffi::{CStr, c_void};
use std::mem::transmute;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A call that can fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Call {
    Submit,
    Wait,
}

/// What fails: the call, how many of its kind go well before it, and how.
#[derive(Clone, Copy, Debug)]
pub struct Failure {
    pub call: Call,
    pub after: u32,
    pub result: vk::Result,
}

/// As for `counted::Counter`: one in the process.
struct Gate {
    submit: Option<vk::PFN_vkQueueSubmit2>,
    wait: Option<vk::PFN_vkWaitForFences>,
    planned: Option<Failure>,
    submit_count: u32,
    wait_count: u32,
    has_failed: bool,
}

impl Gate {
    const OPEN: Self =
        Self { submit: None, wait: None, planned: None, submit_count: 0, wait_count: 0, has_failed: false };

    /// Counts a call; the result with which it fails, where it is the one. A lost device stays lost.
    fn pass(&mut self, call: Call) -> Option<vk::Result> {
        let count = if call == Call::Submit { &mut self.submit_count } else { &mut self.wait_count };
        let index = *count;
        *count += 1;
        let failure = self.planned?;
        let is_lost = self.has_failed && failure.result == vk::Result::ERROR_DEVICE_LOST;
        let is_it = failure.call == call && failure.after == index;
        self.has_failed |= is_it;
        (is_it || is_lost).then_some(failure.result)
    }
}

static GATE: Mutex<Gate> = Mutex::new(Gate::OPEN);

fn gate() -> MutexGuard<'static, Gate> {
    GATE.lock().unwrap_or_else(PoisonError::into_inner)
}

unsafe extern "system" fn gated_submit(
    queue: vk::Queue,
    count: u32,
    submits: *const vk::SubmitInfo2<'_>,
    fence: vk::Fence,
) -> vk::Result {
    if let Some(result) = gate().pass(Call::Submit) {
        return result;
    }
    let submit = gate().submit.expect("the hook stored it");
    // SAFETY: the driver's own function with the caller's arguments.
    unsafe { submit(queue, count, submits, fence) }
}

unsafe extern "system" fn gated_wait(
    device: vk::Device,
    count: u32,
    fences: *const vk::Fence,
    wait_all: vk::Bool32,
    timeout: u64,
) -> vk::Result {
    let failure = gate().pass(Call::Wait);
    let wait = gate().wait.expect("the hook stored it");
    // The true device is not lost: its work ends before the caller, who believes so, takes everything down.
    // SAFETY: the driver's own function with the caller's arguments.
    let result = unsafe { wait(device, count, fences, wait_all, timeout) };
    failure.unwrap_or(result)
}

fn hook(name: &CStr, own: *const c_void) -> *const c_void {
    match name.to_bytes() {
        b"vkQueueSubmit2" => {
            // SAFETY: the pointer is the function of that name.
            gate().submit = Some(unsafe { transmute::<*const c_void, vk::PFN_vkQueueSubmit2>(own) });
            gated_submit as vk::PFN_vkQueueSubmit2 as *const c_void
        }
        b"vkWaitForFences" => {
            // SAFETY: as above.
            gate().wait = Some(unsafe { transmute::<*const c_void, vk::PFN_vkWaitForFences>(own) });
            gated_wait as vk::PFN_vkWaitForFences as *const c_void
        }
        _ => counted::hook(name, own),
    }
}

/// A watched device behind a gate that fails as planned. Whoever asks has `counted::begin` behind them.
pub fn failing_device(planned: Option<Failure>) -> DeviceRequest {
    *gate() = Gate { planned, ..Gate::OPEN };
    DeviceRequest { hook: Some(hook), ..watched_device() }
}

/// Whether the planned failure has come.
pub fn has_failed() -> bool {
    gate().has_failed
}

/// Submits so far.
pub fn submit_count() -> u32 {
    gate().submit_count
}
