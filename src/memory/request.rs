//! What resources ask memory for, and how memory blocks are cut.

use crate::memory::kinds::Use;
use ash::vk;

/// How resources come by their memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strategy {
    /// One memory block for each resource.
    Dedicated,
    /// Ranges one after the other in shared memory blocks; a block returns whole, when its last range does.
    #[default]
    Linear,
    /// Ranges in shared memory blocks wherever there is room; what returns is taken again.
    Tlsf,
}

impl Strategy {
    /// `dedicated`, `linear` or `tlsf`; None for any other word.
    pub fn from_setting(word: &str) -> Option<Self> {
        match word {
            "dedicated" => Some(Self::Dedicated),
            "linear" => Some(Self::Linear),
            "tlsf" => Some(Self::Tlsf),
            _ => None,
        }
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
