//! A file that says nothing of its camera and its light is seen all the same; and where nothing is to be seen, it is said why.

use crate::support;
use crate::support::choices;
use crate::support::gltf_file::GltfFile;
use crate::support::program::Program;
use quincunx::frame::View;
use quincunx::lights::LightSet;
use quincunx::scene::{self, Scene};
use quincunx::settings::Values;
use quincunx::techniques;
use quincunx::techniques::settings_of;
use quincunx::units::Extent;
use serde_json::{Value, json};

const SMALL: [&str; 4] = ["--size", "32x18", "--json", "--technique"];

/// A triangle with these corners, alone in its file.
fn triangle(corners: [f32; 9]) -> GltfFile {
    let mut file = GltfFile::empty();
    let positions = file.floats("VEC3", &corners);
    file.push("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}}]}));
    file.root(json!({"mesh": 0}));
    file
}

/// A folder with the file in it, as `scene.glb`.
fn folder(file: &GltfFile) -> Program {
    let program = Program::new();
    std::fs::write(program.path("scene.glb"), file.glb()).unwrap();
    program
}

/// The report of a small picture, with what the command line adds.
fn report(program: &Program, technique: &str, more: &[&str]) -> Value {
    program.run(&[&["render", "scene.glb"], &SMALL[..], &[technique], more].concat()).fine().json()
}

fn mean(report: &Value) -> f64 {
    report["image"]["mean"].as_array().unwrap().iter().map(|channel| channel.as_f64().unwrap()).sum::<f64>() / 3.0
}

fn notes(report: &Value) -> Vec<&str> {
    report["notes"].as_array().into_iter().flatten().map(|note| note.as_str().unwrap()).collect()
}

#[test]
fn what_has_no_camera_is_seen_from_where_it_looks_to() {
    for (what, corners) in [
        ("lies, seen from above", [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]),
        ("hangs, seen from below", [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
        ("looks back", [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]),
        ("looks aside", [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]),
        ("looks forward", [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    ] {
        let report = report(&folder(&triangle(corners)), "forward", &["-o", "a.png"]);
        // A fifth of the frame, lit by a key of 3 lux that meets it aslant, and by 0.3 from everywhere.
        assert!(mean(&report) > 0.05, "{what}: {}", report["image"]);
        assert_eq!(notes(&report), [] as [&str; 0], "{what}");
        assert_eq!((&report["scene"]["camera"], &report["scene"]["rig"]), (&json!("framing"), &json!("default")));
    }
}

#[test]
fn a_faint_glow_keeps_no_rig_away_and_a_lamp_does() {
    let glowing = |radiance: f64| {
        let mut file = triangle([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        file.push("materials", json!({"emissiveFactor": [radiance, radiance, radiance]}));
        file.primitive()["material"] = json!(0);
        folder(&file)
    };
    for technique in ["forward", "interleaved_deferred", "path_traced"] {
        let faint = report(&glowing(0.01), technique, &["-o", "a.png"]);
        assert_eq!(faint["scene"]["rig"], "default", "{technique}");
        assert!(mean(&faint) > 0.05, "{technique}: {}", faint["image"]);
        let said = faint["scene"]["warnings"][0].as_str().unwrap();
        assert!(said.starts_with("its emissive surfaces make 0 % of it visible, less than half"), "{said}");
        let bright = report(&glowing(0.1), technique, &["-o", "a.png"]);
        assert_eq!(bright["scene"]["rig"], Value::Null, "{technique}");
        assert!(bright["scene"]["warnings"][0].as_str().unwrap().contains("--rig always"), "{technique}");
        let none = report(&glowing(0.01), technique, &["-o", "a.png", "--rig", "none"]);
        assert_eq!(none["scene"]["rig"], Value::Null, "{technique}");
    }
}

/// A lamp lights its room, however small it is; a glow on a model does not light the model.
#[test]
fn real_models_that_glow_are_lit() {
    let Some(folder) = support::shared_scenes() else { return };
    let lit = |scene: &Scene| {
        let values = Values::defaults(&settings_of(techniques::find("forward").unwrap()));
        let view = View::new(scene, "0", Extent::new(32, 18)).unwrap();
        let lights = LightSet::new(scene, &view, &values).unwrap();
        println!("{}: {:?} of it lit by what shines", scene.name, lights.faint_part);
        (lights.has_rig, lights.faint_part.is_some())
    };
    for model in ["DamagedHelmet", "WaterBottle", "MultiUVTest"] {
        let scene = scene::load(&format!("{}/samples/{model}/{model}.gltf", folder.display()), 1).unwrap();
        assert_eq!(lit(&scene), (true, true), "{model}");
    }
    for (spec, has_rig) in [("cornell", false), ("power", false), ("fence", true)] {
        let mut scene = scene::load(spec, 1).unwrap();
        scene.lights.clear();
        assert_eq!(lit(&scene), (has_rig, has_rig), "{spec}");
    }
}

/// One triangle under an eye that looks away from it, or at its back, or at it in the dark.
#[test]
fn where_nothing_is_seen_a_note_says_why_and_what_would_help() {
    let seen_by = |rotation: [f32; 4], z: f32| {
        let mut file = triangle([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        // glTF's own material is a metal, which is black where surfaces are diffuse alone.
        file.json["materials"] = json!([{"pbrMetallicRoughness": {"metallicFactor": 0.0}}]);
        file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        file.push(
            "cameras",
            json!({"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}, "name": "door"}),
        );
        file.root(json!({"camera": 0, "rotation": rotation, "translation": [0.3, 0.3, z]}));
        folder(&file)
    };
    let (onward, around) = ([0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0]);
    // What is said of a picture depends on no technique.
    for technique in choices::techniques() {
        for (rotation, z, more, said) in [
            (around, 3.0, &[][..], &["no surface is in view: camera door looks past", "--camera framing"][..]),
            (around, 3.0, &["--background", "0.5,0.6,0.7"], &["no surface is in view"]),
            (around, -3.0, &[], &["the only triangle in view is single-sided and turned away"]),
            (onward, 3.0, &["--rig", "none"], &["the picture is black", "--rig always"]),
            (
                onward,
                3.0,
                &["--exposure", "-14"],
                &["the picture is black", "of 255 at --exposure -14", "--exposure auto"],
            ),
        ] {
            let program = seen_by(rotation, z);
            let report = report(&program, technique, &[&["-o", "a.png"], more].concat());
            let notes = notes(&report);
            assert_eq!(notes.len(), 1, "{technique}, {more:?}: {notes:?}");
            for word in said {
                assert!(notes[0].contains(word), "{technique}, {more:?}: {notes:?}");
            }
        }
        let program = seen_by(onward, 3.0);
        assert_eq!(notes(&report(&program, technique, &["-o", "a.png"])), [] as [&str; 0], "{technique}");
    }
    // A person reads it too, of a picture and of a frame; what is wanted in the note works.
    let program = seen_by(around, 3.0);
    let render = ["render", "scene.glb", "--technique", "forward", "--size", "32x18", "-o", "a.png"];
    let said = program.run(&render).fine().out;
    assert!(said.contains("\nnote: no surface is in view: camera door"), "{said}");
    let said = program.run(&[&render[..], &["--frames", "0..1"]].concat());
    assert_eq!(said.code, 0);
    assert!(said.err.contains("frame 1: note: no surface is in view"), "{}", said.err);
    assert_eq!(notes(&report(&program, "forward", &["--camera", "framing", "-o", "a.png"])), [] as [&str; 0]);
}

/// A triangle of radiance 0.2 that moves away: the value of `auto` is reported, and typed again it makes the same file.
#[test]
fn an_automatic_exposure_is_a_number_in_the_report() {
    let mut file = triangle([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    file.push(
        "materials",
        json!({"emissiveFactor": [0.2, 0.2, 0.2], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}),
    );
    file.primitive()["material"] = json!(0);
    file.animate(0, "translation", "LINEAR", &[0.0, 1.0], ("VEC3", &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]));
    let program = folder(&file);
    let bytes = |name: &str| std::fs::read(program.path(name)).unwrap();
    let auto = report(&program, "forward", &["-o", "auto.png", "--exposure", "auto", "--aov", "depth.reversed"]);
    // log2(0.18 / 0.2), of the triangle alone.
    assert_eq!((&auto["image"]["exposure_ev"], &auto["settings"]["exposure"]), (&json!(-0.15), &json!(-0.15)));
    let typed = report(&program, "forward", &["-o", "typed.png", "--exposure", "-0.15", "--aov", "depth.reversed"]);
    assert_eq!(typed["settings"], auto["settings"]);
    assert_eq!(bytes("typed.png"), bytes("auto.png"));
    let plain = report(&program, "forward", &["-o", "plain.png", "--aov", "depth.reversed"]);
    assert_eq!((&plain["image"]["exposure_ev"], &plain["image"]["hash"]), (&json!(0.0), &auto["image"]["hash"]));
    assert_ne!(bytes("plain.png"), bytes("auto.png"));
    // Stages are no light.
    let stage = |name: &str| quincunx::picture::image_file::read(program.path(name).as_ref()).unwrap();
    assert_eq!(stage("auto.depth.reversed.png"), stage("plain.depth.reversed.png"));
    assert_ne!(stage("typed.depth.reversed.png"), stage("plain.depth.reversed.png"));
    // Nor is an EXR exposed.
    for (name, exposure) in [("a.exr", "auto"), ("b.exr", "0")] {
        let linear = report(&program, "forward", &["-o", name, "--exposure", exposure]);
        assert_eq!(linear["image"]["exposure_ev"], Value::Null);
    }
    assert_eq!(stage("a.exr"), stage("b.exr"));
    let said = program.run(&["render", "scene.glb", "--technique", "forward", "--size", "32x18", "--exposure", "auto"]);
    assert!(said.fine().out.contains("\nexposure -0.15 EV\n"));
    for wrong in ["automatic", "33", "nan"] {
        program.fails(&["render", "scene.glb", "--exposure", wrong], 2, &["--exposure", "auto or -32 to 32"]);
    }
}

#[test]
fn frames_share_the_exposure_of_the_first_that_is_not_black() {
    // A lamp that is switched on between frames 0 and 1, and comes nearer until frame 3.
    let mut file = triangle([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 4.0}]}});
    let lamp = file.root(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}}));
    let heights = [0.3, 0.3, -1.0, 0.3, 0.3, 4.0, 0.3, 0.3, 1.0];
    file.animate(lamp, "translation", "STEP", &[0.0, 1.0, 2.0], ("VEC3", &heights));
    let program = folder(&file);
    let frames = ["--frames", "0..2", "--fps", "1", "-o", "a.png", "--exposure", "auto", "--quiet"];
    let sequence = report(&program, "forward", &frames);
    let frames = sequence["frames"].as_array().unwrap();
    let exposures: Vec<f64> = frames.iter().map(|frame| frame["settings"]["exposure"].as_f64().unwrap()).collect();
    assert!(mean(&frames[0]) == 0.0 && exposures[0] == 0.0, "{exposures:?}");
    assert!(mean(&frames[2]) > 4.0 * mean(&frames[1]), "the lamp came nearer");
    assert!(exposures[1] != 0.0 && exposures[1] == exposures[2], "{exposures:?}");
    // By itself the last frame would be darkened.
    let alone = report(&program, "forward", &["--time", "2", "-o", "b.png", "--exposure", "auto"]);
    assert!(alone["settings"]["exposure"].as_f64().unwrap() < exposures[1] - 2.0, "{}", alone["settings"]["exposure"]);
}
