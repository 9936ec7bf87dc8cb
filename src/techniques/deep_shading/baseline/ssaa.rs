//! Supersampling: tuples are drawn as for the lists, layer by layer, and each fragment that passes the depth test is shaded
//! (`--shading ssaa`; Clarberg & Munkberg 2014, section 6). Shaders: the vertex stage of visibility, ssaa.frag.
//!
//! Fragments that alpha may discard, and those of `--visibility stochastic`, whose depth a shader writes, are shaded before
//! their depth is tested.

use super::super::choices::Choices;
use crate::gpu::shader::techniques::deep_shading::baseline::ssaa::FRAG_VARIANTS;
use crate::gpu::shader::{Shader, variant};
use crate::passes::{mesh, shadow_maps};
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::modes::visibility::Visibility;

/// `alpha`: the value of the shader's axis.
pub(super) fn fragment(scene: &SceneGpu, choices: &Choices, alpha: &str) -> &'static Shader {
    let shadows = shadow_maps::axis(choices.maps.is_some());
    variant(FRAG_VARIANTS, &[alpha, mesh::vertex_name(scene), shadows, axis(choices), choices.count_axis()])
}

/// The value of the axis VISIBILITY of shaders that draw samples once.
pub(super) fn axis(choices: &Choices) -> &'static str {
    if choices.visibility == Visibility::Stochastic { "stochastic" } else { "interleaved" }
}
