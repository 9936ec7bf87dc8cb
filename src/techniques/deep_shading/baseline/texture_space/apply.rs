//! Textures on draws, where tuples see them. Shaders: the vertex stage of visibility, apply.frag, lookup.glsl.
//! reads   texture_space.textures, texture_space.owners      writes  baseline.colors, baseline.depth

use super::super::super::choices::Choices;
use super::super::ssaa;
use crate::gpu::shader::techniques::deep_shading::baseline::texture_space::apply::FRAG_VARIANTS;
use crate::gpu::shader::{Shader, variant};
use crate::passes::mesh;
use crate::resident::SceneGpu;

/// `alpha`: the value of the shader's axis.
pub(in super::super) fn fragment(scene: &SceneGpu, choices: &Choices, alpha: &str) -> &'static Shader {
    variant(FRAG_VARIANTS, &[alpha, mesh::vertex_name(scene), ssaa::axis(choices), choices.count_axis()])
}
