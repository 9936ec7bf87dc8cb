//! What the validation layers say: collected, counted, and fatal where the caller asked for that.
//!
//! Synchronization validation is switched on beside the core checks, because barriers are stated by hand here.

use ash::vk;
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

/// The layer that holds every check used here.
pub const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// One message of the layer.
#[derive(Clone, Debug)]
pub struct Message {
    /// The layer's own name for the check, such as `VUID-vkCmdDraw-None-02699`.
    pub id: String,
    pub text: String,
}

/// The messages since the last `take`, in the order in which they came.
#[derive(Debug, Default)]
pub struct Log {
    messages: Mutex<Vec<Message>>,
}

/// Messages that say nothing about this program: id and reason.
const ALLOWED: [(&str, &str); 1] = [(
    "WARNING-GPU-Assisted-Validation",
    "where its settings ask for shaders that check themselves: which features the layer enables for that, and which \
     limits it lowers",
)];

impl Log {
    /// Removes and returns what has been said so far.
    pub fn take(&self) -> Vec<Message> {
        std::mem::take(&mut *self.messages.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
    }

    fn push(&self, message: Message) {
        if ALLOWED.iter().any(|(id, _)| message.id == *id) {
            return;
        }
        self.messages.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(message);
    }

    /// What a messenger needs to write into this log. The log must outlive the messenger.
    pub fn messenger_info(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'_> {
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
            )
            .message_type(
                vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
            )
            .pfn_user_callback(Some(callback))
            .user_data(std::ptr::from_ref(self).cast_mut().cast())
    }
}

unsafe extern "system" fn callback(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    log: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the loader passes valid callback data, and `messenger_info` stored a log that outlives the messenger.
    let (data, log) = unsafe { (&*data, &*log.cast::<Log>().cast_const()) };
    let text = |pointer: *const std::ffi::c_char| {
        if pointer.is_null() {
            return String::new();
        }
        // SAFETY: not null, and the loader passes terminated strings.
        unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
    };
    log.push(Message { id: text(data.p_message_id_name), text: text(data.p_message) });
    vk::FALSE
}
