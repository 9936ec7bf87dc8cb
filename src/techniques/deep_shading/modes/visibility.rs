//! What triangles are drawn as (`--visibility`).

use crate::gpu::Access;
use crate::settings::Values;

/// What triangles are drawn as, and in which order tuples and draws come (`--visibility`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    RepeatFrame,
    RepeatDraw,
    Instancing,
    Replicate,
    Stochastic,
    Ray,
}

impl Visibility {
    pub fn of(values: &Values) -> Self {
        match values.text("visibility") {
            "repeat-draw" => Self::RepeatDraw,
            "instancing" => Self::Instancing,
            "replicate" => Self::Replicate,
            "stochastic" => Self::Stochastic,
            "ray" => Self::Ray,
            _ => Self::RepeatFrame,
        }
    }

    /// All layers are drawn into at once.
    pub fn is_layered(self) -> bool {
        matches!(self, Self::RepeatDraw | Self::Instancing | Self::Replicate)
    }

    /// Whatever draws the samples' triangles again draws polygons around them, and finds the samples by what they see.
    pub fn has_polygons(self) -> bool {
        matches!(self, Self::Stochastic | Self::Ray)
    }

    /// How samples come into their layers.
    pub fn writes(self) -> Access {
        if self == Self::Ray { Access::TransferWrite } else { Access::ColorWrite }
    }

    /// Someone must say the layer, and may be chosen.
    pub fn has_layer_from(self) -> bool {
        matches!(self, Self::RepeatDraw | Self::Instancing)
    }
}
