//! Whether a scene's emissive surfaces light it, or only glow: a helmet's lamps do not show the helmet.

use crate::scene::Scene;
use crate::shading::material::{self, MeshPoint};
use glam::Vec3;

/// Where a triangle's emission is looked up: its middle, and near its corners.
const LOOKED_AT: [[f32; 3]; 4] = [[1.0 / 3.0; 3], [0.8, 0.1, 0.1], [0.1, 0.8, 0.1], [0.1, 0.1, 0.8]];

/// What all surfaces together send out of their own, in lumens a square metre of surface, as the mean of the three
/// channels; an estimate from four places a triangle. 0 where there is no surface.
pub fn mean_exitance(scene: &Scene) -> f32 {
    let (mut flux, mut area) = (0.0f64, 0.0f64);
    for draw in &scene.draws {
        let mesh = &scene.meshes[draw.mesh];
        let material = &scene.materials[mesh.material];
        for triangle in 0..mesh.triangle_count() {
            let [a, b, c] = mesh.triangle(triangle).map(|corner| draw.world_from_object.transform_point3(corner));
            let triangle_area = f64::from(0.5 * (b - a).cross(c - a).length());
            area += triangle_area;
            if material.is_emissive() {
                let radiance: Vec3 = LOOKED_AT
                    .iter()
                    .map(|weights| MeshPoint::on(mesh, mesh.corners(triangle), *weights))
                    .map(|point| material::emissive_at(scene, material, &point))
                    .sum();
                flux += triangle_area * f64::from(radiance.element_sum() / (3.0 * LOOKED_AT.len() as f32));
            }
        }
    }
    if area > 0.0 { (std::f64::consts::PI * flux / area) as f32 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, Material, Mesh};
    use glam::Mat4;

    #[test]
    fn the_mean_is_over_all_surfaces() {
        let triangle = |material| Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            indices: vec![0, 1, 2],
            material,
            ..Mesh::default()
        };
        let mut scene = Scene {
            meshes: vec![triangle(0), triangle(1)],
            materials: vec![
                Material { emissive: Vec3::new(6.0, 0.0, 0.0), ..Material::diffuse("lamp", Vec3::ZERO) },
                Material::diffuse("wall", Vec3::ONE),
            ],
            ..Scene::default()
        };
        assert_eq!(mean_exitance(&scene), 0.0);
        // The wall is nine times as large as the lamp.
        for (mesh, scale) in [(0, 1.0), (1, 3.0)] {
            scene.draws.push(Draw { mesh, world_from_object: Mat4::from_scale(Vec3::splat(scale)) });
        }
        assert!((mean_exitance(&scene) - std::f32::consts::PI * 2.0 / 10.0).abs() < 1e-6);
    }
}
