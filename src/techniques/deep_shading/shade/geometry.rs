//! Hulls from a geometry shader (Clarberg & Munkberg 2014, section 4.4). Shaders: corner.vert, geometry.geom, hull.glsl.

use super::Stages;
use crate::gpu::shader::techniques::deep_shading::shade::{corner::VERT, geometry::GEOM};

pub(super) fn stages() -> Stages {
    Stages { vertex: &VERT, geometry: Some(&GEOM), is_conservative: false, vertex_count: 3 }
}
