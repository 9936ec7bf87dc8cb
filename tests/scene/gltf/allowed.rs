//! What glTF allows and readers trip over: it is read, and what is left out of it is said.

use crate::support::gltf_file::{GltfFile, U8, load_bytes};
use serde_json::json;

#[test]
fn a_scene_without_nodes_is_an_empty_one() {
    let mut file = GltfFile::triangle();
    file.push("scenes", json!({"name": "void"}));
    assert_eq!(file.load().unwrap().draws.len(), 1);
    file.json["scene"] = json!(1);
    assert!(file.load().unwrap().draws.is_empty());
}

#[test]
fn a_channel_without_a_node_is_left_out_with_a_warning() {
    let mut file = GltfFile::triangle();
    file.animate(0, "translation", "LINEAR", &[0.0, 1.0], ("VEC3", &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]));
    let channels = file.json["animations"][0]["channels"].as_array_mut().unwrap();
    let pointer = json!({"KHR_animation_pointer": {"pointer": "/materials/0/emissiveFactor"}});
    channels.insert(0, json!({"sampler": 0, "target": {"path": "pointer", "extensions": pointer}}));
    file.json["extensionsUsed"] = json!(["KHR_animation_pointer"]);
    let model = file.model(&quincunx::scene::AnimationChoice::All).unwrap();
    let scene = model.pose(0.5).unwrap();
    assert_eq!(scene.draws[0].world_from_object.w_axis.x, 1.0);
    let warnings = scene.warnings.join("\n");
    assert!(warnings.contains("1 animation channel has no node and is left out"), "{warnings}");
    assert!(warnings.contains("the extension KHR_animation_pointer is ignored"), "{warnings}");
}

#[test]
fn joints_beyond_eight_are_left_out_with_a_warning() {
    let mut file = GltfFile::triangle();
    file.bind(U8, [0; 4], [0.25; 4]);
    let attributes = &mut file.primitive()["attributes"];
    for set in [1, 2] {
        for kind in ["JOINTS", "WEIGHTS"] {
            attributes[format!("{kind}_{set}")] = attributes[format!("{kind}_0")].clone();
        }
    }
    file.json["nodes"][0]["skin"] = json!(0);
    file.push("skins", json!({"joints": [0]}));
    let warnings = file.load().unwrap().warnings;
    assert!(
        warnings.contains(&"1 primitive has joints beyond eight a vertex, which are ignored".to_owned()),
        "{warnings:?}"
    );
}

#[test]
fn vertices_that_few_triangles_use_are_the_same_as_all_of_them() {
    let positions: Vec<f32> = (0..300).map(|number| (number * number % 97) as f32).collect();
    let of = |indices: &[u32]| {
        let mut file = GltfFile::triangle();
        let positions = file.floats("VEC3", &positions);
        let indices = file.indices(U8, indices);
        file.json["meshes"][0]["primitives"][0] =
            json!({"attributes": {"POSITION": positions, "NORMAL": positions}, "indices": indices});
        load_bytes("scene.glb", &file.glb()).unwrap().meshes.remove(0)
    };
    let corners = [[7, 90, 3], [3, 7, 50]].concat();
    let few = of(&corners);
    // So often that all vertices are read, and the unused dropped.
    let all = of(&corners.repeat(40));
    assert_eq!((few.positions.len(), &few.indices), (4, &vec![1, 3, 0, 0, 1, 2]));
    assert_eq!((&few.positions, &few.normals), (&all.positions, &all.normals));
    assert_eq!(few.indices, all.indices[..6]);
}
