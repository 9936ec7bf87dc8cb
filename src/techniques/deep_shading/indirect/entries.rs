//! The compact geometry buffer: samples' pointers, the cache that finds what is there already, and its entries.

use crate::gpu::{Bound, Buffer};
use crate::plan::Resources;
use crate::techniques::deep_shading::resources::{CACHE, ENTRIES, POINTERS, full};

pub struct Entries {
    /// 4 B a sample: pointers.glsl says what.
    pub pointers: Buffer,
    pub cache: Buffer,
    /// As `ENTRIES` names them.
    pub entries: [Buffer; 4],
}

impl Entries {
    pub fn new(resources: &mut Resources) -> Self {
        Self {
            pointers: resources.buffer(&full(POINTERS)),
            cache: resources.buffer(&full(CACHE)),
            entries: ENTRIES.map(|(name, _)| resources.buffer(&full(name))),
        }
    }

    /// All of them, as shaders call them.
    pub fn bound(&self) -> impl Iterator<Item = (&'static str, Bound<'_>)> {
        let entries = ENTRIES.iter().zip(&self.entries).map(|((_, name), buffer)| (*name, Bound::Buffer(buffer)));
        entries.chain([("Pointers", Bound::Buffer(&self.pointers)), ("Cache", Bound::Buffer(&self.cache))])
    }
}
