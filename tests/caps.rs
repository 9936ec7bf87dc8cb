//! Known drivers as data (`assets/caps`): what each technique needs and lacks on each, what its plans take, and what
//! `auto` comes to, as a text file a driver; and what must hold of them whatever the files say.
//!
//! `BLESS=NAME cargo test caps` (or `BLESS=all`) rewrites tests/snapshots/caps/NAME.txt.

use crate::support::program::Program;
use crate::support::skip;
use quincunx::caps::{Caps, known};
use quincunx::error::Result;
use quincunx::job::Job;
use quincunx::study::{self, Study};
use quincunx::techniques::fitness::fitness;
use quincunx::techniques::{self, ALL};
use quincunx::units::Bytes;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const SCENE: &str = "cornell";
const SIZE: &str = "96x54";

/// A technique and settings that reach each choice that devices make (`auto`), and each kind of resource.
const CASES: [&str; 25] = [
    "interleaved_deferred",
    "interleaved_deferred --split tile",
    "interleaved_deferred --split layered",
    "interleaved_deferred --split stencil",
    "interleaved_deferred --direct-shadow ray",
    "inferred_lighting",
    "inferred_lighting --msaa 4",
    "deep_shading",
    "deep_shading --shade-by fragment",
    "deep_shading --visibility repeat-draw",
    "deep_shading --visibility stochastic",
    "deep_shading --visibility ray",
    "deep_shading --shading msaa",
    "deep_shading --shading indirect-gbuffer --visibility stochastic",
    "deep_shading --direct-shadow map",
    "deferred",
    "deferred --cull tiled",
    "forward",
    "forward --msaa 8",
    "forward --msaa 4 --sample-shading on",
    "forward --msaa 4 --sample-format half",
    "forward --direct-shadow map",
    "interleaved_sampling --members sample-locations",
    "path_traced",
    "path_traced --rays query",
];

fn job(case: &str) -> Job {
    let mut words = case.split(' ');
    let mut job = Job::new(SCENE, techniques::find(words.next().unwrap()).unwrap());
    job.set("size", SIZE).unwrap();
    while let (Some(flag), Some(text)) = (words.next(), words.next()) {
        job.set(flag.strip_prefix("--").unwrap(), text).unwrap();
    }
    job
}

/// A plan, and what the settings came to that say `auto`.
type Planned = (Study, BTreeMap<&'static str, String>);

fn planned(name: &str, caps: &Caps, case: &str) -> Result<Planned> {
    let job = job(case);
    let study = study::planned(&job, name, caps)?;
    let mut resolved = study::resolved(&job, caps)?;
    resolved.retain(|key, _| job.values.text(key) == "auto");
    Ok((study, resolved))
}

/// A known driver with a case.
struct Tried {
    name: &'static str,
    caps: Caps,
    case: &'static str,
    planned: Planned,
}

impl Tried {
    fn what(&self) -> String {
        format!("{}: {}", self.name, self.case)
    }
}

/// Every known driver with every case, but those that are refused.
fn every_plan() -> Vec<Tried> {
    let each = known::names().flat_map(|name| CASES.map(|case| (name, case)));
    each.filter_map(|(name, case)| {
        let caps = known::caps(name).unwrap();
        let planned = planned(name, &caps, case).ok()?;
        Some(Tried { name, caps, case, planned })
    })
    .collect()
}

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is not a number"))
}

fn resources(study: &Study) -> Vec<Value> {
    study.table.json()["resources"].as_array().unwrap().clone()
}

/// What a technique lacks on a driver, and how far its settings go there.
fn write_needs(text: &mut String, caps: &Caps) -> std::fmt::Result {
    for technique in ALL {
        let fitness = fitness(*technique, caps);
        let verdict = if fitness.stopped_by.is_empty() { "runs" } else { "does not run" };
        writeln!(text, "{} {verdict}", technique.name())?;
        for need in fitness.stopped_by.iter().chain(&fitness.left_out) {
            writeln!(text, "    {} needs {}", need.of, need.ability.name())?;
        }
        let bounds: Vec<String> = fitness.bounds.iter().map(|(of, most)| format!("{of} to {most}")).collect();
        writeln!(text, "    {}", bounds.join("; "))?;
    }
    Ok(())
}

fn write_plan(text: &mut String, case: &str, planned: Result<Planned>) -> std::fmt::Result {
    writeln!(text, "{case}")?;
    let (study, resolved) = match planned {
        Ok(planned) => planned,
        Err(error) => {
            let (code, message) = (error.exit_code(), error.message());
            let (why, _) = message.split_once(", which ").unwrap_or((message, ""));
            return writeln!(text, "    refused ({code}): {why}");
        }
    };
    let sums = study.table.sums();
    let (asked, bound, peak) = (sums.planned_bytes, sums.allocated_bytes.unwrap(), sums.peak_bytes);
    let types: BTreeSet<u64> = resources(&study).iter().map(|row| number(&row["memory_type"])).collect();
    writeln!(text, "    {asked} B asked for, {bound} bound, {peak} at the peak, memory types {types:?}")?;
    let choices: Vec<String> = resolved.iter().map(|(key, value)| format!("{key} {value}")).collect();
    if choices.is_empty() { Ok(()) } else { writeln!(text, "    auto: {}", choices.join(", ")) }
}

fn snapshot(name: &str) -> String {
    let caps = known::caps(name).unwrap();
    let identity = &caps.identity;
    let mut text = format!("{name}: {}, {}, {}\n", identity.name, identity.device_type, identity.driver_text());
    let rounding = if caps.layout.is_some() { "sizes as this driver rounds them" } else { "sizes are not rounded" };
    let heaps: Vec<String> = caps.heaps.iter().map(|heap| Bytes(heap.bytes).to_string()).collect();
    let write = |text: &mut String| -> std::fmt::Result {
        writeln!(text, "{rounding}; heaps of {}\n\nneeds", heaps.join(", "))?;
        write_needs(text, &caps)?;
        writeln!(text, "\nplans of {SCENE} at {SIZE}")?;
        CASES.iter().try_for_each(|case| write_plan(text, case, planned(name, &caps, case)))
    };
    write(&mut text).unwrap();
    text
}

fn snapshot_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots/caps").join(format!("{name}.txt"))
}

#[test]
fn needs_plans_and_choices_are_as_they_were() {
    for name in known::names() {
        let (path, actual) = (snapshot_path(name), snapshot(name));
        if std::env::var("BLESS").is_ok_and(|blessed| blessed == name || blessed == "all") {
            std::fs::write(&path, &actual).unwrap();
            println!("blessed {}", path.display());
            continue;
        }
        let bless = format!("if it is right: BLESS={name} cargo test caps");
        let expected =
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}\n{bless}", path.display()));
        for (number, (actual, expected)) in actual.lines().zip(expected.lines()).enumerate() {
            assert_eq!(actual, expected, "{name}, line {}\n{bless}", number + 1);
        }
        assert_eq!(actual.lines().count(), expected.lines().count(), "{name}\n{bless}");
    }
}

/// No snapshot of a driver that is no longer known.
#[test]
fn every_snapshot_is_of_a_known_driver() {
    for entry in std::fs::read_dir(snapshot_path("any").parent().unwrap()).unwrap() {
        let file = entry.unwrap().file_name().into_string().unwrap();
        assert!(known::names().any(|name| file == format!("{name}.txt")), "{file}");
    }
}

/// Each memory type is there, is not for attachments that are never stored, and is visible where it must be; what lies
/// in a heap fits into it.
fn require_memory(tried: &Tried) {
    let mut held = vec![0; tried.caps.heaps.len()];
    for row in resources(&tried.planned.0) {
        let what = format!("{}: {}", tried.what(), row["name"]);
        let kind = tried.caps.memory_types.get(number(&row["memory_type"]) as usize).expect(&what);
        assert!(!kind.lazily_allocated, "{what}");
        let is_mapped = kind.host_visible && kind.host_coherent;
        assert!(kind.device_local || is_mapped, "{what}");
        // The block of a frame's numbers is written by the host.
        let (technique, _) = tried.case.split_once(' ').unwrap_or((tried.case, ""));
        assert!(is_mapped || row["name"] != format!("{technique}.frame"), "{what}");
        held[kind.heap as usize] += number(&row["bound_bytes"]);
    }
    for (held, heap) in held.iter().zip(&tried.caps.heaps) {
        assert!(*held <= heap.bytes, "{}: {held} B in a heap of {}", tried.what(), heap.bytes);
    }
}

fn require_samples(tried: &Tried) {
    for row in resources(&tried.planned.0) {
        let samples = row["samples"].as_u64().unwrap_or(1) as u32;
        let is_there = samples == 1 || tried.caps.limits.framebuffer_sample_counts.contains(&samples);
        assert!(is_there, "{}: {row}", tried.what());
    }
}

/// Values that `auto` must have: what the caps support, and never what no device has been seen to do right. None: what
/// does not go by the device.
fn expected_choice(tried: &Tried, key: &str) -> Option<&'static str> {
    let Caps { features, formats, identity, .. } = &tried.caps;
    let is_software = identity.is_software();
    let has_words = features.storage_image_extended_formats;
    Some(match key {
        "storage" if tried.case.contains("layered") || (has_words && !is_software) => "image",
        "storage" => "buffer",
        "conservative" | "polygon-from" if features.geometry_shader => "geometry",
        "conservative" | "polygon-from" => "vertex",
        "vertices" if features.geometry_shader => "indexed",
        "vertices" => "fetched",
        "layer-from" if features.layer_from_vertex_shader => "vertex",
        "layer-from" => "geometry",
        "sample-tests" if features.shader_int64_atomics => "loop",
        "sample-tests" => "layers",
        "shadow-filter" if formats.float_depth_linear => "bilinear",
        "shadow-filter" => "gather",
        "pass-samples" if formats.half_color_sample_counts.contains(&8) => "8",
        "pass-samples" => "4",
        "list-access" => "descriptors",
        "texels" if !is_software => "1",
        "cull-by" if is_software => "invocation",
        "cull-by" => "workgroup",
        _ => return None,
    })
}

/// Whatever the files say: memory that is there, samples that are there, choices by what is there.
#[test]
fn plans_and_choices_are_what_the_caps_allow() {
    let tried = every_plan();
    assert!(tried.len() > CASES.len() * 7, "{} planned", tried.len());
    let mut seen: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for tried in &tried {
        require_memory(tried);
        require_samples(tried);
        for (key, value) in &tried.planned.1 {
            let expected = expected_choice(tried, key).unwrap_or(value);
            assert_eq!(value, expected, "{}: {key}", tried.what());
            seen.entry(key).or_default().insert(value);
        }
    }
    // The files differ in what these ask.
    for key in [
        "storage",
        "conservative",
        "polygon-from",
        "sample-tests",
        "shadow-filter",
        "pass-samples",
        "texels",
        "cull-by",
    ] {
        assert!(seen.get(key).is_some_and(|values| values.len() > 1), "{key}: {seen:?}");
    }
    require_same_bytes(&tried);
}

/// What a plan asks for is arithmetic: where the choices are the same, the same on every device; and one that does not say
/// how it rounds gives no more.
fn require_same_bytes(tried: &[Tried]) {
    let mut asked: BTreeMap<String, (u64, &str)> = BTreeMap::new();
    for Tried { name, caps, case, planned: (study, resolved) } in tried {
        let sums = study.table.sums();
        let (bytes, bound) = (sums.planned_bytes, sums.allocated_bytes.unwrap());
        assert_eq!(study.is_unrounded, caps.layout.is_none(), "{name}");
        assert!(if study.is_unrounded { bound == bytes } else { bound >= bytes }, "{name}: {case}: {bound} of {bytes}");
        // How work is shared out among threads takes no memory.
        let is_of_threads = |key: &str| ["texels", "cull-by"].contains(&key);
        let choices: Vec<_> = resolved.iter().filter(|(key, _)| !is_of_threads(key)).collect();
        let key = format!("{case} {choices:?}");
        let (expected, other) = *asked.entry(key).or_insert((bytes, name));
        assert_eq!(bytes, expected, "{case}: {name} and {other}");
    }
    assert!(asked.len() < tried.len() / 3, "{} of {} have no equal", asked.len(), tried.len());
}

/// Images have sides and layers as the device has them, at a size that fills it too, and one pixel more is refused.
#[test]
fn plans_stay_within_the_limits() {
    // The longest side that --size takes.
    const MOST_SIDE_PX: u32 = 16_384;
    let (mut full, mut refused) = (0, 0);
    for name in known::names() {
        let caps = known::caps(name).unwrap();
        let [most, _] = caps.limits.most_drawn_px();
        let side_px = most.min(MOST_SIDE_PX);
        for technique in ALL {
            let at = |width: u32| {
                let mut job = Job::new(SCENE, *technique);
                job.set("size", &format!("{width}x8")).and_then(|()| study::planned(&job, name, &caps))
            };
            let what = format!("{name}: {}", technique.name());
            match at(side_px + 1) {
                Ok(study) => panic!("{what}: {}", study.table.text()),
                Err(error) => assert!(matches!(error.exit_code(), 2 | 3), "{what}: {error}"),
            }
            refused += 1;
            // Shading space is wider than the picture by two guard bands.
            let Ok(study) = at(if technique.name() == "deep_shading" { side_px - 128 } else { side_px }) else {
                continue;
            };
            full += 1;
            for row in resources(&study) {
                let Some((width, height)) = row["extent"].as_str().and_then(|extent| extent.split_once('x')) else {
                    continue;
                };
                let sides = [width, height].map(|side| side.parse::<u32>().unwrap());
                assert!(sides.iter().all(|side| *side <= caps.limits.max_image_side_px), "{what}: {row}");
                let layers = row["layers"].as_u64().unwrap_or(1);
                assert!(layers <= u64::from(caps.limits.max_image_layers), "{what}: {row}");
            }
        }
    }
    assert!(2 * full > refused, "{full} of {refused} planned");
}

/// Facts of cards that are known from elsewhere: who has what the files must say.
#[test]
fn files_say_what_is_known_of_their_devices() {
    let has = |ability: fn(&Caps) -> bool| -> Vec<&str> {
        known::names().filter(|name| ability(&known::caps(name).unwrap())).collect()
    };
    let gpus = ["amd-polaris10", "amd-navi21", "intel-arc-a770", "intel-iris-xe", "nvidia-h200", "nvidia-rtx-2070"];
    // Since Vega, Maxwell 2 and Gen 9; Polaris is before.
    let conservative = ["amd-navi21", "intel-arc-a770", "intel-iris-xe", "nvidia-h200", "nvidia-rtx-2070"];
    assert_eq!(has(|caps| caps.conservative.is_some_and(|rules| rules.draws_degenerate_triangles)), conservative);
    // RDNA 2 and Turing; it was not looked up on the Arc and the H200.
    assert_eq!(has(|caps| caps.features.fragment_shader_barycentric), ["amd-navi21", "nvidia-rtx-2070"]);
    // It was looked up on one device.
    assert_eq!(has(|caps| !caps.placed_sample_counts().is_empty()), ["nvidia-h200"]);
    // RDNA 2, Xe-HPG and Turing have units for rays; lavapipe walks them.
    assert_eq!(
        has(|caps| caps.features.ray_query),
        ["lavapipe-25.0.7", "amd-navi21", "intel-arc-a770", "nvidia-rtx-2070"]
    );
    assert_eq!(has(|caps| caps.limits.max_image_side_px > 16384), ["nvidia-h200", "nvidia-rtx-2070"]);
    assert_eq!(has(|caps| caps.formats.float_depth_sample_counts.contains(&8)), gpus);
    assert_eq!(
        has(|caps| caps.heaps.len() > 1),
        ["amd-polaris10", "amd-navi21", "intel-arc-a770", "nvidia-h200", "nvidia-rtx-2070", "least-1.3"]
    );
    for name in gpus {
        let lacking: Vec<String> = ALL
            .iter()
            .flat_map(|technique| fitness(*technique, &known::caps(name).unwrap()).left_out)
            .map(|need| need.of)
            .filter(|of| {
                !["hardware", "query", "sample-locations", "barycentrics"].iter().any(|word| of.contains(word))
            })
            .collect();
        assert!(lacking.is_empty(), "{name} lacks what every GPU has: {lacking:?}");
    }
    // Nothing that rasterises runs on what Vulkan promises: it promises no depth buffer of floats.
    for technique in ALL {
        let stopped_by = fitness(*technique, &known::caps(known::LEAST).unwrap()).stopped_by;
        assert_eq!(stopped_by.is_empty(), technique.name() == "path_traced", "{stopped_by:?}");
    }
}

/// What `devices --json` prints is what `--caps` takes: the same plan, but for rounding, and the table says so.
#[test]
fn a_device_can_be_planned_for_by_what_it_says_of_itself() {
    let program = Program::new();
    let devices = program.run(&["devices", "--json"]).fine();
    std::fs::write(program.path("devices.json"), &devices.out).unwrap();
    let plan = ["memory", SCENE, "--technique", "deferred", "--size", "64x36", "--plan"];
    let from = |more: &[&str]| program.run(&[&plan[..], more].concat()).fine();
    let own = from(&["--caps", "devices.json", "--device", "0"]);
    assert!(own.out.contains("how this driver rounds sizes has not been measured"), "{}", own.out);
    assert!(!from(&[]).out.contains("rounds sizes has not been measured"));
    let json = from(&["--caps", "devices.json", "--device", "0", "--json"]).json();
    let identity = &devices.json()["devices"][0]["caps"]["identity"];
    let study = &json["techniques"][0];
    assert!(study["device"].as_str().unwrap().starts_with(identity["name"].as_str().unwrap()), "{study}");
    assert_eq!(study["unrounded"], true);
    assert_eq!(study["memory"]["planned_bytes"], study["memory"]["allocated_bytes"]);
    let Some(known) = crate::support::known_driver() else { return skip("another driver") };
    let measured = from(&["--caps", known, "--json"]).json();
    assert_eq!(measured["techniques"][0]["unrounded"], false);
    assert_eq!(measured["techniques"][0]["memory"]["planned_bytes"], study["memory"]["planned_bytes"]);
    let fails = |more: &[&str], words: &[&str]| program.fails(&[&plan[..], more].concat(), 2, words);
    fails(&["--caps", "devices.json", "--device", "99"], &["--caps devices.json", "--device 99", "0: "]);
    fails(&["--caps", "nowhere.json"], &["--caps nowhere.json", "quincunx devices --json"]);
    fails(&["--caps", "."], &["--caps ."]);
    std::fs::write(program.path("broken.json"), "{\"caps\": {\"identity\": 3}}").unwrap();
    fails(&["--caps", "broken.json"], &["--caps broken.json", "quincunx devices --json"]);
}
