//! Shadow maps' format, the filter that they are read by, and the names of what they take.

use crate::caps::Caps;
use crate::settings::{MapFilter, Values};
use ash::vk;

pub const FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// The value of `--shadow-filter`; auto: the device's filter where it has one for depth.
pub(super) fn filter(values: &Values, caps: &Caps) -> MapFilter {
    let best = if caps.formats.float_depth_linear { MapFilter::Bilinear } else { MapFilter::Gather };
    values.unless_auto("shadow-filter", Values::choice).unwrap_or(best)
}

/// The pass, and what its resources' names begin with.
pub fn pass(technique: &str) -> String {
    format!("{technique}.shadow_maps")
}

pub fn depth_name(technique: &str) -> String {
    format!("{}.depth", pass(technique))
}

pub fn blocks_name(technique: &str) -> String {
    format!("{}.blocks", pass(technique))
}

/// Where each map is drawn from.
pub fn views_name(technique: &str) -> String {
    format!("{}.views", pass(technique))
}
