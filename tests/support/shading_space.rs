//! A rasteriser that leaves shading space empty: samples find no colour there, as on a device whose method of
//! conservative rasterisation leaves pixels out.

use ash::vk;
use std::ffi::{CStr, c_void};
use std::mem::transmute;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// The driver's own functions behind these; what was found once stays, for tests that share a process.
#[derive(Clone, Copy)]
struct Own {
    begin: Option<vk::PFN_vkCmdBeginRendering>,
    draw: Option<vk::PFN_vkCmdDraw>,
}

static OWN: Mutex<Own> = Mutex::new(Own { begin: None, draw: None });

fn own() -> Own {
    *OWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Whether what is recorded is drawn into nothing: only shading space is.
static DRAWS_INTO_NOTHING: AtomicBool = AtomicBool::new(false);

unsafe extern "system" fn noted_begin(buffer: vk::CommandBuffer, info: *const vk::RenderingInfo<'_>) {
    // SAFETY: the caller's own structs; a depth attachment may be left out.
    let (colors, depth) = unsafe { ((*info).color_attachment_count, (*info).p_depth_attachment.as_ref()) };
    // With zmax what is drawn is tested, and still leaves nothing.
    let is_kept = depth.is_some_and(|depth| depth.store_op == vk::AttachmentStoreOp::STORE);
    let into_nothing = colors == 0 && !is_kept;
    DRAWS_INTO_NOTHING.store(into_nothing, Ordering::SeqCst);
    let begin = own().begin.expect("the hook stored it");
    // SAFETY: the driver's own function with the caller's arguments.
    unsafe { begin(buffer, info) };
}

unsafe extern "system" fn draw_into_something(
    buffer: vk::CommandBuffer,
    vertices: u32,
    instances: u32,
    v: u32,
    i: u32,
) {
    if !DRAWS_INTO_NOTHING.load(Ordering::SeqCst) {
        let draw = own().draw.expect("the hook stored it");
        // SAFETY: the driver's own function with the caller's arguments.
        unsafe { draw(buffer, vertices, instances, v, i) };
    }
}

/// `DeviceRequest::hook` of such a device.
pub fn without_shading_space(name: &CStr, function: *const c_void) -> *const c_void {
    let mut own = OWN.lock().unwrap_or_else(PoisonError::into_inner);
    match name.to_bytes() {
        b"vkCmdBeginRendering" => {
            // SAFETY: the pointer is the function of that name.
            own.begin = Some(unsafe { transmute::<*const c_void, vk::PFN_vkCmdBeginRendering>(function) });
            noted_begin as vk::PFN_vkCmdBeginRendering as *const c_void
        }
        b"vkCmdDraw" => {
            // SAFETY: as above.
            own.draw = Some(unsafe { transmute::<*const c_void, vk::PFN_vkCmdDraw>(function) });
            draw_into_something as vk::PFN_vkCmdDraw as *const c_void
        }
        _ => function,
    }
}
