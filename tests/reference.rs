//! References: from a file, made, kept, broken; what is judged against them, and what is refused.

use crate::support::placing_steps;
use crate::support::program::{self, Program};
use crate::support::watched::{Changes, Watched, both, values};
use glam::Vec3;
use quincunx::picture::image_file::WriteOptions;
use quincunx::picture::{Picture, image_file};
use quincunx::reference::cache::Cache;
use quincunx::reference::made::{MadeReference, Watch, reference_picture};
use quincunx::reference::recipe::Recipe;
use quincunx::techniques::settings_of;
use quincunx::units::Extent;
use quincunx::volume::{self, VolumeRequest};
use quincunx::{metrics, scene, techniques};
use serde_json::Value;
use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

const SMALL: [&str; 6] = ["render", "cornell", "--size", "32x18", "--vpls", "16"];

fn small<'a>(more: &[&'a str]) -> Vec<&'a str> {
    SMALL.iter().chain(more).copied().collect()
}

/// What was said while references were made.
#[derive(Default)]
struct Heard {
    notes: RefCell<Vec<String>>,
    renders: RefCell<usize>,
}

impl Watch for Heard {
    fn note(&self, text: &str) {
        self.notes.borrow_mut().push(text.to_owned());
    }

    fn begins(&self, _: &Recipe, _: Option<Duration>) {
        *self.renders.borrow_mut() += 1;
    }
}

fn recipe(watched: &Watched, changes: Changes<'_>) -> Recipe {
    let technique = techniques::find("deferred").unwrap();
    Recipe::new(technique, values("deferred", changes), &watched.session).unwrap()
}

fn made(watched: &Watched, recipe: &Recipe, folder: &Path, heard: &Heard) -> MadeReference {
    reference_picture(recipe, &watched.session, &Cache::new(folder), heard).unwrap()
}

const TINY: Changes<'static> = &[("size", "24x16"), ("lights", "3")];

#[test]
fn the_second_time_nothing_is_rendered() {
    let watched = Watched::open("cornell");
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("not/there/yet");
    let (recipe, heard) = (recipe(&watched, TINY), Heard::default());
    let first = made(&watched, &recipe, &folder, &heard);
    let second = made(&watched, &recipe, &folder, &heard);
    assert!(!first.was_kept && second.was_kept);
    assert_eq!(*heard.renders.borrow(), 1);
    assert_eq!(first.picture, second.picture);
    assert_eq!(first.picture, watched.picture("deferred", TINY));
    assert_eq!(*heard.notes.borrow(), [] as [&str; 0]);
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn a_broken_file_is_put_aside_and_made_again() {
    let watched = Watched::open("cornell");
    let folder = tempfile::tempdir().unwrap();
    let recipe = recipe(&watched, TINY);
    let path = Cache::new(folder.path()).path(&recipe);
    let whole = made(&watched, &recipe, folder.path(), &Heard::default()).picture;
    let bytes = std::fs::read(&path).unwrap();
    let mut other = whole.clone();
    other.pixels[7][1] += 0.5;
    // What a file says of itself, to be put over other pixels.
    let texts = image_file::read_exr_with_texts(&path).unwrap().1;
    let attributes: Vec<(String, String)> = texts.into_iter().collect();
    let options = |attributes| WriteOptions { attributes, ..WriteOptions::default() };
    let breaks: [(&str, &dyn Fn()); 6] = [
        ("broken one", &|| std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap()),
        ("broken one", &|| std::fs::write(&path, b"no picture").unwrap()),
        ("other key", &|| image_file::write(&path, &whole, &options(Vec::new())).unwrap()),
        ("not those", &|| image_file::write(&path, &other, &options(attributes.clone())).unwrap()),
        ("24x16", &|| {
            let small = Picture::filled(Extent::new(2, 2), [1.0; 3]);
            image_file::write(&path, &small, &options(attributes.clone())).unwrap();
        }),
        ("NaN", &|| {
            let dark = Picture::filled(whole.extent, [f32::NAN; 3]);
            image_file::write(&path, &dark, &options(attributes.clone())).unwrap();
        }),
    ];
    for (word, break_it) in breaks {
        break_it();
        let heard = Heard::default();
        let again = made(&watched, &recipe, folder.path(), &heard);
        assert!(!again.was_kept && again.picture == whole, "{word}");
        let notes = heard.notes.borrow();
        assert!(notes.len() == 1 && notes[0].contains("is broken and is made again"), "{notes:?}");
        let said = notes[0].replace("another key", "other key");
        assert!(said.contains(word), "{said}");
        assert!(path.with_extension("broken.exr").exists());
        assert!(made(&watched, &recipe, folder.path(), &heard).was_kept, "{word}");
    }
}

#[test]
fn what_cannot_be_kept_is_used_all_the_same() {
    let watched = Watched::open("cornell");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a file");
    std::fs::write(&file, "").unwrap();
    let heard = Heard::default();
    let picture = made(&watched, &recipe(&watched, TINY), &file, &heard).picture;
    assert_eq!(picture.extent, Extent::new(24, 16));
    assert!(heard.notes.borrow()[0].contains("used but could not be kept"), "{:?}", heard.notes.borrow());
}

#[test]
fn a_key_is_of_all_that_the_picture_hangs_on_and_of_nothing_else() {
    let watched = Watched::open("cornell");
    let truth = techniques::find("deferred").unwrap();
    let key = |technique: &str, changes: Changes<'_>| {
        let judged = techniques::find(technique).unwrap();
        let recipe = Recipe::judging(truth, judged, &values(technique, changes), &watched.session, 256);
        recipe.unwrap().key().to_owned()
    };
    let plain = key("interleaved_deferred", &[]);
    for same in [("exposure", "2"), ("tonemap", "aces"), ("pattern", "2x2"), ("vpls", "32"), ("workgroup", "32x1")] {
        assert_eq!(key("interleaved_deferred", &[same]), plain, "{same:?}");
    }
    for other in [("size", "64x64"), ("lights", "3"), ("brdf", "lambert"), ("background", "1"), ("ambient", "0.5")] {
        assert_ne!(key("interleaved_deferred", &[other]), plain, "{other:?}");
    }
    // Scattered lights depend on the seed; without them the seed is the judged technique's own.
    assert_ne!(key("deferred", &[("lights", "3")]), key("deferred", &[("lights", "3"), ("seed", "2")]));
    assert_eq!(key("deferred", &[("lights", "3:7")]), key("deferred", &[("lights", "3:7"), ("seed", "2")]));
    let hall = Watched::open("lamps:objects=3,lights=3");
    assert_ne!(recipe(&watched, TINY).key(), recipe(&hall, TINY).key());
}

/// A reference of a volume hangs on what the file of its transfer function says, not on its name alone.
#[test]
fn a_changed_transfer_file_makes_another_reference() {
    let volume = volume::open(&VolumeRequest { spec: "marschner-lobb:size=8", raw_size: None, seed: 1 }).unwrap();
    let watched = Watched::with_scene(scene::load("specimen", 1).unwrap().holding(&Arc::new(volume)));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("transfer.txt");
    let key = |text: &str| {
        std::fs::write(&path, text).unwrap();
        let values = values("path_traced", &[("transfer", path.to_str().unwrap())]);
        let technique = techniques::find("path_traced").unwrap();
        Recipe::new(technique, values, &watched.session).unwrap().key().to_owned()
    };
    let first = key("0 0 0 0 0\n1 1 1 1 4\n");
    assert_eq!(first, key("0 0 0 0 0\n1 1 1 1 4.0 # the same\n"));
    assert_ne!(first, key("0 0 0 0 0\n1 1 1 1 5\n"));
}

#[test]
fn a_transport_without_a_reference_says_so() {
    let lamps = Watched::open("lamps:objects=3,lights=3");
    let settings = |technique: &str, changes: Changes<'_>| {
        let values = values(technique, changes);
        let view = quincunx::frame::View::new(&lamps.session.scene, "0", values.extent("size")).unwrap();
        let lights = quincunx::lights::LightSet::new(&lamps.session.scene, &view, &values).unwrap();
        techniques::find(technique).unwrap().reference_settings(&values, &lights)
    };
    let has = |found: quincunx::Result<Vec<(&str, String)>>, key: &str, text: &str| {
        let found = found.unwrap();
        assert!(found.iter().any(|(known, value)| *known == key && value == text), "{found:?} has no {key} {text}");
    };
    has(settings("deferred", &[("direct-shadow", "ray")]), "light-visibility", "on");
    has(settings("deferred", &[("direct-shadow", "none")]), "light-visibility", "off");
    has(settings("deferred", &[]), "transport", "direct");
    has(settings("interleaved_deferred", &[]), "transport", "one-bounce");
    for technique in techniques::ALL.iter().filter(|technique| technique.name() != "path_traced") {
        has(settings(technique.name(), &[]), "ambient-visibility", "off");
    }
    has(settings("interleaved_deferred", &[("vpl-bounces", "3")]), "bounces", "4");
    has(settings("interleaved_deferred", &[("direct", "interleaved")]), "brdf", "lambert");
    // None, all and one of its three lamps cast shadows by volumes.
    let by_volumes = |count| settings("inferred_lighting", &[("direct-shadow", "none"), ("shadow-volumes", count)]);
    has(by_volumes("0"), "light-visibility", "off");
    has(by_volumes("9"), "light-visibility", "on");
    has(settings("inferred_lighting", &[("direct-shadow", "ray"), ("shadow-volumes", "1")]), "light-visibility", "on");
    let error = by_volumes("1").unwrap_err();
    let words = "--shadow-volumes: 1 of 3 lights cast shadows";
    assert!(error.exit_code() == 2 && error.message().contains(words), "{error}");
    let error = settings("interleaved_deferred", &[("direct", "none")]).unwrap_err();
    assert!(error.exit_code() == 2 && error.message().contains("--direct none"), "{error}");
}

/// Nothing shadows ambient light but in path tracing: what is judged against that is judged against light that is not shadowed
/// there either. In a closed room next to nothing comes in from outside.
#[test]
fn ambient_light_is_judged_by_ambient_light() {
    let mut scene = quincunx::scene::load("cornell", 1).unwrap();
    scene.lights.clear();
    scene.materials.iter_mut().for_each(|material| material.emissive = Vec3::ZERO);
    let watched = Watched::with_scene(scene);
    let (truth, folder) = (techniques::find("path_traced").unwrap(), tempfile::tempdir().unwrap());
    // Edges, which are one sample a pixel in all but the first, are most of what is left.
    for (technique, changes, bound) in [
        ("forward", &[("supersample", "8")][..], 0.004),
        ("forward", &[("supersample", "8"), ("background", "0.5")], 0.004),
        ("forward", &[("supersample", "8"), ("brdf", "lambert"), ("ambient", "0.1,0.5,0.2")], 0.004),
        ("deferred", &[], 0.03),
        ("inferred_lighting", &[], 0.04),
        ("deep_shading", &[("spp", "64")], 0.02),
    ] {
        let changes = both(&[("size", "64x48"), ("rig", "always")], changes);
        let recipe = Recipe::judging(
            truth,
            techniques::find(technique).unwrap(),
            &values(technique, &changes),
            &watched.session,
            64,
        );
        let mut recipe = recipe.unwrap();
        let picture = watched.picture(technique, &changes);
        let error = |recipe: &Recipe| {
            let reference = made(&watched, recipe, folder.path(), &Heard::default()).picture;
            metrics::compare(&picture, &reference, 0.1).unwrap().metrics.rmse
        };
        let found = error(&recipe);
        // Coarsely placed vertices move edges.
        let bound = bound + 0.002 * (placing_steps(&watched.session.gpu.caps) - 1.0);
        assert!(found < bound, "{technique} with {changes:?}: {found}");
        let shadowed = settings_of(truth).into_iter().find(|setting| setting.key == "ambient-visibility").unwrap();
        recipe.values.set(&shadowed, "on").unwrap();
        let recipe = Recipe::new(truth, recipe.values, &watched.session).unwrap();
        let unlike = error(&recipe);
        assert!(unlike > 2.0 * bound, "{technique} with {changes:?}: {unlike} where ambient light is shadowed");
    }
}

/// Names the folder to a process that this test starts of itself.
const CHILD: &str = "QUINCUNX_TEST_REFERENCE_CHILD";

#[test]
fn two_processes_at_once_leave_one_whole_file() {
    let work = |folder: &Path| {
        let watched = Watched::open("cornell");
        made(&watched, &recipe(&watched, TINY), folder, &Heard::default())
    };
    if let Some(folder) = std::env::var_os(CHILD) {
        work(Path::new(&folder));
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let start = || {
        // Under a runner the process is that of a dynamic linker, and its file too.
        let mut command = program::start(std::env::args_os().next().unwrap());
        command.args(["--exact", "reference::two_processes_at_once_leave_one_whole_file"]).env(CHILD, folder.path());
        command.stdout(std::process::Stdio::null()).spawn().unwrap()
    };
    for mut child in [start(), start()] {
        assert!(child.wait().unwrap().success());
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(work(folder.path()).was_kept);
}

#[test]
fn a_report_has_the_errors_and_gates_judge_them() {
    let program = Program::new();
    program.run(&small(&["--split", "none", "-o", "none.exr"])).fine();
    let report = program.run(&small(&["--reference", "none.exr", "-o", "a.png", "--json"])).fine().json();
    let errors = &report["errors"];
    assert_eq!((&errors["reference"], &errors["cut"]), (&"none.exr".into(), &Value::Array(Vec::new())));
    program.run(&small(&["-o", "a.exr"])).fine();
    let compared = program.run(&["compare", "a.exr", "none.exr", "--json"]).fine().json();
    for metric in metrics::Metrics::NAMES {
        assert!(errors[metric].is_number(), "{metric}: {errors:#}");
        assert_eq!(errors[metric], compared["metrics"][metric], "{metric}: a PNG's picture is judged before it is cut");
    }
    assert!(errors["rmse"].as_f64().unwrap() > 0.0);
    let failed = program.run(&small(&["--reference", "none.exr", "-o", "b.png", "--max", "rmse=0"]));
    assert!(failed.code == 1 && failed.err.contains("b.png: against the reference: rmse is"), "{}", failed.err);
    assert!(failed.out.contains("errors against none.exr"), "{}", failed.out);
    assert!(Path::new(&program.path("b.png")).exists(), "what failed is there to be looked at");
    let passed = ["--reference", "none.exr", "-o", "b.png", "--max", "rmse=1", "--threshold", "1", "--json"];
    let report = program.run(&small(&passed)).fine().json();
    assert_eq!(
        (&report["errors"]["gates"][0]["passed"], &report["errors"]["over_threshold"]),
        (&true.into(), &0.0.into())
    );
    program.run(&small(&["--split", "none", "-o", "none.png"])).fine();
    let report = program.run(&small(&["--reference", "none.png", "-o", "a.png", "--json"])).fine().json();
    assert_eq!(report["errors"]["cut"].as_array().unwrap().len(), 4);
}

#[test]
fn a_reference_that_does_not_fit_is_refused_before_anything_is_drawn() {
    let program = Program::new();
    program.run(&["render", "cornell", "--size", "20x10", "--vpls", "16", "-o", "other.exr"]).fine();
    let mut broken = image_file::read(Path::new(&program.path("other.exr"))).unwrap();
    broken.pixels[21][0] = f32::NAN;
    image_file::write(Path::new(&program.path("nan.exr")), &broken, &WriteOptions::default()).unwrap();
    program.fails(&small(&["--reference", "other.exr"]), 2, &["other.exr", "20x10", "32x18"]);
    program.fails(&small(&["--reference", "missing.exr"]), 2, &["--reference", "missing.exr"]);
    program.fails(&small(&["--reference", "nan.exr"]), 1, &["nan.exr", "NaN", "(1, 1)"]);
    program.fails(&small(&["--reference", "none"]), 2, &[".png or .exr"]);
    program.fails(&small(&["--reference", "other.exr", "--max", "mse=1"]), 2, &["no metric mse"]);
    let fits = ["render", "cornell", "--size", "20x10", "--vpls", "16", "--reference", "other.exr", "--frames", "0..1"];
    program.fails(&fits, 2, &["other.exr", "one moment", "auto"]);
    let bench =
        ["bench", "frame", "cornell", "--vpls", "16", "--sweep", "size=20x10,32x18", "--reference", "other.exr"];
    program.fails(&bench, 2, &["size=32x18", "20x10"]);
    // What clap refuses.
    assert_eq!(program.run(&small(&["--max", "rmse=1"])).code, 2);
    assert_eq!(program.run(&small(&["--reference", "other.exr", "--reference-spp", "0"])).code, 2);
}

#[test]
fn auto_is_made_once() {
    let program = Program::new();
    let auto = small(&["--reference", "auto", "--reference-spp", "16", "-o", "a.exr", "--json"]);
    let folder = program.path("kept");
    let variables = [("QUINCUNX_CACHE", folder.as_str())];
    let first = program.run_with(&auto, &variables);
    assert!(first.code == 0 && first.err.contains("making the reference: path_traced, 16 samples"), "{}", first.err);
    let second = program.run_with(&auto, &variables).fine();
    assert_eq!(first.json()["errors"], second.json()["errors"]);
}

#[test]
fn rows_of_a_bench_have_both_errors() {
    let program = Program::new();
    let truth = ["render", "cornell", "--size", "32x18", "--vpls", "64", "--split", "none", "-o", "truth.exr"];
    program.run(&truth).fine();
    let bench = |more: &[&str]| {
        let all = ["bench", "frame", "cornell", "--size", "32x18", "--vpls", "16", "--sweep", "split=none,one-pass"];
        let all = [&all[..], &["--repeat", "2", "--reference", "truth.exr"], more].concat();
        program.run(&all)
    };
    let ran = bench(&["--json", "--quiet", "-o", "out", "--validate"]).fine();
    let rows: Vec<Value> = ran.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(rows.len(), 2);
    for row in &rows {
        assert!(row["errors"]["rmse"].as_f64().unwrap() > 0.0, "{row:#}");
        assert_eq!(row["reference"]["name"], "truth.exr");
        let command: Vec<&str> = row["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        assert!(command.join(" ").contains("--reference truth.exr"), "{command:?}");
    }
    assert_eq!(rows[0]["error_against_none"]["rmse"], 0.0);
    let summary = std::fs::read_to_string(program.path("out/summary.md")).unwrap();
    assert!(summary.contains("errors against truth.exr"), "{summary}");
    // Another threshold is another measurement; the same one is kept.
    bench(&["-o", "out", "--resume", "--quiet"]).fine();
    assert_eq!(std::fs::read_to_string(program.path("out/rows.jsonl")).unwrap().lines().count(), 2);
    bench(&["-o", "out", "--resume", "--quiet", "--threshold", "0.2"]).fine();
    assert_eq!(std::fs::read_to_string(program.path("out/rows.jsonl")).unwrap().lines().count(), 4);
    let failed = bench(&["--quiet", "--max", "rmse=0"]);
    assert!(failed.code == 1 && failed.err.contains("split=none: against the reference"), "{}", failed.err);
}
