//! What scripts rely on: the exit code of every verb in every case, and the keys and types of every JSON document
//! (docs/report.md).

mod values;

use crate::support::program::Program;
use serde_json::Value;

const NOWHERE: [(&str, &str); 2] = [("VK_DRIVER_FILES", "/nowhere.json"), ("VK_ICD_FILENAMES", "/nowhere.json")];
const SMALL: [&str; 5] = ["cornell", "--size", "32x18", "--vpls", "16"];

/// `verb`, the small picture, and `more`.
fn small<'a>(verb: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    verb.iter().chain(&SMALL).chain(more).copied().collect()
}

/// Every verb that opens a device, with what makes it small.
fn verbs_with_device() -> [Vec<&'static str>; 4] {
    [small(&["render"], &[]), small(&["bench", "frame"], &["--repeat", "2"]), small(&["memory"], &[]), vec!["devices"]]
}

/// A run's exit code; an error is said on standard error, after what a bench says of its progress.
fn require_code(program: &Program, arguments: &[&str], variables: &[(&str, &str)], code: i32) {
    let ran = program.run_with(arguments, variables);
    assert_eq!(ran.code, code, "{arguments:?}: {}", ran.err);
    assert_eq!(ran.err.contains("error: "), code != 0, "{arguments:?}: {}", ran.err);
}

#[test]
fn every_verb_ends_with_0_where_all_is_well() {
    let program = Program::new();
    for arguments in verbs_with_device() {
        require_code(&program, &arguments, &[], 0);
    }
    require_code(&program, &small(&["render"], &["-o", "a.exr", "--quiet"]), &[], 0);
    // These need no device.
    require_code(&program, &["compare", "a.exr", "a.exr", "--max", "rmse=0"], &NOWHERE, 0);
    require_code(&program, &["scene", "list"], &NOWHERE, 0);
    require_code(&program, &small(&["memory", "--plan"], &[]), &NOWHERE, 0);
    for verb in ["render", "compare", "bench", "memory", "scene", "devices", "settings", "completions", "man"] {
        require_code(&program, &[verb, "--help"], &NOWHERE, 0);
    }
}

#[test]
fn a_gate_ends_with_1() {
    let program = Program::new();
    program.run(&small(&["render"], &["-o", "a.exr"])).fine();
    program.run(&small(&["render"], &["-o", "b.exr", "--seed", "2"])).fine();
    require_code(&program, &["compare", "a.exr", "b.exr", "--max", "rmse=0"], &[], 1);
    require_code(&program, &["compare", "a.exr", "b.exr", "--min", "psnr=inf"], &[], 1);
}

#[test]
fn a_bad_request_ends_with_2_in_every_verb() {
    let program = Program::new();
    for arguments in [
        &["render", "nowhere.glb"][..],
        &["render", "--nothing"],
        &["compare", "a.exr"],
        &["compare", "a.exr", "b.exr"],
        &["bench", "nothing"],
        &["bench", "frame", "cornell", "--sweep", "nothing=1"],
        &["memory", "cornell", "--size", "0x0"],
        &["memory", "cornell", "--plan", "--caps", "voodoo"],
        &["scene"],
        &["scene", "nothing"],
        &["devices", "--nothing"],
        &["nothing"],
        &[],
    ] {
        let ran = program.run(arguments);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{arguments:?}: {}", ran.err);
        assert!(!ran.err.is_empty(), "{arguments:?}");
    }
    assert_eq!(program.files(), [] as [&str; 0]);
}

#[test]
fn without_a_driver_every_verb_that_needs_one_ends_with_3() {
    let program = Program::new();
    for arguments in verbs_with_device() {
        require_code(&program, &arguments, &NOWHERE, 3);
    }
    for arguments in &verbs_with_device()[..3] {
        let elsewhere = [&arguments[..], &["--device", "no such device"]].concat();
        require_code(&program, &elsewhere, &[], 3);
    }
    assert_eq!(program.files(), [] as [&str; 0]);
}

#[test]
fn memory_that_is_too_small_ends_with_4() {
    let program = Program::new();
    for arguments in &verbs_with_device()[..3] {
        require_code(&program, &[&arguments[..], &["--memory-budget", "4KiB"]].concat(), &[], 4);
    }
    require_code(&program, &small(&["memory", "--plan"], &["--memory-budget", "4KiB"]), &NOWHERE, 4);
    assert_eq!(program.files(), [] as [&str; 0]);
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_render_ends_with_130_and_writes_nothing() {
    let program = Program::new();
    for more in [&[][..], &["--profile"]] {
        // It reads its scene for longer than the signal takes.
        let arguments = [&["render", "hall", "--size", "64x36", "-o", "a.png", "--report", "a.json"], more].concat();
        let (code, said) = program.interrupted(&arguments, || true);
        assert_eq!(code, Some(130), "{arguments:?}: {said}");
        assert!(said.starts_with("error: interrupted"), "{said}");
        assert_eq!(program.files(), [] as [&str; 0], "{arguments:?}");
    }
}

/// A key and the kind of what it holds. `a.b` goes into an object, `a[]` into each entry of a list that has some, `a.*`
/// into each value of an object that has some. A kind that ends in `?` may be null or missing.
type Row = (&'static str, &'static str);

const SPREAD: [Row; 4] = [("median", "number"), ("min", "number"), ("max", "number"), ("samples[]", "number")];

const MEMORY: &[Row] = &[
    ("planned_bytes", "count"),
    ("allocated_bytes", "count"),
    ("aliased_bytes", "count"),
    ("peak_bytes", "count"),
    ("peak_pass", "text"),
    ("groups.*", "count"),
    ("resources[].name", "text"),
    ("resources[].group", "text"),
    ("resources[].format", "text?"),
    ("resources[].extent", "extent?"),
    ("resources[].bytes", "count"),
    ("resources[].bound_bytes", "count"),
    ("resources[].first_pass", "text?"),
    ("resources[].last_pass", "text?"),
];

/// Rows of memory that was allocated.
const MADE: &[Row] =
    &[("memory_block_bytes", "count"), ("resources[].memory_block", "count"), ("resources[].offset", "count")];

/// Rows of memory whose bytes a frame counts as it touches them.
const TOUCHED: &[Row] = &[("touched_bytes", "count"), ("touched_of_bytes", "count"), ("touched_groups.*", "count")];

const DEVICE: &[Row] =
    &[("name", "text"), ("type", "text"), ("driver", "text"), ("driver_info", "text"), ("api", "text")];

const REPORT: &[Row] = &[
    ("schema", "count"),
    ("quincunx.version", "text"),
    ("quincunx.commit", "text"),
    ("command[]", "text"),
    ("scene.name", "text"),
    ("scene.hash", "hash"),
    ("scene.triangles", "count"),
    ("scene.draws", "count"),
    ("scene.lights", "count"),
    ("scene.materials", "count"),
    ("technique", "text"),
    ("settings.*", "text or number"),
    ("image.width", "count"),
    ("image.height", "count"),
    ("image.mean[]", "number"),
    ("image.hash", "hash"),
    ("image.path", "text"),
    ("aovs[].name", "text"),
    ("aovs[].format", "text"),
    ("aovs[].extent", "extent"),
    ("aovs[].hash", "hash"),
    ("passes[].name", "text"),
    ("passes[].bytes_read", "count?"),
    ("passes[].bytes_written", "count?"),
    ("passes[].invocations", "count?"),
    ("counters.*", "number"),
];

fn is(value: &Value, kind: &str) -> bool {
    let text = |judge: fn(&str) -> bool| value.as_str().is_some_and(judge);
    match kind {
        "count" => value.is_u64(),
        "number" => value.is_number(),
        "flag" => value.is_boolean(),
        "text" => value.is_string(),
        "text or number" => value.is_string() || value.is_number(),
        "hash" => text(|text| text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit())),
        "extent" => {
            text(|text| text.split_once('x').is_some_and(|(x, y)| x.parse::<u32>().is_ok() && y.parse::<u32>().is_ok()))
        }
        other => panic!("{other} is no kind"),
    }
}

#[track_caller]
fn require_at(value: &Value, path: &str, kind: &str, whole: &str) {
    let (step, rest) = path.split_once('.').unwrap_or((path, ""));
    let (key, is_list) = step.strip_suffix("[]").map_or((step, false), |key| (key, true));
    let inside: Vec<&Value> = match key {
        "*" => value.as_object().unwrap_or_else(|| panic!("{whole}: no object: {value}")).values().collect(),
        key if is_list => value[key].as_array().unwrap_or_else(|| panic!("{whole}: no list: {value}")).iter().collect(),
        key => vec![&value[key]],
    };
    assert!(!inside.is_empty(), "{whole}: nothing in it");
    for inner in inside {
        match kind.strip_suffix('?') {
            Some(_) if rest.is_empty() && inner.is_null() => {}
            _ if !rest.is_empty() => require_at(inner, rest, kind, whole),
            optional => assert!(is(inner, optional.unwrap_or(kind)), "{whole} is no {kind}: {inner}"),
        }
    }
}

#[track_caller]
fn require_rows(document: &Value, rows: &[Row]) {
    for (path, kind) in rows {
        require_at(document, path, kind, path);
    }
}

#[test]
fn the_report_has_the_keys_and_types_of_the_design() {
    let program = Program::new();
    let arguments = small(&["render"], &["--profile", "--aov", "split.normal,discontinuity.flags", "-o", "a.exr"]);
    let printed = program.run(&[&arguments[..], &["--json", "--report", "a.json"]].concat()).fine().json();
    let written: Value = serde_json::from_str(&std::fs::read_to_string(program.path("a.json")).unwrap()).unwrap();
    assert_eq!(printed, written, "--json and --report are one document");
    require_rows(&printed, REPORT);
    require_rows(&printed["device"], DEVICE);
    require_rows(&printed["memory"], MEMORY);
    require_rows(&printed["memory"], MADE);
    require_rows(&printed["total_ms"], &SPREAD);
    for pass in printed["passes"].as_array().unwrap() {
        require_rows(&pass["ms"], &SPREAD);
        // What the host does once has no timestamp.
        if pass["where"].is_null() {
            require_rows(&pass["timestamp_ms"], &SPREAD);
        }
    }
    assert!(printed["memory"]["resources"].as_array().unwrap().iter().any(|row| row["format"].is_string()));
    // Without --profile the frame alone has a time.
    let plain = program.run(&small(&["render"], &["--json", "-o", "a.png"])).fine().json();
    require_rows(&plain["total_ms"], &SPREAD);
    assert!(plain["passes"].as_array().unwrap().iter().all(|pass| !pass["where"].is_null() || pass["ms"].is_null()));
}

/// A key that any object in `value` has, and that begins with `word`.
fn has_key(value: &Value, word: &str) -> bool {
    match value {
        Value::Object(entries) => entries.iter().any(|(key, inner)| key.starts_with(word) || has_key(inner, word)),
        Value::Array(entries) => entries.iter().any(|inner| has_key(inner, word)),
        _ => false,
    }
}

#[test]
fn touched_bytes_are_said_only_where_a_frame_has_counted_them() {
    let program = Program::new();
    for arguments in [small(&["render"], &["-o", "a.png"]), small(&["memory"], &[]), small(&["memory", "--plan"], &[])]
    {
        let text = program.run(&arguments).fine().out;
        let json = program.run(&[&arguments[..], &["--json"]].concat()).fine().json();
        assert!(!text.contains("touched") && !has_key(&json, "touched_"), "{arguments:?}: {text}");
    }
    let deep = ["render", "cornell", "--size", "32x18", "--technique", "deep_shading", "-o", "a.png"];
    let text = program.run(&deep).fine().out;
    let memory = program.run(&[&deep[..], &["--json"]].concat()).fine().json()["memory"].clone();
    require_rows(&memory, TOUCHED);
    let counted: Vec<&Value> =
        memory["resources"].as_array().unwrap().iter().filter(|row| row["touched_bytes"].is_u64()).collect();
    let sum = |key: &str| counted.iter().map(|row| row[key].as_u64().unwrap()).sum::<u64>();
    assert!(!counted.is_empty() && counted.len() < memory["resources"].as_array().unwrap().len(), "{memory:#}");
    assert_eq!(
        (sum("touched_bytes"), sum("bytes")),
        (count(&memory, "touched_bytes"), count(&memory, "touched_of_bytes"))
    );
    assert!(text.contains("  touched: ") && text.contains("over the resources in which the frame counts"), "{text}");
    // Nobody counts: nothing is known.
    let json = program.run(&[&deep[..], &["--instrument", "off", "--json"]].concat()).fine().json();
    assert!(!has_key(&json, "touched_"), "{json:#}");
}

fn count(value: &Value, key: &str) -> u64 {
    value[key].as_u64().unwrap_or_else(|| panic!("{key}: {value:#}"))
}

#[test]
fn other_documents_have_their_keys_and_types() {
    let program = Program::new();
    let memory = program.run(&small(&["memory", "--json"], &[])).fine().json();
    let plan = program.run_with(&small(&["memory", "--plan", "--json"], &[]), &NOWHERE).fine().json();
    for document in [&memory, &plan] {
        require_rows(document, &[("schema", "count"), ("techniques[].technique", "text")]);
        require_rows(document, &[("techniques[].scene", "text"), ("techniques[].device", "text")]);
        require_rows(&document["techniques"][0]["memory"], MEMORY);
    }
    require_rows(&memory["techniques"][0]["memory"], MADE);
    // A PNG: it is cut.
    program.run(&small(&["render"], &["-o", "a.png", "--quiet"])).fine();
    let compared = program.run(&["compare", "a.png", "a.png", "--max", "flip=1", "--json"]).fine().json();
    require_rows(
        &compared,
        &[
            ("schema", "count"),
            ("a", "text"),
            ("b", "text"),
            ("width", "count"),
            ("height", "count"),
            ("metrics.rmse", "number"),
            ("metrics.relmse", "number"),
            // Infinite, where pictures are equal.
            ("metrics.psnr", "number?"),
            ("metrics.ssim", "number"),
            ("metrics.flip", "number"),
            ("metrics.hdr_flip", "number"),
            ("metrics.over_threshold", "number"),
            ("threshold", "number"),
            ("cut[]", "text"),
            ("gates[].metric", "text"),
            ("gates[].bound", "text"),
            ("gates[].value", "number"),
            ("gates[].measured", "number"),
            ("gates[].passed", "flag"),
        ],
    );
    let row = program.run(&small(&["bench", "frame"], &["--repeat", "2", "--json", "--quiet"])).fine().json();
    require_rows(
        &row,
        &[
            ("schema", "count"),
            ("bench", "text"),
            ("variant", "text"),
            ("commit", "text"),
            ("scene.name", "text"),
            ("scene.hash", "hash"),
            ("technique", "text"),
            ("asked.*", "text"),
            ("settings.*", "text or number"),
            ("group", "text"),
            ("memory.planned_bytes", "count"),
            ("memory.allocated_bytes", "count"),
            ("memory.aliased_bytes", "count"),
            ("memory.peak_bytes", "count"),
            ("memory.peak_pass", "text"),
            ("memory.groups.*", "count"),
            ("repeat", "count"),
            ("command[]", "text"),
            ("image_hash", "hash"),
            ("pass_ms.*", "number"),
            ("bytes_written", "count"),
            ("planned_bytes", "count"),
            ("counters.*", "number"),
        ],
    );
    require_rows(&row["device"], DEVICE);
    require_rows(&row["frame_ms"], &SPREAD);
}

#[test]
fn devices_say_what_each_technique_can_do() {
    let program = Program::new();
    let document = program.run(&["devices", "--json"]).fine().json();
    require_rows(&document, &[("schema", "count"), ("devices[].caps.limits.max_image_side_px", "count")]);
    let text = program.run(&["devices"]).fine().out;
    for device in document["devices"].as_array().unwrap() {
        require_rows(&device["caps"]["identity"], DEVICE);
        let techniques = device["techniques"].as_array().unwrap();
        let is_usable = device["missing"].as_array().unwrap().is_empty();
        assert_eq!(techniques.len(), if is_usable { quincunx::techniques::ALL.len() } else { 0 }, "{device:#}");
        for technique in techniques {
            require_rows(
                technique,
                &[("name", "text"), ("runs", "flag"), ("bounds[].of", "text"), ("bounds[].most", "text")],
            );
            assert_eq!(technique["runs"], technique["stopped_by"].as_array().unwrap().is_empty());
            for need in ["stopped_by", "left_out"].iter().flat_map(|key| technique[*key].as_array().unwrap()) {
                require_rows(need, &[("of", "text"), ("needs", "text"), ("instead", "text")]);
                assert!(text.contains(need["of"].as_str().unwrap()), "{text}");
            }
            assert!(text.contains(technique["name"].as_str().unwrap()), "{text}");
        }
    }
}
