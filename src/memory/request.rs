//! What resources ask memory for, and how memory blocks are cut.

use crate::choice::choices;
use crate::memory::kinds::Use;
use ash::vk;

choices! {
    /// How resources come by their memory (`--allocation`).
    #[derive(Default)]
    pub enum Strategy {
        /// Ranges one after the other in shared memory blocks; a block returns whole, when its last range does.
        #[default]
        "linear" => Linear,
        /// One memory block for each resource.
        "dedicated" => Dedicated,
        /// Ranges in shared memory blocks wherever there is room; what returns is taken again.
        "tlsf" => Tlsf,
    }
}

/// Buffers and linear images on one side, optimally tiled images on the other: the two sides share a memory block only
/// in an arena, where the caller that places the parts keeps them bufferImageGranularity apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tiling {
    Linear,
    Optimal,
}

/// A resource's request for memory.
pub struct Request<'a> {
    /// Full name: `interleaved_deferred.gather.irradiance`.
    pub name: &'a str,
    /// Row of the memory table: `scene.textures`.
    pub group: &'a str,
    /// Bytes asked for by arithmetic; the driver's requirement may be larger.
    pub bytes: u64,
    pub requirements: vk::MemoryRequirements,
    pub usage: Use,
    pub tiling: Tiling,
}
