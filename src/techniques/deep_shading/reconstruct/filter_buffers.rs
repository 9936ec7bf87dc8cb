//! What the filter's passes hand to each other.

use crate::gpu::{Bound, Buffer};

pub const RANGES: &str = "reconstruct.samples.draws";

/// One entry a sample of the frame, and one a tile.
pub struct FilterBuffers {
    pub(super) colors: Buffer,
    pub(super) vectors: Buffer,
    pub(super) tiles: Buffer,
}

impl FilterBuffers {
    pub(super) fn bound(&self) -> [(&'static str, Bound<'_>); 3] {
        [
            ("SampleColors", Bound::Buffer(&self.colors)),
            ("SampleVectors", Bound::Buffer(&self.vectors)),
            ("Tiles", Bound::Buffer(&self.tiles)),
        ]
    }

    pub(super) fn sample_bytes(&self) -> u64 {
        self.colors.bytes + self.vectors.bytes
    }
}
