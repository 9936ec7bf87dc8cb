//! Stochastic multisampling (`--shading msaa`; McGuire et al. 2010, as Clarberg & Munkberg 2014 compare with it in figure 8):
//! images of several samples a pixel, and a fragment shader that is run once a pixel and triangle, tests the pixel's samples,
//! writes which of them see the triangle, and shades once. Shaders: msaa.vert, msaa.frag.
//!
//! Samples are those of the table's tuples, in places of their own: the rasteriser's only choose pixels. `--spp` of more
//! samples than the images have (`--pass-samples`) takes several passes in a frame, each with the next tuples of each pixel,
//! into a layer of its own; the resolve takes the mean of all.
//!
//! Where the papers leave a choice
//! - depth is tested a sample, and is one number a fragment: the mean of the depths at which its samples see the triangle (a
//!   shader that is run once a pixel writes no more), which shows where surfaces nearly meet
//! - it is shaded where the first of its samples sees the triangle, with the texture rates of that sample's pixel: noise, which
//!   more samples mend. The mean of all places kept textures sharp that are out of focus, as larger footprints (Loviscach
//!   2005), which are not taken, would not
//! - MASK is tested once a fragment, BLEND once a sample with the fragment's alpha; front or back is what the first sample sees
//! - depth that a shader writes is tested after it has run: what is hidden is shaded too, and counted
//! - the polygon around a triangle's blur is one triangle around a box, because pixels along inner edges would be run once for
//!   each side; where a driver cuts large ones off at the frame, they are
//!
//! Equal to `--shading ssaa --visibility stochastic` with `--pass-samples 1`.

use super::super::choices::Choices;
use crate::gpu::shader::techniques::deep_shading::baseline::msaa::{FRAG_VARIANTS, VERT};
use crate::gpu::shader::{Shader, variant};
use crate::passes::{mesh, shadow_maps};
use crate::resident::{SceneGpu, Sides};
use crate::techniques::deep_shading::visibility::draw::SampleStages;

pub(super) fn stages() -> SampleStages {
    // The shader tells sides apart: what is drawn has none.
    SampleStages { vertex: &VERT, geometry: None, sides: Some(Sides::Both), vertex_count: 3, is_indexed: false }
}

/// `alpha`: the value of the shader's axis.
pub(super) fn fragment(scene: &SceneGpu, choices: &Choices, alpha: &str) -> &'static Shader {
    let shadows = shadow_maps::axis(choices.maps.is_some());
    variant(FRAG_VARIANTS, &[alpha, mesh::vertex_name(scene), shadows, choices.count_axis()])
}
