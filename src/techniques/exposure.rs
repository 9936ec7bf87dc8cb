//! What the film sees while the shutter is open (`--shutter`): the scene, its lights and its camera at each moment, on straight
//! lines from where they are when it opens to where they are when it closes.
//!
//! Where a draw and its vertices both move, as in a skin on a node that moves, a mix of both is not quite the mix of their
//! places in the world.

use super::Inputs;
use super::shutter_close::ShutterClose;
use crate::error::Result;
use crate::frame::View;
use crate::lights::LightSet;
use crate::scene::{Camera, Light, Scene};
use glam::{Mat4, Vec3, Vec4};
use std::ops::{Add, Mul};

/// The time that the shutter is open. Moments of it are parts: 0 when it opens, 1 when it closes.
pub struct Exposure {
    open: Scene,
    close: Box<Scene>,
    lights: LightSet,
    view: View,
    pub closing: ShutterClose,
    /// Indices of the meshes that change; of the others the draws may move.
    changing: Vec<usize>,
}

impl Exposure {
    /// None: nothing moves.
    ///
    /// Errors: as of the scene's own camera and lights.
    pub fn new(inputs: &Inputs<'_>) -> Result<Option<Self>> {
        let Some(closing) = ShutterClose::new(inputs)? else { return Ok(None) };
        let mut open = inputs.scene.clone();
        let close = open.closing.take().expect("`ShutterClose` is of it");
        let changes = |index: &usize| {
            let (from, to) = (&open.meshes[*index], &close.meshes[*index]);
            from.positions != to.positions || from.normals != to.normals || from.tangents != to.tangents
        };
        let changing = (0..open.meshes.len()).filter(changes).collect();
        Ok(Some(Self { close, lights: inputs.lights.clone(), view: inputs.view.clone(), closing, changing, open }))
    }

    /// The scene when the shutter opens, as a moment of its own.
    pub fn opening(&self) -> Scene {
        self.open.clone()
    }

    /// Poses `scene`, which is of another moment.
    pub fn pose(&self, scene: &mut Scene, part: f32) {
        for index in self.changing.iter().copied() {
            let (mesh, from, to) = (&mut scene.meshes[index], &self.open.meshes[index], &self.close.meshes[index]);
            mix_all(&mut mesh.positions, &from.positions, &to.positions, part);
            mix_all(&mut mesh.normals, &from.normals, &to.normals, part);
            mix_all(&mut mesh.tangents, &from.tangents, &to.tangents, part);
            // Handedness stays what it is.
            mesh.tangents.iter_mut().zip(&from.tangents).for_each(|(tangent, from)| tangent.w = from.w);
        }
        let ends = self.open.draws.iter().zip(&self.close.draws);
        for (draw, (from, to)) in scene.draws.iter_mut().zip(ends) {
            draw.world_from_object = mix(from.world_from_object, to.world_from_object, part);
        }
    }

    /// Whether vertices move, and not only the draws that have them.
    pub fn changes_meshes(&self) -> bool {
        !self.changing.is_empty()
    }

    /// The lights of the frame at a moment.
    pub fn lights_at(&self, part: f32) -> LightSet {
        let (mut lights, ends) = (self.lights.clone(), &self.closing.lights);
        lights.lights.iter_mut().zip(&ends.lights).for_each(|(open, close)| *open = between(open, close, part));
        lights.ambient = mix(lights.ambient, ends.ambient, part);
        lights
    }

    /// The camera at a moment: its lens as when the shutter opens.
    pub fn view_at(&self, part: f32) -> View {
        let [from, to] = [&self.view, &self.closing.view].map(|view| view.camera.world_from_view);
        let axis = |of: fn(&Mat4) -> Vec4| {
            let (from, to) = (of(&from).truncate(), of(&to).truncate());
            turned(from, mix(from, to, part))
        };
        let back = axis(|place| place.z_axis);
        let across = axis(|place| place.x_axis);
        let right = turned(across, across - back * back.dot(across));
        let up = back.cross(right);
        let at = mix(from.w_axis, to.w_axis, part);
        let world_from_view = Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), at);
        let is_still = from == to;
        let world_from_view = if is_still { from } else { world_from_view };
        View { camera: Camera { world_from_view, ..self.view.camera.clone() }, ..self.view.clone() }
    }
}

/// Half of the one and half of the other where `part` is 0.5, to the bit their mean; what does not change stays as it is to the
/// bit.
fn mix<T: PartialEq + Mul<f32, Output = T> + Add<Output = T>>(from: T, to: T, part: f32) -> T {
    if from == to { from } else { from * (1.0 - part) + to * part }
}

fn mix_all<T: Copy + PartialEq + Mul<f32, Output = T> + Add<Output = T>>(
    into: &mut [T],
    from: &[T],
    to: &[T],
    part: f32,
) {
    let ends = from.iter().zip(to);
    into.iter_mut().zip(ends).for_each(|(into, (from, to))| *into = mix(*from, *to, part));
}

/// The unit vector of `mixed`; `open` where the two ends were opposite.
pub fn turned(open: Vec3, mixed: Vec3) -> Vec3 {
    mixed.normalize_or(open)
}

fn between(open: &Light, close: &Light, part: f32) -> Light {
    Light {
        intensity: mix(open.intensity, close.intensity, part),
        position: mix(open.position, close.position, part),
        direction: turned(open.direction, mix(open.direction, close.direction, part)),
        ..open.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::LightKind;

    #[test]
    fn a_light_is_on_its_way_and_shines_between_its_directions() {
        let light = |x: f32, direction: Vec3| Light {
            name: String::new(),
            kind: LightKind::Point,
            intensity: Vec3::splat(2.0 * x),
            position: Vec3::new(x, 0.0, 0.0),
            direction,
            range: None,
            radius: 0.0,
        };
        let (open, close) = (light(1.0, Vec3::X), light(3.0, Vec3::Y));
        let middle = between(&open, &close, 0.5);
        assert_eq!((middle.position, middle.intensity), (Vec3::new(2.0, 0.0, 0.0), Vec3::splat(4.0)));
        assert!(middle.direction.abs_diff_eq(Vec3::new(0.5f32.sqrt(), 0.5f32.sqrt(), 0.0), 1e-6));
        assert_eq!(between(&open, &close, 0.25).position, Vec3::new(1.5, 0.0, 0.0));
        assert_eq!(between(&light(0.0, Vec3::X), &light(0.0, -Vec3::X), 0.5).direction, Vec3::X);
    }
}
