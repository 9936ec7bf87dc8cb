//! Bytes that frames touch, as their shaders count them, against what must be touched.

use crate::support::program::Program;
use crate::support::skip;
use crate::support::touched::{bytes, ends, list, rendered, row};
use serde_json::Value;
use std::path::Path;

/// Pixels of the pictures.
const PIXELS: u64 = 64 * 48;
const SIZE: [&str; 2] = ["--size", "64x48"];

#[test]
fn a_pass_over_all_pixels_touches_each_once() {
    let program = Program::new();
    let report =
        rendered(&program, &[&["cornell", "--technique", "deferred", "--touched", "line"], &SIZE[..]].concat());
    // Position and normal are attachments of four halves, cleared and stored; each thread fetches its texel.
    for (name, texel_bytes) in [("position", 8), ("normal", 8)] {
        let all = PIXELS * texel_bytes;
        assert_eq!(bytes(row(&report, "gbuffer", name)), [0, all, 0, all], "{name}");
        assert_eq!(bytes(row(&report, "shade", name)), [all, 0, all, 0], "{name}");
    }
    let all = PIXELS * 16;
    let [.., written, _, stored] = bytes(row(&report, "shade", "shade.color"));
    assert_eq!([written, stored], [all, all]);
    // Every index of a draw is read, once, and every vertex that one names.
    let scene = &report["scene"];
    let triangles = scene["triangles"].as_u64().unwrap();
    let [read, _, asked, _] = bytes(row(&report, "gbuffer", "scene.indices"));
    assert!(asked % 12 == 0 && asked <= 12 * triangles && read <= asked, "{asked} of {triangles} triangles");
    let drawn = asked / 12;
    assert_eq!(report["counters"]["triangles_drawn"].as_f64().unwrap() as u64, drawn);
    let positions = row(&report, "gbuffer", "scene.positions");
    assert_eq!(bytes(positions)[2] % 12, 0, "{positions}");
    assert!(bytes(positions)[2] <= 12 * 3 * drawn, "a vertex is made at most once an index: {positions}");
}

#[test]
fn a_frame_that_counts_has_the_same_picture() {
    let program = Program::new();
    for (technique, settings) in [
        ("interleaved_deferred", &["--touched", "page"][..]),
        ("inferred_lighting", &[]),
        ("adaptive_interleaved", &[]),
        ("interleaved_sampling", &["--touched", "page"]),
        ("forward", &["--msaa", "4"]),
        ("path_traced", &["--spp", "1"]),
    ] {
        let pieces = settings.iter().position(|word| *word == "--touched");
        let (plain, counts) = settings.split_at(pieces.unwrap_or(settings.len()));
        let plain = [&["cornell", "--technique", technique][..], &SIZE, plain].concat();
        let hash = |more: &[&str]| {
            let report = rendered(&program, &[&plain[..], more].concat());
            (report["image"]["hash"].as_str().unwrap().to_owned(), report["memory"]["touched"].is_object())
        };
        let expected = hash(&[]);
        assert!(!expected.1, "{technique}");
        let counts = if counts.is_empty() { &["--touched", "line"] } else { counts };
        assert_eq!(hash(counts), (expected.0, true), "{technique}");
    }
}

/// Buffers that are reached by their addresses and share bytes cannot be told apart.
#[test]
fn buffers_at_addresses_are_counted_as_those_of_descriptors() {
    let program = Program::new();
    let sums = |access: &str| {
        let settings = ["--technique", "deep_shading", "--spp", "2", "--alias", "off", "--list-access", access];
        let arguments = [&["cornell", "--size", "32x24"][..], &settings].concat();
        let plain = rendered(&program, &arguments);
        let report = rendered(&program, &[&arguments[..], &["--touched", "line"]].concat());
        assert_eq!(report["image"]["hash"], plain["image"]["hash"], "{access}");
        let rows = list(&report["memory"]["touched"]["resources"]).iter();
        let named = rows.map(|row| (row["resource"].as_str().unwrap().to_owned(), bytes(row)));
        let lists = ["begins", "nodes", "colors"];
        named.filter(|(name, _)| lists.iter().any(|list| name.ends_with(list))).collect::<Vec<_>>()
    };
    let [descriptors, addresses] = ["descriptors", "addresses"].map(sums);
    assert!(descriptors.len() == 3 && descriptors.iter().all(|(_, bytes)| bytes[2] > 0), "{descriptors:?}");
    assert_eq!(
        descriptors.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        addresses.iter().map(|(name, _)| name).collect::<Vec<_>>()
    );
    for ((name, one), (_, other)) in descriptors.iter().zip(&addresses) {
        // Threads insert in an order of their own, and try again where another was first.
        let near = |at: usize| one[at].abs_diff(other[at]) <= one[at] / 8;
        assert!(near(0) && near(1) && near(2) && near(3), "{name}: {one:?} {other:?}");
    }
}

/// What passes read knows how many lights there are.
#[test]
fn bytes_that_passes_ask_for_know_the_lights() {
    let program = Program::new();
    let asked = |vpls: &str, split: &[&str]| {
        let settings = [&["--vpls", vpls, "--touched", "line"], split].concat();
        let report = rendered(&program, &[&["cornell"], &SIZE[..], &settings].concat());
        let lights = row(&report, "shade", "vpls").clone();
        let passes = list(&report["passes"]);
        let shade = ends(passes, "name", "shade")["bytes_read"].as_u64().unwrap();
        let [distinct, _, asked, _] = bytes(&lights);
        (distinct, asked, shade)
    };
    let [few, many] = ["16", "64"].map(|vpls| asked(vpls, &["--split", "one-pass", "--pattern", "2x2"]));
    // A light takes 48 bytes, and each is read by some pixel; one that is behind a surface is read in part.
    assert_eq!((few.0, many.0), (48 * 16, 48 * 64));
    assert!(many.1 > 2 * few.1 && many.1 <= PIXELS * 48 * 16, "{few:?} {many:?}");
    assert_eq!(many.2 - many.1, few.2 - few.1, "the rest of the pass does not know them: {few:?} {many:?}");
    let none = asked("16", &["--split", "none"]);
    assert_ne!(none.2, few.2, "splits differ");
}

/// What a pass reckons without counting: each thread reads all lights of its subset, which is no less than what it does.
#[test]
fn what_a_pass_reckons_knows_the_lights() {
    let program = Program::new();
    for (split, subsets) in [("none", 1), ("branch", 4), ("remap", 4), ("one-pass", 4), ("two-pass", 4)] {
        let own = [&["--split", split][..], if subsets == 1 { &[] } else { &["--pattern", "2x2"] }].concat();
        let report = |vpls: &str, more: &[&str]| {
            rendered(&program, &[&["cornell", "--vpls", vpls], &SIZE[..], &own, more].concat())
        };
        let shade = |report: &Value| {
            let pass = ends(list(&report["passes"]), "name", "shade");
            ["bytes_read", "invocations"].map(|key| pass[key].as_u64().unwrap())
        };
        let [few, many] = ["16", "64"].map(|vpls| shade(&report(vpls, &[])));
        assert_eq!(few[1], many[1], "{split}");
        assert_eq!(many[0] - few[0], many[1] * (64 - 16) * 48 / subsets, "{split}");
        let touched = report("64", &["--touched", "page"]);
        let counted = shade(&touched);
        let [.., asked, _] = bytes(row(&touched, "shade", "vpls"));
        let reckoned = many[1] * 64 * 48 / subsets;
        assert!(asked <= reckoned && asked > reckoned / 2, "{split}: {asked} {reckoned}");
        assert!(counted[1] >= many[1] && counted[1] < 2 * many[1], "{split}: whole workgroups: {counted:?} {many:?}");
    }
}

/// Fragments that are shaded: each pixel's nearest surface alone behind a prepass, others too without.
#[test]
fn invocations_are_counted_where_arithmetic_cannot_tell() {
    let program = Program::new();
    let of = |technique: &str, pass: &str, more: &[&str]| {
        let report = rendered(&program, &[&["cornell", "--technique", technique], &SIZE[..], more].concat());
        let invocations = ends(list(&report["passes"]), "name", pass)["invocations"].clone();
        let touched = report["memory"]["touched"]["passes"].as_array();
        let counted = touched.map(|passes| ends(passes, "pass", pass)["invocations"].clone());
        assert!(counted.is_none_or(|counted| counted == invocations), "{technique}: {invocations}");
        invocations.as_u64()
    };
    assert_eq!(of("deferred", "gbuffer", &[]), None);
    let counted = |technique: &str, pass: &str| of(technique, pass, &["--touched", "page"]).unwrap();
    let seen = counted("forward", "material");
    assert!(seen <= PIXELS && seen > PIXELS / 2, "{seen}");
    let drawn = counted("deferred", "gbuffer");
    assert!(drawn > seen && drawn < 8 * seen, "{drawn} {seen}");
    let shaded = counted("deferred", "shade");
    assert_eq!(shaded % 64, 0, "workgroups of 64: {shaded}");
}

#[test]
fn pieces_of_a_page_touch_no_less_than_lines() {
    let program = Program::new();
    let of = |pieces: &str| {
        let settings = ["--technique", "deferred", "--touched", pieces];
        rendered(&program, &[&["hall:triangles=5000"], &SIZE[..], &settings].concat())
    };
    let [lines, pages] = ["line", "page"].map(of);
    let sum = |report: &Value| report["memory"]["touched_bytes"].as_u64().unwrap();
    assert!(sum(&lines) < sum(&pages), "{} {}", sum(&lines), sum(&pages));
    for line in list(&lines["memory"]["touched"]["resources"]) {
        let page = ends(list(&pages["memory"]["touched"]["resources"]), "resource", line["resource"].as_str().unwrap());
        assert_eq!(line["asked_read_bytes"], page["asked_read_bytes"], "{line}");
        assert_eq!(line["bytes"], page["bytes"]);
        assert!(line["touched_bytes"].as_u64() <= page["touched_bytes"].as_u64(), "{line} {page}");
        assert!(page["touched_bytes"].as_u64() <= page["bytes"].as_u64(), "{page}");
    }
}

/// A picture of 144 pixels looks up a few thousand texels of what levels it needs.
#[test]
fn a_small_picture_touches_little_of_large_textures() {
    let Some(folder) = std::env::var_os("QUINCUNX_SCENES") else { return skip("QUINCUNX_SCENES is not set") };
    let helmet = Path::new(&folder).join("samples/DamagedHelmet/DamagedHelmet.gltf");
    let program = Program::new();
    let arguments = [helmet.to_str().unwrap(), "--technique", "deferred", "--size", "16x9", "--touched", "line"];
    let report = rendered(&program, &arguments);
    let rows = list(&report["memory"]["resources"]);
    let textures: Vec<_> = rows.iter().filter(|row| row["group"] == "scene.textures").collect();
    let sum = |key: &str| textures.iter().map(|row| row[key].as_u64().unwrap()).sum::<u64>();
    let [touched, of] = ["touched_bytes", "bytes"].map(sum);
    assert!(0 < touched && 100 * touched < of, "{touched} of {of}");
    // The finest level has 2048 texels a side, and a pixel covers hundreds of them.
    let largest = list(&report["memory"]["touched"]["resources"]);
    let levels = largest.iter().filter_map(|row| row["levels"].as_array()).find(|levels| levels.len() > 8).unwrap();
    assert_eq!(levels[0][1], 0, "{levels:?}");
    assert!(levels.iter().any(|level| level[1].as_u64() > Some(0)));
}

#[test]
fn what_cannot_be_counted_is_refused() {
    let program = Program::new();
    let ran = program.run(&["memory", "cornell", "--plan", "--touched", "line"]);
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("--touched line: a plan touches nothing"), "{}", ran.err);
    let ran = program.run(&["bench", "frame", "cornell", "--touched", "page"]);
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("--touched page: frames that count are slow"), "{}", ran.err);
}
