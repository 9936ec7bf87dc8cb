//! Plan: what a frame needs, by arithmetic alone: its resources, and how each pass touches which of them.
//!
//! A resource that passes touch is transient: it lives from its first pass to its last, and its bytes may be another's
//! before and after. A resource that no pass lists (lights, trees, the frame's numbers) is written once and kept; what a run
//! leaves for the next one is kept too.

mod lifetimes;
mod requirements;
mod resources;
mod sharing;

pub use lifetimes::{Lifetime, Peak};
pub use requirements::{Requirement, Requirements};
pub use resources::Resources;
pub use sharing::{Part, PlannedArena, Sharing};

use crate::caps::Limits;
use crate::error::{Error, Result};
use crate::gpu::{Access, ImageDescription};
use crate::memory::kinds::Use;
use crate::units::{Bytes, Extent};
use ash::vk;

/// Format of finished pictures.
pub const PICTURE_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// What a resource is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Buffer { bytes: u64, flags: vk::BufferUsageFlags, usage: Use },
    Image(ImageDescription),
}

impl Shape {
    /// Which of host and device write and read it.
    pub fn usage(&self) -> Use {
        match self {
            Self::Buffer { usage, .. } => *usage,
            Self::Image(_) => Use::Device,
        }
    }
}

/// One resource of the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Planned {
    /// Full name, such as `interleaved_deferred.gather.irradiance`.
    pub name: String,
    /// Row of the memory table.
    pub group: &'static str,
    pub shape: Shape,
    /// Needed after the frame: the picture, and stages that the user asked for.
    pub read_back: bool,
    /// Passes of the next run need what this one left.
    pub is_kept: bool,
}

/// One pass's use of one transient resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touch {
    /// Index into `Plan::resources`.
    pub resource: usize,
    pub access: Access,
}

/// A pass, and the transient resources that it touches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlannedPass {
    pub name: String,
    pub touches: Vec<Touch>,
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

/// The resources and the passes of a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    pub resources: Vec<Planned>,
    /// In the order of recording.
    pub passes: Vec<PlannedPass>,
}

impl Plan {
    /// A buffer that the device alone touches, `bytes` long; an empty list gets one element of 16 bytes, because a
    /// shader that never reads it still binds it.
    pub fn buffer(&mut self, group: &'static str, name: impl Into<String>, bytes: u64) {
        let flags = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_DST
            | vk::BufferUsageFlags::TRANSFER_SRC;
        self.push(group, name, Shape::Buffer { bytes: bytes.max(16), flags, usage: Use::Device });
    }

    /// Shaders reach this buffer by its address. Nothing where the plan has none of the name.
    pub fn addressed(&mut self, name: &str) {
        let found = self.resources.iter_mut().find(|planned| planned.name == name);
        if let Some(Planned { shape: Shape::Buffer { flags, .. }, .. }) = found {
            *flags |= vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        }
    }

    /// A buffer that the host writes before a frame, and all of the frame's invocations read.
    pub fn host_buffer(&mut self, group: &'static str, name: impl Into<String>, bytes: u64) {
        let flags = vk::BufferUsageFlags::STORAGE_BUFFER;
        self.push(group, name, Shape::Buffer { bytes, flags, usage: Use::Frame });
    }

    /// Samples of this depth buffer lie where commands place them. A buffer in its place is a programmer's mistake.
    pub fn place_samples(&mut self, name: &str) {
        match &mut self.named(name).shape {
            Shape::Image(description) => description.are_placed = true,
            Shape::Buffer { .. } => panic!("{name} is no image"),
        }
    }

    pub fn push(&mut self, group: &'static str, name: impl Into<String>, shape: Shape) {
        let name = name.into();
        assert!(self.resources.iter().all(|planned| planned.name != name), "{name} is planned twice");
        self.resources.push(Planned { name, group, shape, read_back: false, is_kept: false });
    }

    /// The next pass, with every transient resource that it touches, by full name; a resource that it touches in two
    /// ways stands there twice, in that order.
    pub fn pass(&mut self, name: impl Into<String>, touches: impl IntoIterator<Item = (String, Access)>) {
        let touches = touches
            .into_iter()
            .map(|(resource, access)| Touch { resource: self.index_of(&resource), access })
            .collect();
        self.passes.push(PlannedPass { name: name.into(), touches });
    }

    /// The resource of this name is read back after the frame. False where the plan has none.
    pub fn read_back(&mut self, name: &str) -> bool {
        let index = self.index(name);
        if let Some(index) = index {
            self.resources[index].read_back = true;
        }
        index.is_some()
    }

    /// What a run leaves in the resource of this name, passes of the next one need: its bytes are its own. The plan has it.
    pub fn keep(&mut self, name: &str) {
        self.named(name).is_kept = true;
    }

    fn named(&mut self, name: &str) -> &mut Planned {
        let index = self.index_of(name);
        &mut self.resources[index]
    }

    /// A name that the plan does not have is a programmer's mistake.
    fn index_of(&self, name: &str) -> usize {
        self.index(name).unwrap_or_else(|| panic!("no resource is called {name}"))
    }

    fn index(&self, name: &str) -> Option<usize> {
        self.resources.iter().position(|planned| planned.name == name)
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
        self.multisampled(group, name, extent, format, 1, usage);
    }

    /// The same with `samples` a pixel.
    pub fn multisampled(
        &mut self,
        group: &'static str,
        name: impl Into<String>,
        extent: Extent,
        format: vk::Format,
        samples: u32,
        usage: vk::ImageUsageFlags,
    ) {
        self.push(group, name, Shape::Image(ImageDescription::plain(extent, format, samples, usage)));
    }

    /// An image of one level that is drawn as `format` and that shaders sample as `sampled_as`.
    pub fn reinterpreted(
        &mut self,
        group: &'static str,
        name: impl Into<String>,
        extent: Extent,
        [format, sampled_as]: [vk::Format; 2],
        usage: vk::ImageUsageFlags,
    ) {
        let sampled_as = (sampled_as != format).then_some(sampled_as);
        let description = ImageDescription { sampled_as, ..ImageDescription::plain(extent, format, 1, usage) };
        self.push(group, name, Shape::Image(description));
    }

    /// The finished picture, RGBA32F: shaders store it, BLEND surfaces blend over it, the host reads it.
    pub fn picture(&mut self, name: impl Into<String>, extent: Extent) {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::STORAGE | Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC;
        let name = name.into();
        self.image("picture", name.as_str(), extent, PICTURE_FORMAT, usage);
        self.read_back(&name);
    }

    /// Sum of the bytes asked for.
    pub fn bytes(&self) -> u64 {
        self.resources.iter().map(Planned::bytes).sum()
    }

    /// What a device's limits leave out is refused before anything is made: images that are too large, and storage buffers
    /// that are longer than one binding may be, except those that shaders reach by their addresses.
    ///
    /// Errors: exit code 2 (images) or 4, naming the resource and the limit; what would fit, the technique knows
    /// (`techniques::bindable`).
    pub fn check(&self, limits: &Limits) -> Result<()> {
        let most_bytes = limits.max_storage_buffer_range_bytes;
        for Planned { name, shape, .. } in &self.resources {
            match shape {
                Shape::Image(description) => description.require_within(name, limits)?,
                Shape::Buffer { bytes, flags, .. } => {
                    let is_bound = flags.contains(vk::BufferUsageFlags::STORAGE_BUFFER)
                        && !flags.contains(vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS);
                    if is_bound && *bytes > most_bytes {
                        let [bytes, most] = [*bytes, most_bytes].map(Bytes);
                        return Err(Error::memory(format!(
                            "{name} needs {bytes}, and this device binds at most {most} at once"
                        )));
                    }
                }
            }
        }
        Ok(())
    }
}
