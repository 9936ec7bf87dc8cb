//! What resources ask memory for, and how memory blocks are cut.

use crate::choice::choices;
use crate::memory::kinds::Use;
use crate::memory::suballocate::{Buddy, Dedicated, Linear, Suballocate, Tlsf};
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
        /// Halves of halves of shared memory blocks; each range takes a power of two.
        "buddy" => Buddy,
    }
}

impl Strategy {
    /// Whether resources share memory blocks.
    pub fn shares_blocks(self) -> bool {
        self != Self::Dedicated
    }

    /// What cuts a new memory block of so many bytes.
    pub fn ranges(self, bytes: u64) -> Box<dyn Suballocate> {
        match self {
            Self::Linear => Box::new(Linear::new(bytes)),
            Self::Dedicated => Box::new(Dedicated::new(bytes)),
            Self::Tlsf => Box::new(Tlsf::new(bytes)),
            Self::Buddy => Box::new(Buddy::new(bytes)),
        }
    }
}

choices! {
    /// How texels of an image lie in memory (`--image-tiling`). Buffers and linear images are on one side, optimally tiled images on
    /// the other: the two sides share a memory block only in an arena, where the caller that places the parts keeps them
    /// bufferImageGranularity apart.
    #[derive(Default)]
    pub enum Tiling {
        /// As the driver likes best.
        #[default]
        "optimal" => Optimal,
        /// Row by row.
        "linear" => Linear,
    }
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
