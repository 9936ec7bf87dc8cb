//! Claims: which triangle of a draw shades a texel of its texture. Shaders: hull.vert, claim.frag.
//! writes  texture_space.owners

use crate::gpu::shader::Shader;
use crate::gpu::shader::techniques::deep_shading::baseline::texture_space::claim::FRAG;

pub(super) const FRAGMENT: &Shader = &FRAG;
