//! `memory`: what is planned without a device, by a known driver's rules, is what that driver asks for and what is made.

use crate::support;
use quincunx::caps::{Caps, known};
use quincunx::gpu::structure::Over;
use quincunx::gpu::{DeviceRequest, Gpu};
use quincunx::job::Job;
use quincunx::plan::Requirements;
use quincunx::units::Bytes;
use quincunx::{study, techniques};
use serde_json::Value;

#[test]
fn the_known_caps_are_those_of_the_driver() {
    let Some(name) = support::known_driver() else { return };
    let mut known = known::caps(name).unwrap();
    known.layout = None;
    let live = support::driver();
    let json = |caps| serde_json::to_value(caps).unwrap();
    let (mut known, mut live) = (json(&known), json(&live));
    // Lanes depend on the processor, the heap on the machine.
    for caps in [&mut known, &mut live] {
        caps["identity"]["name"] = Value::Null;
        caps["limits"]["subgroup_size"] = Value::Null;
        caps["heaps"] = Value::Null;
    }
    assert_eq!(known, live, "{name}");
}

#[test]
fn what_is_planned_without_a_device_is_what_is_made_on_it() {
    let Some(known) = support::known_driver() else { return };
    let mut specs = vec!["cornell".to_owned(), "lamps:objects=10,lights=24".to_owned()];
    if let Some(folder) = support::shared_scenes() {
        specs.push(folder.join("samples/CesiumMilkTruck/CesiumMilkTruck.gltf").to_str().unwrap().to_owned());
    }
    let settings: &[(&str, &[(&str, &str)])] = &[
        ("deferred", &[("size", "97x53")]),
        ("deferred", &[("size", "161x91"), ("cull", "tiled"), ("position", "depth"), ("direct-shadow", "ray")]),
        ("forward", &[("size", "97x53")]),
        ("forward", &[("size", "161x91"), ("msaa", "4"), ("direct-shadow", "ray"), ("light-buffer", "storage")]),
        ("forward", &[("size", "97x53"), ("msaa", "4"), ("supersample", "2"), ("depth-prepass", "off")]),
        ("forward", &[("size", "97x53"), ("direct-shadow", "map"), ("shadow-map-size", "33")]),
        ("inferred_lighting", &[("size", "161x91")]),
        ("inferred_lighting", &[("size", "97x53"), ("volumes", "both"), ("extras", "off"), ("msaa", "4")]),
        ("inferred_lighting", &[("size", "161x91"), ("volumes", "scissor"), ("l-buffer", "half")]),
        ("inferred_lighting", &[("size", "97x53"), ("light-size", "97x53"), ("light-filter", "bilateral")]),
        ("inferred_lighting", &[("size", "161x91"), ("volumes", "scissor"), ("shadow-volumes", "3")]),
        ("interleaved_deferred", &[("size", "161x91")]),
        ("interleaved_deferred", &[("size", "161x91"), ("filter", "gauss-fast"), ("pattern", "5x7")]),
        ("interleaved_deferred", &[("size", "97x53"), ("split", "subsample"), ("position", "float")]),
        ("interleaved_deferred", &[("size", "97x53"), ("split", "branch"), ("direct", "interleaved"), ("vpls", "64")]),
        ("interleaved_deferred", &[("size", "161x91"), ("split", "stencil"), ("vpls", "64")]),
        ("interleaved_deferred", &[("size", "97x53"), ("split", "depth"), ("position", "depth"), ("vpls", "64")]),
        ("interleaved_deferred", &[("size", "161x91"), ("split", "two-pass"), ("storage", "image"), ("vpls", "64")]),
        ("interleaved_deferred", &[("size", "161x91"), ("split", "tile"), ("pattern", "5x7"), ("vpls", "64")]),
        ("interleaved_deferred", &[("size", "161x91"), ("split", "layered"), ("pattern", "5x7"), ("vpls", "64")]),
        ("interleaved_deferred", &[("size", "97x53"), ("split", "fragment"), ("position", "float"), ("vpls", "64")]),
    ];
    for spec in &specs {
        for (technique, changes) in settings {
            require_made_as_planned(known, spec, technique, changes);
        }
    }
}

/// Kircher 2009: 4 bytes a texel of the light buffer's normals, 4 of its ids and linear depth, 4 of its depth (D32_SFLOAT; the
/// paper's has a stencil of a byte among the 4) and 8 of its light. What a driver adds is said to be padding.
#[test]
fn the_buffers_of_inferred_lighting_are_as_large_as_its_texels() {
    let Some(known) = support::known_driver() else { return };
    for (light_size, texels) in [("800x450", 800 * 450), ("1280x720", 1280 * 720)] {
        let changes = [("size", "1280x720"), ("light-size", light_size), ("extras", "off")];
        let job = job("lamps:objects=10,lights=24", "inferred_lighting", &changes);
        let tables = [study::planned(&job, known, &known::caps(known).unwrap()).unwrap(), study::made(&job).unwrap()];
        for table in tables.map(|study| study.table.json()) {
            let rows: Vec<&Value> = table["resources"].as_array().unwrap().iter().collect();
            for (name, format, bytes) in [
                ("geometry.normal", "R32_UINT", 4),
                ("geometry.dsf", "R32_UINT", 4),
                ("geometry.depth", "D32_SFLOAT", 4),
                ("light.l_buffer", "R32G32_UINT", 8),
            ] {
                let name = format!("inferred_lighting.{name}");
                let row = rows.iter().find(|row| row["name"] == name.as_str()).unwrap();
                assert_eq!((&row["format"], &row["bytes"]), (&Value::from(format), &Value::from(bytes * texels)));
                assert!(row["bound_bytes"].as_u64().unwrap() >= bytes * texels, "{row:#}");
            }
            let groups = ["g-buffer", "l-buffer"];
            let asked = rows.iter().filter(|row| groups.contains(&row["group"].as_str().unwrap()));
            assert_eq!(asked.map(|row| row["bytes"].as_u64().unwrap()).sum::<u64>(), 20 * texels, "{light_size}");
        }
    }
}

fn job(spec: &str, technique: &str, changes: &[(&str, &str)]) -> Job {
    let mut job = Job::new(spec, techniques::find(technique).unwrap());
    changes.iter().for_each(|(key, value)| job.set(key, value).unwrap());
    job
}

fn require_made_as_planned(known: &str, spec: &str, technique: &str, changes: &[(&str, &str)]) {
    let job = job(spec, technique, changes);
    let what = format!("{technique} of {spec} with {changes:?}");
    let planned = study::planned(&job, known, &known::caps(known).unwrap()).unwrap().table.json();
    let made = study::made(&job).unwrap().table.json();
    for key in ["planned_bytes", "allocated_bytes", "peak_bytes", "peak_pass", "groups"] {
        assert_eq!(planned[key], made[key], "{what}: {key}");
    }
    let without_place = |table: &Value| -> Vec<Value> {
        let mut rows = table["resources"].as_array().unwrap().clone();
        for row in &mut rows {
            let row = row.as_object_mut().unwrap();
            row.remove("memory_block");
            row.remove("offset");
        }
        rows
    };
    assert_eq!(without_place(&planned), without_place(&made), "{what}");
}

const QUERY: [(&str, &str); 3] = [("size", "97x53"), ("spp", "1"), ("rays", "query")];

/// What is measured of a driver's structures is what it asks for, from none on, and what is planned is made.
#[test]
fn structures_are_as_large_as_their_driver_s_rules_say() {
    let Some(known) = support::known_driver() else { return };
    if !support::has(&support::driver(), support::Feature::RayQuery) {
        return;
    }
    let layout = known::caps(known).unwrap().layout.unwrap();
    let gpu = Gpu::open(&DeviceRequest::default()).unwrap();
    let triangles = |count| [true, false].map(|is_opaque| Over::Triangles { count, is_opaque });
    for over in [0, 1, 2, 3, 1000, 1 << 20].into_iter().flat_map(triangles).chain([Over::Instance]) {
        let [planned, asked] = [Requirements::Rules(&layout), Requirements::Device(&gpu)]
            .map(|requirements| requirements.structure_bytes(over).unwrap());
        assert_eq!(planned, asked, "{over:?}");
    }
    for spec in ["cornell", "lamps:objects=10,lights=24"] {
        require_made_as_planned(known, spec, "path_traced", &QUERY);
    }
}

#[test]
fn structures_of_a_driver_that_nobody_measured_are_not_planned() {
    let name = "lavapipe-25.0.7";
    let mut caps = known::caps(name).unwrap();
    let job = job("cornell", "path_traced", &QUERY);
    let table = study::planned(&job, name, &caps).unwrap().table.json();
    let names: Vec<&str> =
        table["resources"].as_array().unwrap().iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"path_traced.structure.bottom") && names.contains(&"path_traced.structure.top"));
    assert!(!names.contains(&"path_traced.bvh.nodes"), "{names:?}");
    let mut require_refusal = |change: fn(&mut Caps), code: u8, words: &str| {
        change(&mut caps);
        let error = study::planned(&job, name, &caps).map(|_| ()).unwrap_err();
        assert_eq!(error.exit_code(), code, "{error}");
        assert!(error.to_string().contains(words) && error.to_string().contains("--rays tree"), "{error}");
    };
    require_refusal(|caps| caps.layout.as_mut().unwrap().structures = None, 2, "only the driver says");
    require_refusal(|caps| caps.features.ray_query = false, 3, "VK_KHR_ray_query");
}

/// The table of docs/memory.md, made again.
#[test]
fn the_page_says_what_the_heaps_of_three_gpus_hold() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/memory.md")).unwrap();
    let heaps = [("nvidia-rtx-2070", 0), ("nvidia-rtx-2070", 2), ("amd-navi21", 1), ("intel-arc-a770", 0)];
    let head: Vec<String> = heaps
        .iter()
        .map(|(name, heap)| format!("heap {heap} of {}", Bytes(known::caps(name).unwrap().heaps[*heap].bytes)))
        .collect();
    let is_head = |line: &&str| line.starts_with("| technique | peak |");
    let found = page.lines().find(is_head).unwrap();
    assert!(head.iter().all(|words| found.contains(words)), "{found} has not {head:?}");
    for technique in techniques::ALL {
        let mut job = Job::new("cornell", *technique);
        job.set("size", "1920x1080").unwrap();
        let study = |name: &str| study::planned(&job, name, &known::caps(name).unwrap()).unwrap();
        let bound = |(name, heap): &(&str, usize)| {
            let heaps = study::heaps::json(&study(name));
            Bytes(heaps[*heap]["bound_bytes"].as_u64().unwrap()).to_string()
        };
        let peak = study(heaps[0].0).table.json()["peak_bytes"].as_u64().unwrap();
        let cells: Vec<String> = heaps.iter().map(bound).collect();
        let row = format!("| `{}` | {} | {} |", technique.name(), Bytes(peak), cells.join(" | "));
        assert!(page.contains(&row), "docs/memory.md has not\n{row}");
    }
}

#[test]
fn a_stage_that_is_read_back_lives_until_the_end() {
    let caps = known::caps(known::DEFAULT).unwrap();
    let mut job = Job::new("cornell", techniques::find("interleaved_deferred").unwrap());
    let last_pass = |job: &Job| {
        let table = study::planned(job, known::DEFAULT, &caps).unwrap().table.json();
        let rows = table["resources"].as_array().unwrap().clone();
        let row = rows.iter().find(|row| row["name"] == "interleaved_deferred.split.normal").unwrap();
        row["last_pass"].as_str().unwrap().to_owned()
    };
    assert_eq!(last_pass(&job), "interleaved_deferred.shade");
    job.aovs = vec!["split.normal".to_owned()];
    assert_eq!(last_pass(&job), "readback");
}
