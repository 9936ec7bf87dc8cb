//! `bench frame --frames`: means over a sequence, its trees and its flicker.

use crate::support::benched::lines;
use crate::support::program::Program;
use quincunx::metrics::{ErrorFlickerMeter, FlickerMeter};
use quincunx::picture::{Picture, image_file};
use serde_json::{Value, json};
use std::path::Path;

const MOVING: [&str; 7] =
    ["cornell:motion=on", "--technique", "adaptive_interleaved", "--size", "32x24", "--vpls", "16"];
const FRAMES: [&str; 4] = ["--frames", "1..4", "--fps", "6"];

fn rows(program: &Program, more: &[&str]) -> Vec<Value> {
    let arguments = [&["bench", "frame"], &MOVING[..], &["--repeat", "2", "--json", "--quiet", "--validate"], more];
    let cache = program.path("kept");
    lines(&program.run_with(&arguments.concat(), &[("QUINCUNX_CACHE", &cache)]).fine().out)
}

/// Pictures of `render`.
fn pictures(program: &Program, name: &str, scene_and_more: &[&str]) -> Vec<Picture> {
    let file = format!("{name}.exr");
    program.run(&[&["render"], scene_and_more, &FRAMES[..], &["-o", &file, "--quiet"]].concat()).fine();
    (1..=4)
        .map(|frame| image_file::read(Path::new(&program.path(&format!("{name}.{frame:04}.exr")))).unwrap())
        .collect()
}

#[test]
fn a_row_is_the_mean_of_a_sequence_with_its_trees() {
    let program = Program::new();
    let rows = rows(&program, &[&FRAMES[..], &["--sweep", "tree-growth=0,1000"]].concat());
    assert_eq!(rows.len(), 2);
    for (row, trees) in rows.iter().zip([[4, 0], [1, 3]]) {
        assert_eq!(row["frames"], json!({"first": 1, "last": 4, "fps": 6.0}));
        assert_eq!([&row["trees_built"], &row["trees_refitted"]], [&json!(trees[0]), &json!(trees[1])], "{row:#}");
        let parts = row["frame_parts_ms"].as_object().unwrap();
        let names: Vec<&String> = parts.keys().collect();
        assert_eq!(names, ["pose", "upload", "tree", "host", "device"]);
        assert!(parts.values().all(|part| part.as_f64().unwrap() > 0.0) && row["setup_ms"].as_f64().unwrap() > 0.0);
        // Two rounds: each part's median is its mean, and so the sum of them the mean of the sums.
        let sum: f64 = parts.values().map(|part| part.as_f64().unwrap()).sum();
        let samples: Vec<f64> =
            row["frame_ms"]["samples"].as_array().unwrap().iter().map(|sample| sample.as_f64().unwrap()).collect();
        assert!(samples.len() == 2 && ((samples[0] + samples[1]) / 2.0 - sum).abs() < 1e-6 * sum, "{row:#}");
        assert!(row["flicker_error"].is_null());
        // The command of the row repeats its frames.
        let command: Vec<&str> = row["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        assert!(command.windows(4).any(|words| words == FRAMES), "{command:?}");
    }
    // What is timed is what `render` writes.
    assert_eq!(rows[0]["flicker"], rows[1]["flicker"]);
    let mut meter = FlickerMeter::default();
    pictures(&program, "a", &MOVING).iter().for_each(|picture| meter.add(picture));
    let flicker = rows[0]["flicker"].as_f64().unwrap();
    assert!(flicker > 0.0 && (flicker - meter.value().unwrap()).abs() < 1e-12, "{flicker} for {meter:?}");
}

#[test]
fn flicker_of_the_error_is_against_the_reference_of_each_frame() {
    let program = Program::new();
    let rows = rows(&program, &[&FRAMES[..], &["--reference", "auto", "--reference-spp", "4"]].concat());
    let kept = std::fs::read_dir(program.path("kept/references")).unwrap();
    // The reference's seed is its own: another picture than path_traced has by default.
    let mut references: Vec<Picture> = kept.map(|file| image_file::read(&file.unwrap().path()).unwrap()).collect();
    assert_eq!(references.len(), 4, "one a frame");
    let truth = [&MOVING[..1], &["--technique", "path_traced", "--size", "32x24", "--spp", "64", "--brdf", "lambert"]];
    let truth = pictures(&program, "truth", &[&truth.concat()[..], &["--transport", "one-bounce"]].concat());
    // Files are named by their keys: each frame's is that which is nearest to its truth.
    let far = |a: &Picture, b: &Picture| -> f64 {
        let channels = a.pixels.as_flattened().iter().zip(b.pixels.as_flattened());
        channels.map(|(a, b)| f64::from(a - b).powi(2)).sum()
    };
    let mut meter = ErrorFlickerMeter::default();
    for (picture, truth) in pictures(&program, "b", &MOVING).iter().zip(&truth) {
        references.sort_by(|a, b| far(a, truth).total_cmp(&far(b, truth)));
        meter.add(picture, &references[0]);
    }
    let found = rows[0]["flicker_error"].as_f64().unwrap();
    assert!((found - meter.value().unwrap()).abs() < 1e-9, "{found} for {:?}", meter.value());
    assert!(rows[0]["errors"]["rmse"].as_f64().unwrap() > 0.0);
}

#[test]
fn one_moment_and_two_frames_have_no_flicker_and_stages_no_frames() {
    let program = Program::new();
    let two = rows(&program, &["--frames", "0..1"]);
    assert!(two[0]["flicker"].is_null() && two[0]["trees_built"] == 1, "{:#}", two[0]);
    let one = rows(&program, &[]);
    for key in ["frames", "frame_parts_ms", "setup_ms", "trees_built", "trees_refitted", "flicker", "flicker_error"] {
        assert!(one[0].get(key).is_none(), "{key}");
    }
    let stage = program.run(&["bench", "split", "cornell", "--frames", "0..3"]);
    assert!(stage.code == 2 && stage.err.contains("--frames"), "{}", stage.err);
    let file = ["bench", "frame", "cornell", "--size", "8x8", "--frames", "0..3", "--reference", "a.exr"];
    program.run(&["render", "cornell", "--size", "8x8", "-o", "a.exr", "--quiet"]).fine();
    program.fails(&file, 2, &["--reference a.exr", "one moment", "--reference auto"]);
}
