//! Which way the front faces of a scene look: what a camera that is made up stands before.

use super::mesh::Facing;
use super::{Draw, Material, Mesh, Scene};

impl Facing {
    /// The faces of everything that is drawn.
    pub fn of(scene: &Scene) -> Self {
        let mut facing = Self::default();
        for draw in &scene.draws {
            let mesh = &scene.meshes[draw.mesh];
            facing.include(draw, mesh, &scene.materials[mesh.material]);
        }
        facing
    }

    /// Adds the faces of `mesh`, which is the one drawn, of `material`.
    pub fn include(&mut self, draw: &Draw, mesh: &Mesh, material: &Material) {
        for triangle in 0..mesh.triangle_count() {
            let front = 0.5 * draw.front(mesh, triangle);
            if !front.is_finite() {
                continue;
            }
            self.along += front.abs();
            self.area += front.length();
            if !material.double_sided {
                self.net += front;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use glam::{Mat4, Vec3};

    fn plane(double_sided: bool, world_from_object: Mat4) -> Scene {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
        let material = Material { double_sided, ..Material::default() };
        Scene {
            meshes: vec![Mesh { positions, indices: vec![0, 1, 2, 0, 2, 3], ..Mesh::default() }],
            draws: vec![Draw { mesh: 0, world_from_object }],
            materials: vec![material],
            ..Scene::default()
        }
    }

    #[test]
    fn fronts_look_where_the_renderer_draws_them() {
        let twice = Mat4::from_scale(Vec3::new(2.0, 3.0, 1.0));
        assert_eq!(Facing::of(&plane(false, twice)).net, DVec3::Z * 6.0);
        // A mirror turns the winding around, and the renderer turns it back: a wall mirrored in its own plane looks the same way.
        let mirrored = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        assert_eq!(Facing::of(&plane(false, mirrored)).net, DVec3::Z);
        let turned = Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0));
        assert_eq!(Facing::of(&plane(false, turned)).net, -DVec3::Z);
    }

    #[test]
    fn what_is_seen_from_both_sides_has_area_and_no_side() {
        let facing = Facing::of(&plane(true, Mat4::IDENTITY));
        assert_eq!((facing.net, facing.along, facing.area), (DVec3::ZERO, DVec3::Z, 1.0));
    }
}
