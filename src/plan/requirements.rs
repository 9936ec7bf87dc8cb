//! What a driver asks for a resource: bytes, alignment, memory types. A device is asked; without one, the rules of a known
//! driver are applied, which stand in its caps (`assets/caps/`).

use super::Shape;
use crate::caps::LayoutRules;
use crate::error::{Error, Result};
use crate::gpu::image::texel_bytes;
use crate::gpu::structure::Over;
use crate::gpu::{Buffer, Gpu, ImageDescription};
use crate::memory::Tiling;
use ash::vk;

/// A driver's answer for one resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Requirement {
    /// At least the bytes asked for.
    pub bound_bytes: u64,
    /// A power of two.
    pub alignment_bytes: u64,
    /// A bit for each memory type that it may lie in.
    pub memory_type_bits: u32,
    /// That of a buffer is linear.
    pub tiling: Tiling,
}

/// Source of the answers.
#[derive(Clone, Copy)]
pub enum Requirements<'a> {
    Device(&'a Gpu),
    Rules(&'a LayoutRules),
}

impl Requirements<'_> {
    /// Memory that `shape` takes.
    pub fn of(&self, shape: &Shape) -> Requirement {
        match (self, shape) {
            (Self::Device(gpu), Shape::Buffer { bytes, flags, .. }) => {
                Requirement::of(Buffer::requirements(gpu, *bytes, *flags), Tiling::Linear)
            }
            (Self::Device(gpu), Shape::Image(description)) => {
                Requirement::of(description.requirements(gpu), description.tiling(gpu))
            }
            (Self::Rules(rules), Shape::Buffer { bytes, flags, .. }) => Requirement {
                bound_bytes: bytes.next_multiple_of(rules.buffer_size_multiple_bytes),
                alignment_bytes: match flags.contains(vk::BufferUsageFlags::STORAGE_BUFFER) {
                    true => rules.buffer_alignment_bytes,
                    false => rules.vertex_buffer_alignment_bytes,
                },
                memory_type_bits: rules.memory_type_bits,
                tiling: Tiling::Linear,
            },
            (Self::Rules(rules), Shape::Image(description)) => Requirement {
                bound_bytes: image_bytes(rules, description),
                alignment_bytes: rules.image_alignment_bytes,
                memory_type_bits: rules.memory_type_bits,
                tiling: Tiling::Optimal,
            },
        }
    }

    /// The most bytes that an image like this one may have; no bound where none is known.
    pub fn greatest_image_bytes(&self, description: &ImageDescription) -> u64 {
        match self {
            Self::Device(gpu) => description.greatest_bytes(gpu),
            Self::Rules(_) => u64::MAX,
        }
    }

    /// Bytes that an acceleration structure takes; the device has ray queries, or the rules' driver has.
    ///
    /// Errors: it has not been measured how large the rules' driver makes them (exit code 2).
    pub fn structure_bytes(&self, over: Over) -> Result<u64> {
        match self {
            Self::Device(gpu) => Ok(over.sizes(gpu).structure_bytes),
            Self::Rules(rules) => rules.structures.as_ref().map(|rules| over.bytes(rules)).ok_or_else(|| {
                Error::request("--rays query: only the driver says how large an acceleration structure is")
                    .note("without --plan the device is asked; --rays tree can be planned without a device")
            }),
        }
    }
}

/// Each level with its rows and its height rounded up, as often as there are layers and samples.
fn image_bytes(rules: &LayoutRules, description: &ImageDescription) -> u64 {
    let texel = u64::from(match description.format {
        vk::Format::D32_SFLOAT_S8_UINT => rules.depth_stencil_texel_bytes,
        format => texel_bytes(format),
    });
    let layer_bytes: u64 = (0..description.level_count)
        .map(|level| {
            let side = |px: u32| u64::from((px >> level).max(1));
            let row = (side(description.extent.width).next_multiple_of(rules.image_width_multiple_px) * texel)
                .next_multiple_of(rules.image_row_multiple_bytes);
            row * side(description.extent.height).next_multiple_of(rules.image_height_multiple_px)
        })
        .sum();
    (layer_bytes * u64::from(description.layers()) * u64::from(description.samples))
        .next_multiple_of(rules.image_size_multiple_bytes)
}

impl Requirement {
    fn of(answer: vk::MemoryRequirements, tiling: Tiling) -> Self {
        Self {
            bound_bytes: answer.size,
            alignment_bytes: answer.alignment.max(1),
            memory_type_bits: answer.memory_type_bits,
            tiling,
        }
    }
}
