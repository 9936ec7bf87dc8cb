//! Ways to draw members (`--members`): the same samples, and how much each of them shades (section 3.1).

use super::NAME;
use crate::support::difference::{require_same, rmse};
use crate::support::moving::moving;
use crate::support::program::Program;
use crate::support::watched::{Watched, both};
use crate::support::{Feature, has};
use quincunx::volume::{self, VolumeRequest};
use serde_json::json;
use std::sync::Arc;

/// A polygon behind a stipple pattern lets through what is scattered, to the bit: with several samples a pixel and none, with
/// sides that are no whole pixels, and whatever members differ in. A member over the whole frame has its samples in the same
/// places, from where corners are snapped to parts of a pixel instead of parts of a basis, and numbers round otherwise.
#[test]
fn all_ways_take_the_same_samples() {
    let still = |name| moving(name, [0.0; 2]);
    let head = volume::open(&VolumeRequest { spec: "head:size=32", raw_size: None, seed: 1 });
    let head = Arc::new(head.unwrap());
    let basis = |basis, samples| [("basis", basis), ("samples", samples)];
    for (scene, changes, bound) in [
        (still("cornell"), both(&basis("2x2", "4"), &[("direct-shadow", "ray")]), 0.2),
        (still("cornell"), both(&basis("2.5x1.75", "3"), &[]), 0.0),
        (still("fence"), both(&basis("3x2", "0.5"), &[]), 0.02),
        (
            moving("chess:triangles=12000", [0.0, 0.6]),
            both(&basis("2x3", "1"), &[("effect", "aa,motion"), ("shutter", "0,0.6")]),
            0.02,
        ),
        (still("specimen:rod=on").holding(&head), both(&basis("2x2", "1"), &[("effect", "volume")]), 0.002),
    ] {
        let name = scene.name.clone();
        let watched = Watched::with_scene(scene);
        let shared = both(&changes, &[("size", "61x47")]);
        let picture = |members| watched.picture(NAME, &both(&shared, &[("members", members)]));
        let layers = picture("layers");
        require_same(&watched.session.gpu, &picture("stipple"), &layers, &name);
        if bound > 0.0 {
            let tuples = picture("tuples");
            // Samples of neighbours would be as far off as one pixel's picture is from the next one's.
            let mut shifted = layers.clone();
            shifted.pixels.rotate_right(1);
            let (error, other) = (rmse(&tuples, &layers), rmse(&shifted, &layers));
            println!("{name}: RMSE {error}, {other} a pixel beside");
            assert!(error < bound && error < 0.25 * other, "{name}: {error}, {other}");
        }
    }
}

/// At sixteenths of pixels, where hardware can have them, each way has them too.
#[test]
fn sixteenths_are_the_same_whatever_draws_them() {
    let watched = Watched::open("cornell");
    for (basis, samples) in [("2x2", "4"), ("3x2", "2.5"), ("3x2", "0.5")] {
        let own = [("size", "61x47"), ("direct-shadow", "ray"), ("basis", basis), ("samples", samples)];
        let picture = |members, places| watched.picture(NAME, &both(&own, &[("members", members), ("places", places)]));
        let layers = picture("layers", "sixteenths");
        require_same(&watched.session.gpu, &picture("stipple", "sixteenths"), &layers, &(basis, samples));
        let free = picture("layers", "free");
        let (error, moved) = (rmse(&picture("tuples", "sixteenths"), &layers), rmse(&free, &layers));
        println!("{basis}, {samples}: RMSE {error}, {moved} to samples that are free");
        assert!(moved > 0.0 && error < 0.2, "{basis}, {samples}: {error}, {moved}");
    }
}

/// Several members at once, each a sample of the device's behind its own mask, are those that are drawn one by one: in one run, in
/// several, and where the last one has fewer; with holes and with what blends.
#[test]
fn samples_of_the_device_are_members_that_are_drawn_alone() {
    for (scene, changes) in [
        ("cornell", [("basis", "2x2"), ("samples", "4"), ("direct-shadow", "ray"), ("depth-prepass", "on")]),
        ("cornell", [("basis", "3x2"), ("samples", "2.5"), ("direct-shadow", "sun"), ("depth-prepass", "off")]),
        (
            "hall:triangles=5000",
            [("basis", "1x1"), ("samples", "2"), ("direct-shadow", "sun"), ("depth-prepass", "on")],
        ),
        ("fence", [("basis", "3x2"), ("samples", "0.5"), ("direct-shadow", "sun"), ("depth-prepass", "on")]),
    ] {
        let watched = Watched::open(scene);
        if !has(&watched.session.gpu.caps, Feature::SampleLocations) {
            return;
        }
        let shared = both(&changes, &[("size", "61x47"), ("places", "sixteenths")]);
        let picture = |members| watched.picture(NAME, &both(&shared, &[("members", members)]));
        let (tuples, placed) = (picture("tuples"), picture("sample-locations"));
        let mut shifted = tuples.clone();
        shifted.pixels.rotate_right(1);
        let (error, other) = (rmse(&placed, &tuples), rmse(&shifted, &tuples));
        println!("{scene}: RMSE {error}, {other} a pixel beside");
        assert!(error < 0.02 && error < 0.1 * other, "{scene}: {error}, {other}");
    }
}

/// What devices with placed samples take, by arithmetic; what others say; and what no device can.
#[test]
fn placed_samples_are_planned_or_refused_by_name() {
    let program = Program::new();
    let plan = |caps: &'static str, more: &[&'static str]| {
        let begin = ["memory", "cornell", "--plan", "--size", "64x48", "--technique", NAME, "--members"];
        [&begin[..], &["sample-locations", "--caps", caps], more].concat()
    };
    // Sixteen members: eight at once are two runs, and more a pixel than there are members nobody needs.
    for (basis, samples) in [("2x2", 8), ("1x1", 4)] {
        let words = plan("nvidia-h200", &["--basis", basis, "--json"]);
        let table: serde_json::Value = serde_json::from_str(&program.run(&words).fine().out).unwrap();
        let rows = table["techniques"][0]["memory"]["resources"].as_array().unwrap();
        for (name, bytes) in [("material.color", 16), ("depth.reversed", 4)] {
            let row = rows.iter().find(|row| row["name"] == format!("{NAME}.{name}")).unwrap();
            assert_eq!((&row["samples"], &row["bytes"]), (&json!(samples), &json!(64 * 48 * samples * bytes)), "{row}");
        }
    }
    let needs = ["--members sample-locations needs VK_EXT_sample_locations", "--places sixteenths"];
    program.fails(&plan("lavapipe-22.3.6", &[]), 3, &needs);
    for (more, words) in [
        (&["--places", "free"][..], "--members sample-locations with --places free"),
        (&["--basis", "2.5x2"], "--members sample-locations with --basis 2.5x2"),
        (&["--effect", "aa,motion", "--shutter", "0,0.1"], "--members sample-locations with --effect aa,motion"),
    ] {
        program.fails(&plan("nvidia-h200", more), 2, &[words]);
    }
}

/// The pass of depths reads holes at the level of the frame's pixels too: at that of a member's, which lie farther apart, thin wire
/// is all hole and disappears.
#[test]
fn holes_are_where_materials_have_them() {
    let watched = Watched::open("fence:alpha=mask,lights=8");
    let own = [("size", "160x90"), ("basis", "2x2"), ("samples", "1")];
    let [with, without] =
        ["on", "off"].map(|prepass| watched.picture(NAME, &both(&own, &[("depth-prepass", prepass)])));
    require_same(&watched.session.gpu, &with, &without, &"holes of a wire");
}

/// Pixels of other members are masked before they are shaded: over the whole frame nothing is drawn but where a member has its
/// samples, and what it has there is what its own small picture has.
#[test]
fn pixels_of_other_members_are_not_drawn() {
    let watched = Watched::open("cornell");
    let member = |members: &str, prepass: &str| {
        let own = [
            ("depth-prepass", prepass),
            ("size", "62x46"),
            ("basis", "4x3"),
            ("samples", "0.5"),
            ("background", "0.25"),
            ("ambient", "0.3"),
            ("members", members),
        ];
        let renderer = watched.render_stages(NAME, &own, &["material.color"]);
        watched.rgb(&renderer, "material.color")
    };
    let [layers, stipple, tuples] = ["layers", "stipple", "tuples"].map(|members| member(members, "on"));
    assert_eq!(tuples, member("tuples", "off"));
    assert_eq!(layers, stipple);
    let (mut own, mut far) = (0, 0);
    for (layer, tuple) in layers.iter().zip(&tuples) {
        match *layer {
            [0.0, 0.0, 0.0] => assert_eq!(*tuple, [0.25; 3]),
            _ => {
                own += 1;
                far += u32::from((0..3).any(|channel| (layer[channel] - tuple[channel]).abs() > 0.02));
            }
        }
    }
    // One of twelve pixels, of which a few lie on edges.
    assert!((225..=256).contains(&own) && far < own / 20, "{own}, {far}");
}
