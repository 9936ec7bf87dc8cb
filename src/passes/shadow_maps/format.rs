//! Shadow maps' format, the filter that they are read by, and the names of what they take.

use crate::caps::Caps;
use ash::vk;

pub const FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// How a map is asked (`--shadow-filter`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapFilter {
    /// One comparison.
    Nearest,
    /// Four, filtered by the sampler.
    Bilinear,
    /// Four, filtered by the shader.
    Gather,
}

impl MapFilter {
    /// The value of `--shadow-filter`.
    pub(super) fn from_setting(text: &str, caps: &Caps) -> Self {
        match text {
            "auto" if caps.formats.float_depth_linear => Self::Bilinear,
            "auto" | "gather" => Self::Gather,
            "nearest" => Self::Nearest,
            "bilinear" => Self::Bilinear,
            other => panic!("--shadow-filter {other} was checked"),
        }
    }

    /// As settings name it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Bilinear => "bilinear",
            Self::Gather => "gather",
        }
    }
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
