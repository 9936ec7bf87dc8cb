//! What the filter's passes hand to each other.

use crate::gpu::{Access, Barrier, Bound, Buffer, Edge};

pub const RANGES: &str = "reconstruct.samples.draws";

/// One entry a sample of the frame, and one a tile.
pub struct FilterBuffers {
    pub(super) colors: Buffer,
    pub(super) vectors: Buffer,
    pub(super) tiles: Buffer,
}

impl Edge<'_, FilterBuffers> {
    /// Samples' colours and vectors become readable by compute shaders.
    pub(super) fn samples_to_read(self) -> [Barrier; 2] {
        let FilterBuffers { colors, vectors, .. } = self.resource;
        [colors, vectors].map(|buffer| buffer.from(self.from).to(Access::ComputeRead))
    }
}

impl FilterBuffers {
    /// Names the access that touched samples' colours and vectors last.
    pub(super) fn from(&self, access: Access) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

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
