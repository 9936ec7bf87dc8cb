//! glTF files that load: built here in the small, and the shared scenes where QUINCUNX_SCENES names their folder.

mod allowed;
mod animation;
mod animation_broken;
mod broken;
mod broken_corpus;

use std::f32::consts::FRAC_1_SQRT_2;
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::support::gltf_file::{F32, GltfFile, U8, U16, U32, load_bytes, png, write};
use crate::support::shared_scenes;
use glam::{Mat3, Vec2, Vec3};
use quincunx::scene::{AlphaMode, ColorSpace, LightKind, Projection, Scene, Wrap, gltf};
use serde_json::json;

#[test]
fn a_bare_triangle_gets_flat_normals_and_the_default_material() {
    let scene = GltfFile::triangle().load().unwrap();
    assert_eq!(scene.name, "scene");
    assert_eq!((scene.triangle_count(), scene.draws.len(), scene.materials.len()), (1, 1, 1));
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.name, "leaf");
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    assert_eq!(mesh.uvs, [Vec2::ZERO; 3]);
    assert_eq!(mesh.tangents.len(), 3);
    assert_eq!(scene.warnings, [] as [&str; 0]);
}

#[test]
fn all_index_types_and_modes_make_the_same_triangles() {
    let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 9.0, 9.0, 9.0];
    for component_type in [U8, U16, U32] {
        for (mode, indices) in [(4, vec![0, 1, 2, 2, 1, 3]), (5, vec![0, 1, 2, 3]), (6, vec![1, 3, 2, 0])] {
            let mut file = GltfFile::empty();
            let positions = file.floats("VEC3", &corners);
            let normals = file.floats("VEC3", &[0.0, 0.0, 2.0].repeat(5));
            let indices = file.indices(component_type, &indices);
            let primitive = json!({
                "attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices, "mode": mode
            });
            file.push("meshes", json!({"primitives": [primitive]}));
            file.root(json!({"mesh": 0}));
            let scene = file.load().unwrap();
            let mesh = &scene.meshes[0];
            assert_eq!(mesh.triangle_count(), 2);
            // The fifth vertex belongs to no triangle.
            assert_eq!(mesh.positions.len(), 4);
            assert_eq!(scene.bounds().max, Vec3::new(1.0, 1.0, 0.0));
            for triangle in 0..2 {
                let [a, b, c] = mesh.triangle(triangle);
                assert_eq!((b - a).cross(c - a), Vec3::Z, "mode {mode}");
            }
            assert_eq!(mesh.normals, [Vec3::Z; 4]);
        }
    }
}

#[test]
fn interleaved_and_sparse_values_are_found() {
    let mut file = GltfFile::triangle();
    let rows: [[f32; 5]; 3] = [[0.0, 0.0, 1.0, 0.25, 0.5], [1.0, 0.0, 1.0, 0.75, 0.5], [0.0, 1.0, 1.0, 0.25, 1.0]];
    let view = file.view(&rows.concat().iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>());
    file.json["bufferViews"][view]["byteStride"] = json!(20);
    let interleaved = |offset: u32, kind: &str| {
        json!({
            "bufferView": view, "byteOffset": offset, "componentType": F32, "count": 3, "type": kind,
        })
    };
    let positions = file.push("accessors", interleaved(0, "VEC3"));
    let uvs = file.push("accessors", interleaved(12, "VEC2"));
    let places = file.view(&[2]);
    let values = file.view(&[5f32, 6.0, 7.0].map(f32::to_le_bytes).concat());
    file.json["accessors"][positions]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": places, "componentType": U8},
        "values": {"bufferView": values},
    });
    file.primitive()["attributes"] = json!({"POSITION": positions, "TEXCOORD_0": uvs});
    let scene = file.load().unwrap();
    assert_eq!(scene.meshes[0].positions[..2], [Vec3::Z, Vec3::new(1.0, 0.0, 1.0)]);
    assert_eq!(scene.meshes[0].positions[2], Vec3::new(5.0, 6.0, 7.0));
    assert_eq!(scene.meshes[0].uvs, [Vec2::new(0.25, 0.5), Vec2::new(0.75, 0.5), Vec2::new(0.25, 1.0)]);
}

/// Without a buffer view an accessor is 0 before its sparse values; the other attributes bound how long it may be.
#[test]
fn sparse_values_may_stand_alone() {
    let mut file = GltfFile::triangle();
    for (component_type, places) in [(U8, vec![1, 2]), (U16, vec![1, 0, 2, 0]), (U32, vec![1, 0, 0, 0, 2, 0, 0, 0])] {
        let places = file.view(&places);
        let values = file.view(&[2f32, 0.0, 0.0, 0.0, 3.0, 0.0].map(f32::to_le_bytes).concat());
        let positions = file.push(
            "accessors",
            json!({
                "componentType": F32, "count": 3, "type": "VEC3",
                "sparse": {
                    "count": 2,
                    "indices": {"bufferView": places, "componentType": component_type},
                    "values": {"bufferView": values},
                },
            }),
        );
        file.primitive()["attributes"]["POSITION"] = json!(positions);
        let scene = file.load().unwrap();
        assert_eq!(scene.meshes[0].positions, [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 3.0], "{component_type}");
    }
}

/// KHR_mesh_quantization allows every integer for every attribute, at strides of whole words.
#[test]
fn attributes_of_every_component_type_are_read_at_their_stride() {
    const I8: u32 = 5120;
    const I16: u32 = 5122;
    for (component_type, normalized, bytes_each, greatest) in [
        (I8, true, 1, 127),
        (U8, true, 1, 255),
        (I16, true, 2, 32767),
        (U16, true, 2, 65535),
        (I8, false, 1, 1),
        (U8, false, 1, 1),
        (I16, false, 2, 1),
        (U16, false, 2, 1),
    ] {
        let mut file = GltfFile::triangle();
        let mut bytes = Vec::new();
        for uv in [[0, greatest], [greatest, greatest], [greatest, 0]] {
            for value in uv {
                bytes.extend(&u32::to_le_bytes(value)[..bytes_each]);
            }
            bytes.resize(bytes.len().next_multiple_of(12), 0xee);
        }
        let view = file.view(&bytes);
        file.json["bufferViews"][view]["byteStride"] = json!(12);
        let uvs = file.push(
            "accessors",
            json!({"bufferView": view, "componentType": component_type, "normalized": normalized, "count": 3,
                "type": "VEC2"}),
        );
        file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        file.primitive()["attributes"]["TEXCOORD_0"] = json!(uvs);
        let scene = file.load().unwrap();
        assert_eq!(scene.meshes[0].uvs, [Vec2::Y, Vec2::ONE, Vec2::X], "{component_type} {normalized}");
    }
}

#[test]
fn matrices_and_trs_place_alike_and_mirrors_stay() {
    let mut file = GltfFile::triangle();
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    file.json["nodes"] = json!([
        {"mesh": 0, "translation": [1, 2, 3], "rotation": [0, FRAC_1_SQRT_2, 0, FRAC_1_SQRT_2], "scale": [2, 3, 4]},
        {"mesh": 0, "matrix": [0, 0, -2, 0, 0, 3, 0, 0, 4, 0, 0, 0, 1, 2, 3, 1]},
        {"mesh": 0, "scale": [-1, 1, 1], "children": [4]},
        {"mesh": 0, "scale": [1, 0, 1]},
        {"mesh": 0, "translation": [5, 0, 0]},
    ]);
    let scene = file.load().unwrap();
    assert_eq!(scene.draws.len(), 4);
    let transforms: Vec<_> = scene.draws.iter().map(|draw| draw.world_from_object).collect();
    assert!(transforms[0].abs_diff_eq(transforms[1], 1e-5), "{} {}", transforms[0], transforms[1]);
    assert_eq!(Mat3::from_mat4(transforms[2]).determinant(), -1.0);
    assert_eq!(transforms[3].transform_point3(Vec3::ZERO), Vec3::new(-5.0, 0.0, 0.0));
    assert_eq!(scene.warnings.len(), 1);
    assert!(scene.warnings[0].contains("node 3"), "{:?}", scene.warnings);
}

#[test]
fn a_deep_hierarchy_does_not_overflow_the_stack() {
    let mut file = GltfFile::triangle();
    let depth = 100_000;
    file.json["nodes"] = (0..depth).map(|node| json!({"children": [node + 1], "translation": [1, 0, 0]})).collect();
    file.push("nodes", json!({"mesh": 0}));
    let scene = file.load().unwrap();
    assert_eq!(scene.bounds().min.x, depth as f32);
}

#[test]
fn without_a_scene_all_roots_are_shown() {
    let mut file = GltfFile::triangle();
    file.json["nodes"] = json!([{"children": [1]}, {"mesh": 0}, {"mesh": 0}]);
    file.json.as_object_mut().unwrap().remove("scenes");
    assert_eq!(file.load().unwrap().draws.len(), 2);
    file.json["scenes"] = json!([{"nodes": [2]}, {"nodes": [0, 2]}]);
    assert_eq!(file.load().unwrap().draws.len(), 1);
    file.json["scene"] = json!(1);
    assert_eq!(file.load().unwrap().draws.len(), 2);
}

#[test]
fn lights_are_placed_and_turned() {
    let mut file = GltfFile::empty();
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "name": "lamp", "color": [1, 0.5, 0], "intensity": 10, "range": 3},
        {"type": "spot", "intensity": 2, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
        {"type": "directional"},
    ]}});
    let light = |index: u32| json!({"KHR_lights_punctual": {"light": index}});
    file.root(json!({"extensions": light(0), "translation": [1, 2, 3], "scale": [9, 9, 9]}));
    // Turned by 90 degrees about x: -z becomes +y.
    let turned = json!([FRAC_1_SQRT_2, 0, 0, FRAC_1_SQRT_2]);
    file.root(json!({"extensions": light(1), "rotation": turned, "scale": [2, 2, 2], "name": "beam"}));
    file.root(json!({"extensions": light(2)}));
    let scene = file.load().unwrap();
    let [lamp, beam, sun] = &scene.lights[..] else { panic!("{:?}", scene.lights) };
    assert_eq!((lamp.name.as_str(), lamp.kind, lamp.range), ("lamp", LightKind::Point, Some(3.0)));
    assert_eq!((lamp.intensity, lamp.position), (Vec3::new(10.0, 5.0, 0.0), Vec3::new(1.0, 2.0, 3.0)));
    assert_eq!((beam.name.as_str(), beam.kind), ("beam", LightKind::Spot { inner_angle: 0.25, outer_angle: 0.5 }));
    assert!(beam.direction.abs_diff_eq(Vec3::Y, 1e-6), "{}", beam.direction);
    assert_eq!((sun.name.as_str(), sun.kind), ("light 2", LightKind::Directional));
    assert_eq!((sun.direction, sun.intensity), (Vec3::NEG_Z, Vec3::ONE));
}

#[test]
fn cameras_are_named_and_rigid() {
    let mut file = GltfFile::empty();
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    let flat = json!({"xmag": 2.0, "ymag": 1.0, "znear": 0.0, "zfar": 10.0});
    file.push("cameras", json!({"type": "orthographic", "orthographic": flat, "name": "plan"}));
    file.root(json!({"camera": 0, "name": "eye", "translation": [1, 2, 3], "scale": [2, 2, 2]}));
    file.root(json!({"camera": 1, "name": "node"}));
    file.root(json!({"camera": 0}));
    let scene = file.load().unwrap();
    let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    assert_eq!(names, ["eye", "plan", "camera 0"]);
    assert_eq!(scene.cameras[0].world_from_view, glam::Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0)));
    let perspective = Projection::Perspective { y_fov: 1.0, aspect: None, z_near: 0.1, z_far: None };
    assert_eq!(scene.cameras[0].projection, perspective);
    let plan = Projection::Orthographic { x_mag: 2.0, y_mag: 1.0, z_near: 0.0, z_far: 10.0 };
    assert_eq!(scene.cameras[1].projection, plan);
}

#[test]
fn materials_share_images_in_two_colour_spaces_and_normal_maps_get_tangents() {
    let mut file = GltfFile::triangle();
    let view = file.view(&png(3, 2));
    let unused = file.view(b"no picture");
    file.json["images"] = json!([
        {"bufferView": unused, "mimeType": "image/png"},
        {"bufferView": view, "mimeType": "image/png", "name": "grain"},
    ]);
    file.json["samplers"] = json!([{"magFilter": 9728, "minFilter": 9985, "wrapS": 33071, "wrapT": 33648}]);
    file.json["textures"] = json!([{"source": 0}, {"source": 1, "sampler": 0}]);
    file.json["extensionsUsed"] = json!(["KHR_materials_emissive_strength", "KHR_materials_sheen"]);
    file.push(
        "materials",
        json!({
            "name": "felt", "alphaMode": "MASK", "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.5, 0.25, 2.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.75,
                "baseColorTexture": {"index": 1}, "metallicRoughnessTexture": {"index": 1, "texCoord": 1},
            },
            "normalTexture": {"index": 1, "scale": 0.5},
            "occlusionTexture": {"index": 1, "texCoord": 2, "strength": 0.25},
            "emissiveTexture": {"index": 1}, "emissiveFactor": [1.0, 0.5, 0.0],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4.0}},
        }),
    );
    let uvs = file.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    file.primitive()["attributes"]["TEXCOORD_0"] = json!(uvs);
    file.primitive()["material"] = json!(0);
    let scene = file.load().unwrap();

    let felt = &scene.materials[0];
    assert_eq!(scene.materials.len(), 1);
    assert_eq!(felt.base_color.to_array(), [0.5, 0.25, 1.0, 1.0]);
    assert_eq!((felt.metallic, felt.roughness, felt.normal_scale), (0.0, 0.75, 0.5));
    assert_eq!(felt.emissive, Vec3::new(4.0, 2.0, 0.0));
    assert_eq!((felt.alpha, felt.double_sided), (AlphaMode::Mask { cutoff: 0.5 }, true));
    assert_eq!((felt.base_color_texture, felt.emissive_texture), (Some(0), Some(0)));
    assert_eq!((felt.metallic_roughness_texture, felt.normal_texture), (Some(1), Some(1)));
    assert_eq!((felt.occlusion_texture, felt.occlusion_strength), (Some(1), 0.25));
    assert_eq!(felt.placements.map(|placement| placement.uv_set), [0, 1, 0, 0, 0]);
    assert_eq!(
        scene.textures.iter().map(|texture| texture.color_space).collect::<Vec<_>>(),
        [ColorSpace::Srgb, ColorSpace::Linear]
    );
    let sampler = scene.textures[1].sampler;
    assert_eq!((sampler.wrap_u, sampler.wrap_v), (Wrap::ClampToEdge, Wrap::MirroredRepeat));
    assert_eq!((sampler.mag_linear, sampler.min_linear, sampler.mip_linear), (false, true, Some(false)));
    // Only what a material shows is decoded.
    assert_eq!(scene.images.len(), 1);
    assert_eq!((scene.images[0].name.as_str(), scene.images[0].width, scene.images[0].height), ("grain", 3, 2));
    assert_eq!(scene.images[0].rgba8, [1, 2, 3, 4].repeat(6));
    assert_eq!(scene.meshes[0].tangents, [glam::Vec4::new(1.0, 0.0, 0.0, 1.0); 3]);
    for word in ["UV set", "clamped", "KHR_materials_sheen"] {
        assert_eq!(scene.warnings.iter().filter(|warning| warning.contains(word)).count(), 1, "{:?}", scene.warnings);
    }
}

#[test]
fn buffers_come_from_data_uris_and_files_and_change_the_hash() {
    let file = GltfFile::triangle();
    let with_uri = |uri: &str| {
        let mut json = file.json.clone();
        json["buffers"] = json!([{"byteLength": file.bytes.len(), "uri": uri}]);
        json.to_string()
    };
    let hex: String = file.bytes.iter().map(|byte| format!("%{byte:02x}")).collect();
    let embedded = load_bytes("a.gltf", with_uri(&format!("data:application/octet-stream,{hex}")).as_bytes()).unwrap();
    assert_eq!(embedded.triangle_count(), 1);

    let json = with_uri("my%20leaf.bin");
    let (_folder, path) = write(&[("b.gltf", json.as_bytes()), ("my leaf.bin", &file.bytes)]);
    let external = gltf::load(&path).unwrap();
    assert_eq!((external.name.as_str(), external.hash.len()), ("b", 64));
    assert_eq!(external.hash, gltf::load(&path).unwrap().hash);
    let mut moved = file.bytes.clone();
    moved[15] ^= 1;
    let (_folder, path) = write(&[("b.gltf", json.as_bytes()), ("my leaf.bin", &moved)]);
    assert_ne!(external.hash, gltf::load(&path).unwrap().hash);
}

#[test]
fn points_lines_and_empty_primitives_draw_nothing() {
    let mut file = GltfFile::triangle();
    for mode in [0, 1, 2, 3] {
        file.json["meshes"][0]["primitives"]
            .as_array_mut()
            .unwrap()
            .push(json!({"attributes": {"POSITION": 0}, "mode": mode}));
    }
    let two = file.indices(U8, &[0, 1]);
    file.json["meshes"][0]["primitives"]
        .as_array_mut()
        .unwrap()
        .push(json!({"attributes": {"POSITION": 0}, "indices": two}));
    let scene = file.load().unwrap();
    assert_eq!((scene.meshes.len(), scene.draws.len()), (1, 1));
    assert!(scene.warnings[0].starts_with("4 primitives of points or lines"), "{:?}", scene.warnings);
}

/// Triangles, point lights, directional lights, cameras, materials, and how many of them MASK and BLEND.
fn counts(scene: &Scene) -> [usize; 7] {
    let lights = |kind| scene.lights.iter().filter(|light| light.kind == kind).count();
    let mask = scene.materials.iter().filter(|material| matches!(material.alpha, AlphaMode::Mask { .. })).count();
    let blend = scene.materials.iter().filter(|material| material.alpha == AlphaMode::Blend).count();
    [
        scene.triangle_count() as usize,
        lights(LightKind::Point),
        lights(LightKind::Directional),
        scene.cameras.len(),
        scene.materials.len(),
        mask,
        blend,
    ]
}

#[test]
fn the_maps_hold_what_their_table_says() {
    let Some(folder) = shared_scenes() else { return };
    for (name, expected) in [
        ("kaos", [28_230, 187, 1, 13, 51, 1, 0]),
        ("pul1duel-oa", [18_540, 981, 1, 15, 73, 5, 6]),
        ("oa_thor", [33_892, 1662, 1, 83, 49, 2, 9]),
    ] {
        let start = Instant::now();
        let scene = gltf::load(&folder.join(format!("maps/{name}.glb"))).unwrap();
        println!("{name}: {:?}, {:?}", start.elapsed(), scene.warnings);
        assert_eq!(counts(&scene), expected, "{name}");
        let floats = scene.meshes.iter().flat_map(|mesh| &mesh.normals);
        assert!(floats.into_iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5), "{name}");
    }
}

fn gltf_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            gltf_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "gltf" || extension == "glb") {
            found.push(path);
        }
    }
}

#[test]
fn every_shared_scene_loads() {
    let Some(folder) = shared_scenes() else { return };
    let mut files = Vec::new();
    gltf_files(&folder, &mut files);
    files.sort();
    for path in files {
        let start = Instant::now();
        let scene = gltf::load(&path).unwrap();
        println!("{} {:?} {:?} {:?}", scene.name, counts(&scene), start.elapsed(), scene.warnings);
        assert!(!scene.draws.is_empty(), "{}", path.display());
        for mesh in &scene.meshes {
            assert!(mesh.indices.iter().all(|index| (*index as usize) < mesh.positions.len()));
            let lengths = [mesh.normals.len(), mesh.tangents.len(), mesh.uvs.len()];
            assert_eq!(lengths, [mesh.positions.len(); 3], "{}", path.display());
            assert!(mesh.material < scene.materials.len());
        }
    }
}

/// MikkTSpace made the tangents in this file, and they are mirrored in places: ours must point the same way.
#[test]
fn made_tangents_agree_with_those_in_a_file() {
    let Some(folder) = shared_scenes() else { return };
    let folder = folder.join("samples/NormalTangentMirrorTest");
    let given = gltf::load(&folder.join("NormalTangentMirrorTest.gltf")).unwrap();

    let copy = tempfile::tempdir().unwrap();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        std::fs::copy(&path, copy.path().join(path.file_name().unwrap())).unwrap();
    }
    let path = copy.path().join("without.gltf");
    let text = std::fs::read_to_string(folder.join("NormalTangentMirrorTest.gltf")).unwrap();
    let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
    for primitive in json["meshes"][0]["primitives"].as_array_mut().unwrap() {
        primitive["attributes"].as_object_mut().unwrap().remove("TANGENT");
    }
    std::fs::write(&path, json.to_string()).unwrap();
    let made = gltf::load(&path).unwrap();

    let (mut agreeing, mut corners) = (0, 0);
    for (given, made) in given.meshes.iter().zip(&made.meshes) {
        for (given_index, made_index) in given.indices.iter().zip(&made.indices) {
            let (given, made) = (given.tangents[*given_index as usize], made.tangents[*made_index as usize]);
            agreeing += usize::from(given.w == made.w && given.truncate().dot(made.truncate()) > 0.9);
            corners += 1;
        }
    }
    println!("{agreeing} of {corners} corners agree");
    assert!(agreeing * 100 >= corners * 99, "{agreeing} of {corners} corners agree");
}
