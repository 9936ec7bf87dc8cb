//! Small scenes of squares, for pictures that a formula knows.

use glam::{Mat4, Vec2, Vec3, Vec4, vec3};
use quincunx::scene::{Camera, Draw, Light, LightKind, Material, Mesh, Projection, Scene};

/// Adds a rectangle around `center` with half sides `half_u` and `half_v`; its front is the side of their cross product.
pub fn rectangle(scene: &mut Scene, center: Vec3, half_u: Vec3, half_v: Vec3, material: Material) {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    scene.meshes.push(Mesh {
        positions: corners.map(|(u, v)| center + half_u * u + half_v * v).to_vec(),
        normals: vec![half_u.cross(half_v).normalize(); 4],
        tangents: vec![Vec4::ZERO; 4],
        uvs: corners.map(|(u, v)| Vec2::new(0.5 + 0.5 * u, 0.5 - 0.5 * v)).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
        material: scene.materials.len(),
        ..Mesh::default()
    });
    scene.draws.push(Draw { mesh: scene.meshes.len() - 1, world_from_object: Mat4::IDENTITY });
    scene.materials.push(material);
}

/// A closed box around the origin, its sides 2 long, seen from inside.
pub fn closed_box(material: &Material) -> Scene {
    let mut scene = Scene { name: "box".to_owned(), ..Scene::default() };
    for (out, u) in [(Vec3::X, Vec3::Y), (Vec3::Y, Vec3::Z), (Vec3::Z, Vec3::X)] {
        for out in [out, -out] {
            rectangle(&mut scene, out, u, (-out).cross(u), material.clone());
        }
    }
    scene
}

/// A camera at `eye` that looks at `target`, with a vertical angle of `y_fov` radians.
pub fn camera(eye: Vec3, target: Vec3, y_fov: f32) -> Camera {
    let back = (eye - target).normalize();
    let aside = if back.y.abs() > 0.9 { Vec3::Z } else { Vec3::Y };
    let right = aside.cross(back).normalize();
    let up = back.cross(right);
    Camera {
        name: "eye".to_owned(),
        world_from_view: Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), eye.extend(1.0)),
        projection: Projection::Perspective { y_fov, aspect: None, z_near: 0.01, z_far: None },
    }
}

pub fn point_light(position: Vec3, candela: f32) -> Light {
    Light {
        name: String::new(),
        kind: LightKind::Point,
        intensity: vec3(candela, 0.5 * candela, 0.25 * candela),
        position,
        direction: -Vec3::Y,
        range: None,
        radius: 0.0,
    }
}

/// A surface that gives light and takes none.
pub fn panel(radiance: Vec3) -> Material {
    Material { emissive: radiance, ..Material::diffuse("panel", Vec3::ZERO) }
}

/// A square that stands before a wall, from the paper's figure 4: between both runs an edge that no texel of the light
/// buffer follows. `wall_light`: candela of a light that reaches the wall and not the square.
pub fn edge(wall_light: f32) -> Scene {
    let mut scene =
        Scene { name: format!("edge {wall_light}"), hash: format!("edge {wall_light}"), ..Scene::default() };
    let gray = Material::diffuse("gray", Vec3::splat(0.5));
    rectangle(&mut scene, vec3(0.0, 0.0, -6.0), 6.0 * Vec3::X, 6.0 * Vec3::Y, gray.clone());
    let (u, v) = (vec3(0.9, 0.3, 0.0), vec3(-0.3, 0.9, 0.0));
    rectangle(&mut scene, vec3(-0.5, -0.4, -3.0), u, v, gray);
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, 0.9));
    let of_wall = Light { range: Some(2.0), ..point_light(vec3(0.3, 0.2, -5.0), wall_light) };
    scene.lights.push(point_light(Vec3::ZERO, 5.0));
    scene.lights.push(of_wall);
    scene
}
