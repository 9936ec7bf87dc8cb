//! Triangles as they are, which the device draws conservatively (VK_EXT_conservative_rasterization). Shader: corner.vert.

use super::Stages;
use crate::gpu::shader::techniques::deep_shading::shade::corner::VERT;

pub(super) fn stages() -> Stages {
    Stages { vertex: &VERT, geometry: None, is_conservative: true, vertex_count: 3 }
}
