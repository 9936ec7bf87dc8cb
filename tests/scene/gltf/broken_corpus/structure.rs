//! Hierarchies that are no tree, elements that point nowhere, broken animations, skins and targets; and short files that
//! ask for much.

use super::Case;
use crate::support::gltf_file::{GltfFile, U8, U16};
use serde_json::{Value, json};

pub fn cases() -> Vec<Case> {
    let mut cases = vec![
        nodes("a node that is its own child", &["node 0", "cycle"], json!([{"mesh": 0, "children": [0]}])),
        nodes(
            "two nodes in a circle",
            &["node 1", "cycle"],
            json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]),
        ),
        nodes("a node with two parents", &["node 2"], json!([{"children": [2]}, {"children": [2]}, {"mesh": 0}])),
        nodes("a child that is not there", &["children"], json!([{"mesh": 0, "children": [9]}])),
        nodes("a mesh that is not there", &["mesh"], json!([{"mesh": 9}])),
        nodes("a camera that is not there", &["camera"], json!([{"mesh": 0, "camera": 9}])),
        nodes("a skin that is not there", &["skin"], json!([{"mesh": 0, "skin": 9}])),
        Case::changed("a scene that is not there", &["scene"], |file| file.json["scene"] = json!(7)),
        Case::changed("no scenes, no nodes", &["no triangle"], |file| {
            file.json["scenes"] = json!([]);
            file.json["nodes"] = json!([]);
        }),
        Case::changed("points", &["no triangle"], |file| file.primitive()["mode"] = json!(0)),
        Case::changed("a mode of 9", &["mode"], |file| file.primitive()["mode"] = json!(9)),
        Case::changed("a mesh without primitives", &["no triangle"], |file| {
            file.json["meshes"][0]["primitives"] = json!([]);
        }),
    ];
    let mut deep = GltfFile::triangle();
    let chain = (1..100_000).map(|child| json!({"children": [child]})).chain([json!({"mesh": 0})]);
    deep.json["nodes"] = Value::Array(chain.collect());
    cases.push(Case::drawn("nodes 100,000 deep", deep.glb()));
    let mut circle = GltfFile::triangle();
    let chain = (1..100_000).map(|child| json!({"children": [child]})).chain([json!({"children": [1]})]);
    circle.json["nodes"] = Value::Array(chain.collect());
    cases.push(Case::refused("a circle of 100,000 nodes", circle.glb(), &["parent"]));
    cases.extend(moving());
    cases.extend(bent());
    cases
}

fn nodes(name: &str, words: &[&str], nodes: Value) -> Case {
    Case::changed(name, words, |file| file.json["nodes"] = nodes)
}

fn moving() -> Vec<Case> {
    let animated = |name: &str, words: &[&str], change: &dyn Fn(&mut GltfFile)| {
        Case::changed(name, words, |file| {
            file.animate(0, "translation", "LINEAR", &[0.0, 1.0], ("VEC3", &[0.0; 6]));
            change(file);
        })
    };
    let channel = "animation 0, channel 0";
    let times = |times_s: [f32; 2]| {
        move |file: &mut GltfFile| {
            let input = file.floats("SCALAR", &times_s);
            file.json["animations"][0]["samplers"][0]["input"] = json!(input);
        }
    };
    vec![
        animated("times that go back", &[channel, "ascend"], &times([1.0, 0.0])),
        animated("a time of NaN", &[channel, "input"], &times([0.0, f32::NAN])),
        animated("a negative time", &[], &times([-1.0, 0.0])).either(),
        animated("a value of infinity", &[channel, "output"], &|file| {
            let output = file.floats("VEC3", &[0.0, 0.0, 0.0, f32::INFINITY, 0.0, 0.0]);
            file.json["animations"][0]["samplers"][0]["output"] = json!(output);
        }),
        animated("fewer values than keys", &[channel, "keyframes"], &|file| {
            let output = file.floats("VEC3", &[0.0; 3]);
            file.json["animations"][0]["samplers"][0]["output"] = json!(output);
        }),
        animated("a channel of a node that is not there", &[channel, "node 9"], &|file| {
            file.json["animations"][0]["channels"][0]["target"]["node"] = json!(9);
        }),
        animated("a channel of a sampler that is not there", &["sampler"], &|file| {
            file.json["animations"][0]["channels"][0]["sampler"] = json!(9);
        }),
        animated("an unknown path", &[channel, "path"], &|file| {
            file.json["animations"][0]["channels"][0]["target"]["path"] = json!("colour");
        }),
        animated("an unknown interpolation", &["interpolation"], &|file| {
            file.json["animations"][0]["samplers"][0]["interpolation"] = json!("BOUNCE");
        }),
    ]
}

/// Skins and morph targets.
fn bent() -> Vec<Case> {
    let skinned = |name: &str, words: &[&str], change: &dyn Fn(&mut GltfFile)| {
        Case::changed(name, words, |file| {
            *file = GltfFile::skinned_triangle();
            change(file);
        })
    };
    let weights = |weight: f32| {
        move |file: &mut GltfFile| {
            let weights = file.floats("VEC4", &[weight; 12]);
            file.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
        }
    };
    let matrices = |number: f32| {
        move |file: &mut GltfFile| {
            let matrices = file.floats("MAT4", &[number; 32]);
            file.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
        }
    };
    let target = |name: &str, words: &[&str], target: Value, weights: Value| {
        Case::changed(name, words, |file| {
            file.primitive()["targets"] = json!([target]);
            file.json["meshes"][0]["weights"] = weights;
        })
    };
    vec![
        skinned("a joint beyond the skin", &["skin 0"], &|file| {
            file.bind(U8, [7, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]);
        }),
        skinned("a skin without joints", &["skin"], &|file| file.json["skins"][0]["joints"] = json!([])),
        skinned("a joint that is no node", &["joints"], &|file| file.json["skins"][0]["joints"] = json!([99])),
        skinned("weights of NaN", &["WEIGHTS_0"], &weights(f32::NAN)),
        skinned("weights below zero", &["WEIGHTS_0"], &weights(-1.0)),
        skinned("joints without weights", &["WEIGHTS_0"], &|file| {
            file.primitive()["attributes"].as_object_mut().unwrap().remove("WEIGHTS_0");
        }),
        skinned("inverse bind matrices of infinity", &["skin 0", "inverseBindMatrices"], &matrices(f32::INFINITY)),
        skinned("inverse bind matrices that are not affine", &["skin 0", "affine"], &matrices(1.0)),
        skinned("fewer matrices than joints", &["skin 0", "inverseBindMatrices"], &|file| {
            let matrices = file.floats("MAT4", &[]);
            file.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
        }),
        target("a target that is not there", &["meshes[0]"], json!({"POSITION": 9}), json!([1])),
        target("weights for targets that are not there", &["weights"], json!({"POSITION": 0}), json!([1, 1])),
        target("a target's weight of 1e300", &["weight"], json!({"POSITION": 0}), json!([1e300])),
        target("a target that moves beyond floats", &["32-bit floats"], json!({"POSITION": 0}), json!([3e38])),
    ]
}

/// Short files that ask for much: what is named many times counts many times.
pub fn amplified() -> Vec<Case> {
    let strip = |count: usize| {
        let mut file = GltfFile::triangle();
        let indices = file.indices(U8, &[0, 1, 2].repeat(count));
        file.primitive()["indices"] = json!(indices);
        file
    };
    let mut primitives = strip(100_000);
    let primitive = primitives.primitive().clone();
    primitives.json["meshes"][0]["primitives"] = json!(vec![primitive; 800]);

    let mut instances = strip(100_000);
    for _ in 0..1000 {
        instances.root(json!({"mesh": 0}));
    }

    let mut channels = GltfFile::triangle();
    let times: Vec<f32> = (0..100_000).map(|key| key as f32).collect();
    channels.animate(0, "translation", "LINEAR", &times, ("VEC3", &vec![0.0; 300_000]));
    let channel = channels.json["animations"][0].clone();
    for _ in 0..400 {
        channels.push("animations", channel.clone());
    }

    let mut targets = strip(100_000);
    targets.primitive()["targets"] = json!(vec![json!({"POSITION": 0}); 400]);

    let mut skins = strip(100_000);
    skins.bind(U16, [0; 4], [1.0, 0.0, 0.0, 0.0]);
    skins.push("skins", json!({"joints": [0]}));
    skins.json["nodes"][0]["skin"] = json!(0);
    for _ in 0..200 {
        skins.root(json!({"mesh": 0, "skin": 0}));
    }

    let mut vertices = GltfFile::triangle();
    let positions = vertices.floats("VEC3", &vec![0.5; 3 << 20]);
    let indices = vertices.indices(U8, &[0, 1, 2]);
    let primitive = json!({"attributes": {"POSITION": positions, "NORMAL": positions}, "indices": indices});
    vertices.json["meshes"][0]["primitives"] = json!(vec![primitive; 1000]);

    let mut buffers = GltfFile::triangle();
    buffers.json["buffers"] = json!([{"byteLength": buffers.bytes.len()}]);
    for _ in 0..1000 {
        buffers.push("buffers", json!({"byteLength": 8 << 20, "uri": "large.bin"}));
    }

    vec![
        Case::refused("one index list in 800 primitives", primitives.glb(), &["mesh 0", "indices", "limit"]),
        Case::refused("one mesh of 100,000 triangles on 1000 nodes", instances.glb(), &["node", "triangles", "limit"]),
        Case::refused("one curve in 400 animations", channels.glb(), &["animation", "numbers", "limit"]),
        Case::refused("one accessor in 400 morph targets", targets.glb(), &["node 0", "morph targets", "limit"]),
        Case::refused("one skinned mesh on 200 nodes", skins.glb(), &["node", "limit"]),
        Case::drawn("a million vertices in 1000 primitives of one triangle", vertices.glb()),
        Case::drawn("one file of 8 MiB as 1000 buffers", buffers.glb()).with_file("large.bin", vec![0; 8 << 20]),
    ]
}
