//! The technique's name, the names, formats and sizes of what it holds.

use crate::gpu::shader::techniques::deep_shading::nodes;
use crate::gpu::shader::techniques::deep_shading::reconstruct::blur::LAYER_COUNT;
use crate::gpu::shader::techniques::deep_shading::reconstruct::layer_mean::MEAN_PAIRS;
use crate::plan::Plan;
use crate::units::Extent;
use ash::vk::{Format, ImageUsageFlags as Usage};

pub const NAME: &str = "deep_shading";

/// The full name of a pass or a resource.
pub fn full(what: &str) -> String {
    format!("{NAME}.{what}")
}

pub const SPIDS: &str = "visibility.spids";
pub const DEPTH: &str = "visibility.depth";

/// Depth at shading points, s_z.
pub const SHADING_DEPTHS: &str = "visibility.shading_depths";
pub const BEGINS: &str = "lists.begins";
pub const NODES: &str = "lists.nodes";
pub const COLORS: &str = "shade.colors";
pub const LINEAR: &str = "lists.linear";
pub const ADDRESSES: &str = "lists.addresses";
pub const ZMAX: &str = "lists.zmax";
/// The same as a depth buffer.
pub const SHADE_DEPTH: &str = "shade.depth";
pub const MARKS: &str = "lists.marks";
pub const LENGTHS: &str = "count.lengths";
pub const COUNTERS: &str = "count.counters";
pub const COLOR: &str = "resolve.color";
pub const SPID_FORMAT: Format = Format::R32G32_UINT;
pub const DEPTH_FORMAT: Format = Format::D32_SFLOAT;
pub const SHADING_DEPTH_FORMAT: Format = Format::R32_UINT;

/// The paper's M.
pub const LINEAR_COUNT: u64 = nodes::LINEAR_COUNT as u64;

/// Bytes of the pointer at which a list begins.
pub const BEGIN_BYTES: u64 = 4;

/// Bytes of a row's id, a node (id, next), a colour (RGBA16F), and an address.
pub const ROW_ID_BYTES: u64 = 4;
pub const NODE_BYTES: u64 = 8;
pub const COLOR_BYTES: u64 = 8;
pub const ADDRESS_BYTES: u64 = 4;

/// In which order entries are shaded, and the bytes of one's place.
pub const ORDER: &str = "entries.order";
pub const ORDER_BYTES: u64 = 4;

/// A picture that is not the last one.
pub fn stored(plan: &mut Plan, name: &str, frame: Extent) {
    plan.image("color", full(name), frame, crate::plan::PICTURE_FORMAT, Usage::STORAGE);
}

pub const POINTERS: &str = "indirect.pointers";
pub const CACHE: &str = "indirect.cache";

/// Buffers of the entries, as entries.glsl names them in order.
pub const ENTRIES: [(&str, &str); 4] = [
    ("indirect.places", "EntryPlaces"),
    ("indirect.normals", "EntryNormals"),
    ("indirect.base_colors", "EntryBaseColors"),
    ("indirect.radiances", "EntryRadiances"),
];

/// Bytes of an entry in one of its buffers, of a pointer, and of a word of the cache.
pub const ENTRY_BYTES: u64 = 16;
pub const POINTER_BYTES: u64 = 4;
pub const CACHE_BYTES: u64 = 4;
pub const SAMPLE_COLORS: &str = "reconstruct.samples.colors";
pub const SAMPLE_VECTORS: &str = "reconstruct.samples.vectors";
pub const LAYER_MEANS: &str = "reconstruct.means";

/// Bytes of a sample in each of two buffers: half floats of red, green, blue and the circle of confusion; and two
/// half floats of motion with a depth.
pub const SAMPLE_BYTES: u64 = 8;

/// Bytes of a pixel's layers.
pub const MEANS_BYTES: u64 = 8 * MEAN_PAIRS as u64 * LAYER_COUNT as u64;

/// nearest.glsl's words.
pub const NEAREST_BYTES: u64 = 8;
