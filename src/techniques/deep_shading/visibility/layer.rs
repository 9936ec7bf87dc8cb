//! The stage that writes the layer a triangle is drawn into where tuples are drawn together (`--layer-from`). Shaders:
//! sample.vert, and layer.geom, which passes triangles through.

use crate::gpu::shader::techniques::deep_shading::visibility::layer::GEOM_VARIANTS;
use crate::gpu::shader::variant;
use crate::passes::mesh;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::modes::layer_from::LayerFrom;
use crate::techniques::deep_shading::modes::vertices::Vertices;
use crate::techniques::deep_shading::visibility::draw;
use crate::techniques::deep_shading::visibility::draw::{Repeats, SampleStages};

impl LayerFrom {
    /// For draws that repeat so.
    pub(super) fn stages(self, scene: &SceneGpu, repeats: &Repeats, vertices: Vertices) -> SampleStages {
        let layer = if self == Self::Vertex { "vertex" } else { "none" };
        let geometry =
            (self == Self::Geometry).then(|| variant(GEOM_VARIANTS, &[mesh::vertex_name(scene), vertices.name()]));
        SampleStages::sharp(draw::vertex_shader(scene, repeats, layer, vertices), geometry, vertices)
    }
}
