//! `--statistics`: what the device counts in each pass. Dispatches and vertices are known to the last one; of fragments the
//! device counts at least as many as the shaders do themselves. Nothing else changes.

use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, driver, has};
use quincunx::gpu::commands::{Recording, Submits};
use quincunx::gpu::statistics::PassStatistics;
use quincunx::session::Renderer;
use serde_json::Value;
use std::collections::BTreeMap;

const FRAGMENT: (&str, &str) = ("shade-by", "fragment");
const DEEP: &str = "deep_shading";
/// Neither side is a multiple of a workgroup's, of a block of pixels or of 2.
const SIZE: (&str, &str) = ("size", "97x55");
const WIDTH: u64 = 97;
const HEIGHT: u64 = 55;

fn counting(submits: Submits) -> Recording {
    Recording { has_statistics: true, ..submits.into() }
}

/// Statistics of each pass of one more frame.
fn statistics(watched: &Watched, renderer: &Renderer) -> BTreeMap<String, PassStatistics> {
    let counted = renderer.frame().unwrap().statistics;
    crate::support::watched::require_silence(&watched.session.gpu, "a frame that is counted");
    assert_eq!(counted.len(), renderer.passes().len());
    renderer.passes().iter().map(|pass| pass.name.clone()).zip(counted).collect()
}

fn of(watched: &Watched, changes: Changes<'_>) -> (BTreeMap<&'static str, f64>, BTreeMap<String, PassStatistics>) {
    let renderer = watched.render_as(DEEP, changes, &[], counting(Submits::One));
    let counted = statistics(watched, &renderer);
    (renderer.measured_counters().unwrap(), counted)
}

/// Threads beyond the frame's edge run too; a pass has nothing of the pass before it, with a submit a pass or one for all.
#[test]
fn dispatches_and_vertices_are_counted_to_the_last() {
    if !has(&driver(), Feature::PipelineStatistics) {
        return;
    }
    let watched = Watched::open("cornell");
    for submits in [Submits::One, Submits::PerPass] {
        let renderer = watched.render_as("deferred", &[SIZE, ("workgroup", "32x2")], &[], counting(submits));
        let texels: u64 = renderer.resolved["texels"].parse().unwrap();
        let counted = statistics(&watched, &renderer);
        let [gbuffer, shade] = ["gbuffer", "shade"].map(|pass| &counted[&format!("deferred.{pass}")]);
        let threads = WIDTH.next_multiple_of(32) * HEIGHT.div_ceil(texels).next_multiple_of(2);
        assert_eq!(shade["compute_shader_invocations"], threads, "{submits:?}");
        let triangles = renderer.counters["triangles_drawn"] as u64;
        assert_eq!(gbuffer["input_assembly_primitives"], triangles, "{submits:?}");
        assert_eq!(gbuffer["input_assembly_vertices"], 3 * triangles, "{submits:?}");
        // Vertices that triangles share may be shaded once.
        let shaded = gbuffer["vertex_shader_invocations"];
        assert!(shaded >= triangles && shaded <= 3 * triangles, "{submits:?}: {gbuffer:?}");
        // Walls cover the middle of the frame.
        assert!(gbuffer["fragment_shader_invocations"] >= WIDTH * HEIGHT / 4, "{submits:?}: {gbuffer:?}");
        assert_eq!(gbuffer["compute_shader_invocations"], 0, "{submits:?}");
        for idle in ["vertex_shader_invocations", "clipping_primitives", "fragment_shader_invocations"] {
            assert_eq!(shade[idle], 0, "{submits:?}: {idle}");
        }
    }
}

/// Corners are as many as triangles have of them for each tuple; in a mesh most are shared by six triangles, and of a run of these the
/// device places each once.
#[test]
fn indexed_draws_place_a_vertex_once_for_the_triangles_around_it() {
    let caps = driver();
    if !has(&caps, Feature::PipelineStatistics) || !has(&caps, Feature::GeometryShader) {
        return;
    }
    let watched = Watched::open("hall:triangles=8000");
    for visibility in ["repeat-frame", "repeat-draw"] {
        let placed = |vertices| {
            let changes = [SIZE, ("spp", "2"), ("tuples", "4"), ("visibility", visibility), ("vertices", vertices)];
            let (counters, counted) = of(&watched, &changes);
            let counted = &counted[&format!("{DEEP}.visibility")];
            let corners = 3 * 4 * counters["triangles_drawn"] as u64;
            assert_eq!(counted["input_assembly_vertices"], corners, "{changes:?}");
            (counted["vertex_shader_invocations"], corners)
        };
        let [(fetched, corners), (indexed, _)] = ["fetched", "indexed"].map(placed);
        println!("{visibility}: {indexed} of {fetched} vertices are placed");
        assert_eq!(fetched, corners, "{visibility}");
        assert!(3 * indexed < 2 * corners && 6 * indexed >= corners, "{visibility}: {indexed} of {corners}");
    }
}

#[test]
fn shaders_count_no_more_executions_than_the_device() {
    if !has(&driver(), Feature::PipelineStatistics) {
        return;
    }
    let watched = Watched::open("fence:lights=6");
    let common = both(&[SIZE], &[("spp", "4"), ("camera", "rotor"), ("aperture", "0.1"), ("focus", "4")]);
    for (pass, changes) in [
        ("shade", &[FRAGMENT, ("conservative", "geometry")][..]),
        ("shade", &[FRAGMENT, ("conservative", "vertex")]),
        ("baseline.ssaa", &[("shading", "ssaa")]),
        ("baseline.msaa", &[("shading", "msaa"), ("visibility", "stochastic")]),
    ] {
        if changes == [FRAGMENT, ("conservative", "geometry")]
            && !has(&watched.session.gpu.caps, Feature::GeometryShader)
        {
            continue;
        }
        let (counters, counted) = of(&watched, &both(&common, changes));
        let counted = &counted[&format!("{DEEP}.{pass}")];
        let (shaded, fragments) = (counters["shader_invocations"], counted["fragment_shader_invocations"] as f64);
        println!("{changes:?}: {fragments} of {shaded}, {counted:?}");
        assert!(shaded > 0.0 && shaded <= fragments, "{changes:?}: {counters:?}, {counted:?}");
        let triangles = counters["triangles_drawn"] as u64;
        match changes {
            // A hull of each triangle comes out of the geometry shader, or none.
            [_, ("conservative", "geometry")] => {
                assert_eq!(counted["geometry_shader_invocations"], triangles);
                assert!(counted["geometry_shader_primitives"] > 0, "{counted:?}");
            }
            [_, ("conservative", "vertex")] => {
                assert_eq!(counted["input_assembly_vertices"] % triangles, 0, "{counted:?}");
                assert!(counted["input_assembly_vertices"] > 3 * triangles, "{counted:?}");
            }
            _ => {}
        }
    }
}

/// Reported like counters, and like the bytes and invocations beside them.
#[test]
fn statistics_are_of_the_last_of_a_picture_s_runs() {
    if !has(&driver(), Feature::PipelineStatistics) {
        return;
    }
    let watched = Watched::open("cornell");
    let of_runs = |count: &str| of(&watched, &[SIZE, ("spp", "2"), ("accumulate", count)]).1;
    let [one, three] = ["1", "3"].map(|count| of_runs(count)[&format!("{DEEP}.resolve")].clone());
    assert_eq!(one, three);
    assert!(one["compute_shader_invocations"] >= WIDTH * HEIGHT, "{one:?}");
}

fn passes(report: &Value) -> Vec<&Value> {
    report["passes"].as_array().unwrap().iter().collect()
}

#[test]
fn the_report_has_them_and_the_picture_stays() {
    let program = Program::new();
    let run = |more: &[&str]| {
        let arguments = ["render", "cornell", "--size", "33x17", "--vpls", "16", "--validate", "-o", "a.png"];
        program.run(&[&arguments[..], more].concat())
    };
    if !driver().features.pipeline_statistics {
        let ran = run(&["--statistics"]);
        assert_eq!(ran.code, 3, "{}", ran.err);
        for words in ["--statistics needs pipelineStatisticsQuery", "counters"] {
            assert!(ran.err.contains(words), "{}", ran.err);
        }
        assert!(program.files().is_empty());
        return;
    }
    let plain = run(&["--json"]).fine().json();
    assert!(passes(&plain).iter().all(|pass| pass.get("statistics").is_none()), "{plain:#}");
    let counted = run(&["--json", "--statistics"]).fine().json();
    assert_eq!(counted["image"]["hash"], plain["image"]["hash"]);
    for pass in passes(&counted) {
        // Light walks on the host have none.
        assert_eq!(pass.get("statistics").is_some(), pass["where"].is_null(), "{pass:#}");
    }
    let text = run(&["--statistics"]).fine().out;
    let line = text.lines().find(|line| line.contains("interleaved_deferred.gather")).unwrap();
    assert!(line.contains("compute ") && line.ends_with(" invocations"), "{text}");
    // Each frame of a sequence and the last of a profile have the same.
    let profile = run(&["--json", "--statistics", "--profile"]).fine().json();
    let frames = run(&["--json", "--statistics", "--quiet", "--frames", "0..1"]).fine().json();
    for report in [&profile, &frames["frames"][0], &frames["frames"][1]] {
        // A later frame has its tree already, and no pass that makes one.
        let on_device = passes(&counted).into_iter().filter(|pass| pass["where"].is_null());
        for pass in on_device {
            let again = passes(report).into_iter().find(|again| again["name"] == pass["name"]).unwrap();
            assert_eq!(pass["statistics"], again["statistics"], "{}", pass["name"]);
        }
    }
}
