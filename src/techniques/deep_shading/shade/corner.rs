//! Triangles as they are, which the device rasterises conservatively (VK_EXT_conservative_rasterization) or as usual,
//! to show what conservative rasterisation is for, and costs (Clarberg & Munkberg 2014, table 2). Shader: corner.vert.

use crate::gpu::shader::techniques::deep_shading::shade::corner::VERT_VARIANTS;
use crate::gpu::shader::variant;
use crate::techniques::deep_shading::shade::stages::SpaceStages;

/// `marks`, `weights`: values of the shader's axes.
pub(super) fn stages(is_conservative: bool, marks: &str, weights: &str) -> SpaceStages {
    SpaceStages {
        vertex: variant(VERT_VARIANTS, &[marks, weights]),
        geometry: None,
        is_conservative,
        has_hulls: false,
        vertex_count: 3,
    }
}
