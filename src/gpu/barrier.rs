//! Barriers: a resource, how it was touched last, and how it is touched next.

use super::access::{Access, AccessSet};
use super::buffer::Buffer;
use super::image::Image;
use ash::vk;

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

impl<R> Edge<'_, R> {
    /// The same resource after one more access: what a pass hands on of what it was handed.
    pub fn after(self, access: Access) -> Self {
        Self { from: self.from.after(access), ..self }
    }
}

/// One barrier: a resource, its last accesses, its next one.
#[derive(Clone, Copy, Debug)]
pub struct Barrier {
    pub(super) target: Target,
    pub(super) from: AccessSet,
    pub(super) to: Access,
    /// The contents need not survive.
    pub(super) discard: bool,
    /// The image's samples lie where `Commands::place_samples` says.
    pub(super) is_placed: bool,
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
        Barrier { target: self.resource.target(), from: self.from, to: access, discard: false, is_placed: false }
    }
}

impl Edge<'_, Image> {
    /// The next access: the right side.
    pub fn to(self, access: Access) -> Barrier {
        let is_placed = self.resource.description.are_placed;
        Barrier { target: self.resource.target(), from: self.from, to: access, discard: false, is_placed }
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
        Barrier { target: self.target(), from: self.takes_over, to: access, discard: true, is_placed: false }
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
        let is_placed = self.description.are_placed;
        Barrier { target: self.target(), from: self.takes_over, to: access, discard: true, is_placed }
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

    /// `places`: where samples of images that are `is_placed` lie, chained for the change of their layout.
    pub(super) fn image_barrier<'a>(
        &self,
        image: vk::Image,
        aspect: vk::ImageAspectFlags,
        places: Option<&'a vk::SampleLocationsInfoEXT<'a>>,
    ) -> vk::ImageMemoryBarrier2<'a> {
        let old_layout = if self.discard { vk::ImageLayout::UNDEFINED } else { self.from.layout() };
        let barrier = vk::ImageMemoryBarrier2::default()
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
            );
        // Several barriers may have the one, which a chain that is pushed, and so mutable, would not let them.
        let chained =
            places.filter(|_| self.is_placed).map_or(std::ptr::null(), |places| std::ptr::from_ref(places).cast());
        vk::ImageMemoryBarrier2 { p_next: chained, ..barrier }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_after_a_known_reader_needs_no_barrier_and_a_writer_always_does() {
        let target = Target::Buffer(vk::Buffer::null());
        let barrier = |from: AccessSet, to| Barrier { target, from, to, discard: false, is_placed: false }.is_needed();
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
        let barrier = Barrier {
            target,
            from: Access::ComputeRead.into(),
            to: Access::ComputeSample,
            discard: false,
            is_placed: false,
        };
        assert!(barrier.is_needed());
    }
}
