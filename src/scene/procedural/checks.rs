//! What every procedural mesh and scene must be: the tests of all of them call this.

use glam::{Vec3, Vec4};

use crate::scene::{Material, Mesh, Scene};

/// Lengths, indices, unit normals that agree with the winding, tangents, unmirrored texture coordinates.
pub fn assert_mesh_is_sound(mesh: &Mesh) {
    let name = &mesh.name;
    let count = mesh.positions.len();
    assert!(mesh.triangle_count() > 0 && mesh.indices.len().is_multiple_of(3), "{name}");
    assert!(mesh.normals.len() == count && mesh.tangents.len() == count && mesh.uvs.len() == count, "{name}");
    assert!(mesh.normal_groups.is_empty() || mesh.normal_groups.len() == count, "{name}");
    assert!(mesh.indices.iter().all(|index| (*index as usize) < count), "{name}");
    assert!(mesh.positions.iter().all(|position| position.is_finite()), "{name}");
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()), "{name}");
    for (normal, tangent) in mesh.normals.iter().zip(&mesh.tangents) {
        assert!((normal.length() - 1.0).abs() < 1e-5, "{name}: normal {normal}");
        if *tangent != Vec4::ZERO {
            assert!((tangent.truncate().length() - 1.0).abs() < 1e-5, "{name}: tangent {tangent}");
            assert!(tangent.truncate().dot(*normal).abs() < 1e-5, "{name}: tangent {tangent}, normal {normal}");
            assert_eq!(tangent.w, 1.0, "{name}");
        }
    }
    for triangle in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.triangle(triangle);
        let geometric = (b - a).cross(c - a);
        assert!(geometric.length() > 1e-10, "{name}: triangle {triangle} has no area: {a} {b} {c}");
        let indices = [0, 1, 2].map(|corner| mesh.indices[3 * triangle + corner] as usize);
        for index in indices {
            let normal = mesh.normals[index];
            assert!(geometric.dot(normal) > 0.0, "{name}: normal {normal} against the winding of {a} {b} {c}");
        }
        // v runs down: counter-clockwise in space is clockwise in the picture.
        let [a, b, c] = indices.map(|index| mesh.uvs[index]);
        assert!((b - a).perp_dot(c - a) < 1e-9, "{name}: triangle {triangle} mirrors its texture: {a} {b} {c}");
    }
}

/// Every mesh, every index from one list into another, and names on everything.
pub fn assert_scene_is_sound(scene: &Scene) {
    let Scene { name, meshes, materials, textures, images, lights, cameras, .. } = scene;
    assert_eq!(scene.hash.len(), 64, "{name}");
    let is_lit = !lights.is_empty() || scene.drawn_materials().any(Material::is_emissive);
    assert!(!cameras.is_empty() && is_lit && !scene.draws.is_empty(), "{name}");
    for mesh in meshes {
        assert_mesh_is_sound(mesh);
        let has_tangents = mesh.tangents.iter().all(|tangent| *tangent != Vec4::ZERO);
        assert_eq!(has_tangents, materials[mesh.material].normal_texture.is_some(), "{name}: {}", mesh.name);
    }
    for draw in &scene.draws {
        assert!(draw.mesh < meshes.len(), "{name}");
        assert!(draw.world_from_object.determinant() > 0.0, "{name}: {}", meshes[draw.mesh].name);
    }
    for material in materials {
        let all = [
            material.base_color_texture,
            material.metallic_roughness_texture,
            material.normal_texture,
            material.emissive_texture,
        ];
        assert!(all.iter().flatten().all(|texture| *texture < textures.len()), "{name}: {}", material.name);
        assert!(material.base_color.min_element() >= 0.0 && material.base_color.max_element() <= 1.0, "{name}");
    }
    assert!(textures.iter().all(|texture| texture.image < images.len()), "{name}");
    assert!(images.iter().all(|image| image.rgba8.len() == (4 * image.width * image.height) as usize), "{name}");
    assert!(lights.iter().all(|light| light.intensity.cmpge(Vec3::ZERO).all()), "{name}");
    for camera in cameras {
        let view = camera.world_from_view;
        assert!((view.determinant() - 1.0).abs() < 1e-5, "{name}: {}", camera.name);
    }
    let mut names: Vec<&String> = meshes.iter().map(|mesh| &mesh.name).collect();
    names.extend(materials.iter().map(|material| &material.name));
    names.extend(images.iter().map(|image| &image.name));
    names.extend(lights.iter().map(|light| &light.name));
    names.extend(cameras.iter().map(|camera| &camera.name));
    assert!(names.iter().all(|name| !name.is_empty()), "{name}");
}

/// A hash of what is drawn: vertices, indices, places, pictures, lights.
pub fn fingerprint(scene: &Scene) -> String {
    let mut hasher = blake3::Hasher::new();
    for mesh in &scene.meshes {
        hasher.update(bytemuck::cast_slice(&mesh.positions));
        hasher.update(bytemuck::cast_slice(&mesh.normals));
        hasher.update(bytemuck::cast_slice(&mesh.tangents));
        hasher.update(bytemuck::cast_slice(&mesh.uvs));
        hasher.update(bytemuck::cast_slice(&mesh.indices));
    }
    for draw in &scene.draws {
        hasher.update(bytemuck::bytes_of(&draw.world_from_object));
    }
    for image in &scene.images {
        hasher.update(&image.rgba8);
    }
    for light in &scene.lights {
        hasher.update(bytemuck::bytes_of(&light.position));
        hasher.update(bytemuck::bytes_of(&light.intensity));
    }
    hasher.finalize().to_hex().to_string()
}
