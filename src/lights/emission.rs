//! How much of a scene its emissive surfaces light: whether they are its lamps, or only glow.

use crate::picture::tonemap::{REC709_WEIGHTS, weighted};
use crate::scene::{Bounds, Draw, Material, Mesh, Scene, TextureSlot};
use crate::shading::material::{MeshPoint, emissive_at};
use glam::{DVec3, Vec3};

/// Texels looked up for all triangles of a material together, where it has fewer triangles: each of them is looked at in as
/// many places then, so that a panel of two triangles does not depend on two texels.
const LOOKUPS: usize = 1 << 14;
/// Rows of places on one triangle at most.
const MOST_ROWS: usize = 64;

/// Part of the surfaces, by area, that emissive ones let be seen: that shine with a luminance of at least `least_radiance`
/// themselves; or all, where what shines gives white surfaces so much on average. Both sides of what is double-sided count.
///
/// Why this is the measure: a glow on a dark body shows itself, and the body stays black, however bright the glow is. What
/// lights others is estimated without a ray: in a closed room of area S, flux F gives F / S lux on average, from however
/// small a lamp, before any of it is reflected. What leaves the scene's box on the way lights nothing: of a lamp's flux
/// that part counts that the box has before the lamp's plane. Emissive textures are read where the triangles have them,
/// not as their whole mean: of an atlas that many materials share, a lamp shows one spot.
pub fn lit_part(scene: &Scene, least_radiance: f64) -> f64 {
    let bounds = scene.bounds();
    let (mut sent, mut shining_area, mut area) = (0.0, 0.0, 0.0);
    for draw in &scene.draws {
        let mesh = &scene.meshes[draw.mesh];
        let material = &scene.materials[mesh.material];
        let sides = if material.double_sided { 2.0 } else { 1.0 };
        let rows = rows(mesh, material);
        for triangle in 0..mesh.triangle_count() {
            let front = draw.front(mesh, triangle);
            let one_side = 0.5 * front.length();
            // What is not a number, and what has no area, is not seen.
            if one_side.is_nan() || one_side <= 0.0 {
                continue;
            }
            area += sides * one_side;
            if rows == 0 {
                continue;
            }
            let glow = Glow::of(scene, material, mesh, triangle, rows, least_radiance);
            shining_area += sides * one_side * glow.shining_part;
            // Before and behind a plane there is all of the box.
            let before = if material.double_sided { 1.0 } else { part_before(&bounds, draw, mesh, triangle, front) };
            sent += one_side * before * glow.radiance;
        }
    }
    if area == 0.0 {
        0.0
    } else if sent >= least_radiance * area {
        1.0
    } else {
        shining_area / area
    }
}

/// The part of the box before the triangle's plane, along `front`, which is normal to it; 0 to 1.
fn part_before(bounds: &Bounds, draw: &Draw, mesh: &Mesh, triangle: usize, front: DVec3) -> f64 {
    let corner = draw.world_from_object.transform_point3(mesh.triangle(triangle)[0]);
    let half = 0.5 * (bounds.max - bounds.min).as_dvec3();
    let reach = half.dot(front.abs());
    let at = front.dot((corner - bounds.center()).as_dvec3());
    if reach > 0.0 { ((reach - at) / (2.0 * reach)).clamp(0.0, 1.0) } else { 0.0 }
}

/// Rows of places at which each triangle is sampled; 0 where it sends no light.
fn rows(mesh: &Mesh, material: &Material) -> usize {
    if !material.is_emissive() {
        return 0;
    }
    match material.texture(TextureSlot::Emissive) {
        None => 1,
        Some(_) => (LOOKUPS / mesh.triangle_count().max(1)).isqrt().clamp(1, MOST_ROWS),
    }
}

/// Light that a triangle sends.
struct Glow {
    /// Mean luminance.
    radiance: f64,
    /// Part of it that sends at least as much as is asked for.
    shining_part: f64,
}

impl Glow {
    /// Looked at in the middles of the `rows` squared triangles that the triangle is cut into.
    fn of(scene: &Scene, material: &Material, mesh: &Mesh, triangle: usize, rows: usize, least_radiance: f64) -> Self {
        let corners = mesh.corners(triangle);
        let third = 1.0 / (3 * rows) as f32;
        let (mut sum, mut shining_count) = (0.0, 0);
        let mut look = |thirds: [usize; 2]| {
            let [u, v] = thirds.map(|count| count as f32 * third);
            let point = MeshPoint::on(mesh, corners, [1.0 - u - v, u, v]);
            let radiance = luminance(emissive_at(scene, material, &point));
            sum += radiance;
            shining_count += u32::from(radiance >= least_radiance);
        };
        for row in 0..rows {
            for column in 0..rows - row {
                look([3 * row + 1, 3 * column + 1]);
                if row + column + 1 < rows {
                    look([3 * row + 2, 3 * column + 2]);
                }
            }
        }
        let count = (rows * rows) as f64;
        Self { radiance: sum / count, shining_part: f64::from(shining_count) / count }
    }
}

fn luminance(color: Vec3) -> f64 {
    weighted(color.to_array().map(f64::from), REC709_WEIGHTS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ColorSpace, Image, Sampler, Texture};
    use glam::{Mat4, Vec2};

    /// A square of 1 m that sends `radiance` where its texture, white on the left and black on the right, lets it; and a dark
    /// one of `dark_m2`.
    fn scene(radiance: f32, dark_m2: f32) -> Scene {
        let square = |material: usize| Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y],
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
            indices: vec![0, 1, 2, 0, 2, 3],
            material,
            ..Mesh::default()
        };
        let shining =
            Material { emissive: Vec3::splat(radiance), emissive_texture: Some(0), ..Material::diffuse("", Vec3::ONE) };
        let rgba8 = [[255; 4], [0, 0, 0, 255]].concat();
        let sampler = Sampler { mag_linear: false, ..Sampler::default() };
        Scene {
            meshes: vec![square(0), square(1)],
            draws: [(0, 1.0), (1, dark_m2)]
                .map(|(mesh, x)| Draw { mesh, world_from_object: Mat4::from_scale(Vec3::new(x, 1.0, 1.0)) })
                .to_vec(),
            materials: vec![shining, Material::diffuse("", Vec3::ONE)],
            images: vec![Image { name: String::new(), width: 2, height: 1, rgba8 }.into()],
            textures: vec![Texture { image: 0, sampler, color_space: ColorSpace::Srgb }],
            ..Scene::default()
        }
    }

    #[test]
    fn what_glows_shows_itself_by_area_and_where_the_texture_has_it() {
        for (dark_m2, expected) in [(1.0, 0.25), (3.0, 0.125)] {
            let part = lit_part(&scene(2.0, dark_m2), 0.5);
            assert!((part - expected).abs() < 0.01, "{part}, {expected}");
            assert_eq!(lit_part(&scene(0.4, dark_m2), 0.5), 0.0, "too faint to be seen");
        }
        // Only the white texel of the picture: half of it would be wrong.
        let mut spot = scene(2.0, 1.0);
        spot.meshes[0].uvs = vec![Vec2::new(0.2, 0.5); 4];
        assert!((lit_part(&spot, 0.5) - 0.5).abs() < 1e-6);
        // Both sides, of three in all, where they light nothing else.
        spot.materials[0].double_sided = true;
        assert!((lit_part(&spot, 1.5) - 2.0 / 3.0).abs() < 1e-6);
        spot.materials[0].unlit = true;
        assert_eq!(lit_part(&spot, 0.5), 0.0);
        assert_eq!(lit_part(&Scene::default(), 0.5), 0.0);
    }

    #[test]
    fn a_lamp_lights_a_room_by_its_flux_and_a_glow_on_a_body_nothing() {
        // A cube of 1 m, seen from inside or from outside, a hundredth of whose lid shines.
        let cube = |is_room: bool, radiance: f32| {
            let mut scene = scene(radiance, 1.0);
            scene.materials[0].emissive_texture = None;
            scene.meshes[1].positions = scene.meshes[0].positions.clone();
            let turned = |x: f32, y: f32| Mat4::from_rotation_y(y) * Mat4::from_rotation_x(x);
            let quarter = std::f32::consts::FRAC_PI_2;
            let sides = [(0.0, 0.0), (0.0, 1.0), (0.0, 2.0), (0.0, 3.0), (1.0, 0.0), (-1.0, 0.0)];
            let side = Mat4::from_translation(Vec3::new(-0.5, -0.5, if is_room { -0.5 } else { 0.5 }));
            let mut draws: Vec<Draw> = sides
                .map(|(x, y)| Draw { mesh: 1, world_from_object: turned(x * quarter, y * quarter) * side })
                .to_vec();
            let lamp = side * Mat4::from_scale(Vec3::new(0.1, 0.1, 1.0));
            draws.push(Draw { mesh: 0, world_from_object: turned(-quarter, 0.0) * lamp });
            Scene { draws, ..scene }
        };
        // 0.01 square metres of 30 or of 20, over 6.01 of white surface: 0.0499 and 0.0333.
        assert_eq!(lit_part(&cube(true, 30.0), 0.04), 1.0);
        assert!((lit_part(&cube(true, 20.0), 0.04) - 0.01 / 6.01).abs() < 1e-6);
        assert!((lit_part(&cube(false, 3000.0), 0.04) - 0.01 / 6.01).abs() < 1e-6);
    }

    #[test]
    fn places_lie_on_the_triangle_and_count_alike() {
        // Along u, which grows evenly over the triangle, the mean is that of the corners.
        let mut scene = scene(1.0, 1.0);
        let image = Image { name: String::new(), width: 3, height: 1, rgba8: [[0; 4], [128; 4], [255; 4]].concat() };
        scene.images = vec![image.into()];
        scene.textures[0].sampler.mag_linear = true;
        scene.textures[0].color_space = ColorSpace::Linear;
        scene.meshes[0].uvs = [1.0, 5.0, 5.0, 1.0].map(|sixths| Vec2::new(sixths / 6.0, 0.5)).to_vec();
        for rows in [1, 2, 7] {
            let glow = |triangle| Glow::of(&scene, &scene.materials[0], &scene.meshes[0], triangle, rows, 2.0).radiance;
            let [a, b] = [0, 1].map(glow);
            assert!((0.5 * (a + b) - 0.5).abs() < 0.002 && (a - 2.0 / 3.0).abs() < 0.003, "{rows}: {a} {b}");
        }
    }
}
