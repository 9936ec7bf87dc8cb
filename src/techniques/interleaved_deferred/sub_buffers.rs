//! Sub-buffers in device memory, and the block layout between two passes: buffers, an image, or an array of layers. The
//! mirror of sub_buffers.glsl, which names the bindings.
//!
//! A copy states how it writes and reads by its `Stage`: compute shaders store, fragment programs draw; what lies in
//! images is read through a sampler that never filters.

use crate::error::Result;
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::{Access, AccessSet, Barrier, Bound, Buffer, Edge, Gpu, Image, ImageDescription, readback};
use crate::passes::gbuffer::SurfaceParts;
use crate::plan::{Plan, Resources, Shape};
use crate::settings::PositionStorage;
use crate::techniques::interleaved_deferred::resources::NAME;
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

/// How sub-buffers lie in memory (`--storage`, and `--split layered`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// One after the other in a storage buffer.
    Buffer,
    /// Tiled side by side in one image (figure 3).
    Image,
    /// A layer each of one image.
    Layers,
}

/// What runs on each texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    Compute,
    Fragment,
}

impl Stage {
    /// How it reads an image.
    pub fn samples(self) -> Access {
        match self {
            Self::Compute => Access::ComputeSample,
            Self::Fragment => Access::FragmentSample,
        }
    }

    /// How it reads a buffer.
    pub fn reads(self) -> Access {
        match self {
            Self::Compute => Access::ComputeRead,
            Self::Fragment => Access::GraphicsRead,
        }
    }
}

impl Storage {
    /// The value of the shaders' axis STORAGE.
    pub fn name(self) -> &'static str {
        match self {
            Self::Buffer => "buffer",
            Self::Image => "image",
            Self::Layers => "layers",
        }
    }

    /// How `stage` writes it.
    pub fn written(self, stage: Stage) -> Access {
        match stage {
            Stage::Compute => Access::ComputeWrite,
            Stage::Fragment => Access::ColorWrite,
        }
    }

    /// How `stage` reads it.
    pub fn read(self, stage: Stage) -> Access {
        match self {
            Self::Buffer => Access::ComputeRead,
            Self::Image | Self::Layers => stage.samples(),
        }
    }

    /// Plans texels of 4, 8 or 16 bytes for all sub-buffers, which `writer` will write.
    pub fn plan(
        self,
        plan: &mut Plan,
        group: &'static str,
        what: &str,
        mapping: &MappingParams,
        texel_bytes: u64,
        writer: Stage,
    ) {
        use vk::ImageUsageFlags as Usage;
        let name = format!("{NAME}.{what}");
        let (extent, layer_count) = match self {
            Self::Buffer => return plan.buffer(group, name, mapping.texel_count() * texel_bytes),
            Self::Image => (mapping.padded(), None),
            Self::Layers => (Extent::new(mapping.sub_width_px, mapping.sub_height_px), Some(mapping.subset_count())),
        };
        let written = if writer == Stage::Fragment { Usage::COLOR_ATTACHMENT } else { Usage::STORAGE };
        let usage = written | Usage::SAMPLED | Usage::TRANSFER_SRC;
        let format = words_format(texel_bytes);
        plan.push(
            group,
            name,
            Shape::Image(ImageDescription { layer_count, ..ImageDescription::plain(extent, format, 1, usage) }),
        );
    }
}

/// The format of texels of 4, 8 or 16 bytes: whole words, which every driver keeps bit for bit.
pub fn words_format(texel_bytes: u64) -> vk::Format {
    match texel_bytes {
        4 => vk::Format::R32_UINT,
        8 => vk::Format::R32G32_UINT,
        16 => vk::Format::R32G32B32A32_UINT,
        other => panic!("no texel has {other} bytes"),
    }
}

/// The texels of all sub-buffers.
pub enum Texels {
    Buffer(Buffer),
    Image(Image, Sampler),
}

impl Texels {
    /// Takes what `Storage::plan` put in.
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, what: &str, storage: Storage) -> Result<Self> {
        let name = format!("{NAME}.{what}");
        Ok(match storage {
            Storage::Buffer => Self::Buffer(resources.buffer(&name)),
            Storage::Image | Storage::Layers => {
                Self::Image(resources.image(&name), Sampler::clamped(gpu, vk::Filter::NEAREST)?)
            }
        })
    }

    /// Names the access that touched them last.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    /// First touch of the frame, old contents not needed.
    pub fn discard(&self, access: Access) -> Barrier {
        match self {
            Self::Buffer(buffer) => buffer.discard(access),
            Self::Image(image, _) => image.discard(access),
        }
    }

    /// As a source of sub_buffers.glsl.
    pub fn source(&self) -> Bound<'_> {
        match self {
            Self::Buffer(buffer) => Bound::Buffer(buffer),
            // The layout is the same for fragment programs.
            Self::Image(image, sampler) => Bound::Sampled(image, sampler.handle, Access::ComputeSample),
        }
    }

    /// As a target of sub_buffers.glsl.
    pub fn target(&self) -> Bound<'_> {
        match self {
            Self::Buffer(buffer) => Bound::Buffer(buffer),
            Self::Image(image, _) => Bound::Storage(image),
        }
    }

    /// As a colour attachment. Fragment programs draw into images only.
    pub fn attachment(&self) -> &Image {
        match self {
            Self::Buffer(buffer) => panic!("{} is no image", buffer.name),
            Self::Image(image, _) => image,
        }
    }

    /// Their bytes after a frame; `last`: how the frame touched them last.
    pub fn read(&self, gpu: &Arc<Gpu>, last: Access) -> Result<Vec<u8>> {
        match self {
            Self::Buffer(buffer) => readback::buffer(gpu, buffer, buffer.bytes, last),
            Self::Image(image, _) => readback::image(gpu, image, last),
        }
    }

    /// Index of a pixel's texel in what `read` gives.
    pub fn index_of(&self, mapping: &MappingParams, pixel: [u32; 2]) -> usize {
        let texel = mapping.texel_of_pixel(pixel);
        match self {
            Self::Image(image, _) if image.description.layer_count.is_none() => {
                let [x, y] = mapping.tiled_of(texel);
                y as usize * image.description.extent.width as usize + x as usize
            }
            // Layers come one after the other, as sub-buffers in a buffer do.
            Self::Image(..) | Self::Buffer(_) => mapping.linear_of(texel) as usize,
        }
    }
}

impl Edge<'_, Texels> {
    /// The next access: the right side.
    pub fn to(self, access: Access) -> Barrier {
        match self.resource {
            Texels::Buffer(buffer) => buffer.from(self.from).to(access),
            Texels::Image(image, _) => image.from(self.from).to(access),
        }
    }
}

/// What a split moves, and how it lies and is written there.
#[derive(Clone, Copy)]
pub struct Moved {
    pub parts: SurfaceParts,
    pub storage: Storage,
    pub position: PositionStorage,
    pub writer: Stage,
}

/// Position and normal of each texel: what irradiance needs; and colour where splits move it, as the paper's do.
pub struct Surface {
    pub position: Texels,
    pub normal: Texels,
    pub color: Option<Texels>,
    /// What there is of a texel, and its bytes.
    pub parts: SurfaceParts,
    pub texel_bytes: u64,
}

/// Parts of sub-buffers, in the order of fragment.frag's locations.
fn part_names(parts: SurfaceParts) -> &'static [&'static str] {
    if parts.has_color() { &["position", "normal", "color"] } else { &["position", "normal"] }
}

/// Bytes of a texel's `parts`: what few materials say lies in the colour's spare bits.
pub fn texel_bytes(parts: SurfaceParts, position: PositionStorage) -> u64 {
    position.bytes() + 8 + if parts.has_color() { 8 } else { 0 }
}

impl Surface {
    /// Plans `what`.position, `what`.normal and what else `parts` have.
    pub fn plan(plan: &mut Plan, what: &str, mapping: &MappingParams, moved: &Moved) {
        let Moved { parts, storage, position, writer } = *moved;
        for part in part_names(parts) {
            let bytes = if *part == "position" { position.bytes() } else { 8 };
            storage.plan(plan, "split", &format!("{what}.{part}"), mapping, bytes, writer);
        }
    }

    /// What a pass touches that touches `parts` in one way.
    pub fn touches(what: &str, parts: SurfaceParts, access: Access) -> impl Iterator<Item = (String, Access)> {
        part_names(parts).iter().map(move |part| (format!("{NAME}.{what}.{part}"), access))
    }

    /// Takes what `plan` put in.
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, what: &str, moved: &Moved) -> Result<Self> {
        let Moved { parts, storage, position, .. } = *moved;
        let texel_bytes = texel_bytes(parts, position);
        let mut texels = |part: &str| Texels::new(gpu, resources, &format!("{what}.{part}"), storage);
        let color = parts.has_color().then(|| texels("color")).transpose()?;
        Ok(Self { position: texels("position")?, normal: texels("normal")?, color, parts, texel_bytes })
    }

    /// Names the access that touched all parts last.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    /// All parts, in the order of fragment.frag's locations.
    pub fn all(&self) -> impl Iterator<Item = &Texels> {
        [&self.position, &self.normal].into_iter().chain(&self.color)
    }

    /// Those of its parts that are among `parts`.
    fn some(&self, parts: SurfaceParts) -> impl Iterator<Item = &Texels> {
        self.all().take(part_names(parts).len())
    }

    /// First touch of the frame, old contents not needed.
    pub fn discard(&self, access: Access) -> impl Iterator<Item = Barrier> {
        self.all().map(move |texels| texels.discard(access))
    }

    /// What READS_SURFACE binds of `parts`.
    pub fn source(&self, parts: SurfaceParts) -> impl Iterator<Item = (&'static str, Bound<'_>)> {
        ["source_position", "source_normal", "source_color"].into_iter().zip(self.some(parts).map(Texels::source))
    }

    /// What WRITES_SURFACE binds.
    pub fn target(&self) -> impl Iterator<Item = (&'static str, Bound<'_>)> {
        ["target_position", "target_normal", "target_color"].into_iter().zip(self.all().map(Texels::target))
    }
}

impl Edge<'_, Surface> {
    /// The next access of `parts`.
    pub fn to(self, parts: SurfaceParts, access: Access) -> Vec<Barrier> {
        self.resource.some(parts).map(|texels| texels.from(self.from).to(access)).collect()
    }
}
