//! Area lights: connected emissive surfaces, and points of them for shadow rays (Dubla 2009, section 3.3).
//!
//! A draw's emissive triangles that share corners are one light. Points of a light are chosen by power over its
//! triangles and evenly over each, by two numbers, so that points of numbers that are spread are spread over the light.

use crate::gpu::shader::structs::AreaSampleBlock;
use crate::lights::emitters::luminous;
use crate::scene::{Draw, Mesh, Scene};
use crate::shading::material::{MeshPoint, emissive_at};
use glam::Vec3;
use std::collections::HashMap;

/// A triangle that shines.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ShiningTriangle {
    /// Index into the scene's draws.
    draw: usize,
    /// Index into its mesh's triangles.
    triangle: usize,
    /// Radiance times area, summed over channels.
    power: f64,
}

/// A light: triangles that are connected, or all those that were left.
#[derive(Clone, Debug)]
pub struct AreaLight {
    triangles: Vec<ShiningTriangle>,
    power: f64,
    /// Power of each triangle and all before it, as a part of `power`.
    cumulative: Vec<f64>,
}

/// The area lights of a scene, the most powerful first; where there are more than `most`, at least 1, all
/// beyond it are the last one.
///
/// Textures are left out of the choice of triangles: one that is off costs noise, not truth.
pub fn area_lights(scene: &Scene, most: usize) -> Vec<AreaLight> {
    let mut lights: Vec<AreaLight> = Vec::new();
    for (index, draw) in scene.draws.iter().enumerate() {
        let mesh = &scene.meshes[draw.mesh];
        let material = &scene.materials[mesh.material];
        if !material.is_emissive() {
            continue;
        }
        let radiance = luminous(material.emissive);
        for triangles in connected(mesh) {
            let shining: Vec<ShiningTriangle> = triangles
                .into_iter()
                .map(|triangle| {
                    let [a, b, c] = corners(draw, mesh, triangle);
                    let area = 0.5 * (b - a).cross(c - a).length();
                    ShiningTriangle { draw: index, triangle, power: radiance * f64::from(area) }
                })
                .filter(|shining| shining.power > 0.0)
                .collect();
            let power: f64 = shining.iter().map(|shining| shining.power).sum();
            if power > 0.0 {
                lights.push(AreaLight::of(shining));
            }
        }
    }
    lights.sort_by(|one, other| other.power.total_cmp(&one.power));
    if lights.len() > most {
        let beyond = lights.split_off(most - 1);
        lights.push(AreaLight::of(beyond.into_iter().flat_map(|light| light.triangles).collect()));
    }
    lights
}

fn corners(draw: &Draw, mesh: &Mesh, triangle: usize) -> [Vec3; 3] {
    mesh.triangle(triangle).map(|corner| draw.world_from_object.transform_point3(corner))
}

/// A mesh's triangles in groups that share corners, each in the mesh's order: corners at one place are one.
fn connected(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut place_of: HashMap<[u32; 3], usize> = HashMap::new();
    let mut parents: Vec<usize> = Vec::new();
    fn root(parents: &mut [usize], mut at: usize) -> usize {
        while parents[at] != at {
            parents[at] = parents[parents[at]];
            at = parents[at];
        }
        at
    }
    let mut first_corners = Vec::with_capacity(mesh.triangle_count());
    for triangle in 0..mesh.triangle_count() {
        let places = mesh.triangle(triangle).map(|corner| {
            // 0 and -0 are one place.
            let next = place_of.len();
            *place_of.entry((corner + 0.0).to_array().map(f32::to_bits)).or_insert(next)
        });
        parents.extend(parents.len()..place_of.len());
        let [a, b, c] = places.map(|place| root(&mut parents, place));
        parents[b] = a;
        let c = root(&mut parents, c);
        parents[c] = a;
        first_corners.push(places[0]);
    }
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut group_of: HashMap<usize, usize> = HashMap::new();
    for (triangle, place) in first_corners.into_iter().enumerate() {
        let group = *group_of.entry(root(&mut parents, place)).or_insert_with(|| {
            groups.push(Vec::new());
            groups.len() - 1
        });
        groups[group].push(triangle);
    }
    groups
}

impl AreaLight {
    fn of(triangles: Vec<ShiningTriangle>) -> Self {
        let power: f64 = triangles.iter().map(|shining| shining.power).sum();
        let mut sum = 0.0;
        let up_to = |shining: &ShiningTriangle| {
            sum += shining.power / power;
            sum
        };
        let cumulative = triangles.iter().map(up_to).collect();
        Self { triangles, power, cumulative }
    }

    /// Points of it, each of which stands for all of the light: the mean over them is what the light gives. `numbers`: two for
    /// each, as `at` takes them.
    pub fn points(&self, scene: &Scene, numbers: &[[f32; 2]]) -> Vec<AreaSampleBlock> {
        numbers.iter().map(|numbers| self.at(scene, *numbers)).collect()
    }

    /// The point of two numbers, 0 to 1 without 1. `scene`: of which it is a light, or that one at another moment.
    pub fn at(&self, scene: &Scene, [pick, v]: [f32; 2]) -> AreaSampleBlock {
        let pick = f64::from(pick);
        let at = self.cumulative.partition_point(|sum| *sum <= pick).min(self.triangles.len() - 1);
        let before = if at == 0 { 0.0 } else { self.cumulative[at - 1] };
        let chance = self.triangles[at].power / self.power;
        // What the choice left of the number is a number again.
        let u = ((pick - before) / chance).clamp(0.0, 1.0);
        self.point(scene, &self.triangles[at], chance, [u as f32, v])
    }

    fn point(&self, scene: &Scene, shining: &ShiningTriangle, chance: f64, [u, v]: [f32; 2]) -> AreaSampleBlock {
        let draw = &scene.draws[shining.draw];
        let mesh = &scene.meshes[draw.mesh];
        let material = &scene.materials[mesh.material];
        let [a, b, c] = corners(draw, mesh, shining.triangle);
        let root = u.sqrt();
        let weights = [1.0 - root, root * (1.0 - v), root * v];
        // As long as twice the area.
        let front = draw.front(mesh, shining.triangle).as_vec3();
        let radiance = emissive_at(scene, material, &MeshPoint::on(mesh, mesh.corners(shining.triangle), weights));
        let area = f64::from(0.5 * front.length()) / chance;
        AreaSampleBlock {
            position_ws: (a * weights[0] + b * weights[1] + c * weights[2]).extend(0.0).to_array(),
            normal_ws: front.normalize_or_zero().extend(f32::from(u8::from(material.double_sided))).to_array(),
            intensity: (radiance * area as f32).extend(0.0).to_array(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pairs::in_order;
    use crate::sampling::sampler::Sampler;
    use crate::scene::Material;
    use glam::{Mat4, Vec4, vec3};

    /// Squares of 1 m at these places, of two triangles each that share corners by place alone, radiance 2.
    fn panels(places: &[f32]) -> Scene {
        let square = [Vec3::ZERO, Vec3::X, vec3(1.0, 1.0, 0.0), Vec3::ZERO, vec3(1.0, 1.0, 0.0), Vec3::Y];
        let positions: Vec<Vec3> = places.iter().flat_map(|x| square.map(|corner| corner + Vec3::X * *x)).collect();
        let mesh = Mesh { indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() };
        Scene {
            meshes: vec![mesh],
            draws: vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }],
            materials: vec![Material { emissive: Vec3::splat(2.0), ..Material::diffuse("", Vec3::ZERO) }],
            ..Scene::default()
        }
    }

    #[test]
    fn what_is_connected_is_one_light_and_what_is_left_is_the_last() {
        // The second touches the first, the third is apart.
        let counts = |most| {
            let lights = area_lights(&panels(&[0.0, 1.0, 5.0, 9.0]), most);
            lights.iter().map(|light| light.triangles.len()).collect::<Vec<_>>()
        };
        assert_eq!(counts(9), [4, 2, 2]);
        assert_eq!(counts(2), [4, 4]);
        assert_eq!(counts(1), [8]);
        let mut dark = panels(&[0.0]);
        dark.materials[0].emissive = Vec3::ZERO;
        assert!(area_lights(&dark, 4).is_empty());
    }

    #[test]
    fn points_lie_on_the_light_and_their_mean_is_its_power() {
        let scene = panels(&[0.0, 5.0]);
        let light = &area_lights(&scene, 1)[0];
        let points = light.points(&scene, &in_order(Sampler::Sobol, [16, 1], 32, 7));
        let mut right = 0;
        for point in &points {
            let [x, y, z, _] = point.position_ws;
            let x = if x > 3.0 { x - 5.0 } else { x };
            right += u32::from(point.position_ws[0] > 3.0);
            assert!((0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y) && z == 0.0, "{point:?}");
            assert_eq!(point.normal_ws, [0.0, 0.0, 1.0, 0.0]);
            // Radiance 2 over the two square metres that each stands for.
            assert!((Vec4::from_array(point.intensity).x - 4.0).abs() < 1e-4);
        }
        assert!((250..=262).contains(&right), "{right} of 512");
        // Every stretch of 16 has points on both.
        for stretch in points.chunks(16) {
            let right = stretch.iter().filter(|point| point.position_ws[0] > 3.0).count();
            assert!((4..=12).contains(&right), "{right}");
        }
    }

    #[test]
    fn a_mirrored_light_shines_the_way_its_front_faces() {
        let mut scene = panels(&[0.0]);
        scene.draws[0].world_from_object = Mat4::from_scale(vec3(-1.0, 1.0, 1.0));
        scene.materials[0].double_sided = true;
        let point = area_lights(&scene, 1)[0].at(&scene, [0.5; 2]);
        assert_eq!(point.normal_ws, [0.0, 0.0, 1.0, 1.0]);
    }
}
