//! Stochastic rasterisation: polygons around triangles' blur, every sample in them tested by the fragment shader (Clarberg &
//! Munkberg 2014, section 4.2, "Stochastic Rasterization"). Shaders: stochastic.vert, bound.glsl, stochastic.frag, covers.glsl,
//! reduced.glsl, own_samples.glsl.
//!
//! A polygon is drawn into each tuple's layer, where a pixel is a sample, or once for all of an eye (looped.rs).
//! Polygons come from a geometry shader, as in the paper (polygon.rs), or from vertex shaders, each of which makes the polygon for
//! itself.
//!
//! Samples of a layer are at other places of their pixels, of the lens and in time (`--pixel-samples own`), or at their tuple's,
//! so that both kinds of visibility see the very same samples (`shared`). They are tested by their corners, placed as for all else,
//! or by fewer products (`--coverage-test reduced`).
//!
//! Differs from the paper: polygons' sides touch the hull of the blur instead of walking around it.

use super::super::choices::Choices;
use super::polygon;
use crate::gpu::shader::techniques::deep_shading::visibility::bound::{BOUND_MOST_SIDES, BOUND_STILL_SIDES};
use crate::gpu::shader::techniques::deep_shading::visibility::stochastic::{FRAG_VARIANTS, VERT_VARIANTS};
use crate::gpu::shader::{Shader, variant};
use crate::resident::Sides;
use crate::techniques::deep_shading::modes::polygon_from::PolygonFrom;
use crate::techniques::deep_shading::visibility::draw::SampleStages;

pub(super) const FRAGMENTS: &[&Shader] = FRAG_VARIANTS;

/// `tests`: the value of the shaders' axis.
pub(super) fn stages(choices: &Choices, tests: &str) -> SampleStages {
    if choices.raster.polygon_from == PolygonFrom::Geometry {
        return polygon::stages(tests);
    }
    let side_count = if choices.blur.is_moving { BOUND_MOST_SIDES } else { BOUND_STILL_SIDES };
    SampleStages {
        vertex: variant(VERT_VARIANTS, &[tests]),
        geometry: None,
        // The shader tells sides apart: polygons have none.
        sides: Some(Sides::Both),
        // A fan of triangles.
        vertex_count: 3 * (side_count - 2),
        is_indexed: false,
    }
}
