//! Animations, skins and morph targets that must be refused: each with one request error that names its element.

use crate::support::gltf_file::{GltfFile, U8, expect, load_bytes};
use proptest::prelude::*;
use quincunx::scene::AnimationChoice;
use serde_json::{Value, json};

/// The triangle that `channel` moves, after a change to its document, must be refused with these words.
#[track_caller]
fn refused_moving(change: impl FnOnce(&mut GltfFile), words: &[&str]) {
    let mut file = GltfFile::triangle();
    file.animate(0, "translation", "LINEAR", &[0.0, 1.0], ("VEC3", &[0.0; 6]));
    file.json["animations"][0]["name"] = json!("sway");
    assert!(file.load().is_ok());
    change(&mut file);
    expect(&file.load().unwrap_err(), "scene.glb", words);
}

#[track_caller]
fn refused_skinned(change: impl FnOnce(&mut GltfFile), words: &[&str]) {
    let mut file = GltfFile::skinned_triangle();
    assert!(file.load().is_ok());
    change(&mut file);
    expect(&file.load().unwrap_err(), "scene.glb", words);
}

#[test]
fn samplers_that_do_not_fit() {
    let channel = "animation 0 \"sway\", channel 0";
    let output = |kind: &'static str, values: Vec<f32>| {
        move |file: &mut GltfFile| {
            let output = file.floats(kind, &values);
            file.json["animations"][0]["samplers"][0]["output"] = json!(output);
        }
    };
    let input = |times_s: Vec<f32>| {
        move |file: &mut GltfFile| {
            let input = file.floats("SCALAR", &times_s);
            file.json["animations"][0]["samplers"][0]["input"] = json!(input);
        }
    };
    refused_moving(output("VEC3", vec![0.0; 9]), &[channel, "9 numbers; 2 keyframes of 3 numbers need 6"]);
    refused_moving(output("VEC4", vec![0.0; 8]), &[channel, "output", "Vec4"]);
    refused_moving(output("VEC3", vec![0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0]), &[channel, "output", "element 0"]);
    refused_moving(input(vec![0.0, 0.0]), &[channel, "from 0 s to 0 s after key 0", "ascend", "--animation none"]);
    refused_moving(input(vec![1.0, 0.5]), &[channel, "from 1 s to 0.5 s"]);
    refused_moving(input(vec![0.0, f32::INFINITY]), &[channel, "input", "element 1"]);
    refused_moving(input(vec![]), &[channel, "no keyframe"]);
    refused_moving(
        |file| file.json["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE"),
        &[channel, "2 keyframes of 9"],
    );
    for (key, place) in [("input", "samplers[0].input"), ("output", "samplers[0].output")] {
        refused_moving(|file| file.json["animations"][0]["samplers"][0][key] = json!(99), &["animations[0]", place]);
    }
    refused_moving(
        |file| file.json["animations"][0]["channels"][0]["sampler"] = json!(7),
        &["animations[0].channels[0].sampler"],
    );
    refused_moving(
        |file| file.json["animations"][0]["samplers"][0]["interpolation"] = json!("BOUNCE"),
        &["animations[0].samplers[0].interpolation"],
    );
}

#[test]
fn targets_that_cannot_move() {
    let target =
        |target: Value| move |file: &mut GltfFile| file.json["animations"][0]["channels"][0]["target"] = target;
    refused_moving(target(json!({"node": 5, "path": "translation"})), &["node 5", "there are 1 nodes"]);
    refused_moving(target(json!({"node": 0, "path": "colour"})), &["channel 0", "path is none of"]);
    refused_moving(target(json!({"node": 0, "path": "weights"})), &["channel 0", "node 0", "no morph targets"]);
    refused_moving(target(json!({"node": 0, "path": "rotation"})), &["channel 0", "output", "4 components"]);
    refused_moving(
        |file| file.json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
        &["channel 0", "node 0", "has a matrix"],
    );
    refused_moving(
        |file| {
            file.animate(0, "rotation", "LINEAR", &[0.0, 1.0], ("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]));
        },
        &["animation 1, channel 0", "rotation of key 1 is zero"],
    );
    // Each end is near enough for itself.
    refused_moving(
        |file| {
            file.json["animations"] = json!([]);
            file.animate(0, "translation", "LINEAR", &[0.0, 1.0], ("VEC3", &[-3e38, 0.0, 0.0, 3e38, 0.0, 0.0]));
        },
        &["reaches from", "too far"],
    );
}

#[test]
fn what_is_broken_and_does_not_play_does_no_harm() {
    let mut file = GltfFile::triangle();
    file.animate(0, "translation", "LINEAR", &[1.0, 0.0], ("VEC3", &[0.0; 6]));
    assert!(file.model(&AnimationChoice::All).is_err());
    assert!(file.model(&AnimationChoice::None).is_ok());
}

#[test]
fn skins_that_do_not_fit() {
    refused_skinned(
        |file| file.json["skins"][0]["joints"] = json!([1]),
        &["node 0", "skin 0", "vertex 0 names joint 1", "has 1 joints"],
    );
    refused_skinned(|file| file.json["skins"][0]["joints"] = json!([]), &["skin 0 \"bones\"", "no joints"]);
    refused_skinned(|file| file.json["skins"][0]["joints"] = json!([1, 9]), &["skins[0].joints[1]"]);
    refused_skinned(|file| file.json["nodes"][0]["skin"] = json!(3), &["nodes[0].skin"]);
    refused_skinned(
        |file| file.json["scenes"][0]["nodes"] = json!([0, 1]),
        &["skin 0 \"bones\"", "joint 1 is node 2", "not in the scene"],
    );
    refused_skinned(|file| file.json["nodes"][1]["children"] = json!([1]), &["node 1", "cycle"]);
    refused_skinned(
        |file| (file.json["nodes"][1]["children"], file.json["nodes"][2]["children"]) = (json!([2]), json!([1])),
        &["node 1", "cycle"],
    );
    let matrices = |count: usize, last: f32| {
        move |file: &mut GltfFile| {
            let mut values =
                [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0].repeat(count);
            *values.last_mut().unwrap() = last;
            let matrices = file.floats("MAT4", &values);
            file.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
        }
    };
    refused_skinned(matrices(1, 1.0), &["skin 0", "inverseBindMatrices", "1 matrices for 2 joints"]);
    refused_skinned(matrices(2, 0.0), &["skin 0", "element 1", "affine"]);
    refused_skinned(matrices(2, f32::NAN), &["skin 0", "inverseBindMatrices", "element 1"]);
    refused_skinned(|file| file.json["skins"][0]["inverseBindMatrices"] = json!(0), &["skin 0", "16 components"]);
    refused_skinned(|file| file.json["nodes"][2]["scale"] = json!([3e38, 1, 1]), &["too far"]);
}

#[test]
fn joints_and_weights_that_do_not_fit() {
    let attribute = |name: &'static str, accessor: Value| {
        move |file: &mut GltfFile| file.primitive()["attributes"][name] = accessor
    };
    let remove = |name: &'static str| {
        move |file: &mut GltfFile| {
            file.primitive()["attributes"].as_object_mut().unwrap().remove(name);
        }
    };
    for name in ["JOINTS_0", "WEIGHTS_0"] {
        refused_skinned(remove(name), &["mesh 0 \"leaf\", primitive 0", "needs both JOINTS_0 and WEIGHTS_0"]);
        refused_skinned(attribute(name, json!(0)), &["mesh 0 \"leaf\", primitive 0", name, "accessor 0", "Vec"]);
        refused_skinned(attribute(name, json!(99)), &["meshes[0].primitives[0].attributes"]);
    }
    refused_skinned(attribute("JOINTS_1", json!(1)), &["needs both JOINTS_1 and WEIGHTS_1"]);
    refused_skinned(attribute("JOINTS_0", json!(2)), &["JOINTS_0", "unsigned bytes"]);
    let weights = |values: Vec<f32>| {
        move |file: &mut GltfFile| {
            let weights = file.floats("VEC4", &values);
            file.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
        }
    };
    refused_skinned(weights([1.0, -0.5, 0.0, 0.0].repeat(3)), &["WEIGHTS_0", "element 0", "at least 0"]);
    refused_skinned(weights(vec![f32::INFINITY; 12]), &["WEIGHTS_0", "element 0", "finite"]);
    refused_skinned(weights(vec![1.0; 8]), &["WEIGHTS_0", "2 elements", "POSITION has 3"]);
    // No weight at all is repaired, and said.
    let mut file = GltfFile::skinned_triangle();
    weights(vec![0.0; 12])(&mut file);
    let scene = file.load().unwrap();
    assert!(scene.warnings[0].starts_with("3 vertices without joint weights"), "{:?}", scene.warnings);
}

#[test]
fn morph_targets_that_do_not_fit() {
    let morphing = |change: &dyn Fn(&mut GltfFile), words: &[&str]| {
        let mut file = GltfFile::triangle();
        file.primitive()["targets"] = json!([{"POSITION": 0}]);
        assert!(file.load().is_ok());
        change(&mut file);
        expect(&file.load().unwrap_err(), "scene.glb", words);
    };
    let short = |file: &mut GltfFile| {
        let short = file.floats("VEC3", &[0.0; 6]);
        file.primitive()["targets"] = json!([{"POSITION": 0}, {"NORMAL": short}]);
    };
    morphing(&short, &["mesh 0 \"leaf\", primitive 0: morph target 1: NORMAL", "2 elements", "POSITION has 3"]);
    morphing(&|file| file.primitive()["targets"] = json!([{"POSITION": 9}]), &["meshes[0].primitives[0].targets[0]"]);
    morphing(&|file| file.json["meshes"][0]["weights"] = json!([0.5, 0.5]), &["node 0", "2 morph weights for 1"]);
    morphing(&|file| file.json["nodes"][0]["weights"] = json!([]), &["node 0", "0 morph weights for 1"]);
    morphing(&|file| file.json["nodes"][0]["weights"] = json!([1e300]), &["node 0", "finite"]);
    morphing(&|file| file.json["nodes"][0]["weights"] = json!([3e38]), &["too far"]);
    let uneven = |file: &mut GltfFile| {
        let primitives = file.json["meshes"][0]["primitives"].as_array_mut().unwrap();
        primitives.push(json!({"attributes": {"POSITION": 0}}));
    };
    morphing(&uneven, &["mesh 0 \"leaf\": primitive 1", "primitive 0, which has 1"]);
    let count = |file: &mut GltfFile| {
        file.animate(0, "weights", "LINEAR", &[0.0, 1.0], ("SCALAR", &[0.0; 3]));
    };
    morphing(&count, &["animation 0, channel 0", "3 numbers; 2 keyframes of 1 numbers need 2"]);
}

#[test]
fn few_bytes_that_ask_for_much() {
    // 33 nodes that bend two million corners each.
    let mut file = GltfFile::skinned_triangle();
    let indices = file.indices(U8, &[0; 1 << 21]);
    file.primitive()["indices"] = json!(indices);
    for _ in 0..32 {
        file.root(json!({"mesh": 0, "skin": 0}));
    }
    expect(
        &file.load().unwrap_err(),
        "scene.glb",
        &["node 19", "indices of meshes that bend", "is the limit for a file with 2.00 MiB"],
    );

    // 1024 targets of 32768 corners.
    let mut file = GltfFile::triangle();
    let indices = file.indices(U8, &[0; 1 << 15]);
    file.primitive()["indices"] = json!(indices);
    file.primitive()["targets"] = json!(vec![json!({"POSITION": 0}); 1024]);
    expect(&file.load().unwrap_err(), "scene.glb", &["node 0", "vectors of morph targets", "limit"]);

    // A target of few vectors, at each of many nodes.
    let mut file = GltfFile::triangle();
    file.primitive()["targets"] = json!(vec![json!({"POSITION": 0}); 4096]);
    for _ in 0..30_000 {
        file.root(json!({"mesh": 0}));
    }
    expect(&file.load().unwrap_err(), "scene.glb", &["over all nodes", "limit"]);

    // One long accessor, named by many channels.
    let mut file = GltfFile::triangle();
    let times_s: Vec<f32> = (0..1 << 16).map(|key| key as f32).collect();
    file.animate(0, "translation", "LINEAR", &times_s, ("VEC3", &vec![0.0; 3 << 16]));
    file.json["animations"][0]["channels"] = json!(vec![file.json["animations"][0]["channels"][0].clone(); 300]);
    expect(&file.load().unwrap_err(), "scene.glb", &["channel 20", "numbers of animations", "limit"]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever a few changed bytes make of a moving file, it loads or is refused; it does not panic.
    #[test]
    fn changed_bytes_never_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut file = GltfFile::skinned_triangle();
        file.primitive()["targets"] = json!([{"POSITION": 0, "NORMAL": 0}]);
        file.animate(2, "rotation", "CUBICSPLINE", &[0.0, 1.0], ("VEC4", &[1.0; 24]));
        file.animate(0, "weights", "STEP", &[0.0, 1.0], ("SCALAR", &[0.0, 1.0]));
        let mut bytes = file.glb();
        for (place, value) in changes {
            let place = place.index(bytes.len());
            // Digits stay digits in half of the cases, so that numbers go wrong and not only the syntax.
            bytes[place] = if bytes[place].is_ascii_digit() && value < 128 { b'0' + value % 10 } else { value };
        }
        if let Err(error) = load_bytes("scene.glb", &bytes) {
            prop_assert_eq!(error.exit_code(), 2);
        }
    }
}
