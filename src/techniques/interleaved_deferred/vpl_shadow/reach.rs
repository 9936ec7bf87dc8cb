//! What a face of a light's map can hold, and which faces the picture can ask (Segovia 2006, section 6.1: culling by the frustum and by
//! what is potentially visible). Boxes of clusters stand for what lies in them.

use super::unrolled::Face;
use crate::gpu::shader::structs::VplBlock;
use crate::scene::Bounds;
use glam::{Vec3, Vec4};

/// Four planes through the light around a face, and the one that the light shines away from.
pub struct Reach {
    position: Vec3,
    /// Inwards, not of unit length.
    normals: [Vec3; 5],
}

impl Reach {
    pub fn of(vpl: &VplBlock, face: &Face) -> Self {
        let [position, normal] = [vpl.position_ws, vpl.normal_ws].map(|at| Vec4::from_array(at).truncate());
        let [right, up, back] = [0, 1, 2].map(|axis| face.view.camera.world_from_view.col(axis).truncate());
        Self { position, normals: [right - back, -right - back, up - back, -up - back, normal] }
    }

    /// Whether anything in the box may lie within `slack_m` of the face's half space and pyramid.
    pub fn may_hold(&self, bounds: &Bounds, slack_m: f32) -> bool {
        let (center, half) = (bounds.center() - self.position, (bounds.max - bounds.min) * 0.5 + slack_m);
        self.normals.iter().all(|normal| normal.dot(center) + normal.abs().dot(half) >= 0.0)
    }

    /// The width of a face's texel where the box is nearest to the light, at least: a face is 90 degrees wide, and what is seen in its
    /// corner is farther away than deep.
    pub fn least_texel_m(&self, bounds: &Bounds, size_px: u32) -> f32 {
        let nearest_m = self.position.distance(self.position.clamp(bounds.min, bounds.max));
        2.0 * nearest_m / 3f32.sqrt() / size_px as f32
    }
}

#[cfg(test)]
mod tests {
    use super::super::unrolled::{MapAtlas, MapShape};
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// What lies in front of a light is in a face that may hold it, whatever box is around it.
        #[test]
        fn no_face_misses_what_it_is_asked_about(
            at in prop::array::uniform3(-3f32..3.0),
            position in prop::array::uniform3(-1f32..1.0),
            towards in prop::array::uniform3(-1f32..1.0),
            size in prop::array::uniform3(0f32..1.0),
        ) {
            let [at, position, size] = [at, position, size].map(Vec3::from_array);
            let normal = Vec3::from_array(towards).try_normalize().unwrap_or(Vec3::X);
            let vpl = VplBlock {
                position_ws: position.extend(0.0).to_array(),
                normal_ws: normal.extend(0.0).to_array(),
                intensity: [1.0; 4],
            };
            let room = Bounds { min: Vec3::splat(-4.0), max: Vec3::splat(4.0) };
            let atlas = MapAtlas::new(MapShape::Hemicube, 16, 1, 16384);
            let faces = atlas.faces(&vpl, &room);
            let holding: Vec<bool> = faces
                .iter()
                .map(|face| Reach::of(&vpl, face).may_hold(&Bounds { min: at - size, max: at + size }, 1e-4))
                .collect();
            let is_in_front = (at - position).dot(normal) > 0.0;
            for (face, is_held) in faces.iter().zip(&holding) {
                let clip = face.clip_from_world * at.extend(1.0);
                let is_inside = clip.w > 1e-3 && clip.x.abs().max(clip.y.abs()) <= clip.w;
                prop_assert!(!is_inside || *is_held, "{clip} is in the face");
            }
            prop_assert!(!is_in_front || holding.contains(&true));
            let behind = position - normal * 2.0;
            let point = Bounds { min: behind, max: behind };
            prop_assert!(faces.iter().all(|face| !Reach::of(&vpl, face).may_hold(&point, 1e-4)));
        }
    }
}
