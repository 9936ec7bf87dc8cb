//! Stochastic rasterisation: polygons around triangles' blur, every sample in them tested by the fragment shader (Clarberg &
//! Munkberg 2014, section 4.2, "Stochastic Rasterization"). Shaders: stochastic.vert, bound.glsl, stochastic.frag, covers.glsl.
//!
//! Differs from the paper: samples of a layer share their time and their place on the lens, so that both kinds of visibility see
//! the very same samples; polygons come from vertex shaders, and their sides touch the hull of the blur instead of walking
//! around it.

use super::super::choices::Choices;
use crate::gpu::shader::Shader;
use crate::gpu::shader::techniques::deep_shading::visibility::stochastic::{FRAG_VARIANTS, VERT};

/// BOUND_MOST_SIDES and BOUND_STILL_SIDES of bound.glsl.
const MOST_SIDES: u32 = 12;
const STILL_SIDES: u32 = 7;

pub(super) fn vertex_shader() -> &'static Shader {
    &VERT
}

pub(super) fn fragment_shaders() -> &'static [&'static Shader] {
    FRAG_VARIANTS
}

/// Of a polygon: a fan of triangles.
pub(super) fn vertex_count(choices: &Choices) -> u32 {
    let sides = if choices.is_moving { MOST_SIDES } else { STILL_SIDES };
    3 * (sides - 2)
}
