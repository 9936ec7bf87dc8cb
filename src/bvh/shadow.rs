//! Shadow rays as surfaces send them: the twin of `occluded` in glsl/bvh_walk.glsl.

use super::Bvh;
use glam::Vec3;

/// A tree and how far off their surfaces rays begin.
#[derive(Clone, Copy)]
pub struct ShadowRays<'a> {
    pub bvh: &'a Bvh,
    /// Metres along the normal; twice as much before the light they end.
    pub offset_m: f32,
}

impl ShadowRays<'_> {
    /// Whether anything lies between a surface point and a light `distance` metres away in the unit direction. A normal of 0
    /// is that of a place without a surface, which the ray need not leave.
    pub fn occluded(&self, position_ws: Vec3, normal_ws: Vec3, mut direction_ws: Vec3, mut distance: f32) -> bool {
        let offset = normal_ws * self.offset_m;
        // Off the surface the light lies another way; a sun is too far for squares of floats.
        if offset != Vec3::ZERO && distance < 1e15 {
            let to_light = direction_ws * distance - offset;
            distance = to_light.length();
            direction_ws = to_light / distance.max(1e-12);
        }
        let limit = distance - 2.0 * self.offset_m;
        limit > 0.0 && self.bvh.occluded(position_ws + offset, direction_ws, limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, Material, Mesh, Scene};
    use glam::Mat4;

    /// A square metre in the plane y = 0.
    fn square() -> Bvh {
        let corners = [[-0.5, 0.0, -0.5], [0.5, 0.0, -0.5], [0.5, 0.0, 0.5], [-0.5, 0.0, 0.5]];
        let indices = vec![0, 2, 1, 0, 3, 2];
        let mesh = Mesh { positions: corners.map(Vec3::from_array).to_vec(), indices, ..Mesh::default() };
        let draws = vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }];
        Bvh::build(&Scene { meshes: vec![mesh], draws, materials: vec![Material::default()], ..Scene::default() })
            .unwrap()
    }

    #[test]
    fn a_ray_leaves_its_surface_and_ends_before_what_lies_at_the_light() {
        let bvh = square();
        let rays = ShadowRays { bvh: &bvh, offset_m: 0.01 };
        let below = Vec3::new(0.1, -1e-3, 0.2);
        // Rounding has put the point under its own surface.
        assert!(!rays.occluded(below, Vec3::Y, Vec3::Y, 3.0));
        assert!(ShadowRays { offset_m: 1e-4, ..rays }.occluded(below, Vec3::Y, Vec3::Y, 3.0));
        // The square is the light, or before it, or behind it.
        let above = Vec3::new(0.1, 2.0, 0.2);
        for (distance, is_hidden) in [(2.0, false), (2.05, true), (1.9, false)] {
            assert_eq!(rays.occluded(above, Vec3::ZERO, -Vec3::Y, distance), is_hidden, "{distance}");
        }
        assert!(rays.occluded(above, Vec3::ZERO, -Vec3::Y, 1e30), "a sun has no place");
        assert!(!rays.occluded(below, Vec3::Y, Vec3::Y, 0.015), "nothing is left of the ray");
    }

    /// From a point a little off its surface the ray goes to the light all the same.
    #[test]
    fn an_offset_turns_the_ray_to_the_light() {
        let bvh = square();
        let rays = ShadowRays { bvh: &bvh, offset_m: 0.1 };
        // To a light at (0.52, -1, 0) from (0.52, 1, 0) whose normal is +x: straight down past the edge, and off by 0.1 m
        // the ray still ends at the light, so it stays outside.
        let position = Vec3::new(0.52, 1.0, 0.0);
        assert!(!rays.occluded(position, Vec3::X, -Vec3::Y, 2.0));
        // With the normal -x it begins above the square and crosses it.
        assert!(rays.occluded(position, -Vec3::X, -Vec3::Y, 2.0));
    }
}
