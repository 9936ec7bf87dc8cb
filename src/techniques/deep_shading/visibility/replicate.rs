//! Interleave-ReplicateGS: each draw call once, and a geometry shader makes a triangle for each tuple (Clarberg & Munkberg
//! 2014, section 4.2). Vertices are fetched once for many tuples. Shaders: replicate.vert, replicate.geom.
//!
//! The output of a geometry shader is limited: the paper's 32 tuples of 32 bytes a vertex fit, but what samples need
//! here is longer (52), so that a draw call is repeated for the next tuples.

use crate::caps::Limits;
use crate::gpu::shader::techniques::deep_shading::visibility::replicate::{GEOM_VARIANTS, VERT_VARIANTS};
use crate::gpu::shader::variant;
use crate::passes::mesh;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::modes::vertices::Vertices;
use crate::techniques::deep_shading::visibility::draw::{Repeats, SampleStages};

/// Components of a vertex that replicate.geom gives out: place 4, layer 1, place in shading space 4, triangle 1, coordinates 2,
/// tuple 1; then colour 4 and second coordinates 2.
const PLAIN_COMPONENTS: u32 = 13;
const EXTENDED_COMPONENTS: u32 = PLAIN_COMPONENTS + 6;

/// TUPLES of replicate.geom: most tuples of one draw. Eight fit the least that Vulkan promises of geometry shaders.
const MORE: u32 = 16;
const FEWER: u32 = 8;

/// Tuples that one draw makes triangles of.
fn most_tuples(limits: &Limits, tuple_count: u32, is_extended: bool) -> u32 {
    let components = if is_extended { EXTENDED_COMPONENTS } else { PLAIN_COMPONENTS };
    let vertices = limits.max_geometry_vertices.min(limits.max_geometry_components / components);
    if tuple_count > FEWER && 3 * MORE <= vertices { MORE } else { FEWER }
}

pub fn repeats(scene: &SceneGpu, limits: &Limits, tuple_count: u32) -> Repeats {
    let step = most_tuples(limits, tuple_count, scene.extended.is_some());
    Repeats { tuples: 0..tuple_count, step, instance_count: 1 }
}

/// `repeats`: of the same scene.
pub(super) fn stages(scene: &SceneGpu, repeats: &Repeats) -> SampleStages {
    let tuples = if repeats.step == MORE { "16" } else { "8" };
    let vertex = mesh::vertex_name(scene);
    let geometry = variant(GEOM_VARIANTS, &[vertex, tuples]);
    SampleStages::sharp(variant(VERT_VARIANTS, &[vertex]), Some(geometry), Vertices::Fetched)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;

    #[test]
    fn a_draw_makes_as_many_triangles_as_geometry_shaders_may_give_out() {
        let limits = |vertices, components| Limits {
            max_geometry_vertices: vertices,
            max_geometry_components: components,
            ..known::caps(known::LEAST).unwrap().limits
        };
        let least = limits(256, 1024);
        assert_eq!([most_tuples(&least, 32, false), most_tuples(&least, 32, true)], [16; 2]);
        assert_eq!(most_tuples(&least, 8, false), 8);
        let fewer = limits(256, 911);
        assert_eq!([most_tuples(&fewer, 32, false), most_tuples(&fewer, 32, true)], [16, 8]);
        assert_eq!([most_tuples(&limits(256, 912), 32, true), most_tuples(&limits(47, 4096), 32, true)], [16, 8]);
        // No GPU gives out fewer.
        for gpu in ["amd-polaris10", "intel-iris-xe", "nvidia-rtx-2070"] {
            assert_eq!(most_tuples(&known::caps(gpu).unwrap().limits, 32, true), 16, "{gpu}");
        }
    }
}
