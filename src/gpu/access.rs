//! One vocabulary for barriers: how a resource is touched, as stage, access and layout in one word.
//!
//! A pass states the right side (`to`), because it knows what it needs. `record` states the left side (`from`), because
//! only the technique knows who wrote. Nothing is inferred; debug builds compare the left side with the truth
//! (`Commands`), and synchronization validation checks the rest.

use super::buffer::Buffer;
use super::image::Image;
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

    fn stage(self) -> vk::PipelineStageFlags2 {
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

    fn access(self) -> vk::AccessFlags2 {
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

    /// Both sets' accesses.
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    pub fn with(self, access: Access) -> Self {
        Self(self.0 | access.bit())
    }

    fn stages(self) -> vk::PipelineStageFlags2 {
        self.iter().fold(vk::PipelineStageFlags2::NONE, |stages, access| stages | access.stage())
    }

    /// What must be made available: reads need none.
    fn writes(self) -> vk::AccessFlags2 {
        self.iter()
            .filter(|access| access.writes())
            .fold(vk::AccessFlags2::NONE, |flags, access| flags | access.access())
    }

    /// The layout that the last access left; all accesses of a set share one.
    fn layout(self) -> vk::ImageLayout {
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

/// A resource, or several, and how it was touched last: the left side of a barrier.
#[derive(Debug)]
pub struct Edge<'a, R> {
    pub resource: &'a R,
    pub from: AccessSet,
}

// By hand, because a derived Copy would ask the resource to be Copy.
impl<R> Clone for Edge<'_, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R> Copy for Edge<'_, R> {}

/// One barrier: a resource, its last accesses, its next one.
#[derive(Clone, Copy, Debug)]
pub struct Barrier {
    pub(super) target: Target,
    pub(super) from: AccessSet,
    pub(super) to: Access,
    /// The contents need not survive.
    pub(super) discard: bool,
}

/// The resource that a barrier covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    Buffer(vk::Buffer),
    Image(vk::Image, vk::ImageAspectFlags),
}

impl Edge<'_, Buffer> {
    /// The next access: the right side.
    pub fn to(self, access: Access) -> Barrier {
        Barrier { target: self.resource.target(), from: self.from, to: access, discard: false }
    }
}

impl Edge<'_, Image> {
    /// The next access: the right side.
    pub fn to(self, access: Access) -> Barrier {
        Barrier { target: self.resource.target(), from: self.from, to: access, discard: false }
    }
}

impl Buffer {
    pub fn target(&self) -> Target {
        Target::Buffer(self.handle)
    }

    /// Names the access that touched it last.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    /// First touch of the frame, old contents not needed; it waits for the resource that had the bytes before.
    pub fn discard(&self, access: Access) -> Barrier {
        Barrier { target: self.target(), from: self.takes_over, to: access, discard: true }
    }
}

impl Image {
    pub fn target(&self) -> Target {
        Target::Image(self.handle, self.aspect())
    }

    /// Names the access that touched it last.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    /// First touch of the frame, old contents not needed; it waits for the resource that had the bytes before.
    pub fn discard(&self, access: Access) -> Barrier {
        Barrier { target: self.target(), from: self.takes_over, to: access, discard: true }
    }
}

impl Barrier {
    /// Readers that follow readers in the same layout need no barrier.
    pub(super) fn is_needed(&self) -> bool {
        if self.discard {
            return matches!(self.target, Target::Image(..)) || self.takes_over();
        }
        let same_layout = match self.target {
            Target::Buffer(_) => true,
            Target::Image(..) => self.from.layout() == self.to.layout(),
        };
        let known = self.from.contains(self.to.into());
        self.to.writes() || self.from.iter().any(Access::writes) || !same_layout || !known
    }

    /// Whether its bytes were another resource's in this frame.
    pub(super) fn takes_over(&self) -> bool {
        self.discard && self.from != AccessSet::UNTOUCHED
    }

    /// Barriers that make the accesses of the bytes' earlier owners available: a barrier of one resource speaks of its
    /// own accesses only.
    pub(super) fn memory_barrier(&self) -> vk::MemoryBarrier2<'static> {
        vk::MemoryBarrier2::default()
            .src_stage_mask(self.from.stages())
            .src_access_mask(self.from.writes())
            .dst_stage_mask(self.to.stage())
            .dst_access_mask(self.to.access())
    }

    pub(super) fn buffer_barrier(&self, buffer: vk::Buffer) -> vk::BufferMemoryBarrier2<'static> {
        // Neither hands it to another queue. A family by name says that the contents may go, as an undefined layout does of an
        // image: buffers have no other word for it, and tools/pretend overwrites them there.
        let family = if self.discard { 0 } else { vk::QUEUE_FAMILY_IGNORED };
        vk::BufferMemoryBarrier2::default()
            .src_queue_family_index(family)
            .dst_queue_family_index(family)
            .src_stage_mask(self.from.stages())
            .src_access_mask(self.from.writes())
            .dst_stage_mask(self.to.stage())
            .dst_access_mask(self.to.access())
            .buffer(buffer)
            .size(vk::WHOLE_SIZE)
    }

    pub(super) fn image_barrier(
        &self,
        image: vk::Image,
        aspect: vk::ImageAspectFlags,
    ) -> vk::ImageMemoryBarrier2<'static> {
        let old_layout = if self.discard { vk::ImageLayout::UNDEFINED } else { self.from.layout() };
        vk::ImageMemoryBarrier2::default()
            .src_stage_mask(self.from.stages())
            .src_access_mask(self.from.writes())
            .dst_stage_mask(self.to.stage())
            .dst_access_mask(self.to.access())
            .old_layout(old_layout)
            .new_layout(self.to.layout())
            .image(image)
            .subresource_range(
                vk::ImageSubresourceRange::default()
                    .aspect_mask(aspect)
                    .level_count(vk::REMAINING_MIP_LEVELS)
                    .layer_count(vk::REMAINING_ARRAY_LAYERS),
            )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_after_a_known_reader_needs_no_barrier_and_a_writer_always_does() {
        let target = Target::Buffer(vk::Buffer::null());
        let barrier = |from: AccessSet, to| Barrier { target, from, to, discard: false }.is_needed();
        assert!(barrier(Access::ComputeWrite.into(), Access::ComputeRead));
        assert!(!barrier(Access::ComputeRead.into(), Access::ComputeRead));
        // The write was made visible to compute only: another stage needs its own barrier.
        assert!(barrier(Access::ComputeRead.into(), Access::GraphicsRead));
        assert!(!barrier(Access::ComputeRead | Access::GraphicsRead, Access::GraphicsRead));
        assert!(barrier(Access::ComputeRead.into(), Access::ComputeWrite));
    }

    #[test]
    fn an_image_changes_layout_even_between_readers() {
        let target = Target::Image(vk::Image::null(), vk::ImageAspectFlags::COLOR);
        let barrier = Barrier { target, from: Access::ComputeRead.into(), to: Access::ComputeSample, discard: false };
        assert!(barrier.is_needed());
    }
}
