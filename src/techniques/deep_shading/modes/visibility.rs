//! What triangles are drawn as (`--visibility`).

use crate::caps::Caps;
use crate::choice::choices;
use crate::gpu::Access;
use crate::settings::Values;
use crate::techniques::deep_shading::modes::shading_kind::ShadingKind;

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
    /// `--visibility`, `auto` resolved.
    pub fn of(values: &Values, caps: &Caps) -> Self {
        let has_layers = caps.features.layer_from_vertex_shader || caps.features.geometry_shader;
        let best = match values.choice("shading") {
            // 0.86 to 0.90 of repeat-frame's time on lavapipe, 1.02 to 1.06 on an H200.
            ShadingKind::Deep | ShadingKind::IndirectGbuffer if has_layers && caps.identity.is_software() => {
                Self::Instancing
            }
            ShadingKind::Msaa => Self::Stochastic,
            _ => Self::RepeatFrame,
        };
        values.unless_auto("visibility", Values::choice).unwrap_or(best)
    }

    /// Whether all layers are drawn into at once.
    pub fn is_layered(self) -> bool {
        matches!(self, Self::RepeatDraw | Self::Instancing | Self::Replicate)
    }

    /// Whether polygons around triangles are drawn, whose pixels a shader tests.
    pub fn has_polygons(self) -> bool {
        self == Self::Stochastic
    }

    /// Whether vertex shaders place triangles for one tuple each, so that `--vertices` chooses how they come by these.
    pub fn draws_corners(self) -> bool {
        matches!(self, Self::RepeatFrame | Self::RepeatDraw | Self::Instancing)
    }

    /// Whether each sample is looked at by itself, wherever in its pixel, on the lens and in time it is.
    pub fn tests_samples(self) -> bool {
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
