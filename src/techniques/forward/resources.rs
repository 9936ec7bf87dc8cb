//! The technique's name, the names of what it holds, and how large some of it is.

use crate::gpu::shader::structs::LightBlock;
use crate::gpu::shader::techniques::forward::material::UNIFORM_LIGHT_COUNT;

pub const NAME: &str = "forward";
pub const DEPTH: &str = "forward.depth.reversed";

/// The lights once more, where the material pass reads them as uniforms.
pub const UNIFORM: &str = "forward.lights.uniform";

/// Bytes of the lights that the material pass reads as uniforms.
pub const UNIFORM_BYTES: u64 = UNIFORM_LIGHT_COUNT as u64 * size_of::<LightBlock>() as u64;
pub const LISTS: &str = "forward.lights.lists";

/// No virtual lights: what blended surfaces bind in their place.
pub const VPLS: &str = "forward.vpls";

/// What the material pass and blended surfaces draw into.
pub const DRAWN: &str = "forward.material.color";

/// The mean of its samples.
pub const RESOLVED: &str = "forward.resolve.color";
