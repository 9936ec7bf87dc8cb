//! An image: handle, view, description, allocation.

use super::access::AccessSet;
use super::marks::Marked;
use super::marks::shape::Texels;
use super::{Berth, Gpu};
use crate::caps::Limits;
use crate::error::{Error, Result};
use crate::memory::kinds::Use;
use crate::memory::{Allocation, Request, Tiling};
use crate::units::{Bytes, Extent};
use ash::vk;
use std::mem::ManuallyDrop;
use std::sync::Arc;

/// A two-dimensional image, an array of them, a cube of six, or a three-dimensional one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageDescription {
    pub extent: Extent,
    pub format: vk::Format,
    /// What shaders sample its texels as, of as many bytes each; None: as they are.
    pub sampled_as: Option<vk::Format>,
    pub level_count: u32,
    /// None: a plain image. Some: an array of so many layers, whose views are arrays, of one layer too.
    pub layer_count: Option<u32>,
    /// Six layers, square, are the faces of a cube, which shaders look up by directions.
    pub is_cube: bool,
    /// None: a flat image. Some: a three-dimensional one, so many texels deep, of one level, one layer and one sample.
    pub depth: Option<u32>,
    /// Samples a pixel: 1, or another power of two where the image has one level and is only drawn into, resolved, and fetched.
    pub samples: u32,
    /// They lie where `Commands::place_samples` says, which changes of a depth buffer's layout must know.
    pub are_placed: bool,
    pub usage: vk::ImageUsageFlags,
}

impl ImageDescription {
    /// An image of one level and one layer, sampled as it is.
    pub fn plain(extent: Extent, format: vk::Format, samples: u32, usage: vk::ImageUsageFlags) -> Self {
        Self {
            extent,
            format,
            sampled_as: None,
            level_count: 1,
            layer_count: None,
            is_cube: false,
            depth: None,
            samples,
            are_placed: false,
            usage,
        }
    }

    /// Layers, of a plain image one.
    pub fn layers(&self) -> u32 {
        self.layer_count.unwrap_or(1)
    }

    /// Texels from front to back, of a flat image one.
    pub fn slices(&self) -> u32 {
        self.depth.unwrap_or(1)
    }

    /// The texels in granules.
    fn texels(&self, granule_bytes: u64) -> Texels {
        let Self { extent: Extent { width, height }, level_count: levels, samples, .. } = *self;
        let layers = self.layers() * self.slices() * samples;
        Texels { layers, levels, samples, ..Texels::new([width, height], texel_bytes(self.format), granule_bytes) }
    }

    /// Bytes by arithmetic, all levels, layers, slices and samples; what the driver requires may be more.
    pub fn bytes(&self) -> u64 {
        let layer_bytes: u64 = (0..self.level_count)
            .map(|level| {
                let width = u64::from((self.extent.width >> level).max(1));
                let height = u64::from((self.extent.height >> level).max(1));
                width * height * u64::from(texel_bytes(self.format))
            })
            .sum();
        layer_bytes * u64::from(self.layers()) * u64::from(self.slices()) * u64::from(self.samples)
    }

    /// How its texels lie in memory: as `gpu` was asked for, if the driver makes such an image, and does with it all that it does with others
    /// of its formats.
    pub fn tiling(&self, gpu: &Gpu) -> Tiling {
        let Self { extent, format, level_count, samples, .. } = *self;
        let makes = |most: vk::ImageFormatProperties| {
            let sides = [(extent.width, most.max_extent.width), (extent.height, most.max_extent.height)];
            sides.iter().chain(&[(self.slices(), most.max_extent.depth)]).all(|(side, most)| side <= most)
                && level_count <= most.max_mip_levels
                && self.layers() <= most.max_array_layers
                && most.sample_counts.contains(vk::SampleCountFlags::from_raw(samples))
                && self.bytes() <= most.max_resource_size
        };
        let is_linear = gpu.image_tiling == Tiling::Linear
            && [Some(format), Some(storage_format(format)), self.sampled_as]
                .into_iter()
                .flatten()
                .all(|format| gpu.is_as_able_linear(format))
            && gpu.image_properties(&self.create_info(Tiling::Linear)).is_some_and(makes);
        if is_linear { Tiling::Linear } else { Tiling::Optimal }
    }

    fn create_info(&self, tiling: Tiling) -> vk::ImageCreateInfo<'static> {
        let Self { extent, format, level_count, samples, usage, .. } = *self;
        let is_stored_otherwise = usage.contains(vk::ImageUsageFlags::STORAGE) && storage_format(format) != format;
        let reinterpreted = is_stored_otherwise || self.sampled_as.is_some();
        let flag = |flag, is_set| if is_set { flag } else { vk::ImageCreateFlags::empty() };
        let flags = flag(vk::ImageCreateFlags::MUTABLE_FORMAT, reinterpreted)
            | flag(vk::ImageCreateFlags::CUBE_COMPATIBLE, self.is_cube)
            | flag(vk::ImageCreateFlags::SAMPLE_LOCATIONS_COMPATIBLE_DEPTH_EXT, self.are_placed);
        vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(if self.depth.is_some() { vk::ImageType::TYPE_3D } else { vk::ImageType::TYPE_2D })
            .format(format)
            .extent(vk::Extent3D { width: extent.width, height: extent.height, depth: self.slices() })
            .mip_levels(level_count)
            .array_layers(self.layers())
            .samples(vk::SampleCountFlags::from_raw(samples))
            .tiling(match tiling {
                Tiling::Optimal => vk::ImageTiling::OPTIMAL,
                Tiling::Linear => vk::ImageTiling::LINEAR,
            })
            .usage(usage)
    }

    /// Errors: a side or the layers of image `name` are beyond the device's limits (exit code 2).
    pub fn require_within(&self, name: &str, limits: &Limits) -> Result<()> {
        let drawn = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        let is_drawn = self.usage.intersects(drawn);
        let [width, height] = if is_drawn { limits.most_drawn_px() } else { [limits.max_image_side_px; 2] };
        let (extent, layers, most_layers) = (self.extent, self.layers(), limits.max_image_layers);
        if let Some(depth) = self.depth {
            let most = limits.max_volume_side_px;
            if extent.width.max(extent.height).max(depth) > most {
                return Err(Error::request(format!(
                    "{name}: {extent}x{depth} texels: this device allows {most} a side of a three-dimensional image"
                )));
            }
        }
        if extent.width > width || extent.height > height {
            return Err(Error::request(format!("{name}: {extent} pixels: this device allows {width} x {height}")));
        }
        if layers > most_layers {
            return Err(Error::request(format!(
                "{name}: {layers} layers: this device allows {most_layers} in an image"
            )));
        }
        Ok(())
    }

    /// The most bytes that the driver lets such an image have, whatever its extent; 0 where it makes none.
    pub fn greatest_bytes(&self, gpu: &Gpu) -> u64 {
        let most = gpu.image_properties(&self.create_info(self.tiling(gpu)));
        most.map_or(0, |most| most.max_resource_size)
    }

    /// What the driver requires of memory for such an image, without making one.
    pub fn requirements(&self, gpu: &Gpu) -> vk::MemoryRequirements {
        let info = self.create_info(self.tiling(gpu));
        let query = vk::DeviceImageMemoryRequirements::default().create_info(&info);
        let mut found = vk::MemoryRequirements2::default();
        // SAFETY: a live device with maintenance4; the info outlives the call.
        unsafe { gpu.device.get_device_image_memory_requirements(&query, &mut found) };
        found.memory_requirements
    }
}

/// Bytes of a texel of the formats that this program uses.
pub fn texel_bytes(format: vk::Format) -> u32 {
    match format {
        vk::Format::R8_UINT => 1,
        vk::Format::R16_UINT => 2,
        vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB => 4,
        vk::Format::R16G16_UINT | vk::Format::R16G16_UNORM => 4,
        vk::Format::R32_UINT | vk::Format::R32_SFLOAT | vk::Format::D32_SFLOAT => 4,
        // Some drivers hold depth and stencil in 8: that is theirs to say.
        vk::Format::D32_SFLOAT_S8_UINT => 5,
        vk::Format::R32G32_UINT | vk::Format::R16G16B16A16_SFLOAT | vk::Format::R16G16B16A16_UNORM => 8,
        vk::Format::R32G32B32A32_SFLOAT | vk::Format::R32G32B32A32_UINT => 16,
        other => panic!("format {other:?} is not in the program's vocabulary"),
    }
}

/// The format through which shaders store into an image: halves and fractions as integers, because drivers round them
/// differently.
fn storage_format(format: vk::Format) -> vk::Format {
    match format {
        vk::Format::R16G16B16A16_SFLOAT | vk::Format::R16G16B16A16_UNORM => vk::Format::R32G32_UINT,
        other => other,
    }
}

/// An image with its memory and its views; all end when it is dropped, after the fence of its last frame.
pub struct Image {
    gpu: Arc<Gpu>,
    pub handle: vk::Image,
    pub view: vk::ImageView,
    /// The same texels as shaders store them; `view` itself where the formats are one.
    pub storage_view: vk::ImageView,
    /// One of each layer, to draw into; of a plain image, and of one that is never attached, none.
    pub layer_views: Vec<vk::ImageView>,
    /// What shaders sample: of depth with stencil the depth alone; the texels as another format; else `view` itself.
    pub sampled_view: vk::ImageView,
    pub name: String,
    pub description: ImageDescription,
    /// Last accesses of the resource that had its bytes before it in the frame.
    pub(super) takes_over: AccessSet,
    /// Where it is counted what touches it; None: nobody counts.
    pub marked: Option<Arc<Marked>>,
    allocation: ManuallyDrop<Allocation>,
}

/// Views of one image.
struct Views {
    view: vk::ImageView,
    storage: vk::ImageView,
    sampled: vk::ImageView,
    layers: Vec<vk::ImageView>,
}

impl Image {
    /// Makes an image in device memory, in bytes from `berth`.
    ///
    /// Errors: a side or the layers are beyond the device's limit (exit code 2); the driver or the memory refuses (4).
    pub fn at(
        gpu: &Arc<Gpu>,
        name: &str,
        group: &str,
        description: ImageDescription,
        berth: Berth<'_>,
    ) -> Result<Self> {
        let ImageDescription { extent, format, .. } = description;
        description.require_within(name, &gpu.caps.limits)?;
        let info = description.create_info(description.tiling(gpu));
        let (bytes, most) = (description.bytes(), description.greatest_bytes(gpu));
        if bytes > most {
            return Err(Error::memory(format!(
                "{name} ({extent}, {format:?}) needs {}, and this device makes such images up to {}",
                Bytes(bytes),
                Bytes(most)
            ))
            .note("a smaller --size would fit"));
        }
        // SAFETY: a live device; the info has no pointers.
        let handle = unsafe { gpu.device.create_image(&info, None) }
            .map_err(|result| Error::device(format!("creating image {name} ({extent}, {format:?}): {result}")))?;
        // First, for what is bound has views, which nobody else would destroy.
        let marked =
            gpu.marks.as_ref().map(|marks| marks.image(name, description.texels(marks.granule_bytes()))).transpose();
        match marked.and_then(|marked| Ok((Self::bind(gpu, name, group, description, handle, berth)?, marked))) {
            Ok(((allocation, Views { view, storage, sampled, layers }), marked)) => {
                gpu.name(handle, name);
                gpu.name(view, name);
                let (name, allocation) = (name.to_owned(), ManuallyDrop::new(allocation));
                let (gpu, takes_over) = (gpu.clone(), berth.takes_over());
                Ok(Self {
                    gpu,
                    handle,
                    view,
                    storage_view: storage,
                    layer_views: layers,
                    sampled_view: sampled,
                    name,
                    description,
                    takes_over,
                    marked,
                    allocation,
                })
            }
            Err(error) => {
                // SAFETY: never used.
                unsafe { gpu.device.destroy_image(handle, None) };
                Err(error)
            }
        }
    }

    fn bind(
        gpu: &Arc<Gpu>,
        name: &str,
        group: &str,
        description: ImageDescription,
        handle: vk::Image,
        berth: Berth<'_>,
    ) -> Result<(Allocation, Views)> {
        // SAFETY: the image was made from this device.
        let requirements = unsafe { gpu.device.get_image_memory_requirements(handle) };
        let bytes = description.bytes();
        let tiling = description.tiling(gpu);
        let request = Request { name, group, bytes, requirements, usage: Use::Device, tiling };
        let allocation = berth.allocate(&gpu.memory, &request)?;
        // SAFETY: fresh memory of an allowed type, in bounds, bound once.
        unsafe { gpu.device.bind_image_memory(handle, allocation.handle, allocation.offset) }
            .map_err(|result| Error::device(format!("binding image {name}: {result}")))?;
        let whole = vk::ImageSubresourceRange::default()
            .aspect_mask(aspect_of(description.format))
            .level_count(description.level_count)
            .layer_count(description.layers());
        let view_type = match description {
            ImageDescription { depth: Some(_), .. } => vk::ImageViewType::TYPE_3D,
            ImageDescription { is_cube: true, .. } => vk::ImageViewType::CUBE,
            ImageDescription { layer_count: Some(_), .. } => vk::ImageViewType::TYPE_2D_ARRAY,
            _ => vk::ImageViewType::TYPE_2D,
        };
        let view_as = |format, usage, range| {
            let mut usage = vk::ImageViewUsageCreateInfo::default().usage(usage);
            let info = vk::ImageViewCreateInfo::default()
                .image(handle)
                .view_type(view_type)
                .format(format)
                .subresource_range(range)
                .push_next(&mut usage);
            // SAFETY: a bound image of this device; the format is its own or one that MUTABLE_FORMAT allows.
            unsafe { gpu.device.create_image_view(&info, None) }
                .map_err(|result| Error::device(format!("creating a view of image {name}: {result}")))
        };
        let (format, usage) = (description.format, description.usage);
        let is_stored_otherwise = usage.contains(vk::ImageUsageFlags::STORAGE) && storage_format(format) != format;
        let is_sampled_in_part =
            usage.contains(vk::ImageUsageFlags::SAMPLED) && format == vk::Format::D32_SFLOAT_S8_UINT;
        let mut own_usage = if is_stored_otherwise { usage & !vk::ImageUsageFlags::STORAGE } else { usage };
        if description.sampled_as.is_some() {
            assert!(!is_stored_otherwise, "{name}: an image is drawn or stored and sampled as another format, not all");
            own_usage &= !vk::ImageUsageFlags::SAMPLED;
        }
        let view = view_as(format, own_usage, whole)?;
        let other = if is_stored_otherwise {
            view_as(storage_format(format), vk::ImageUsageFlags::STORAGE, whole)
        } else if let Some(sampled_as) = description.sampled_as {
            assert_eq!(texel_bytes(sampled_as), texel_bytes(format), "{name} is sampled as texels of another size");
            view_as(sampled_as, vk::ImageUsageFlags::SAMPLED, whole)
        } else if is_sampled_in_part {
            view_as(format, vk::ImageUsageFlags::SAMPLED, whole.aspect_mask(vk::ImageAspectFlags::DEPTH))
        } else {
            Ok(view)
        };
        let attached = usage & (vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT);
        let layer_count = if attached.is_empty() { 0 } else { description.layer_count.unwrap_or_default() };
        let mut layers = Vec::new();
        let mut made = vec![view];
        let all = other.and_then(|other| {
            made.extend((other != view).then_some(other));
            for layer in 0..layer_count {
                layers.push(view_as(format, attached, whole.base_array_layer(layer).layer_count(1))?);
            }
            Ok(other)
        });
        match all {
            Ok(other) => {
                let storage = if is_stored_otherwise { other } else { view };
                let sampled = if is_sampled_in_part || description.sampled_as.is_some() { other } else { view };
                Ok((allocation, Views { view, storage, sampled, layers }))
            }
            Err(error) => {
                // SAFETY: never used.
                unsafe { made.into_iter().chain(layers).for_each(|view| gpu.device.destroy_image_view(view, None)) };
                Err(error)
            }
        }
    }

    pub(super) fn aspect(&self) -> vk::ImageAspectFlags {
        aspect_of(self.description.format)
    }

    /// All of a level, every layer, for copies.
    pub(super) fn whole_level(&self, level: u32) -> vk::ImageSubresourceLayers {
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(self.aspect());
        layers.mip_level(level).layer_count(self.description.layers())
    }
}

fn aspect_of(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
        vk::Format::D32_SFLOAT_S8_UINT => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: the frame's fence was waited for; view, image, memory in this order, each once.
        unsafe {
            self.layer_views.iter().for_each(|layer| self.gpu.device.destroy_image_view(*layer, None));
            for other in [self.storage_view, self.sampled_view].into_iter().filter(|other| *other != self.view) {
                self.gpu.device.destroy_image_view(other, None);
            }
            self.gpu.device.destroy_image_view(self.view, None);
            self.gpu.device.destroy_image(self.handle, None);
            ManuallyDrop::drop(&mut self.allocation);
        }
    }
}
