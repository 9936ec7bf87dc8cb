//! `render --time` and `render --frames` from outside: which files, which reports, which exit codes.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::gltf_file::{GltfFile, painted_png};
use crate::support::program::{Program, quincunx};
use crate::support::watched::Watched;
use crate::support::{driver, shared_scenes};
use quincunx::picture::{Picture, image_file};
use quincunx::scene::{AnimationChoice, Scene, Texturing};
use serde_json::json;

/// A triangle with a picture on it that crosses the frame within a second.
fn moving_file() -> GltfFile {
    let mut file = GltfFile::triangle();
    file.animate(0, "translation", "LINEAR", &[0.0, 1.0], ("VEC3", &[0.0, 0.0, 0.0, 3.0, 0.0, 0.0]));
    file.json["animations"][0]["name"] = json!("cross");
    let view = file.view(&painted_png(16, 8, |x, y| [16 * x as u8, 32 * y as u8, 255 - 16 * x as u8, 255]));
    file.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    file.push("textures", json!({"source": 0}));
    file.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    let uvs = file.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    file.primitive()["attributes"]["TEXCOORD_0"] = json!(uvs);
    file.primitive()["material"] = json!(0);
    file
}

/// The same, in a folder of its own.
fn moving() -> Program {
    let program = Program::new();
    std::fs::write(program.path("moving.glb"), moving_file().glb()).unwrap();
    program
}

const RENDER: [&str; 6] = ["render", "moving.glb", "--technique", "deferred", "--size", "32x18"];

fn render<'a>(more: &[&'a str]) -> Vec<&'a str> {
    RENDER.iter().chain(more).copied().collect()
}

#[test]
fn a_frame_is_the_picture_at_its_time() {
    let program = moving();
    let ran = program
        .run(&render(&[
            "--frames", "2..4", "--fps", "4", "--time", "0.25", "-o", "a.png", "--json", "--report", "r.json",
            "--quiet",
        ]))
        .fine();
    let document = ran.json();
    let frames = document["frames"].as_array().unwrap();
    assert_eq!((&document["schema"], frames.len()), (&json!(1), 3));
    let written: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(program.path("r.json")).unwrap()).unwrap();
    assert_eq!(written, document);
    for (report, (frame, time_s)) in frames.iter().zip([(2, 0.75), (3, 1.0), (4, 1.25)]) {
        assert_eq!((&report["frame"], &report["time_s"]), (&json!(frame), &json!(time_s)));
        assert_eq!(report["image"]["path"], format!("a.{frame:04}.png"));
        let time = time_s.to_string();
        assert_eq!(report["settings"]["time"].as_f64(), Some(time_s));
        let single = program.run(&render(&["--time", &time, "--json", "-o", "single.png"])).fine().json();
        assert_eq!(single["image"]["hash"], report["image"]["hash"], "frame {frame}");
        assert_eq!(single["scene"]["hash"], report["scene"]["hash"], "frame {frame}");
        let [a, b] = ["single.png".to_owned(), format!("a.{frame:04}.png")]
            .map(|file| std::fs::read(program.path(&file)).unwrap());
        assert_eq!(a, b, "frame {frame}");
    }
    // The triangle has arrived at 1 s.
    assert_ne!(frames[0]["image"]["hash"], frames[1]["image"]["hash"]);
    assert_eq!(frames[1]["image"]["hash"], frames[2]["image"]["hash"]);
    assert_eq!(program.files(), ["a.0002.png", "a.0003.png", "a.0004.png", "moving.glb", "r.json", "single.png"]);
}

/// The pictures of a model stay on the device from moment to moment, and nothing of that shows.
#[test]
fn textures_stay_between_the_moments_of_a_model() {
    let file = moving_file();
    let [model, other] = [file.model(&AnimationChoice::All).unwrap(), file.model(&AnimationChoice::All).unwrap()];
    let moment = |time_s: f64| model.pose(time_s).unwrap();
    let limited = |scene: Scene| Scene { texturing: Texturing { limit_px: 4, ..scene.texturing }, ..scene };
    let kept = |scene: Scene| {
        let texturing = Texturing { fills_gutters: false, ..scene.texturing };
        Scene { texturing, ..scene }
    };
    let hash = |watched: &Watched| watched.hash("deferred", &[("size", "32x18")]);
    let mut watched = Watched::with_scene(moment(0.0));
    let mut seen = vec![hash(&watched)];
    for (scene, stays) in [
        (moment(0.25), true),
        (moment(0.5), true),
        (limited(moment(0.75)), false),
        (limited(moment(0.5)), true),
        (moment(0.5), false),
        (kept(moment(0.5)), false),
        // Equal, and read again.
        (other.pose(0.75).unwrap(), false),
    ] {
        watched = watched.showing(scene.clone());
        // Owners are listed in the order in which they came.
        let owners = watched.session.gpu.memory.snapshot().resources;
        let place = |name: &str| owners.iter().position(|entry| entry.name == name).unwrap();
        assert_eq!(place("scene.textures.0") < place("scene.positions"), stays, "{} of {}", scene.hash, seen.len());
        assert_eq!(owners.iter().filter(|entry| entry.name == "scene.textures.0").count(), 1);
        seen.push(hash(&watched));
        assert_eq!(seen.last(), Some(&hash(&Watched::with_scene(scene))));
    }
    assert_eq!(seen[2], seen[5]);
    assert!(seen[2] != seen[4] && seen[0] != seen[1], "the limit shows, and so does time");
}

#[test]
fn each_frame_has_a_line_and_stages_beside_it() {
    let program = moving();
    let ran = program.run(&render(&["--frames", "0..1", "--validate", "--aov", "gbuffer.normal", "-o", "a.png"]));
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(ran.err, "frame 0, 1 of 2: wrote a.0000.png\nframe 1, 2 of 2: wrote a.0001.png\n");
    assert_eq!(ran.out, "2 of 2 frames are written\n");
    let files = ["a.0000.gbuffer.normal.png", "a.0000.png", "a.0001.gbuffer.normal.png", "a.0001.png", "moving.glb"];
    assert_eq!(program.files(), files);
    program.run(&render(&["--frames", "7..7", "-o", "b.exr", "--quiet"])).fine();
    assert!(program.files().contains(&"b.0007.exr".to_owned()));
}

#[test]
fn a_built_in_scene_is_the_same_at_all_times() {
    let program = Program::new();
    let cornell = |more: &[&str]| {
        let base = ["render", "cornell", "--size", "32x18", "--technique", "deferred", "--json", "--quiet"];
        program.run(&[&base[..], more].concat()).fine().json()
    };
    let still = cornell(&["-o", "a.png"]);
    let later = cornell(&["-o", "a.png", "--time", "7.5", "--animation", "none"]);
    assert_eq!((&still["image"]["hash"], &still["scene"]["hash"]), (&later["image"]["hash"], &later["scene"]["hash"]));
    let frames = cornell(&["--frames", "0..1", "-o", "b.png"]);
    for report in frames["frames"].as_array().unwrap() {
        assert_eq!(report["image"]["hash"], still["image"]["hash"]);
    }
    program.fails(&["render", "cornell", "--animation", "walk"], 2, &["--animation walk", "the scene has none"]);
}

/// One frame's report, and its picture.
struct Framed {
    hash: String,
    picture: Picture,
    /// Counters of the tree that rays walk, and whether a pass of the host says how long making it took.
    refits: f64,
    cost: f64,
    has_pass: bool,
}

/// Frames 0 to 4 of `scene`, rendered by `technique` in one session.
fn frames_of(scene: &str, technique: &str, more: &[&str]) -> Vec<Framed> {
    let program = Program::new();
    let base = ["render", scene, "--technique", technique, "--size", "48x27", "--frames", "0..4", "--json", "--quiet"];
    let document = program.run(&[&base[..], &["-o", "a.exr", "--validate"], more].concat()).fine().json();
    let framed = |report: &serde_json::Value| {
        let counter = |key: &str| report["counters"][key].as_f64().unwrap();
        let has_pass = report["passes"].as_array().unwrap().iter().any(|pass| {
            pass["name"] == format!("{technique}.bvh") && pass["where"] == "host, once" && pass["ms"]["median"].is_f64()
        });
        let text = |key: &str| report["image"][key].as_str().unwrap().to_owned();
        let picture = image_file::read(Path::new(&program.path(&text("path")))).unwrap();
        let (refits, cost) = (counter("tree_refits"), counter("tree_cost"));
        Framed { hash: text("hash"), picture, refits, cost, has_pass }
    };
    document["frames"].as_array().unwrap().iter().map(framed).collect()
}

/// The same bits, of a technique whose rays ask whether anything is there, and of one whose rays ask for the nearest. Of
/// the latter `most_pixels` may be a last bit off: of two triangles that meet in an edge, a ray meets on it that which is
/// tried first. The greatest cost of a refitted tree.
#[track_caller]
fn refitting_shows_in_no_picture(scene: &str, most_pixels: usize) -> f64 {
    let (mut most_cost, is_software) = (0f64, driver().identity.is_software());
    for (technique, own, most_pixels) in [
        ("adaptive_interleaved", &["--emissive", "on", "--vpls", "16"][..], 0),
        ("path_traced", &["--spp", "1", "--bounces", "2"], most_pixels),
    ] {
        let of = |growth: &str| frames_of(scene, technique, &[own, &["--fps", "3", "--tree-growth", growth]].concat());
        let (refitted, built) = (of("1000"), of("0"));
        for (frame, (a, b)) in refitted.iter().zip(&built).enumerate() {
            let pixels = a.picture.pixels.iter().zip(&b.picture.pixels);
            let differing: Vec<_> = pixels.filter(|(a, b)| a != b).collect();
            // On an H200 some more of BoxAnimated's are, by a last bit as all are.
            let more = if is_software { 0 } else { a.picture.pixels.len() / 20 };
            assert!(differing.len() <= most_pixels + more, "{scene}, {technique}, frame {frame}: {differing:?}");
            assert!(
                differing.iter().all(|(a, b)| (0..3).all(|at| (a[at] - b[at]).abs() <= 4e-7 * a[at])),
                "{differing:?}"
            );
            assert_eq!((a.refits, a.has_pass), (frame as f64, true), "{scene}, {technique}");
            assert_eq!((b.refits, b.cost, b.has_pass), (0.0, 1.0, true), "{scene}, {technique}");
            most_cost = most_cost.max(a.cost);
        }
        assert_ne!(built[0].hash, built[4].hash, "{scene}, {technique}: nothing moves");
    }
    most_cost
}

#[test]
fn a_refitted_tree_shows_in_no_picture_of_a_built_in_scene() {
    let most_cost = refitting_shows_in_no_picture("chess:triangles=12000", 0);
    assert!(most_cost > 1.0, "{most_cost}");
}

#[test]
fn a_refitted_tree_shows_in_no_picture_of_skins_and_nodes_that_move() {
    let Some(folder) = shared_scenes() else { return };
    for (file, least_cost, most_pixels) in [("RiggedSimple", 1.2, 0), ("BoxAnimated", 1.2, 1)] {
        let path = folder.join(format!("samples/{file}/{file}.gltf"));
        let most_cost = refitting_shows_in_no_picture(path.to_str().unwrap(), most_pixels);
        assert!(most_cost > least_cost, "{file}: {most_cost}");
    }
}

/// The beam bends and comes back: its tree is built anew as often as its cost has grown by the share.
#[test]
fn a_tree_is_built_anew_where_its_cost_has_grown() {
    let Some(folder) = shared_scenes() else { return };
    let path = folder.join("samples/RiggedSimple/RiggedSimple.gltf");
    let more = ["--fps", "3", "--direct-shadow", "ray"];
    let refits = |growth: &str| {
        let rows = frames_of(path.to_str().unwrap(), "deferred", &[&more[..], &["--tree-growth", growth]].concat());
        let greatest = 1.0 + growth.parse::<f64>().unwrap();
        let costs: Vec<f64> = rows.iter().map(|row| row.cost).collect();
        assert!(costs.iter().all(|cost| *cost <= greatest), "{growth}: {costs:?}");
        rows.iter().map(|row| row.refits).collect::<Vec<_>>()
    };
    assert_eq!(refits("1"), [0.0, 1.0, 2.0, 3.0, 4.0]);
    let some = refits("0.1");
    assert!(some[1..].contains(&0.0) && some.iter().any(|count| *count > 0.0), "{some:?}");
}

#[test]
fn what_cannot_be_is_refused() {
    let program = moving();
    program.fails(&render(&["--frames", "5..3"]), 2, &["--frames 5..3", "A <= B", "--frames 0..47"]);
    program.fails(&render(&["--frames", "-1..3"]), 2, &["--frames -1..3"]);
    program.fails(&render(&["--frames", "0..3", "--fps", "0"]), 2, &["--fps 0", "0.001 to 1000"]);
    program.fails(&render(&["--frames", "0..3", "-o", "a.jpg"]), 2, &["a.jpg", ".png or .exr"]);
    program.fails(
        &render(&["--frames", "0..3", "--time", "1e9"]),
        2,
        &["frame 3", "--time 1000000000.125", "1000000000"],
    );
    program.fails(&render(&["--time", "-1"]), 2, &["--time -1", "0 to 1000000000"]);
    program.fails(&render(&["--time", "nan"]), 2, &["--time nan"]);
    program.fails(&render(&["--animation", "run"]), 2, &["moving.glb", "--animation run", "cross"]);
    program.fails(&render(&["--fps", "12"]), 2, &["--frames"]);
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_finished_frames() {
    let program = moving();
    let mut child = quincunx()
        .current_dir(program.folder.path())
        .args(render(&["--frames", "0..99999", "--quiet", "-o", "a.png", "--report", "r.json"]))
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let second = program.folder.path().join("a.00001.png");
    let started = Instant::now();
    while !second.exists() {
        if started.elapsed() > Duration::from_secs(120) || child.try_wait().unwrap().is_some() {
            // It must not go on after the test.
            child.kill().unwrap();
            panic!("no frame came");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let report: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(program.path("r.json")).unwrap()).unwrap();
    let finished = report["frames"].as_array().unwrap().len();
    let pictures: Vec<String> = program.files().into_iter().filter(|file| file.ends_with(".png")).collect();
    assert!((2..100_000).contains(&finished));
    assert_eq!(pictures.len(), finished);
    for picture in pictures {
        image::open(program.path(&picture)).unwrap();
    }
}
