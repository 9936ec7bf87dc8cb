//! What a device may lack of what Vulkan 1.3 leaves optional, and the words for it. A technique states what it needs as
//! data: the same list refuses a render and is what `devices` prints.

use super::{Caps, Formats};
use crate::error::Error;

/// An optional ability of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ability {
    /// A depth buffer of floats that shaders sample.
    FloatDepth,
    /// A depth buffer of floats that a sampler filters.
    FilteredDepth,
    /// Depth and stencil in one image.
    DepthWithStencil,
    /// Surfaces blend over a picture of floats.
    BlendFloats,
    /// Surfaces are drawn into pairs of 16-bit fractions.
    FixedPairs,
    /// Shaders sample four 16-bit fractions a texel.
    FixedQuads,
    /// Shaders store two words a texel into an image.
    StoreWordPairs,
    /// Fragment shaders count in storage buffers.
    FragmentAtomics,
    /// What lies beyond the far plane is drawn on it.
    DepthClamp,
    /// Floats of colour and depth with 4 samples a pixel.
    FourSamples,
    /// Floats of colour and depth with 8 samples a pixel.
    EightSamples,
    /// Geometry shaders.
    GeometryShader,
    /// Vertex shaders choose the layer that is drawn into.
    LayerFromVertex,
    /// Shaders keep the greatest of 64 bits in storage buffers.
    WideAtomics,
    /// All pixels that a triangle touches are drawn, those of triangles without an area too.
    ConservativeRaster,
    /// Shaders send rays through structures that the driver builds.
    RayQuery,
    /// The device counts what the stages of a pass do.
    PipelineStatistics,
}

impl Ability {
    /// Whether a device of these caps has it.
    pub fn is_there(self, caps: &Caps) -> bool {
        match self {
            Self::FloatDepth => caps.formats.float_depth,
            Self::FilteredDepth => caps.formats.float_depth_linear,
            Self::DepthWithStencil => caps.formats.float_depth_with_stencil,
            Self::BlendFloats => caps.formats.float_color_blend,
            Self::FixedPairs => caps.formats.fixed_pair_color,
            Self::FixedQuads => caps.formats.fixed_quad_sampled,
            Self::StoreWordPairs => caps.features.storage_image_extended_formats,
            Self::FragmentAtomics => caps.features.fragment_stores_and_atomics,
            Self::DepthClamp => caps.features.depth_clamp,
            Self::FourSamples => has_samples(&caps.formats, 4),
            Self::EightSamples => has_samples(&caps.formats, 8),
            Self::GeometryShader => caps.features.geometry_shader,
            Self::WideAtomics => caps.features.shader_int64_atomics,
            Self::LayerFromVertex => caps.features.layer_from_vertex_shader,
            Self::ConservativeRaster => caps.conservative.is_some_and(|rules| rules.draws_degenerate_triangles),
            Self::RayQuery => caps.features.ray_query,
            Self::PipelineStatistics => caps.features.pipeline_statistics,
        }
    }

    /// Vulkan's words for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::FloatDepth => "D32_SFLOAT as sampled depth attachment",
            Self::FilteredDepth => "D32_SFLOAT sampled with linear filtering",
            Self::DepthWithStencil => "D32_SFLOAT_S8_UINT as depth and stencil attachment",
            Self::BlendFloats => "R32G32B32A32_SFLOAT as blended colour attachment",
            Self::FixedPairs => "R16G16_UNORM as colour attachment",
            Self::FixedQuads => "R16G16B16A16_UNORM as sampled image",
            Self::StoreWordPairs => "shaderStorageImageExtendedFormats",
            Self::FragmentAtomics => "fragmentStoresAndAtomics",
            Self::DepthClamp => "depthClamp",
            Self::FourSamples => "4 samples a pixel in float colour and D32_SFLOAT attachments",
            Self::EightSamples => "8 samples a pixel in float colour and D32_SFLOAT attachments",
            Self::GeometryShader => "geometryShader",
            Self::WideAtomics => "shaderBufferInt64Atomics with shaderInt64",
            Self::LayerFromVertex => "shaderOutputLayer",
            Self::ConservativeRaster => "VK_EXT_conservative_rasterization with degenerateTrianglesRasterized",
            Self::RayQuery => "VK_KHR_ray_query with VK_KHR_acceleration_structure",
            Self::PipelineStatistics => "pipelineStatisticsQuery",
        }
    }
}

fn has_samples(formats: &Formats, count: u32) -> bool {
    let Formats { float_color_sample_counts, half_color_sample_counts, float_depth_sample_counts, .. } = formats;
    [float_color_sample_counts, half_color_sample_counts, float_depth_sample_counts]
        .iter()
        .all(|counts| counts.contains(&count))
}

/// Something that cannot be made without an ability.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// What needs it: a setting such as `--split stencil`, or a part of every frame.
    pub of: String,
    pub ability: Ability,
    /// What works without it; empty where nothing does.
    pub instead: &'static str,
}

impl Need {
    /// Whether a device of these caps can do it.
    pub fn is_met(&self, caps: &Caps) -> bool {
        self.ability.is_there(caps)
    }

    /// The error where it is not met (exit code 3).
    pub fn refusal(&self, caps: &Caps) -> Error {
        let (device, driver, ability) = (&caps.identity.name, caps.identity.driver_text(), self.ability.name());
        let error = Error::no_device(format!("{} needs {ability}, which {device} on {driver} lacks", self.of));
        let error = if self.instead.is_empty() { error } else { error.note(self.instead) };
        error.note("`quincunx devices` lists what each device can do")
    }
}
