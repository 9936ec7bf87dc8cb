//! What triangles are drawn as (`--visibility`).

use crate::choice::choices;
use crate::gpu::Access;

choices! {
    /// Shape in which triangles are drawn, and order of tuples and draws (`--visibility`).
    pub enum Visibility {
        "repeat-frame" => RepeatFrame,
        "repeat-draw" => RepeatDraw,
        "instancing" => Instancing,
        "replicate" => Replicate,
        "stochastic" => Stochastic,
        "ray" => Ray,
    }
}

impl Visibility {
    /// Whether all layers are drawn into at once.
    pub fn is_layered(self) -> bool {
        matches!(self, Self::RepeatDraw | Self::Instancing | Self::Replicate)
    }

    /// Whether later passes redraw polygons around triangles, and find samples by the triangle that they see.
    pub fn has_polygons(self) -> bool {
        matches!(self, Self::Stochastic | Self::Ray)
    }

    /// How samples come into their layers.
    pub fn writes(self) -> Access {
        if self == Self::Ray { Access::TransferWrite } else { Access::ColorWrite }
    }

    /// Whether some stage must write `gl_Layer`, so that `--layer-from` chooses which.
    pub fn has_layer_from(self) -> bool {
        matches!(self, Self::RepeatDraw | Self::Instancing)
    }
}
