//! The stage that writes the layer a triangle is drawn into where tuples are drawn together (`--layer-from`). Shaders:
//! sample.vert, and layer.geom, which passes triangles through.

use super::sample::{self, Repeats, Stages};
use crate::gpu::Caps;
use crate::gpu::shader::techniques::deep_shading::visibility::layer::GEOM_VARIANTS;
use crate::gpu::shader::variant;
use crate::passes::mesh;
use crate::resident::SceneGpu;
use crate::settings::Values;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerFrom {
    /// The vertex shader.
    Vertex,
    /// A geometry shader after it.
    Geometry,
}

impl LayerFrom {
    /// `--layer-from`, `auto` resolved.
    pub fn of(values: &Values, caps: &Caps) -> Self {
        match values.text("layer-from") {
            "vertex" => Self::Vertex,
            "geometry" => Self::Geometry,
            _ if caps.features.layer_from_vertex_shader => Self::Vertex,
            _ => Self::Geometry,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Geometry => "geometry",
        }
    }

    /// For draws that repeat so.
    pub(super) fn stages(self, scene: &SceneGpu, repeats: &Repeats) -> Stages {
        let layer = if self == Self::Vertex { "vertex" } else { "none" };
        let geometry = (self == Self::Geometry).then(|| variant(GEOM_VARIANTS, &[mesh::vertex_name(scene)]));
        Stages::sharp(sample::vertex_shader(scene, repeats, layer), geometry)
    }
}
