//! What a device may lack of what Vulkan 1.3 leaves optional, and the words for it. Who needs something says so as data:
//! the same list refuses a render and is what `devices` prints.

use super::Caps;
use crate::error::Error;

/// An optional ability of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ability {
    /// A depth buffer of floats that shaders sample.
    FloatDepth,
    /// Depth and stencil in one image.
    DepthWithStencil,
    /// Surfaces blend over a picture of floats.
    BlendFloats,
    /// Shaders store two words a texel into an image.
    StoreWordPairs,
    /// Shaders send rays through structures that the driver builds.
    RayQuery,
}

impl Ability {
    /// Whether a device of these caps has it.
    pub fn is_there(self, caps: &Caps) -> bool {
        match self {
            Self::FloatDepth => caps.formats.float_depth,
            Self::DepthWithStencil => caps.formats.float_depth_with_stencil,
            Self::BlendFloats => caps.formats.float_color_blend,
            Self::StoreWordPairs => caps.features.storage_image_extended_formats,
            Self::RayQuery => caps.features.ray_query,
        }
    }

    /// Vulkan's words for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::FloatDepth => "D32_SFLOAT as sampled depth attachment",
            Self::DepthWithStencil => "D32_SFLOAT_S8_UINT as depth and stencil attachment",
            Self::BlendFloats => "R32G32B32A32_SFLOAT as blended colour attachment",
            Self::StoreWordPairs => "shaderStorageImageExtendedFormats",
            Self::RayQuery => "VK_KHR_ray_query with VK_KHR_acceleration_structure",
        }
    }
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
        let error = Error::no_device(format!("{} needs {ability}, which {device} on {driver} has not", self.of));
        let error = if self.instead.is_empty() { error } else { error.note(self.instead) };
        error.note("`quincunx devices` tells what each device can do")
    }
}
