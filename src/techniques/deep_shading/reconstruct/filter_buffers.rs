//! What the filter's passes hand to each other.

use crate::gpu::{Access, Barrier, Bound, Buffer};
use crate::plan::Resources;
use crate::techniques::deep_shading::resources::{LAYER_MEANS, SAMPLE_COLORS, SAMPLE_VECTORS, full};

pub(super) const BINS: &str = "reconstruct.bins";
pub(super) const TILES: &str = "reconstruct.layers.tiles";

/// One entry a sample of the frame (`colors`, `vectors`), some a tile (`bins`, `tiles`), or some a pixel (`means`).
pub struct FilterBuffers {
    pub(super) colors: Buffer,
    pub(super) vectors: Buffer,
    pub(super) bins: Buffer,
    pub(super) tiles: Buffer,
    pub(super) means: Buffer,
}

impl FilterBuffers {
    pub(super) fn new(resources: &mut Resources) -> Self {
        Self {
            colors: resources.buffer(&full(SAMPLE_COLORS)),
            vectors: resources.buffer(&full(SAMPLE_VECTORS)),
            bins: resources.buffer(&full(BINS)),
            tiles: resources.buffer(&full(TILES)),
            means: resources.buffer(&full(LAYER_MEANS)),
        }
    }

    pub(super) fn bound(&self) -> [(&'static str, Bound<'_>); 5] {
        [
            ("SampleColors", Bound::Buffer(&self.colors)),
            ("SampleVectors", Bound::Buffer(&self.vectors)),
            ("Bins", Bound::Buffer(&self.bins)),
            ("Tiles", Bound::Buffer(&self.tiles)),
            ("LayerMeans", Bound::Buffer(&self.means)),
        ]
    }

    /// Samples' colours and vectors, which `from` touched last, become readable by compute shaders.
    pub(super) fn samples_to_read(&self, from: Access) -> [Barrier; 2] {
        [&self.colors, &self.vectors].map(|buffer| buffer.from(from).to(Access::ComputeRead))
    }

    pub(super) fn sample_bytes(&self) -> u64 {
        self.colors.bytes + self.vectors.bytes
    }
}
