//! What a device may lack of what Vulkan 1.3 leaves optional, and the words for it: one table, which `devices` lists. A
//! technique states what it needs of it as data: the same needs refuse a render and are what `devices` says of it.

use super::{Caps, Formats};
use crate::error::Error;

/// Declares the abilities: what Vulkan calls each, what a list of them calls it, and whether caps have it.
macro_rules! abilities {
    ($($(#[$doc:meta])* $ability:ident: $name:literal, $short:literal, $is_there:expr;)+) => {
        /// An optional ability of a device.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Ability {
            $($(#[$doc])* $ability,)+
        }

        impl Ability {
            /// All of them, in the order in which they are listed.
            pub const ALL: &'static [Self] = &[$(Self::$ability),+];

            /// Whether a device of these caps has it.
            pub fn is_there(self, caps: &Caps) -> bool {
                let is_there: fn(&Caps) -> bool = match self {
                    $(Self::$ability => $is_there,)+
                };
                is_there(caps)
            }

            /// Vulkan's words for it.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$ability => $name,)+
                }
            }

            /// A word or a few that follow "has" and "has no".
            pub fn short(self) -> &'static str {
                match self {
                    $(Self::$ability => $short,)+
                }
            }
        }
    };
}

abilities! {
    /// A depth buffer of floats that shaders sample.
    FloatDepth: "D32_SFLOAT as sampled depth attachment", "float depth", |caps| caps.formats.float_depth;
    /// A depth buffer of floats that a sampler filters.
    FilteredDepth: "D32_SFLOAT sampled with linear filtering", "filtered depth", |caps| caps.formats.float_depth_linear;
    /// Depth and stencil in one image.
    DepthWithStencil:
        "D32_SFLOAT_S8_UINT as depth and stencil attachment", "stencils beside float depth",
        |caps| caps.formats.float_depth_with_stencil;
    /// Surfaces blend over a picture of floats.
    BlendFloats:
        "R32G32B32A32_SFLOAT as blended colour attachment", "blending of floats", |caps| caps.formats.float_color_blend;
    /// Surfaces are drawn into pairs of 16-bit fractions.
    FixedPairs: "R16G16_UNORM as colour attachment", "drawn 16-bit fractions", |caps| caps.formats.fixed_pair_color;
    /// The same, blended.
    BlendFixedPairs:
        "R16G16_UNORM as blended colour attachment", "blended 16-bit fractions", |caps| caps.formats.fixed_pair_blend;
    /// Shaders sample four 16-bit fractions a texel.
    FixedQuads:
        "R16G16B16A16_UNORM as sampled image", "sampled 16-bit fractions", |caps| caps.formats.fixed_quad_sampled;
    /// Shaders store two words a texel into an image.
    StoreWordPairs:
        "shaderStorageImageExtendedFormats", "stored pairs of words",
        |caps| caps.features.storage_image_extended_formats;
    /// Fragment shaders count in storage buffers.
    FragmentAtomics:
        "fragmentStoresAndAtomics", "atomics of fragments", |caps| caps.features.fragment_stores_and_atomics;
    /// What lies beyond the far plane is drawn on it.
    DepthClamp: "depthClamp", "clamped depth", |caps| caps.features.depth_clamp;
    /// Floats of colour and depth with 4 samples a pixel.
    FourSamples:
        "4 samples a pixel in float colour and D32_SFLOAT attachments", "4 samples a pixel",
        |caps| has_samples(&caps.formats, 4);
    /// Floats of colour and depth with 8 samples a pixel.
    EightSamples:
        "8 samples a pixel in float colour and D32_SFLOAT attachments", "8 samples a pixel",
        |caps| has_samples(&caps.formats, 8);
    /// Fragment shaders run once a sample.
    SampleShading: "sampleRateShading", "sample shading", |caps| caps.features.sample_rate_shading;
    /// Geometry shaders.
    GeometryShader: "geometryShader", "geometry shaders", |caps| caps.features.geometry_shader;
    /// Vertex shaders choose the layer that is drawn into.
    LayerFromVertex: "shaderOutputLayer", "layers from vertex shaders", |caps| caps.features.layer_from_vertex_shader;
    /// Shaders calculate with floats of 16 bits.
    HalfFloats: "shaderFloat16", "16-bit floats", |caps| caps.features.shader_float16;
    /// Shaders keep the greatest of 64 bits in storage buffers.
    WideAtomics:
        "shaderBufferInt64Atomics with shaderInt64", "64-bit atomics", |caps| caps.features.shader_int64_atomics;
    /// All pixels that a triangle touches are drawn, those of triangles without an area too.
    ConservativeRaster:
        "VK_EXT_conservative_rasterization with degenerateTrianglesRasterized",
        "conservative rasterisation of every triangle",
        |caps| caps.conservative.is_some_and(|rules| rules.draws_degenerate_triangles);
    /// Fragment shaders are told where on its triangle a fragment is.
    FragmentBarycentrics:
        "VK_KHR_fragment_shader_barycentric", "barycentrics of fragments",
        |caps| caps.features.fragment_shader_barycentric;
    /// Samples lie in sixteenths of a pixel where they are told to.
    SampleLocations:
        "VK_EXT_sample_locations at sixteenths of a pixel", "placed samples",
        |caps| !caps.placed_sample_counts().is_empty();
    /// Shaders send rays through structures that the driver builds.
    RayQuery: "VK_KHR_ray_query with VK_KHR_acceleration_structure", "ray queries", |caps| caps.features.ray_query;
    /// Corners are drawn where they are, within 1/256 pixel: depths are of the planes that shadow rays start off.
    FineCorners:
        "subPixelPrecisionBits of at least 8", "corners within 1/256 pixel", |caps| caps.limits.sub_pixel_bits >= 8;
    /// The device counts the samples that a draw leaves.
    PreciseOcclusion: "occlusionQueryPrecise", "exact occlusion queries", |caps| caps.features.occlusion_query_precise;
    /// The device counts what the stages of a pass do.
    PipelineStatistics: "pipelineStatisticsQuery", "pipeline statistics", |caps| caps.features.pipeline_statistics;
    /// The driver says how much of a heap is left.
    MemoryBudget: "VK_EXT_memory_budget", "memory budget", |caps| caps.features.memory_budget;
    /// The device's clock is read between passes.
    Timestamps: "timestamps on the queue", "timestamps", |caps| caps.limits.timestamp_period_ns > 0.0;
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
