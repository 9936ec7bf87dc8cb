//! What passes have in memory: images in the layout of a machine, and buffers, one after the other.

use super::access::Access;
use super::layout::Layout;
use crate::gpu::shader::structs::MappingParams;
use crate::techniques::interleaved_deferred::split_method::StorageKind;
use crate::units::Extent;

/// Bytes of a texel of the position (`--position half` and `unorm16`) and of the normal, and of one of the irradiance.
pub const TEXEL_BYTES: u32 = 8;

/// Resources begin at multiples of this: far enough that none shares a line with another.
const ALIGNMENT: u64 = 1 << 16;

/// An image, or a buffer of entries.
#[derive(Clone, Copy, Debug)]
pub struct Resource {
    base: u64,
    /// All of it, with the padding of an image's layout.
    bytes: u64,
    /// A texel, or an entry.
    entry_bytes: u32,
    layout: Layout,
    /// The extent of an image, or of each of its layers; a buffer has none.
    extent: Extent,
}

impl Resource {
    /// Address of a texel of an image.
    pub fn texel(&self, at: [u32; 2]) -> u64 {
        self.entry(self.layout.index(self.extent, at))
    }

    /// Address of a texel of a layer.
    pub fn layer_texel(&self, [x, y, layer]: [u32; 3]) -> u64 {
        self.entry(u64::from(layer) * self.layout.texel_count(self.extent) + self.layout.index(self.extent, [x, y]))
    }

    /// Address of an entry of a buffer.
    pub fn entry(&self, index: u64) -> u64 {
        self.base + index * u64::from(self.entry_bytes)
    }

    /// Reads an entry, or a texel, at its address.
    pub fn read(&self, address: u64) -> Access {
        Access::read(address, self.entry_bytes)
    }

    /// Writes an entry, or a texel, at its address.
    pub fn write(&self, address: u64) -> Access {
        Access::write(address, self.entry_bytes)
    }

    /// Bytes that are asked for of it, to read and to write.
    pub fn asked_bytes(&self, accesses: &[Access]) -> [u64; 2] {
        let own = self.base..self.base + self.bytes;
        let mut asked = [0; 2];
        for access in accesses.iter().filter(|access| own.contains(&access.address)) {
            asked[usize::from(access.is_write)] += u64::from(access.bytes);
        }
        asked
    }
}

/// Gives out addresses, one resource after the other.
#[derive(Default)]
pub struct Space {
    end: u64,
}

impl Space {
    /// An image of `TEXEL_BYTES` a texel.
    pub fn image(&mut self, layout: Layout, extent: Extent) -> Resource {
        self.layers(layout, extent, 1)
    }

    /// An image of `TEXEL_BYTES` a texel with layers, which lie one after the other.
    pub fn layers(&mut self, layout: Layout, extent: Extent, count: u32) -> Resource {
        let resource = self.take(u64::from(count) * layout.texel_count(extent), TEXEL_BYTES);
        Resource { layout, extent, ..resource }
    }

    /// A buffer of `TEXEL_BYTES` a texel.
    pub fn buffer(&mut self, texels: u64) -> Resource {
        self.take(texels, TEXEL_BYTES)
    }

    /// A buffer of entries of another size.
    pub fn entries(&mut self, count: u64, entry_bytes: usize) -> Resource {
        self.take(count, entry_bytes as u32)
    }

    fn take(&mut self, count: u64, entry_bytes: u32) -> Resource {
        let (base, bytes) = (self.end, count * u64::from(entry_bytes));
        self.end = (base + bytes).next_multiple_of(ALIGNMENT);
        Resource { base, bytes, entry_bytes, layout: Layout::Linear, extent: Extent::new(0, 0) }
    }
}

/// Texels in the three orders of `MappingParams`, one resource a part: position and normal, or irradiance alone.
#[derive(Clone, Copy, Debug)]
pub struct Texels {
    pub storage: StorageKind,
    pub parts: [Resource; 2],
}

impl Texels {
    pub fn new(space: &mut Space, storage: StorageKind, layout: Layout, mapping: &MappingParams) -> Self {
        let mut one = || match storage {
            StorageKind::Buffer => space.buffer(mapping.texel_count()),
            StorageKind::Image => space.image(layout, mapping.padded()),
        };
        Self { storage, parts: [one(), one()] }
    }

    /// Address of a texel of a sub-buffer.
    pub fn of_sub_buffer(&self, part: usize, mapping: &MappingParams, texel: [u32; 3]) -> u64 {
        match self.storage {
            StorageKind::Buffer => self.parts[part].entry(mapping.linear_of(texel)),
            StorageKind::Image => self.parts[part].texel(mapping.tiled_of(texel)),
        }
    }

    /// Address of a texel of the block layout.
    pub fn of_block(&self, part: usize, mapping: &MappingParams, [x, y]: [u32; 2]) -> u64 {
        match self.storage {
            StorageKind::Buffer => {
                self.parts[part].entry(u64::from(y) * u64::from(mapping.padded().width) + u64::from(x))
            }
            StorageKind::Image => self.parts[part].texel([x, y]),
        }
    }
}
