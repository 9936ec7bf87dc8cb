//! What the parts of a frame are recorded with.

use crate::gpu::commands::{Heirs, Recording};

/// How parts are recorded.
pub struct PartRecording {
    /// Label of their command buffers, and the technique's name.
    pub name: &'static str,
    pub recording: Recording,
    pub heirs: Heirs,
}
