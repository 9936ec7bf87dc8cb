//! What a split and a gather of interleaved deferred shading have in memory: images in the layout of a machine, and buffers.

use super::layout::Layout;
use crate::gpu::shader::structs::MappingParams;
use crate::techniques::interleaved_deferred::split_method::StorageKind;
use crate::units::Extent;

/// Bytes of a texel of the position (`--position half` and `unorm16`) and of the normal, and of one of the irradiance.
pub const TEXEL_BYTES: u32 = 8;

/// Resources begin at multiples of this: far enough that none shares a line with another.
const ALIGNMENT: u64 = 1 << 16;

/// An image, or a buffer of texels in some order.
#[derive(Clone, Copy, Debug)]
pub struct Resource {
    base: u64,
    layout: Layout,
    /// The extent of an image; a buffer has none.
    extent: Extent,
}

impl Resource {
    /// Address of a texel of an image.
    pub fn texel(&self, at: [u32; 2]) -> u64 {
        self.base + self.layout.index(self.extent, at) * u64::from(TEXEL_BYTES)
    }

    /// Address of a texel of a buffer.
    pub fn entry(&self, index: u64) -> u64 {
        self.base + index * u64::from(TEXEL_BYTES)
    }
}

/// Gives out addresses, one resource after the other.
#[derive(Default)]
pub struct Space {
    end: u64,
}

impl Space {
    pub fn image(&mut self, layout: Layout, extent: Extent) -> Resource {
        let base = self.take(layout.texel_count(extent));
        Resource { base, layout, extent }
    }

    pub fn buffer(&mut self, texels: u64) -> Resource {
        let base = self.take(texels);
        Resource { base, layout: Layout::Linear, extent: Extent::new(0, 0) }
    }

    fn take(&mut self, texels: u64) -> u64 {
        let base = self.end;
        self.end = (base + texels * u64::from(TEXEL_BYTES)).next_multiple_of(ALIGNMENT);
        base
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
