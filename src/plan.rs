//! Plan: the resources that a frame needs, by arithmetic alone; and `Resources`, the same made real.

use crate::error::{Error, Result};
use crate::gpu::{Buffer, Gpu, Image, ImageDescription};
use crate::memory::kinds::Use;
use crate::units::{Bytes, Extent};
use ash::vk;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Format of finished pictures.
pub const PICTURE_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// What a resource is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Buffer { bytes: u64, flags: vk::BufferUsageFlags, usage: Use },
    Image(ImageDescription),
}

/// One resource of the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Planned {
    /// Full name, such as `interleaved_deferred.gather.irradiance`.
    pub name: String,
    /// Row of the memory table.
    pub group: &'static str,
    pub shape: Shape,
}

impl Planned {
    /// Bytes asked for.
    pub fn bytes(&self) -> u64 {
        match self.shape {
            Shape::Buffer { bytes, .. } => bytes,
            Shape::Image(description) => description.bytes(),
        }
    }
}

/// The resources of a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    pub resources: Vec<Planned>,
}

impl Plan {
    /// A buffer that the device alone touches, `bytes` long; an empty list gets one element of 16 bytes, because a
    /// shader that never reads it still binds it.
    pub fn buffer(&mut self, group: &'static str, name: impl Into<String>, bytes: u64) {
        let bytes = bytes.max(16);
        let flags = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_DST
            | vk::BufferUsageFlags::TRANSFER_SRC;
        self.push(group, name, Shape::Buffer { bytes, flags, usage: Use::Device });
    }

    /// A buffer that the host writes.
    pub fn host_buffer(&mut self, group: &'static str, name: impl Into<String>, bytes: u64) {
        let flags = vk::BufferUsageFlags::STORAGE_BUFFER;
        self.push(group, name, Shape::Buffer { bytes, flags, usage: Use::Upload });
    }

    pub fn push(&mut self, group: &'static str, name: impl Into<String>, shape: Shape) {
        let name = name.into();
        assert!(self.resources.iter().all(|planned| planned.name != name), "{name} is planned twice");
        self.resources.push(Planned { name, group, shape });
    }

    /// An image of one level.
    pub fn image(
        &mut self,
        group: &'static str,
        name: impl Into<String>,
        extent: Extent,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
    ) {
        self.push(group, name, Shape::Image(ImageDescription { extent, format, level_count: 1, usage }));
    }

    /// The finished picture, RGBA32F: shaders store it, BLEND surfaces blend over it, the host reads it.
    pub fn picture(&mut self, name: impl Into<String>, extent: Extent) {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::STORAGE | Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC;
        self.image("picture", name, extent, PICTURE_FORMAT, usage);
    }

    /// Sum of the bytes asked for.
    pub fn bytes(&self) -> u64 {
        self.resources.iter().map(Planned::bytes).sum()
    }

    /// Storage buffers that are longer than one binding may be are refused before anything is made.
    ///
    /// Errors: exit code 4, naming the resource and the limit.
    pub fn check(&self, max_storage_buffer_range_bytes: u64) -> Result<()> {
        for planned in &self.resources {
            if let Shape::Buffer { bytes, .. } = planned.shape
                && bytes > max_storage_buffer_range_bytes
            {
                return Err(Error::device(format!(
                    "{} needs {}, and this device binds at most {} at once",
                    planned.name,
                    Bytes(bytes),
                    Bytes(max_storage_buffer_range_bytes)
                ))
                .note("a smaller --size, or a scene with fewer triangles, would fit"));
            }
        }
        Ok(())
    }
}

/// The plan made real: each pass takes its resources out by name.
#[derive(Default)]
pub struct Resources {
    buffers: BTreeMap<String, Buffer>,
    images: BTreeMap<String, Image>,
}

impl Resources {
    /// Makes every resource of the plan.
    ///
    /// Errors: memory is too small or a limit is passed (exit code 4).
    pub fn make(gpu: &Arc<Gpu>, plan: &Plan) -> Result<Self> {
        plan.check(gpu.caps.limits.max_storage_buffer_range_bytes)?;
        let mut resources = Self::default();
        for planned in &plan.resources {
            match planned.shape {
                Shape::Buffer { bytes, flags, usage } => {
                    let buffer = Buffer::new(gpu, &planned.name, planned.group, bytes, flags, usage)?;
                    resources.buffers.insert(planned.name.clone(), buffer);
                }
                Shape::Image(description) => {
                    let image = Image::new(gpu, &planned.name, planned.group, description)?;
                    resources.images.insert(planned.name.clone(), image);
                }
            }
        }
        Ok(resources)
    }

    /// Takes a buffer out. The plan has it: another name is a programmer's mistake.
    pub fn buffer(&mut self, name: &str) -> Buffer {
        self.buffers.remove(name).unwrap_or_else(|| panic!("the plan has no buffer {name}, or it was taken"))
    }

    /// Takes an image out. The plan has it: another name is a programmer's mistake.
    pub fn image(&mut self, name: &str) -> Image {
        self.images.remove(name).unwrap_or_else(|| panic!("the plan has no image {name}, or it was taken"))
    }
}
