//! One vocabulary for barriers: how a resource is touched, as stage, access and layout in one word.
//!
//! A pass states the right side (`to`), because it knows what it needs. `record` states the left side (`from`), because
//! only the technique knows who wrote. Nothing is inferred; debug builds compare the left side with the truth
//! (`Commands`), and synchronization validation checks the rest.

use ash::vk;

/// One way of touching a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read as a storage buffer or storage image by a compute shader.
    ComputeRead,
    /// Written (and perhaps read) as a storage buffer or storage image by a compute shader.
    ComputeWrite,
    /// Read through an image descriptor by a compute shader.
    ComputeSample,
    /// Read as a storage or uniform buffer by vertex, geometry and fragment shaders.
    GraphicsRead,
    /// Read through an image descriptor by a fragment shader.
    FragmentSample,
    /// Written (and perhaps read) as a storage buffer by a fragment shader.
    FragmentWrite,
    /// Written as a colour attachment, blending included.
    ColorWrite,
    /// Tested and written as the depth attachment.
    DepthWrite,
    /// Tested as a read-only depth attachment.
    DepthTest,
    /// Tested as a read-only depth attachment and read through an image descriptor by fragment shaders, while its stencil is
    /// tested and written.
    StencilWrite,
    TransferRead,
    TransferWrite,
    /// Read as vertices or indices.
    VertexRead,
    /// Commands of draws, and how many there are.
    IndirectRead,
    /// Read by the build of an acceleration structure: a structure that it holds.
    StructureRead,
    /// Written (and read) by the build of an acceleration structure: the structure itself, or scratch.
    StructureWrite,
    /// An acceleration structure that rays of a compute shader go through.
    ComputeTrace,
}

impl Access {
    const ALL: [Self; 17] = [
        Self::ComputeRead,
        Self::ComputeWrite,
        Self::ComputeSample,
        Self::GraphicsRead,
        Self::FragmentSample,
        Self::FragmentWrite,
        Self::ColorWrite,
        Self::DepthWrite,
        Self::DepthTest,
        Self::StencilWrite,
        Self::TransferRead,
        Self::TransferWrite,
        Self::VertexRead,
        Self::IndirectRead,
        Self::StructureRead,
        Self::StructureWrite,
        Self::ComputeTrace,
    ];

    pub(super) fn stage(self) -> vk::PipelineStageFlags2 {
        use vk::PipelineStageFlags2 as Stage;
        match self {
            Self::ComputeRead | Self::ComputeWrite | Self::ComputeSample | Self::ComputeTrace => Stage::COMPUTE_SHADER,
            // Geometry shaders too, where there are any.
            Self::GraphicsRead => Stage::PRE_RASTERIZATION_SHADERS | Stage::FRAGMENT_SHADER,
            Self::FragmentSample | Self::FragmentWrite => Stage::FRAGMENT_SHADER,
            Self::ColorWrite => Stage::COLOR_ATTACHMENT_OUTPUT,
            Self::DepthWrite | Self::DepthTest => Stage::EARLY_FRAGMENT_TESTS | Stage::LATE_FRAGMENT_TESTS,
            Self::StencilWrite => Stage::EARLY_FRAGMENT_TESTS | Stage::LATE_FRAGMENT_TESTS | Stage::FRAGMENT_SHADER,
            Self::TransferRead | Self::TransferWrite => Stage::ALL_TRANSFER,
            Self::VertexRead => Stage::VERTEX_INPUT,
            Self::IndirectRead => Stage::DRAW_INDIRECT,
            Self::StructureRead | Self::StructureWrite => Stage::ACCELERATION_STRUCTURE_BUILD_KHR,
        }
    }

    pub(super) fn access(self) -> vk::AccessFlags2 {
        use vk::AccessFlags2 as Flags;
        match self {
            Self::ComputeRead => Flags::SHADER_STORAGE_READ | Flags::UNIFORM_READ,
            Self::ComputeWrite | Self::FragmentWrite => Flags::SHADER_STORAGE_READ | Flags::SHADER_STORAGE_WRITE,
            Self::ComputeSample | Self::FragmentSample => Flags::SHADER_SAMPLED_READ,
            Self::GraphicsRead => Flags::SHADER_STORAGE_READ | Flags::UNIFORM_READ,
            Self::ColorWrite => Flags::COLOR_ATTACHMENT_READ | Flags::COLOR_ATTACHMENT_WRITE,
            Self::DepthWrite => Flags::DEPTH_STENCIL_ATTACHMENT_READ | Flags::DEPTH_STENCIL_ATTACHMENT_WRITE,
            Self::DepthTest => Flags::DEPTH_STENCIL_ATTACHMENT_READ,
            Self::StencilWrite => {
                Flags::DEPTH_STENCIL_ATTACHMENT_READ
                    | Flags::DEPTH_STENCIL_ATTACHMENT_WRITE
                    | Flags::SHADER_SAMPLED_READ
            }
            Self::TransferRead => Flags::TRANSFER_READ,
            Self::TransferWrite => Flags::TRANSFER_WRITE,
            Self::VertexRead => Flags::VERTEX_ATTRIBUTE_READ | Flags::INDEX_READ,
            Self::IndirectRead => Flags::INDIRECT_COMMAND_READ,
            Self::StructureRead | Self::ComputeTrace => Flags::ACCELERATION_STRUCTURE_READ_KHR,
            Self::StructureWrite => Flags::ACCELERATION_STRUCTURE_READ_KHR | Flags::ACCELERATION_STRUCTURE_WRITE_KHR,
        }
    }

    /// The layout that an image must have for it; a buffer has none.
    pub fn layout(self) -> vk::ImageLayout {
        match self {
            Self::ComputeRead | Self::ComputeWrite => vk::ImageLayout::GENERAL,
            Self::ComputeSample | Self::FragmentSample => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
            Self::ColorWrite => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
            Self::DepthWrite => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
            Self::DepthTest => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
            Self::StencilWrite => vk::ImageLayout::DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL,
            Self::TransferRead => vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            Self::TransferWrite => vk::ImageLayout::TRANSFER_DST_OPTIMAL,
            Self::GraphicsRead | Self::FragmentWrite => vk::ImageLayout::UNDEFINED,
            Self::VertexRead | Self::IndirectRead => vk::ImageLayout::UNDEFINED,
            Self::StructureRead | Self::StructureWrite | Self::ComputeTrace => vk::ImageLayout::UNDEFINED,
        }
    }

    pub fn writes(self) -> bool {
        match self {
            Self::ComputeWrite | Self::FragmentWrite | Self::ColorWrite | Self::DepthWrite => true,
            Self::StencilWrite | Self::TransferWrite | Self::StructureWrite => true,
            Self::ComputeRead | Self::ComputeSample | Self::GraphicsRead | Self::FragmentSample => false,
            Self::DepthTest | Self::TransferRead | Self::VertexRead | Self::IndirectRead => false,
            Self::ComputeTrace | Self::StructureRead => false,
        }
    }

    /// Whether it writes this part, depth or stencil, of an image that has both.
    pub fn writes_aspect(self, aspect: vk::ImageAspectFlags) -> bool {
        self.writes() && !(self == Self::StencilWrite && aspect == vk::ImageAspectFlags::DEPTH)
    }

    fn bit(self) -> u32 {
        1 << self as u16
    }
}

/// Several accesses at once: all readers since the last write, or one writer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct AccessSet(u32);

impl AccessSet {
    /// Not touched in this frame. A frame begins after the fence of the one before it, so there is nothing to wait for.
    pub const UNTOUCHED: Self = Self(0);

    pub fn iter(self) -> impl Iterator<Item = Access> {
        Access::ALL.into_iter().filter(move |access| self.0 & access.bit() != 0)
    }

    pub fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// What is known after one more access: readers join readers, but for those of an image in another layout, which
    /// the transition waited for; a writer stands alone.
    pub fn after(self, access: Access) -> Self {
        let of_buffers = |access: Access| access.layout() == vk::ImageLayout::UNDEFINED;
        let same = |known: Access| known.layout() == access.layout() || of_buffers(known) || of_buffers(access);
        let joins = !access.writes() && self.iter().all(|known| !known.writes() && same(known));
        if joins { self.with(access) } else { access.into() }
    }

    /// What is known after a reader that has waited for all of them: the readers among them, and it.
    pub fn read_by(self, access: Access) -> Self {
        self.iter().filter(|known| !known.writes()).fold(access.into(), Self::with)
    }

    /// Both sets' accesses.
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    pub fn with(self, access: Access) -> Self {
        Self(self.0 | access.bit())
    }

    pub(super) fn stages(self) -> vk::PipelineStageFlags2 {
        self.iter().fold(vk::PipelineStageFlags2::NONE, |stages, access| stages | access.stage())
    }

    /// What must be made available: reads need none.
    pub(super) fn writes(self) -> vk::AccessFlags2 {
        self.iter()
            .filter(|access| access.writes())
            .fold(vk::AccessFlags2::NONE, |flags, access| flags | access.access())
    }

    /// The layout that the last access left; all accesses of a set share one.
    pub(super) fn layout(self) -> vk::ImageLayout {
        self.iter().next().map_or(vk::ImageLayout::UNDEFINED, Access::layout)
    }
}

impl From<Access> for AccessSet {
    fn from(access: Access) -> Self {
        Self(access.bit())
    }
}

impl std::ops::BitOr for Access {
    type Output = AccessSet;

    fn bitor(self, other: Self) -> AccessSet {
        AccessSet::from(self).with(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What was written is waited for by the reader: who comes after it waits for readers alone.
    #[test]
    fn a_reader_that_waited_for_all_leaves_readers() {
        let drawn = Access::ComputeWrite | Access::GraphicsRead;
        assert_eq!(drawn.read_by(Access::ComputeRead), Access::GraphicsRead | Access::ComputeRead);
        assert_eq!(AccessSet::from(Access::FragmentWrite).read_by(Access::ComputeRead), Access::ComputeRead.into());
        // `after` is of a writer that stood alone, or of readers that no writer stands among.
        assert_eq!(drawn.after(Access::ComputeRead), Access::ComputeRead.into());
    }
}
