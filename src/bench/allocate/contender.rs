//! Who replays a trace: this program's strategies at some sizes of memory blocks, and allocators of others.

use super::play::{Accounted, Player};
use crate::caps::Caps;
use crate::gpu::Gpu;
use crate::memory::Strategy;

/// Name of this program's allocator in rows.
pub const OURS: &str = "quincunx";

/// A strategy with a size of memory blocks.
#[derive(Clone, Debug)]
pub struct Variant {
    /// As it was asked for.
    pub label: String,
    pub strategy: Strategy,
    /// None: as the program grows them.
    pub block_bytes: Option<u64>,
}

/// Where memory blocks are.
pub enum Place<'a> {
    /// Nowhere: numbers alone, under these caps.
    Numbers(&'a Caps),
    Device(&'a Gpu),
}

impl Place<'_> {
    pub fn caps(&self) -> &Caps {
        match self {
            Self::Numbers(caps) => caps,
            Self::Device(gpu) => &gpu.caps,
        }
    }

    /// Name in rows.
    pub fn name(&self) -> &str {
        match self {
            Self::Numbers(_) => "numbers",
            Self::Device(gpu) => &gpu.caps.identity.name,
        }
    }
}

/// An allocator that bytes are taken from for a look, and one that is timed.
pub struct Contender {
    pub allocator: &'static str,
    pub variant: String,
    pub accounted: Box<dyn Accounted>,
    pub timed: Box<dyn Player>,
}
