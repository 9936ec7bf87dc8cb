//! What a device is asked to be when it opens.

use crate::caps::Caps;
use crate::memory::touched::Touched;
use crate::memory::trace::Recorder;
use crate::memory::{Strategy, Tiling};
use std::ffi::{CStr, c_void};
use std::sync::Arc;

/// Replaces a device function by name, or leaves it: how a test stands between this program and the driver.
pub type DeviceHook = fn(&CStr, *const c_void) -> *const c_void;

/// Which device, how its memory is kept, and how it is watched.
#[derive(Clone, Debug, Default)]
pub struct DeviceRequest {
    /// An index of the list that `devices` prints, or a part of a name; None: the first that fits, GPUs first.
    pub selector: Option<String>,
    /// Load the validation layer with synchronization checks and collect its messages.
    pub validate: bool,
    pub strategy: Strategy,
    /// What memory blocks in one heap may sum up to; None: the heap's size.
    pub budget_bytes: Option<u64>,
    /// Greatest size of a shared memory block, a power of two; None: `memory::pool::SHARED_BLOCK_BYTES`.
    pub block_bytes: Option<u64>,
    /// Keeps what is asked of memory and comes back.
    pub recorder: Option<Arc<Recorder>>,
    /// Reads and writes of shaders beyond a buffer's end hit nothing else (robustBufferAccess). Without, such a mistake may
    /// lose the device; what looks for mistakes and what is timed does without.
    pub robust: bool,
    /// How texels of images lie in memory, of those that the driver makes so.
    pub image_tiling: Tiling,
    /// Whether it is counted what frames touch: shaders do it themselves, which costs much time.
    pub touched: Touched,
    /// None: the driver's own functions.
    pub hook: Option<DeviceHook>,
    /// Changes what devices say of themselves before one is chosen: how a test has a device that is not there.
    pub pretense: Option<fn(&mut Caps)>,
}
