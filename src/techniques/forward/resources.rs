//! The technique's name, the names of what it holds, and how large some of it is.

use crate::gpu::shader::structs::LightBlock;

pub const NAME: &str = "forward";
pub const DEPTH: &str = "forward.depth.reversed";

/// The lights once more, where the material pass reads them as uniforms.
pub const UNIFORM: &str = "forward.lights.uniform";

/// material.frag's UNIFORM_LIGHT_COUNT.
pub const UNIFORM_LIGHT_COUNT: usize = 1024;
pub const UNIFORM_BYTES: u64 = (UNIFORM_LIGHT_COUNT * size_of::<LightBlock>()) as u64;
pub const LISTS: &str = "forward.lights.lists";

/// No virtual lights: what blended surfaces bind in their place.
pub const VPLS: &str = "forward.vpls";

/// What the material pass and blended surfaces draw into.
pub const DRAWN: &str = "forward.material.color";

/// The mean of its samples.
pub const RESOLVED: &str = "forward.resolve.color";
