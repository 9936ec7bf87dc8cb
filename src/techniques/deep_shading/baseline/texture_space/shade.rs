//! Shading: each texel once, by its owner, in the middle of the exposure from the middle of the lens. Shaders: hull.vert, shade.frag.
//! reads   the scene, its lights, texture_space.owners      writes  texture_space.textures

use super::super::super::choices::Choices;
use crate::gpu::shader::techniques::deep_shading::baseline::texture_space::shade::FRAG_VARIANTS;
use crate::gpu::shader::{Shader, variant};
use crate::passes::{mesh, shadow_maps};
use crate::resident::SceneGpu;

pub(super) fn fragment(scene: &SceneGpu, choices: &Choices) -> &'static Shader {
    variant(FRAG_VARIANTS, &[mesh::vertex_name(scene), shadow_maps::axis(choices.maps.is_some())])
}
