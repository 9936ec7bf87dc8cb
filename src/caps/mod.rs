//! What a device can do, as plain data: looked up once, printed by `devices`, and read by a Plan that needs no device.

pub mod file;
pub mod known;
pub mod needs;
pub mod quirks;

pub use needs::{Ability, Need};

use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A device's identity, limits, optional features and memory, without Vulkan types.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Caps {
    pub identity: Identity,
    pub limits: Limits,
    pub features: Features,
    pub formats: Formats,
    /// None: there is no VK_EXT_conservative_rasterization, or it was not looked up.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conservative: Option<ConservativeRules>,
    /// None: there is no VK_EXT_sample_locations, or it was not looked up.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample_locations: Option<SampleLocationRules>,
    pub heaps: Vec<Heap>,
    pub memory_types: Vec<MemoryType>,
    /// There for drivers on which it was measured only; a live device is asked instead.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<LayoutRules>,
}

impl Caps {
    /// Bytes that the largest heap may hold under `--memory-budget`; None: as many as it has.
    pub fn budget_bytes(&self, asked: Option<u64>) -> u64 {
        let heap_bytes = self.heaps.iter().map(|heap| heap.bytes).max().unwrap_or_default();
        heap_bytes.min(asked.unwrap_or(u64::MAX))
    }

    /// The same with heaps that nothing fills: those of a known driver are those of the machine that it was measured on.
    pub fn with_endless_heaps(&self) -> Self {
        let mut endless = self.clone();
        endless.heaps.iter_mut().for_each(|heap| heap.bytes = u64::MAX);
        endless
    }

    /// Numbers of samples a pixel, more than one and rising, that can be placed at sixteenths of it in pictures of floats and in depth
    /// buffers.
    pub fn placed_sample_counts(&self) -> Vec<u32> {
        let Formats { float_color_sample_counts, float_depth_sample_counts, .. } = &self.formats;
        let rules = self.sample_locations.iter().filter(|rules| rules.has_sixteenths());
        let counts = rules.flat_map(|rules| rules.sample_counts.iter().copied());
        let is_drawn =
            |count: &u32| [float_color_sample_counts, float_depth_sample_counts].iter().all(|has| has.contains(count));
        counts.filter(|count| [2, 4, 8, 16].contains(count)).filter(is_drawn).collect()
    }

    /// How a plan without the device rounds: as measured, or not at all where that was not done.
    pub fn rules(&self) -> Cow<'_, LayoutRules> {
        match &self.layout {
            Some(measured) => Cow::Borrowed(measured),
            None => Cow::Owned(LayoutRules::unrounded(self.memory_types.len())),
        }
    }
}

/// What VK_EXT_conservative_rasterization promises on a device.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConservativeRules {
    /// By how much every edge is moved outwards before pixels are asked whether a triangle touches them (pixels).
    pub overestimation_px: f32,
    /// What a pipeline may add to that at most, and in which steps (pixels).
    pub most_extra_px: f32,
    pub extra_step_px: f32,
    /// Triangles that have no area once their corners are snapped are drawn too.
    pub draws_degenerate_triangles: bool,
}

impl ConservativeRules {
    /// What a pipeline adds so that edges lie `margin_px` farther out at least, as near to that as the device comes.
    pub fn extra_px(&self, margin_px: f32) -> f32 {
        let lacking = (margin_px - self.overestimation_px).max(0.0);
        let step = if self.extra_step_px > 0.0 { self.extra_step_px } else { self.most_extra_px };
        if step > 0.0 { ((lacking / step).ceil() * step).min(self.most_extra_px) } else { 0.0 }
    }
}

/// Where VK_EXT_sample_locations lets a device's samples be, the same places in every pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SampleLocationRules {
    /// Numbers of samples a pixel that can be placed, rising.
    pub sample_counts: Vec<u32>,
    /// Places lie at whole multiples of 1 / 2^this pixels.
    pub sub_pixel_bits: u32,
    /// The least and the greatest place along a side of a pixel (pixels).
    pub range_px: [f32; 2],
}

impl SampleLocationRules {
    /// Whether samples may lie at every sixteenth of a pixel, which is what the least of devices have.
    pub fn has_sixteenths(&self) -> bool {
        self.sub_pixel_bits >= 4 && self.range_px[0] <= 0.0 && self.range_px[1] >= 15.0 / 16.0
    }
}

/// How a driver rounds sizes up, measured on it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LayoutRules {
    pub buffer_size_multiple_bytes: u64,
    /// Alignment of storage buffers.
    pub buffer_alignment_bytes: u64,
    /// Alignment of vertex and index buffers.
    pub vertex_buffer_alignment_bytes: u64,
    /// Texels of a row are rounded up to a multiple of this, then its bytes, then the rows.
    pub image_width_multiple_px: u64,
    pub image_row_multiple_bytes: u64,
    pub image_height_multiple_px: u64,
    /// All of an image, after its levels and layers.
    pub image_size_multiple_bytes: u64,
    pub image_alignment_bytes: u64,
    /// Bytes that a texel of depth and stencil takes: 5, or with padding.
    pub depth_stencil_texel_bytes: u32,
    /// A bit for each memory type that any resource may lie in.
    pub memory_type_bits: u32,
    /// None: it has no ray queries, or it was not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub structures: Option<StructureRules>,
}

impl LayoutRules {
    /// No rounding, and any of the memory types: the bytes that texels and elements hold, which no driver goes below.
    fn unrounded(type_count: usize) -> Self {
        Self {
            buffer_size_multiple_bytes: 1,
            buffer_alignment_bytes: 1,
            vertex_buffer_alignment_bytes: 1,
            image_width_multiple_px: 1,
            image_row_multiple_bytes: 1,
            image_height_multiple_px: 1,
            image_size_multiple_bytes: 1,
            image_alignment_bytes: 1,
            depth_stencil_texel_bytes: 5,
            memory_type_bits: u32::MAX.checked_shl(type_count as u32).map_or(u32::MAX, |others| !others),
            structures: None,
        }
    }
}

/// How large a driver makes acceleration structures, measured on it: a header, inner nodes, one fewer than leaves and at
/// least one, and leaves.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StructureRules {
    pub header_bytes: u64,
    pub inner_bytes: u64,
    pub triangle_bytes: u64,
    pub instance_bytes: u64,
}

impl StructureRules {
    /// Bytes of a structure over `count` triangles.
    pub fn over_triangles(&self, count: u32) -> u64 {
        self.bytes(u64::from(count), self.triangle_bytes)
    }

    /// Bytes of a structure over one instance of another.
    pub fn over_instance(&self) -> u64 {
        self.bytes(1, self.instance_bytes)
    }

    fn bytes(&self, count: u64, leaf_bytes: u64) -> u64 {
        self.header_bytes + self.inner_bytes * (count.max(2) - 1) + leaf_bytes * count
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    pub name: String,
    /// `cpu`, `discrete-gpu`, `integrated-gpu`, `virtual-gpu` or `other`.
    #[serde(rename = "type")]
    pub device_type: String,
    pub driver: String,
    pub driver_info: String,
    /// Highest Vulkan version, such as `1.3.230`.
    pub api: String,
}

impl Identity {
    /// The place of a device in the choice without `--device`: GPUs before processors.
    pub fn preference(&self) -> u32 {
        match self.device_type.as_str() {
            "discrete-gpu" => 0,
            "integrated-gpu" => 1,
            "virtual-gpu" => 2,
            "cpu" => 3,
            _ => 4,
        }
    }

    /// Whether `--device` names the device of this index; without, every one is.
    pub fn is_named(&self, selector: Option<&str>, index: usize) -> bool {
        let Some(text) = selector else { return true };
        match text.parse::<usize>() {
            Ok(wanted) => wanted == index,
            Err(_) => format!("{} {}", self.name, self.driver_info).to_lowercase().contains(&text.to_lowercase()),
        }
    }

    /// The driver, with its version if it reports one.
    pub fn driver_text(&self) -> &str {
        if self.driver_info.is_empty() { &self.driver } else { &self.driver_info }
    }

    /// Whether times measured on it are those of a software driver.
    pub fn is_software(&self) -> bool {
        self.device_type == "cpu"
    }
}

/// Sizes in bytes, counts and periods.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Limits {
    pub max_image_side_px: u32,
    /// Width and height of a viewport; data from before it was looked up gets the least that Vulkan promises.
    #[serde(default = "least_drawn_px")]
    pub max_viewport_px: [u32; 2],
    /// Width and height of what one rendering draws into; the same.
    #[serde(default = "least_drawn_px")]
    pub max_framebuffer_px: [u32; 2],
    /// Data from before it was looked up gets the least that Vulkan promises.
    #[serde(default = "least_image_layers")]
    pub max_image_layers: u32,
    /// A side of a three-dimensional image; the same.
    #[serde(default = "least_volume_side_px")]
    pub max_volume_side_px: u32,
    pub max_storage_buffer_range_bytes: u64,
    /// Data from before it was looked up gets the least that Vulkan promises.
    #[serde(default = "least_uniform_buffer_range_bytes")]
    pub max_uniform_buffer_range_bytes: u64,
    pub max_push_constant_bytes: u32,
    pub max_workgroup_invocations: u32,
    pub max_workgroup_size: [u32; 3],
    pub max_workgroup_count: [u32; 3],
    /// Memory that the invocations of a workgroup share; in older caps files the least that Vulkan allows.
    #[serde(default = "least_shared_memory_bytes")]
    pub max_shared_memory_bytes: u32,
    pub max_sampled_images_per_stage: u32,
    /// In older caps files the least that Vulkan allows.
    #[serde(default = "least_storage_buffers_per_stage")]
    pub max_storage_buffers_per_stage: u32,
    /// In older caps files the least that Vulkan allows.
    #[serde(default = "least_storage_images_per_stage")]
    pub max_storage_images_per_stage: u32,
    pub max_bound_descriptor_sets: u32,
    pub max_color_attachments: u32,
    pub max_allocation_count: u32,
    pub max_allocation_bytes: u64,
    pub buffer_image_granularity_bytes: u64,
    pub non_coherent_atom_bytes: u64,
    pub min_storage_buffer_offset_bytes: u64,
    pub max_sampler_anisotropy: f32,
    /// Where in a pixel vertices may lie, in bits a side: what is interpolated is as exact as that. As for
    /// `max_image_layers`.
    #[serde(default = "least_sub_pixel_bits")]
    pub sub_pixel_bits: u32,
    /// Layers that one rendering draws into; as for `max_image_layers`.
    #[serde(default = "least_framebuffer_layers")]
    pub max_framebuffer_layers: u32,
    /// Vertices that a geometry shader gives out for one primitive; 0 where there are none. As for `max_image_layers`.
    #[serde(default = "least_geometry_vertices")]
    pub max_geometry_vertices: u32,
    /// Components of all these vertices together. The same.
    #[serde(default = "least_geometry_components")]
    pub max_geometry_components: u32,
    pub subgroup_size: u32,
    /// Nanoseconds a tick; 0 where the queue writes no timestamps.
    pub timestamp_period_ns: f32,
    /// Bits of a timestamp that count, 36 to 64, of data from before it was looked up 36; 0 as for the period.
    #[serde(default = "least_timestamp_bits")]
    pub timestamp_bits: u32,
    pub framebuffer_sample_counts: Vec<u32>,
}

impl Limits {
    /// The longest sides of what can be drawn into, pixels.
    pub fn most_drawn_px(&self) -> [u32; 2] {
        [0, 1].map(|axis| self.max_image_side_px.min(self.max_viewport_px[axis]).min(self.max_framebuffer_px[axis]))
    }
}

fn one_sample() -> Vec<u32> {
    vec![1]
}

fn least_drawn_px() -> [u32; 2] {
    [4096; 2]
}

fn least_volume_side_px() -> u32 {
    256
}

fn least_storage_buffers_per_stage() -> u32 {
    4
}

fn least_storage_images_per_stage() -> u32 {
    4
}

fn least_timestamp_bits() -> u32 {
    36
}

fn least_image_layers() -> u32 {
    256
}

fn least_uniform_buffer_range_bytes() -> u64 {
    16 << 10
}

fn least_sub_pixel_bits() -> u32 {
    4
}

fn least_framebuffer_layers() -> u32 {
    256
}

fn least_geometry_vertices() -> u32 {
    256
}

fn least_geometry_components() -> u32 {
    1024
}

fn least_shared_memory_bytes() -> u32 {
    16 << 10
}

/// Optional features, each of which some technique or setting asks for.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Features {
    pub geometry_shader: bool,
    pub layer_from_vertex_shader: bool,
    pub fragment_stores_and_atomics: bool,
    /// False in caps files older than this field.
    #[serde(default)]
    pub depth_clamp: bool,
    /// Occlusion queries count samples. False in caps files older than this field.
    #[serde(default)]
    pub occlusion_query_precise: bool,
    /// Fragment shaders run once a sample. False in caps files older than this field.
    #[serde(default)]
    pub sample_rate_shading: bool,
    /// VK_KHR_fragment_shader_barycentric with its feature. False in caps files older than this field.
    #[serde(default)]
    pub fragment_shader_barycentric: bool,
    pub sampler_anisotropy: bool,
    pub storage_image_extended_formats: bool,
    pub shader_float16: bool,
    /// 64-bit atomics in storage buffers, with 64-bit integers in shaders.
    pub shader_int64_atomics: bool,
    pub pipeline_statistics: bool,
    /// VK_KHR_ray_query and VK_KHR_acceleration_structure with their features, and addresses of buffers.
    pub ray_query: bool,
    pub memory_budget: bool,
}

/// What Vulkan leaves optional of the formats that this program uses, in optimally tiled images.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Formats {
    /// D32_SFLOAT as depth attachment and sampled.
    pub float_depth: bool,
    /// D32_SFLOAT sampled with linear filtering. False in caps files older than this field.
    #[serde(default)]
    pub float_depth_linear: bool,
    /// D32_SFLOAT_S8_UINT as attachment of depth and stencil.
    pub float_depth_with_stencil: bool,
    /// R32G32B32A32_SFLOAT blends as colour attachment.
    pub float_color_blend: bool,
    /// R16G16_UNORM as colour attachment. False in caps files older than this field.
    #[serde(default)]
    pub fixed_pair_color: bool,
    /// The same, blended. False in caps files older than this field.
    #[serde(default)]
    pub fixed_pair_blend: bool,
    /// R16G16B16A16_UNORM sampled. False in caps files older than this field.
    #[serde(default)]
    pub fixed_quad_sampled: bool,
    /// Samples a pixel of R32G32B32A32_SFLOAT as colour attachment. Only 1 in caps files older than this field.
    #[serde(default = "one_sample")]
    pub float_color_sample_counts: Vec<u32>,
    /// Samples a pixel of R16G16B16A16_SFLOAT as colour attachment, likewise.
    #[serde(default = "one_sample")]
    pub half_color_sample_counts: Vec<u32>,
    /// Samples a pixel of D32_SFLOAT as depth attachment, likewise.
    #[serde(default = "one_sample")]
    pub float_depth_sample_counts: Vec<u32>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Heap {
    pub bytes: u64,
    pub device_local: bool,
}

/// What a driver says of a heap at a moment (VK_EXT_memory_budget).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct HeapBudget {
    /// What this process may take of it, by the driver's estimate.
    pub budget_bytes: u64,
    /// What this process has taken of it.
    pub usage_bytes: u64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct MemoryType {
    /// Index into `Caps::heaps`.
    pub heap: u32,
    pub device_local: bool,
    pub host_visible: bool,
    pub host_coherent: bool,
    pub host_cached: bool,
    pub lazily_allocated: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_move_outwards_by_whole_steps_as_far_as_the_device_lets_them() {
        let rules = |overestimation_px, most_extra_px, extra_step_px| ConservativeRules {
            overestimation_px,
            most_extra_px,
            extra_step_px,
            draws_degenerate_triangles: true,
        };
        let margin = 4.0 / 256.0;
        for (rules, extra) in [
            // AMD's, as RADV says; one that does it already; NVIDIA's steps; one whose most is less than is asked for.
            (rules(0.0, 0.0, 0.0), 0.0),
            (rules(0.5, 0.75, 0.25), 0.0),
            (rules(0.0, 0.75, 0.25), 0.25),
            (rules(1.0 / 512.0, 0.75, 1.0 / 128.0), 2.0 / 128.0),
            (rules(0.0, 1.0 / 128.0, 1.0 / 256.0), 1.0 / 128.0),
        ] {
            assert_eq!(rules.extra_px(margin), extra, "{rules:?}");
        }
    }
}
