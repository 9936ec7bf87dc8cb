//! Moving glTF files: nodes, skins and morph targets where their curves have them, built here in the small, and the shared
//! scenes where QUINCUNX_SCENES names their folder.

use std::f32::consts::FRAC_1_SQRT_2;

use crate::support::gltf_file::{GltfFile, U8, U16, png};
use crate::support::shared_scenes;
use glam::{Quat, Vec3};
use quincunx::scene::gltf::Model;
use quincunx::scene::{AnimationChoice, LightKind, Scene};
use serde_json::json;

/// The two scenes have the same meshes, vertices, triangles and draws in the same order.
#[track_caller]
fn require_same_structure(a: &Scene, b: &Scene) {
    assert_eq!(a.meshes.len(), b.meshes.len());
    for (a, b) in a.meshes.iter().zip(&b.meshes) {
        assert_eq!((&a.name, a.material, a.positions.len()), (&b.name, b.material, b.positions.len()));
        let lengths = [a.normals.len(), a.tangents.len(), a.uvs.len()];
        assert_eq!((lengths, &a.indices), ([b.normals.len(), b.tangents.len(), b.uvs.len()], &b.indices));
        assert_eq!(lengths, [a.positions.len(); 3]);
    }
    let meshes = |scene: &Scene| scene.draws.iter().map(|draw| draw.mesh).collect::<Vec<_>>();
    assert_eq!(meshes(a), meshes(b));
}

fn origin(scene: &Scene, draw: usize) -> Vec3 {
    scene.draws[draw].world_from_object.w_axis.truncate()
}

#[test]
fn nodes_lights_and_cameras_move_together() {
    let mut file = GltfFile::triangle();
    file.json["nodes"][0]["children"] = json!([1]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "directional"}]}});
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    file.push("nodes", json!({"mesh": 0, "camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}));
    let turned = [0.0, 0.0, 0.0, 1.0, FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
    file.animate(0, "translation", "LINEAR", &[1.0, 3.0], ("VEC3", &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]));
    file.animate(1, "rotation", "LINEAR", &[0.0, 2.0], ("VEC4", &turned));
    file.animate(1, "scale", "STEP", &[0.0, 2.0], ("VEC3", &[1.0, 1.0, 1.0, 2.0, 3.0, 4.0]));
    let model = file.model(&AnimationChoice::All).unwrap();
    for (time_s, x) in [(0.0, 0.0), (1.0, 0.0), (1.5, 1.0), (3.0, 4.0), (99.0, 4.0)] {
        let scene = model.pose(time_s).unwrap();
        assert_eq!(origin(&scene, 0), Vec3::X * x, "{time_s}");
        assert_eq!(origin(&scene, 1), Vec3::X * x, "{time_s}");
        assert_eq!(scene.cameras[0].world_from_view.w_axis.truncate(), Vec3::X * x, "{time_s}");
    }
    let half = model.pose(1.0).unwrap();
    let (scale, rotation, _) = half.draws[1].world_from_object.to_scale_rotation_translation();
    assert!(rotation.abs_diff_eq(Quat::from_rotation_x(std::f32::consts::FRAC_PI_4), 1e-6), "{rotation}");
    assert!(scale.abs_diff_eq(Vec3::ONE, 1e-6), "{scale}");
    let late = model.pose(2.0).unwrap();
    assert!(late.lights[0].direction.abs_diff_eq(Vec3::Y, 1e-6), "{}", late.lights[0].direction);
    assert_eq!(late.lights[0].kind, LightKind::Directional);
    let scale = late.draws[1].world_from_object.to_scale_rotation_translation().0;
    assert!(scale.abs_diff_eq(Vec3::new(2.0, 3.0, 4.0), 1e-5), "{scale}");
    assert_eq!(late.warnings, [] as [&str; 0]);
    // The made-up camera's box holds all of it: x from 0 to 5, whatever the moment.
    assert_eq!(late.lasting_bounds(), half.lasting_bounds());
    assert!(late.lasting_bounds().max.x >= 5.0 && half.bounds().max.x < 2.0);
}

#[test]
fn integers_that_stand_for_rotations_and_weights_are_read() {
    for (component_type, one, half) in [(5120, 127, 90), (U8, 255, 180), (5122, 32767, 23170), (U16, 65535, 46340)] {
        let mut file = GltfFile::triangle();
        // 90 degrees about x.
        let bytes: Vec<u8> = [0, 0, 0, one, half, 0, 0, half]
            .iter()
            .flat_map(|value: &i32| value.to_le_bytes()[..if component_type < 5122 { 1 } else { 2 }].to_vec())
            .collect();
        let view = file.view(&bytes);
        let output = json!({"bufferView": view, "componentType": component_type, "normalized": true, "count": 2, "type": "VEC4"});
        file.animate(0, "rotation", "LINEAR", &[0.0, 1.0], ("VEC4", &[0.0; 8]));
        let output = file.push("accessors", output);
        file.json["animations"][0]["samplers"][0]["output"] = json!(output);
        let scene = file.model(&AnimationChoice::All).unwrap().pose(1.0).unwrap();
        let up = scene.draws[0].world_from_object.transform_vector3(Vec3::Y);
        assert!(up.abs_diff_eq(Vec3::Z, 1e-5), "{component_type}: {up}");
    }
}

#[test]
fn animations_are_chosen_by_name_or_index_and_the_first_wins() {
    let mut file = GltfFile::triangle();
    file.json["nodes"][0]["translation"] = json!([9, 0, 0]);
    let to = |x: f32| [x, 0.0, 0.0];
    file.animate(0, "translation", "LINEAR", &[0.0], ("VEC3", &to(1.0)));
    file.animate(0, "translation", "LINEAR", &[0.0], ("VEC3", &to(2.0)));
    file.json["animations"][1]["name"] = json!("walk");
    let x_of = |choice: &str| {
        let scene = file.model(&AnimationChoice::parse(choice)).unwrap().pose(0.0).unwrap();
        (origin(&scene, 0).x, scene.warnings.len(), scene.hash)
    };
    let (all, none, second, walk) = (x_of("all"), x_of("none"), x_of("1"), x_of("walk"));
    assert_eq!([all.0, none.0, second.0, walk.0, x_of("0").0], [1.0, 9.0, 2.0, 2.0, 1.0]);
    assert_eq!([all.1, none.1, second.1], [1, 0, 0]);
    let scene = file.model(&AnimationChoice::All).unwrap().pose(0.0).unwrap();
    assert!(scene.warnings[0].contains("animation 1 \"walk\", channel 0"), "{:?}", scene.warnings);
    assert!(all.2 != none.2 && all.2 != second.2 && none.2 != second.2);
    for wrong in ["2", "run", "-1"] {
        let error = file.model(&AnimationChoice::parse(wrong)).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("index below 2") && error.to_string().contains("walk"), "{error}");
    }
}

#[test]
fn the_hash_tells_moments_apart_where_something_plays() {
    let mut file = GltfFile::triangle();
    let hash = |file: &GltfFile, choice: &str, time_s| {
        file.model(&AnimationChoice::parse(choice)).unwrap().pose(time_s).unwrap().hash
    };
    assert_eq!(hash(&file, "all", 0.0), hash(&file, "none", 5.0));
    file.animate(0, "scale", "LINEAR", &[0.0], ("VEC3", &[2.0; 3]));
    assert_eq!(hash(&file, "all", 1.0), hash(&file, "all", 1.0));
    assert_ne!(hash(&file, "all", 1.0), hash(&file, "all", 1.5));
    assert_eq!(hash(&file, "none", 1.0), hash(&file, "none", 1.5));
}

/// A strip of three pairs of vertices at y = 0, 1, 2, bent about x at y = 1 by a second joint, which turns by 90 degrees
/// within 2 seconds. Its own node stands far away.
fn strip() -> GltfFile {
    let mut file = GltfFile::empty();
    let rows = [0.0f32, 1.0, 2.0];
    let positions: Vec<f32> = rows.iter().flat_map(|y| [-0.5, *y, 0.0, 0.5, *y, 0.0]).collect();
    let positions = file.floats("VEC3", &positions);
    let normals = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(6));
    let tangents = file.floats("VEC4", &[0.0, 1.0, 0.0, 1.0].repeat(6));
    let joints = file.indices(U8, &[0, 1, 7, 7].repeat(6));
    file.json["accessors"][joints]["type"] = json!("VEC4");
    file.json["accessors"][joints]["count"] = json!(6);
    // Twice what they should be: they are made to sum up to 1. Joints without weight may name anything.
    let weights: Vec<f32> = rows.iter().flat_map(|y| [2.0 - y, *y, 0.0, 0.0].repeat(2)).collect();
    let weights = file.floats("VEC4", &weights);
    let indices = file.indices(U8, &[0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5]);
    let view = file.view(&png(1, 1));
    file.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    file.push("textures", json!({"source": 0}));
    file.push("materials", json!({"normalTexture": {"index": 0}}));
    let attributes = json!({"POSITION": positions, "NORMAL": normals, "TANGENT": tangents, "JOINTS_0": joints, "WEIGHTS_0": weights});
    file.push("meshes", json!({"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}));
    let identity = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let mut back = identity;
    back[13] = -1.0;
    let inverse_bind = file.floats("MAT4", &[identity, back].concat());
    file.root(json!({"mesh": 0, "skin": 0, "translation": [100, 0, 0]}));
    file.root(json!({"name": "root", "children": [2]}));
    file.push("nodes", json!({"name": "hinge", "translation": [0, 1, 0]}));
    file.push("skins", json!({"joints": [1, 2], "inverseBindMatrices": inverse_bind}));
    let turned = [0.0, 0.0, 0.0, 1.0, FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
    file.animate(2, "rotation", "LINEAR", &[0.0, 2.0], ("VEC4", &turned));
    file
}

#[track_caller]
fn require_bent(scene: &Scene, what: &str) {
    let mesh = &scene.meshes[scene.draws[0].mesh];
    let near = |found: Vec3, expected: [f32; 3]| {
        assert!(found.abs_diff_eq(Vec3::from_array(expected), 1e-5), "{what}: {found} for {expected:?}");
    };
    for (side, x) in [(0, -0.5), (1, 0.5)] {
        near(mesh.positions[side], [x, 0.0, 0.0]);
        near(mesh.positions[2 + side], [x, 1.0, 0.0]);
        near(mesh.positions[4 + side], [x, 1.0, 1.0]);
        near(mesh.normals[side], [0.0, 0.0, 1.0]);
        near(mesh.normals[2 + side], [0.0, -FRAC_1_SQRT_2, FRAC_1_SQRT_2]);
        near(mesh.normals[4 + side], [0.0, -1.0, 0.0]);
        near(mesh.tangents[4 + side].truncate(), [0.0, 0.0, 1.0]);
    }
}

#[test]
fn a_strip_bends_at_its_second_joint() {
    let model = strip().model(&AnimationChoice::All).unwrap();
    let (rest, bent) = (model.pose(0.0).unwrap(), model.pose(2.0).unwrap());
    assert_eq!((rest.meshes.len(), rest.draws[0].world_from_object), (1, glam::Mat4::IDENTITY));
    assert_eq!(rest.meshes[0].positions[5], Vec3::new(0.5, 2.0, 0.0));
    require_bent(&bent, "as built");
    require_same_structure(&rest, &bent);
    // Half way: 45 degrees.
    let half = model.pose(1.0).unwrap().meshes[0].positions[5];
    assert!(half.abs_diff_eq(Vec3::new(0.5, 1.0 + FRAC_1_SQRT_2, FRAC_1_SQRT_2), 1e-5), "{half}");
}

#[test]
fn joints_and_weights_have_every_type_and_a_second_set() {
    for (component_type, one) in [(U8, 255u32), (U16, 65535)] {
        let mut file = strip();
        let weights: Vec<u32> =
            [[one, 0], [one / 2, one / 2], [0, one]].iter().flat_map(|[a, b]| [*a, *b, 0, 0].repeat(2)).collect();
        let weights = file.indices(component_type, &weights);
        let joints = file.indices(U16, &[0, 1, 0, 0].repeat(6));
        for accessor in [weights, joints] {
            file.json["accessors"][accessor]["type"] = json!("VEC4");
            file.json["accessors"][accessor]["count"] = json!(6);
        }
        file.json["accessors"][weights]["normalized"] = json!(true);
        let attributes = &mut file.primitive()["attributes"];
        (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
        require_bent(&file.model(&AnimationChoice::All).unwrap().pose(2.0).unwrap(), "integers");
    }
    // The second set has the hinge, the first the root.
    let mut file = strip();
    let joints = [0, 1].map(|joint| {
        let joints = file.indices(U8, &[joint; 24]);
        file.json["accessors"][joints]["type"] = json!("VEC4");
        file.json["accessors"][joints]["count"] = json!(6);
        joints
    });
    let weights = [[1.0, 0.5, 0.0], [0.0, 0.5, 1.0]].map(|column| {
        let rows: Vec<f32> = column.iter().flat_map(|weight| [*weight, 0.0, 0.0, 0.0].repeat(2)).collect();
        file.floats("VEC4", &rows)
    });
    let attributes = &mut file.primitive()["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints[0]), json!(weights[0]));
    (attributes["JOINTS_1"], attributes["WEIGHTS_1"]) = (json!(joints[1]), json!(weights[1]));
    require_bent(&file.model(&AnimationChoice::All).unwrap().pose(2.0).unwrap(), "two sets");
}

#[test]
fn without_inverse_bind_matrices_joints_take_the_mesh_as_it_is() {
    let mut file = strip();
    file.json["skins"][0].as_object_mut().unwrap().remove("inverseBindMatrices");
    let scene = file.model(&AnimationChoice::None).unwrap().pose(0.0).unwrap();
    assert_eq!(scene.meshes[0].positions[5], Vec3::new(0.5, 3.0, 0.0));
    assert_eq!(scene.meshes[0].positions[0], Vec3::new(-0.5, 0.0, 0.0));
}

#[test]
fn nodes_that_share_a_mesh_bend_it_each_for_itself() {
    let mut file = strip();
    // The second node has no skin, the third another one, which does not turn.
    file.root(json!({"mesh": 0, "translation": [0, 0, 7]}));
    file.push("skins", json!({"joints": [1, 1]}));
    file.root(json!({"mesh": 0, "skin": 1}));
    let scene = file.model(&AnimationChoice::All).unwrap().pose(2.0).unwrap();
    assert_eq!((scene.meshes.len(), scene.draws.len()), (3, 3));
    require_bent(&scene, "the first");
    let [_, still, other] = [0, 1, 2].map(|draw| scene.meshes[scene.draws[draw].mesh].positions[5]);
    assert_eq!([still, other], [Vec3::new(0.5, 2.0, 0.0); 2]);
    assert_eq!(origin(&scene, 1), Vec3::Z * 7.0);
}

#[test]
fn morph_targets_add_up_and_weights_come_from_animation_node_or_mesh() {
    let mut file = GltfFile::triangle();
    let lift = file.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]);
    let slide = file.floats("VEC3", &[2.0, 0.0, 0.0].repeat(3));
    file.primitive()["targets"] = json!([{"POSITION": lift}, {"POSITION": slide}]);
    let corner = |file: &GltfFile, time_s: f64| {
        let scene = file.model(&AnimationChoice::All).unwrap().pose(time_s).unwrap();
        let mesh = &scene.meshes[scene.draws[0].mesh];
        // The file has no normals: they stay those of the triangle, however it bends.
        let [a, b, c] = mesh.triangle(0);
        let normal = (b - a).cross(c - a).normalize();
        assert!(mesh.normals.iter().all(|found| found.abs_diff_eq(normal, 1e-6)), "{:?}", mesh.normals);
        c
    };
    assert_eq!(corner(&file, 0.0), Vec3::Y);
    file.json["meshes"][0]["weights"] = json!([0.25, 0.0]);
    assert_eq!(corner(&file, 0.0), Vec3::new(0.0, 1.0, 1.0));
    file.json["nodes"][0]["weights"] = json!([0.0, -0.5]);
    assert_eq!(corner(&file, 0.0), Vec3::new(-1.0, 1.0, 0.0));
    // In-tangents, values and out-tangents of both targets, at 0 and at 2 s.
    let values = [[0.0, 0.0], [0.0, 1.0], [2.0, 0.0], [0.0, 0.0], [1.0, 1.0], [0.0, 0.0]].concat();
    file.animate(0, "weights", "CUBICSPLINE", &[0.0, 2.0], ("SCALAR", &values));
    assert_eq!(corner(&file, 0.0), Vec3::new(2.0, 1.0, 0.0));
    assert_eq!(corner(&file, 2.0), Vec3::new(2.0, 1.0, 4.0));
    // (0 + 1) / 2 + 2 (2 - 0) / 8 = 1.
    assert!(corner(&file, 1.0).abs_diff_eq(Vec3::new(2.0, 1.0, 4.0), 1e-5));
}

#[test]
fn morphed_normals_and_tangents_stay_unit_and_parted_vertices_follow() {
    let mut file = strip();
    let grow = file.floats("VEC3", &[0.0, 0.0, 5.0].repeat(6));
    let lean = file.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0].repeat(3));
    file.primitive()["targets"] = json!([{"POSITION": grow, "NORMAL": lean}]);
    file.json["nodes"][0] = json!({"mesh": 0, "weights": [1.0]});
    let scene = file.model(&AnimationChoice::All).unwrap().pose(0.0).unwrap();
    let mesh = &scene.meshes[0];
    assert!(mesh.positions.iter().all(|position| position.z == 5.0));
    assert_eq!(mesh.normals[0], Vec3::Z);
    assert!(mesh.normals[1].abs_diff_eq(Vec3::new(FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2), 1e-6), "{}", mesh.normals[1]);
    for (tangent, normal) in mesh.tangents.iter().zip(&mesh.normals) {
        assert!((tangent.truncate().length() - 1.0).abs() < 1e-5 && tangent.truncate().dot(*normal).abs() < 1e-5);
    }
    // Without normals each triangle gets vertices of its own, which the targets and joints must find again.
    let mut flat = strip();
    flat.primitive()["attributes"].as_object_mut().unwrap().remove("NORMAL");
    flat.primitive()["targets"] = json!([{"POSITION": grow}]);
    flat.json["accessors"] = file.json["accessors"].clone();
    flat.json["bufferViews"] = file.json["bufferViews"].clone();
    flat.bytes = file.bytes.clone();
    let scene = flat.model(&AnimationChoice::All).unwrap().pose(2.0).unwrap();
    let last = scene.meshes[0].triangle(3)[2];
    assert_eq!(scene.meshes[0].positions.len(), 12);
    assert!(last.abs_diff_eq(Vec3::new(0.5, 1.0, 1.0), 1e-5), "{last}");
}

#[test]
fn a_draw_that_is_flattened_for_a_moment_stays_in_the_scene() {
    let mut file = GltfFile::triangle();
    file.root(json!({"mesh": 0, "translation": [3, 0, 0]}));
    file.animate(1, "scale", "STEP", &[0.0, 1.0], ("VEC3", &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]));
    let model = file.model(&AnimationChoice::All).unwrap();
    let (gone, there) = (model.pose(0.0).unwrap(), model.pose(1.0).unwrap());
    require_same_structure(&gone, &there);
    assert_eq!((gone.draws.len(), &gone.warnings[..]), (2, &[][..]));
    let corner = gone.draws[1].world_from_object.transform_point3(Vec3::X);
    assert!(corner.abs_diff_eq(Vec3::X * 3.0, 1e-7), "{corner}");
    assert_eq!(there.draws[1].world_from_object.transform_point3(Vec3::X), Vec3::X * 4.0);
}

fn model_of(file: &str) -> Option<Model> {
    shared_scenes().map(|folder| Model::open(&folder.join(file), &AnimationChoice::All).unwrap())
}

/// How many draws stand elsewhere at the second moment.
fn moved(a: &Scene, b: &Scene) -> usize {
    require_same_structure(a, b);
    a.draws.iter().zip(&b.draws).filter(|(a, b)| a.world_from_object != b.world_from_object).count()
}

#[test]
fn the_rigged_cylinder_bends_by_what_its_animation_says() {
    let Some(model) = model_of("samples/RiggedSimple/RiggedSimple.gltf") else { return };
    let (start, bent) = (model.pose(1.0 / 24.0).unwrap(), model.pose(25.0 / 24.0).unwrap());
    assert_eq!(moved(&start, &bent), 0);
    let (a, b) = (&start.meshes[0], &bent.meshes[0]);
    let by_height = |x: &usize, y: &usize| a.positions[*x].y.total_cmp(&a.positions[*y].y);
    let top = (0..a.positions.len()).max_by(by_height).unwrap();
    let bottom = (0..a.positions.len()).min_by(by_height).unwrap();
    // About x, from a half sine of -0.002 at key 0 to 0.293 (with a cosine of -0.956) at key 1.
    let degrees = a.normals[top].angle_between(b.normals[top]).to_degrees();
    assert!((33.8..34.2).contains(&degrees), "{degrees}");
    assert!(a.positions[top].distance(b.positions[top]) > 1.0);
    assert!(a.positions[bottom].distance(b.positions[bottom]) < 1e-4);
    assert!(b.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5));
}

#[test]
fn wheels_turn_boxes_open_and_movers_move() {
    let Some(truck) = model_of("samples/CesiumMilkTruck/CesiumMilkTruck.gltf") else { return };
    let (a, b) = (truck.pose(0.0).unwrap(), truck.pose(1.0 / 24.0).unwrap());
    // Two axles, and from -0.088 to -0.189 as half sines about z.
    assert_eq!(moved(&a, &b), 2);
    let wheels = (0..a.draws.len()).find(|draw| a.draws[*draw].world_from_object != b.draws[*draw].world_from_object);
    let [first, second] = [&a, &b].map(|scene| scene.draws[wheels.unwrap()].world_from_object);
    let degrees = first.x_axis.truncate().angle_between(second.x_axis.truncate()).to_degrees();
    assert!((11.0..12.5).contains(&degrees), "{degrees}");
    assert_eq!(first.w_axis, second.w_axis);

    let cubes = model_of("samples/InterpolationTest/InterpolationTest.gltf").unwrap();
    // At 0.5 s also the three that step have left their first key.
    assert_eq!(moved(&cubes.pose(0.0).unwrap(), &cubes.pose(0.5).unwrap()), 9);
    assert_eq!(cubes.pose(0.0).unwrap().warnings, [] as [&str; 0]);

    let lid = model_of("samples/BoxAnimated/BoxAnimated.gltf").unwrap();
    let tops = [0.0, 0.625, 1.25].map(|time_s| lid.pose(time_s).unwrap().bounds().max.y);
    // Up by 2.52 within 1.25 s, evenly.
    assert!((tops[1] - tops[0] - 1.26).abs() < 1e-4 && (tops[2] - tops[1] - 1.26).abs() < 1e-4, "{tops:?}");

    let city = model_of("samples/VC/VC.gltf").unwrap();
    assert!(moved(&city.pose(0.0).unwrap(), &city.pose(10.0).unwrap()) > 20);

    let map = model_of("maps/kaos.glb").unwrap();
    let (a, b) = (map.pose(0.0).unwrap(), map.pose(2.0).unwrap());
    // The meshes of five doors.
    assert_eq!((moved(&a, &b), a.draws.len()), (11, 61));
    assert_eq!(a.lights.len(), b.lights.len());
}

/// What a technique with motion needs of every scene.
#[test]
fn every_moment_of_a_shared_scene_has_the_same_structure() {
    for file in ["samples/RiggedSimple/RiggedSimple.gltf", "samples/VC/VC.gltf", "maps/pul1duel-oa.glb"] {
        let Some(model) = model_of(file) else { return };
        let first = model.pose(0.0).unwrap();
        for time_s in [0.3, 1.7, 1e6] {
            require_same_structure(&first, &model.pose(time_s).unwrap());
        }
    }
}
