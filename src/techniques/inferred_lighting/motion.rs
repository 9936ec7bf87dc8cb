//! Motion: where the scene was a moment before, for the motion vectors of the geometry pass. Kircher 2009, section 2.1, names
//! them among what the G-buffer may hold beside. Shaders: motion.vert, geometry.frag.
//! reads   the scene a moment before: camera, placements, vertices
//! writes  geometry.motion   image, 4 B a texel: two half floats, texels to the right and down since then
//!
//! Vertices have their own earlier places, so that skins and morph targets have vectors too. What stands still under a camera
//! that does has exactly 0.

use crate::error::Result;
use crate::frame::View;
use crate::gpu::shader::structs::EarlierCameraBlock;
use crate::gpu::shader::techniques::inferred_lighting::motion::VERT_VARIANTS;
use crate::gpu::shader::{Shader, variant};
use crate::gpu::{Access, Bound, Buffer, Gpu, upload};
use crate::passes::mesh;
use crate::plan::{Plan, Resources};
use crate::resident::{SceneGpu, SceneStats};
use crate::techniques::Inputs;
use crate::techniques::inferred_lighting::resources::NAME;
use glam::Vec2;
use half::f16;
use std::sync::Arc;

fn full(what: &str) -> String {
    format!("{NAME}.motion.{what}")
}

/// Plans the earlier moment's buffers.
pub fn plan(plan: &mut Plan, stats: &SceneStats) {
    plan.buffer("scene.geometry", full("camera"), size_of::<EarlierCameraBlock>() as u64);
    plan.buffer("scene.geometry", full("draws"), stats.draw_count * 64);
    plan.buffer("scene.geometry", full("positions"), stats.vertex_count * 12);
}

/// The vertex stage for `scene`.
pub fn vertex_shader(scene: &SceneGpu) -> &'static Shader {
    variant(VERT_VARIANTS, &[mesh::vertex_name(scene)])
}

/// Texels to the right and down of a word; what nothing is drawn into has none.
pub fn vector_px(word: u32) -> Vec2 {
    let half = |bits: u32| f16::from_bits(bits as u16).to_f32();
    if word == u32::MAX { Vec2::ZERO } else { Vec2::new(half(word), half(word >> 16)) }
}

/// The scene a moment before, in device memory.
pub struct PreviousMoment {
    camera: Buffer,
    draws: Buffer,
    positions: Buffer,
}

impl PreviousMoment {
    /// Takes the buffers out that `plan` put in; a scene without an earlier moment is its own.
    ///
    /// Errors: memory for the upload (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, inputs: &Inputs<'_>, resources: &mut Resources) -> Result<Self> {
        let scene = inputs.scene.earlier.as_deref().unwrap_or(inputs.scene);
        let view = View::new(scene, inputs.values.text("camera"), inputs.view.extent)?;
        let send = |buffer: Buffer, bytes: &[u8]| -> Result<Buffer> {
            upload::buffer(gpu, &buffer, bytes, Access::GraphicsRead)?;
            Ok(buffer)
        };
        let camera = EarlierCameraBlock { clip_from_world: view.clip_from_world().to_cols_array_2d() };
        let draws: Vec<_> = scene.draws.iter().map(|draw| draw.world_from_object.to_cols_array()).collect();
        // One mesh after the other, as `resident` has them.
        let positions: Vec<_> =
            scene.meshes.iter().flat_map(|mesh| mesh.positions.iter().map(|position| position.to_array())).collect();
        Ok(Self {
            camera: send(resources.buffer(&full("camera")), bytemuck::bytes_of(&camera))?,
            draws: send(resources.buffer(&full("draws")), bytemuck::cast_slice(&draws))?,
            positions: send(resources.buffer(&full("positions")), bytemuck::cast_slice(&positions))?,
        })
    }

    /// What motion.vert binds beside mesh.vert's.
    pub fn bound(&self) -> [(&'static str, Bound<'_>); 3] {
        [
            ("EarlierCamera", Bound::Buffer(&self.camera)),
            ("EarlierDraws", Bound::Buffer(&self.draws)),
            ("EarlierPositions", Bound::Buffer(&self.positions)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_two_half_floats_and_an_empty_one_is_no_motion() {
        let word = u32::from(f16::from_f32(1.5).to_bits()) | u32::from(f16::from_f32(-3.0).to_bits()) << 16;
        assert_eq!(vector_px(word), Vec2::new(1.5, -3.0));
        assert_eq!(vector_px(u32::MAX), Vec2::ZERO);
    }
}
