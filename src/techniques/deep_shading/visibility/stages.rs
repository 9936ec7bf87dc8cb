//! Before fragments: the stages of each kind of visibility, and how its calls repeat.

use crate::caps::Limits;
use crate::gpu::Layers;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::choices::Choices;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::visibility::draw::{Repeats, SampleStages};
use crate::techniques::deep_shading::visibility::{draw, instancing, repeat_draw, repeat_frame, replicate, stochastic};

impl Visibility {
    /// How each draw call is repeated for its tuples; where layers are drawn one by one, the repeats of the first.
    pub fn repeats(self, scene: &SceneGpu, limits: &Limits, tuple_count: u32) -> Repeats {
        match self {
            Self::RepeatFrame | Self::Stochastic | Self::Ray => repeat_frame::repeats(0),
            Self::RepeatDraw => repeat_draw::repeats(tuple_count),
            Self::Instancing => instancing::repeats(tuple_count),
            Self::Replicate => replicate::repeats(scene, limits, tuple_count),
        }
    }

    /// How often the vertices of a draw call are fetched.
    pub fn round_count(self, repeats: &Repeats, layer_count: u32) -> u32 {
        if self.is_layered() { repeats.round_count() } else { layer_count }
    }

    /// Calls `draw` with the layers to open, one after the other or all together, and how calls repeat in them.
    pub fn for_layers(self, repeats: &Repeats, layer_count: u32, mut draw: impl FnMut(Layers, &Repeats)) {
        if self.is_layered() {
            draw(Layers::All(layer_count), repeats);
        } else {
            (0..layer_count).for_each(|tuple| draw(Layers::One(tuple), &repeat_frame::repeats(tuple)));
        }
    }
}

/// Before fragments. `repeats`: of the same visibility, which draws.
pub fn stages(scene: &SceneGpu, choices: &Choices, repeats: &Repeats) -> SampleStages {
    let vertices = choices.raster.vertices;
    match choices.visibility {
        Visibility::RepeatFrame => {
            SampleStages::sharp(draw::vertex_shader(scene, repeats, "none", vertices), None, vertices)
        }
        Visibility::RepeatDraw | Visibility::Instancing => choices.raster.layer_from.stages(scene, repeats, vertices),
        Visibility::Replicate => replicate::stages(scene, repeats),
        Visibility::Stochastic => stochastic::stages(choices, "layer"),
        Visibility::Ray => unreachable!("rays draw nothing"),
    }
}
