//! The scene in the middle of the exposure, where it is shaded: what moves is halfway between its places when the shutter opens
//! and when it closes.
//!
//! Where a draw and its vertices both move, as in a skin on a node that moves, the mean of both is not quite the mean
//! of their places in the world; shading takes the latter (corners.glsl), shadow maps this one.

use crate::error::Result;
use crate::gpu::shader::structs::FrameBlock;
use crate::lights::LightSet;
use crate::scene::{Light, Scene};
use crate::techniques::Inputs;
use crate::techniques::shutter_close::ShutterClose;
use glam::{Vec3, Vec4};

/// Half of the way through the exposure.
pub struct MidExposure {
    /// Meshes, draws and lights; no pictures of its own.
    pub scene: Scene,
    pub lights: LightSet,
    pub closing: ShutterClose,
}

impl MidExposure {
    /// None: nothing moves.
    ///
    /// Errors: as of the scene's own camera and lights.
    pub fn new(inputs: &Inputs<'_>) -> Result<Option<Self>> {
        let Some(closing) = ShutterClose::new(inputs)? else { return Ok(None) };
        let (mut scene, mut lights) = (inputs.scene.clone(), inputs.lights.clone());
        let close = scene.closing.take().expect("`ShutterClose` is of it");
        for (mesh, end) in scene.meshes.iter_mut().zip(&close.meshes) {
            mesh.positions.iter_mut().zip(&end.positions).for_each(|(open, close)| *open = open.midpoint(*close));
        }
        for (draw, end) in scene.draws.iter_mut().zip(&close.draws) {
            draw.world_from_object = (draw.world_from_object + end.world_from_object) * 0.5;
        }
        let ends = &closing.lights;
        lights.lights.iter_mut().zip(&ends.lights).for_each(|(open, close)| *open = between(open, close));
        lights.ambient = lights.ambient.midpoint(ends.ambient);
        Ok(Some(Self { scene, lights, closing }))
    }

    /// `open`, the frame's own block, with the eye and its axes in the middle.
    pub fn frame(&self, inputs: &Inputs<'_>, open: &FrameBlock) -> FrameBlock {
        let close = self.closing.block(inputs);
        let mean = |a: [f32; 4], b: [f32; 4]| Vec4::from(a).midpoint(Vec4::from(b));
        let direction = |a: [f32; 4], b: [f32; 4]| turned(Vec4::from(a).truncate(), mean(a, b).truncate()).extend(0.0);
        FrameBlock {
            eye_ws: mean(open.eye_ws, close.eye_ws).to_array(),
            forward_ws: direction(open.forward_ws, close.forward_ws).to_array(),
            right_ws: direction(open.right_ws, close.right_ws).to_array(),
            up_ws: direction(open.up_ws, close.up_ws).to_array(),
            ambient: self.lights.ambient.extend(0.0).to_array(),
            ..*open
        }
    }
}

/// The unit vector of `mean`; `open` where the two ends were opposite.
fn turned(open: Vec3, mean: Vec3) -> Vec3 {
    mean.normalize_or(open)
}

fn between(open: &Light, close: &Light) -> Light {
    Light {
        intensity: open.intensity.midpoint(close.intensity),
        position: open.position.midpoint(close.position),
        direction: turned(open.direction, open.direction.midpoint(close.direction)),
        ..open.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::LightKind;

    #[test]
    fn a_light_is_halfway_and_shines_between_its_directions() {
        let light = |x: f32, direction: Vec3| Light {
            name: String::new(),
            kind: LightKind::Point,
            intensity: Vec3::splat(2.0 * x),
            position: Vec3::new(x, 0.0, 0.0),
            direction,
            range: None,
            radius: 0.0,
        };
        let middle = between(&light(1.0, Vec3::X), &light(3.0, Vec3::Y));
        assert_eq!((middle.position, middle.intensity), (Vec3::new(2.0, 0.0, 0.0), Vec3::splat(4.0)));
        assert!(middle.direction.abs_diff_eq(Vec3::new(0.5f32.sqrt(), 0.5f32.sqrt(), 0.0), 1e-6));
        assert_eq!(between(&light(0.0, Vec3::X), &light(0.0, -Vec3::X)).direction, Vec3::X);
    }
}
