//! The compact geometry buffer: samples' pointers, the cache that finds what is there already, and its entries.

use crate::gpu::{Access, AccessSet, Barrier, Bound, Buffer, Edge};
use crate::plan::Resources;
use crate::techniques::deep_shading::resources::{CACHE, ENTRIES, POINTERS, full};

pub struct Entries {
    /// 4 B a sample: pointers.glsl says what.
    pub pointers: Buffer,
    pub cache: Buffer,
    /// As `ENTRIES` names them.
    pub entries: [Buffer; 4],
}

impl Edge<'_, Entries> {
    /// Entries become readable as `access` says.
    pub fn to(self, access: Access) -> impl Iterator<Item = Barrier> {
        self.resource.entries.iter().map(move |buffer| buffer.from(self.from).to(access))
    }
}

impl Entries {
    /// Names the access that touched the entries last.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

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
