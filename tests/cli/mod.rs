//! The program from outside: exit codes, what it says, and which files it leaves.

mod compare;
mod sampling;
mod scene_verbs;

use crate::support::program::Program;
use quincunx::techniques::Technique;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// A picture that costs next to nothing.
const SMALL: [&str; 6] = ["render", "cornell", "--size", "32x18", "--vpls", "16"];

fn small<'a>(more: &[&'a str]) -> Vec<&'a str> {
    SMALL.iter().chain(more).copied().collect()
}

#[test]
fn a_scene_that_cannot_be_read_is_a_bad_request() {
    let program = Program::new();
    program.fails(&["render", "missing.glb"], 2, &["missing.glb"]);
    std::fs::write(program.path("text.glb"), "this is no glTF").unwrap();
    program.fails(&["render", "text.glb"], 2, &["text.glb"]);
    std::fs::write(program.path("empty.gltf"), "").unwrap();
    program.fails(&["render", "empty.gltf"], 2, &["empty.gltf"]);
    program.fails(&["render", "nowhere"], 2, &["nowhere", "cornell, hall, lamps"]);
    program.fails(&["render", "lamps:lights=5001"], 2, &["lights=5001", "0 to 5000"]);
    program.fails(&["render", "cornell:size=3"], 2, &["cornell"]);
}

#[test]
fn an_impossible_setting_is_a_bad_request_and_says_what_is_possible() {
    let program = Program::new();
    program.fails(
        &small(&["--pattern", "0x6"]),
        2,
        &["interleaved_deferred", "--pattern 0x6", "1 to 64", "Segovia 2006"],
    );
    program.fails(&small(&["--pattern", "65x1"]), 2, &["1 to 64"]);
    program.fails(&small(&["--kernel", "6"]), 2, &["--kernel 6", "odd", "5 to 17"]);
    program.fails(&small(&["--kernel", "19"]), 2, &["--kernel 19", "5 to 17"]);
    program.fails(&small(&["--block", "0"]), 2, &["--block 0", "N or NxM", "1 to 1024"]);
    program.fails(&small(&["--block", "16x1025"]), 2, &["--block 16x1025", "1 to 1024"]);
    program.fails(&small(&["--fragment-passes", "3"]), 2, &["--fragment-passes 3", "1 to 2"]);
    program.fails(
        &small(&["--split", "fragment", "--storage", "buffer"]),
        2,
        &["--storage buffer", "draw into images"],
    );
    program.fails(&small(&["--split", "tile", "--copy", "push"]), 2, &["--split tile with --copy push", "--copy pull"]);
    program.fails(&small(&["--direct-pattern", "2"]), 2, &["--direct-pattern 2", "auto or NxM", "1 to 64"]);
    program.fails(
        &small(&["--direct", "interleaved", "--direct-pattern", "4x3"]),
        2,
        &["--direct-pattern 4x3 with --pattern 4x4", "I of 1, 2, 4 and J of 1, 2, 4"],
    );
    program.fails(&small(&["--split", "twice"]), 2, &["--split twice", "one-pass"]);
    program.fails(&["render", "cornell", "--size", "0x18"], 2, &["--size 0x18", "1 to 16384"]);
    program.fails(&small(&["--camera", "door"]), 2, &["--camera door", "cornell"]);
    let few = ["render", "cornell", "--size", "32x18", "--vpls", "8", "--pattern", "4x4"];
    program.fails(&few, 2, &["8 lights for the 16 subsets", "--vpls 16 or more"]);
    program.fails(
        &["render", "cornell", "--technique", "forwards"],
        2,
        &["forwards", "interleaved_deferred", "deferred"],
    );
    let unread = ["render", "cornell", "--technique", "deferred", "--pattern", "4x4"];
    program.fails(&unread, 2, &["deferred does not read --pattern"]);
    program.fails(&small(&["--patern", "4x4"]), 2, &["--patern"]);
    program.fails(&small(&["--aov", "split.colour"]), 2, &["split.colour", "split.normal"]);
    program.fails(&small(&["--split", "none", "--aov", "split.normal"]), 2, &["--aov split.normal", "one-pass"]);
    let no_filter = [
        "--filter none",
        "it has gbuffer.normal, gbuffer.color, gbuffer.color.id, split.normal, shade.irradiance, gather.irradiance",
    ];
    program.fails(&small(&["--filter", "none", "--aov", "filter.irradiance"]), 2, &no_filter);
    program.fails(&small(&["--split", "none", "--aov", "filter.irradiance"]), 2, &["with --split none all lights"]);
    let plan = ["memory", "cornell", "--plan", "--technique", "forward", "--aov", "depth.reversed"];
    program.run(&plan).fine();
    program.fails(&[&plan[..], &["--msaa", "4"]].concat(), 2, &["--msaa 4", "--msaa 1", "it has none"]);
    let stageless = ["memory", "cornell", "--plan", "--technique", "path_traced", "--aov", "color"];
    program.fails(&stageless, 2, &["--aov color: path_traced has no such stage", "it has none"]);
    program.fails(&small(&["--rig", "none", "--lights", "many"]), 2, &["--lights many"]);
}

#[test]
fn a_report_says_what_storage_and_block_came_to() {
    let program = Program::new();
    let report = |more: &[&str]| program.run(&small(&[&["--json", "-o", "a.png"], more].concat())).fine().json();
    let default = report(&[]);
    let storage = if default["device"]["type"] == "cpu" { "buffer" } else { "image" };
    assert_eq!(default["settings"]["storage"], storage);
    let blocks = report(&["--split", "two-pass", "--pattern", "3x5", "--storage", "image"]);
    assert_eq!((&blocks["settings"]["block"], &blocks["settings"]["storage"]), (&"18x20".into(), &"image".into()));
    let flat = report(&["--split", "tile", "--pattern", "2x2", "--block", "32x5"]);
    assert_eq!(flat["settings"]["block"], "32x6");
    let fragment = report(&["--split", "fragment"]);
    assert_eq!(fragment["settings"]["storage"], "image");
    let names: Vec<&str> =
        fragment["passes"].as_array().unwrap().iter().map(|pass| pass["name"].as_str().unwrap()).collect();
    for pass in ["split.blocks", "split.translate", "shade", "gather.translate", "gather.blocks"] {
        assert!(names.contains(&format!("interleaved_deferred.{pass}").as_str()), "{names:?} has no {pass}");
    }
}

#[test]
fn a_report_says_what_the_direct_pattern_came_to() {
    let program = Program::new();
    let report = |more: &[&str]| {
        let lamps = ["render", "lamps:objects=10,lights=24", "--size", "32x18", "--vpls", "96"];
        let joined = ["--direct", "interleaved", "--json", "-o", "a.png"];
        program.run(&[&lamps[..], &joined, more].concat()).fine().json()
    };
    for (more, direct_pattern, vpls, lights) in [
        (&["--pattern", "8x6"][..], "8x6", 2.0, 48.0),
        (&["--pattern", "8x6", "--direct-pattern", "4x3"], "4x3", 2.0, 12.0),
        (&["--pattern", "8x6", "--direct-pattern", "1x1"], "1x1", 2.0, 1.0),
        (&["--split", "none"], "1x1", 96.0, 1.0),
        (&["--pattern", "8x6", "--split", "subsample"], "1x1", 96.0, 1.0),
    ] {
        let report = report(more);
        assert_eq!(report["settings"]["direct-pattern"], direct_pattern, "{more:?}");
        let counter = |name: &str| report["counters"][name].as_f64().unwrap();
        assert_eq!(counter("vpls"), 96.0);
        assert_eq!(counter("subset_lights_per_pixel"), vpls + counter("lights") / lights, "{more:?}");
    }
}

#[test]
fn a_budget_that_is_spent_says_what_would_help() {
    let program = Program::new();
    let budget = |text: &'static str| small(&["--memory-budget", text]);
    program.fails(&budget("64MB"), 2, &["--memory-budget 64MB", "512MiB, 2GiB", "or none"]);
    program.fails(&budget("0"), 2, &["--memory-budget 0", "the default is --memory-budget none"]);
    program.fails(&small(&["--texture-limit", "16385"]), 2, &["--texture-limit 16385", "0 to 16384"]);
    program.fails(&budget("4KiB"), 4, &["allocating scene.", "the budget of 4.00 KiB is "]);
    let frame = ["render", "cornell", "--size", "640x360", "--vpls", "16", "--memory-budget", "8MiB"];
    let help = "a smaller --size would need less; `memory --technique interleaved_deferred` prints the plan";
    program.fails(&frame, 4, &["allocating interleaved_deferred.", "the budget of 8.00 MiB is spent", help]);
    let textured = ["render", "hall:triangles=8000", "--size", "64x36", "--memory-budget", "30MiB"];
    program.fails(
        &[&textured[..], &["--texture-limit", "0"]].concat(),
        4,
        &["allocating scene.textures.", "most of it by scene.textures (", "--texture-limit 256"],
    );
    // What fits is found where nothing is asked for.
    let found = program.run(&[&textured[..], &["--technique", "deferred", "--json"]].concat()).fine().json();
    let limit_px = found["settings"]["texture-limit"].as_u64().unwrap();
    assert!(limit_px.is_power_of_two() && limit_px <= 256, "{limit_px}");
    let plan = ["memory", textured[1], "--size", "64x36", "--plan", "--memory-budget", "30MiB", "--json"];
    let planned = program.run(&plan).fine().json();
    assert!(planned["techniques"][0]["memory"]["groups"]["scene.textures"].as_u64().unwrap() < 23 << 20, "{planned}");
    let limited = textured.iter().copied().chain(["--technique", "deferred", "--texture-limit", "256", "--json"]);
    let report = program.run(&limited.collect::<Vec<_>>()).fine().json();
    assert_eq!(
        (&report["settings"]["texture-limit"], &report["settings"]["memory-budget"]),
        (&256.into(), &"30MiB".into())
    );
    assert!(report["memory"]["memory_block_bytes"].as_u64().unwrap() <= 30 << 20);
    assert_eq!(report["memory"]["planned_bytes"], sum_of(&report, "bytes"));
    assert_eq!(report["memory"]["allocated_bytes"], sum_of(&report, "bound_bytes"));
}

/// Over the resources of a report.
fn sum_of(report: &Value, key: &str) -> u64 {
    report["memory"]["resources"].as_array().unwrap().iter().map(|one| one[key].as_u64().unwrap()).sum()
}

#[test]
fn every_allocation_gives_the_same_picture_and_says_how_its_memory_blocks_are_filled() {
    let program = Program::new();
    let reports = ["linear", "dedicated", "tlsf", "buddy"]
        .map(|strategy| program.run(&small(&["--allocation", strategy, "--json", "-o", "a.png"])).fine().json());
    for report in &reports {
        assert_eq!(report["image"]["hash"], reports[0]["image"]["hash"]);
        let blocks = report["memory"]["memory_blocks"].as_array().unwrap();
        let sum = |key: &str| -> u64 { blocks.iter().map(|block| block[key].as_u64().unwrap()).sum() };
        assert_eq!(report["memory"]["memory_block_bytes"], sum("bytes"));
        let [allocated, aliased] =
            ["allocated_bytes", "aliased_bytes"].map(|key| report["memory"][key].as_u64().unwrap());
        assert!(aliased > 0);
        assert_eq!(allocated - aliased, sum("used_bytes"));
        assert!(blocks.iter().all(|block| block["fragmentation"].is_number()), "{blocks:?}");
    }
}

#[test]
fn an_output_that_cannot_be_written_is_a_bad_request_and_nothing_half_written_stays() {
    let program = Program::new();
    program.fails(&small(&["-o", "no/such/folder/a.png"]), 2, &["no/such/folder"]);
    program.fails(&small(&["--report", "no/such/folder/a.json"]), 2, &["no/such/folder"]);
    program.fails(&small(&["-o", "a.jpg"]), 2, &["a.jpg", ".png or .exr"]);
    program.fails(&small(&["-o", "noextension"]), 2, &["noextension"]);
    std::fs::create_dir(program.path("folder.png")).unwrap();
    program.fails(&small(&["-o", "folder.png"]), 2, &["folder.png"]);
    std::fs::create_dir(program.path("folder.json")).unwrap();
    let ran = program.run(&small(&["-o", "a.png", "--report", "folder.json"]));
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("folder.json"), "{}", ran.err);
    // /proc takes no files from anybody, root included.
    if Path::new("/proc/self").is_dir() {
        program.fails(&small(&["-o", "/proc/a.png"]), 2, &["/proc/a.png"]);
    }
}

#[test]
fn without_a_driver_or_a_fitting_device_it_says_so() {
    let program = Program::new();
    let nowhere = [("VK_DRIVER_FILES", "/nonexistent"), ("VK_ICD_FILENAMES", "/nonexistent")];
    for command in [&SMALL[..], &["devices"], &["devices", "--json"]] {
        let ran = program.run_with(command, &nowhere);
        assert_eq!(ran.code, 3, "{command:?}: {}", ran.err);
        assert!(ran.err.starts_with("error: ") && ran.err.contains("VK_DRIVER_FILES"), "{}", ran.err);
        assert_eq!(ran.out, "", "{command:?}");
    }
    assert_eq!(program.files(), [] as [&str; 0]);
    // What is there is listed.
    let words = ["--device abacus: no device's name or driver contains 'abacus'", "there are:", "\n       0: "];
    for verb in [&SMALL[..], &["bench", "rays", "cornell"], &["memory", "cornell", "--size", "32x18"]] {
        program.fails(&[verb, &["--device", "abacus"]].concat(), 3, &words);
    }
    program.fails(&small(&["--device", "99"]), 3, &["--device 99: no device has this index", "\n       0: "]);
}

#[test]
fn json_is_one_document_with_the_keys_of_the_design() {
    let program = Program::new();
    let ran = program.run(&small(&["--json", "--aov", "split.normal,filter.irradiance", "-o", "a.exr"])).fine();
    let report = ran.json();
    for key in [
        "schema",
        "quincunx",
        "command",
        "device",
        "scene",
        "technique",
        "settings",
        "image",
        "aovs",
        "passes",
        "total_ms",
        "memory",
        "counters",
    ] {
        assert!(!report[key].is_null(), "there is no {key}: {report:#}");
    }
    for (object, keys) in [
        ("quincunx", &["version", "commit"][..]),
        ("device", &["name", "type", "driver", "driver_info", "api"]),
        ("scene", &["name", "hash", "triangles", "draws", "lights", "materials"]),
        ("image", &["width", "height", "mean", "hash", "path"]),
        ("memory", &["planned_bytes", "allocated_bytes", "memory_block_bytes", "peak_bytes", "groups", "resources"]),
        ("total_ms", &["median", "min", "max", "samples"]),
    ] {
        for key in keys {
            assert!(!report[object][key].is_null(), "{object} has no {key}: {}", report[object]);
        }
    }
    assert_eq!(report["schema"], 1);
    assert_eq!(report["technique"], "interleaved_deferred");
    assert_eq!((&report["image"]["width"], &report["image"]["height"]), (&32.into(), &18.into()));
    assert_eq!(report["settings"]["pattern"], "4x4");
    assert_eq!(report["settings"]["vpls"], 16);
    assert_eq!(report["scene"]["triangles"], 38);
    let names: Vec<&str> = report["aovs"].as_array().unwrap().iter().map(|aov| aov["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["split.normal", "filter.irradiance"]);
    let command: Vec<&str> = report["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
    assert_eq!(command[1..5], ["render", "cornell", "--size", "32x18"]);
    for resource in report["memory"]["resources"].as_array().unwrap() {
        for key in ["name", "group", "bytes", "bound_bytes", "memory_block", "offset"] {
            assert!(!resource[key].is_null(), "a resource has no {key}: {resource}");
        }
    }
    let passes = |report: &Value| -> Vec<String> {
        report["passes"].as_array().unwrap().iter().map(|pass| pass["name"].as_str().unwrap().to_owned()).collect()
    };
    let expected = ["bvh", "vpls", "gbuffer", "split", "shade", "gather", "discontinuity", "filter", "composite"];
    assert_eq!(passes(&report), expected.map(|pass| format!("interleaved_deferred.{pass}")));
    // The same document as a file, with the times of each pass.
    let ran = program.run(&small(&["--profile", "--quiet", "-o", "b.png", "--report", "b.json"])).fine();
    assert_eq!(ran.out, "");
    let profile: Value = serde_json::from_str(&std::fs::read_to_string(program.path("b.json")).unwrap()).unwrap();
    assert_eq!(passes(&profile), passes(&report));
    assert!(profile["passes"].as_array().unwrap().iter().all(|pass| pass["ms"]["median"].is_number()), "{profile:#}");
    assert_eq!(profile["image"]["hash"], report["image"]["hash"]);
}

#[test]
fn the_same_command_gives_the_same_hash_and_the_same_file() {
    let program = Program::new();
    let run = |file: &str| program.run(&small(&["--json", "-o", file])).fine().json()["image"]["hash"].clone();
    assert_eq!(run("a.png"), run("b.png"));
    let read = |file: &str| std::fs::read(program.path(file)).unwrap();
    assert!(read("a.png") == read("b.png"), "the files differ");
    let other = program.run(&small(&["--json", "--seed", "2", "-o", "c.png"])).fine().json()["image"]["hash"].clone();
    assert_ne!(run("a.png"), other, "a seed changes the virtual point lights");
}

#[test]
fn without_o_the_picture_goes_into_the_current_folder() {
    let program = Program::new();
    let ran = program.run(&SMALL).fine();
    assert!(ran.out.contains("wrote cornell-interleaved_deferred.png"), "{}", ran.out);
    program
        .run(&["render", "lamps:objects=3,lights=2", "--technique", "deferred", "--size", "32x18", "--quiet"])
        .fine();
    assert_eq!(program.files(), ["cornell-interleaved_deferred.png", "lamps-deferred.png"]);
}

#[test]
fn stages_go_into_layers_of_an_exr_and_beside_a_png() {
    let program = Program::new();
    let stages = "gbuffer.normal,gbuffer.color,shade.irradiance,gather.irradiance,discontinuity.flags";
    program.run(&small(&["--quiet", "--aov", stages, "-o", "a.exr"])).fine();
    assert_eq!(program.files(), ["a.exr"]);
    program.run(&small(&["--quiet", "--aov", "gbuffer.normal,discontinuity.flags", "-o", "b.png"])).fine();
    assert_eq!(program.files(), ["a.exr", "b.discontinuity.flags.png", "b.gbuffer.normal.png", "b.png"]);
    for stage in ["gather.irradiance", "filter.irradiance"] {
        let fused = small(&["--quiet", "--fuse", "on", "--aov", stage, "-o", "c.exr"]);
        program.fails(&fused, 2, &[stage, "--fuse off"]);
    }
    // An EXR holds what was rendered; a PNG of it is the same to half a code.
    program.run(&["compare", "b.png", "a.exr", "--min", "psnr=inf"]).fine();
}

#[test]
fn validate_has_nothing_to_say() {
    let program = Program::new();
    for more in [&[][..], &["--split", "none"], &["--filter", "gauss-fast", "--cull", "tiled"], &["--profile"]] {
        let mut arguments = small(&["--validate", "--quiet"]);
        arguments.extend(more);
        // Messages at closing, such as a leaked object, fail the command too.
        assert_eq!(program.run(&arguments).fine().out, "");
    }
    let deferred =
        ["render", "lamps:objects=3,lights=3", "--technique", "deferred", "--size", "33x17", "--validate", "--quiet"];
    assert_eq!(program.run(&deferred).fine().out, "");
}

#[test]
fn a_failed_gate_exits_with_1_and_prints_all_the_same() {
    let program = Program::new();
    program.run(&small(&["--quiet", "-o", "a.exr"])).fine();
    program.run(&small(&["--quiet", "-o", "b.exr", "--seed", "2"])).fine();
    program.run(&["compare", "a.exr", "a.exr", "--max", "rmse=0"]).fine();
    let ran = program.run(&["compare", "a.exr", "b.exr", "--max", "rmse=0", "--json"]);
    assert_eq!(ran.code, 1);
    assert_eq!(ran.json()["gates"][0]["passed"], false);
    assert!(ran.err.starts_with("error: comparing a.exr with b.exr: rmse is "), "{}", ran.err);
    program.fails(&["compare", "a.exr", "missing.exr"], 2, &["missing.exr"]);
}

#[test]
fn devices_and_scenes_are_listed() {
    let program = Program::new();
    let document = program.run(&["devices", "--json"]).fine().json();
    let devices = document["devices"].as_array().unwrap();
    assert!(!devices.is_empty());
    for device in devices {
        assert!(device["caps"]["identity"]["name"].is_string(), "{device:#}");
        assert!(device["missing"].is_array(), "{device:#}");
    }
    assert!(program.run(&["devices"]).fine().out.starts_with("0: "));
    let scenes = program.run(&["scene", "list"]).fine().out;
    for name in ["cornell", "hall", "lamps", "hall:triangles=N", "fence:alpha=WORD"] {
        assert!(scenes.contains(name), "{scenes}");
    }
    assert_eq!(program.files(), [] as [&str; 0]);
}

/// Flags of the settings that a help lists.
fn listed(help: &str) -> BTreeSet<&str> {
    let flags = help.lines().filter_map(|line| line.trim_start().strip_prefix("--")?.split(' ').next());
    let all: BTreeSet<&str> = quincunx::techniques::ALL.iter().flat_map(|technique| keys_of(*technique)).collect();
    flags.filter(|flag| all.contains(flag)).collect()
}

/// A help without its line breaks.
fn words(help: &str) -> String {
    help.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn keys_of(technique: &dyn Technique) -> BTreeSet<&'static str> {
    quincunx::techniques::settings_of(technique).iter().map(|setting| setting.key).collect()
}

#[test]
fn help_lists_the_settings_of_one_technique_and_all_where_it_is_asked_to() {
    let program = Program::new();
    let help = |arguments: &[&str]| {
        let out = program.run(arguments).fine().out;
        assert!(!out.contains('\u{1b}'), "{arguments:?}: a pipe has no colours");
        out
    };
    let all: BTreeSet<&str> = quincunx::techniques::ALL.iter().flat_map(|technique| keys_of(*technique)).collect();
    for verb in [&["render"][..], &["memory"], &["bench", "frame"]] {
        for flag in ["--help", "-h"] {
            let plain = help(&[verb, &[flag]].concat());
            let default = quincunx::techniques::find("interleaved_deferred").unwrap();
            assert_eq!(listed(&plain), keys_of(default), "{verb:?}");
            assert!(words(&plain).contains("--technique all --help"), "{plain}");
            assert_eq!(listed(&help(&[verb, &[flag, "--technique", "all"]].concat())), all, "{verb:?}");
            assert_eq!(listed(&help(&[verb, &["--technique", "all", flag]].concat())), all, "{verb:?}");
        }
    }
    for technique in quincunx::techniques::ALL {
        let name = technique.name();
        let own = help(&["render", "--technique", name, "--help"]);
        assert_eq!(listed(&own), keys_of(*technique), "{name}");
        assert!(own.contains(&format!("Settings of {name}:")), "{own}");
        // With the technique's own choices, and no other's.
        for setting in quincunx::techniques::settings_of(*technique) {
            let default = format!("[{}] [default: {}]", setting.range(), setting.default);
            assert!(words(&own).contains(&default), "--{}: {default}", setting.key);
        }
    }
    let two = ["memory", "--technique", "forward", "--technique=deferred", "--help"];
    let keys = |name: &str| keys_of(quincunx::techniques::find(name).unwrap());
    assert_eq!(listed(&help(&two)), keys("forward").union(&keys("deferred")).copied().collect());
    assert!(listed(&help(&["help", "render"])).contains("pattern"));
    program.fails(&small(&["--technique", "all"]), 2, &["--technique all", "interleaved_deferred"]);
    let ran = program.run(&[]);
    assert_eq!((ran.code, ran.out.as_str()), (2, ""));
    assert!(program.run(&["--version"]).fine().out.starts_with("quincunx "));
}

#[test]
fn quiet_verbs_say_nothing_but_what_json_asks_for() {
    let program = Program::new();
    program.run(&small(&["--quiet", "-o", "a.png"])).fine();
    for verb in [
        &["devices"][..],
        &["compare", "a.png", "a.png"],
        &["memory", "cornell", "--plan"],
        &["memory", "cornell", "--size", "32x18"],
        &["scene", "list"],
        &["scene", "inspect", "cornell"],
        &["scene", "export", "cornell", "-o", "a.glb"],
    ] {
        assert_eq!(program.run(&[verb, &["--quiet"]].concat()).fine().out, "", "{verb:?}");
        assert_ne!(program.run(verb).fine().out, "", "{verb:?}");
    }
    for verb in [&["devices"][..], &["compare", "a.png", "a.png"], &["scene", "inspect", "cornell"]] {
        program.run(&[verb, &["--json", "--quiet"]].concat()).fine().json();
    }
    let failed = program.run(&["compare", "a.png", "a.png", "--max", "psnr=1", "--quiet"]);
    assert!(failed.code == 1 && failed.out.is_empty() && failed.err.starts_with("error: "), "{}", failed.err);
}

#[test]
fn memory_is_planned_without_any_driver() {
    let program = Program::new();
    let plan = ["memory", "cornell", "--size", "64x32", "--vpls", "32", "--plan"];
    let nowhere = [("VK_DRIVER_FILES", "/nowhere.json"), ("VK_ICD_FILENAMES", "/nowhere.json")];
    let ran = program.run_with(&[&plan[..], &["--json"]].concat(), &nowhere).fine();
    let study = &ran.json()["techniques"][0];
    assert_eq!(
        (study["technique"].as_str(), study["device"].as_str()),
        (Some("interleaved_deferred"), Some("lavapipe-22.3.6"))
    );
    let rows = study["memory"]["resources"].as_array().unwrap();
    let normal = rows.iter().find(|row| row["name"] == "interleaved_deferred.split.normal").unwrap();
    assert_eq!((normal["bytes"].as_u64(), normal["bound_bytes"].as_u64()), (Some(64 * 32 * 8), Some(64 * 32 * 8)));
    assert_eq!(
        (&normal["first_pass"], &normal["last_pass"]),
        (&"interleaved_deferred.split".into(), &"interleaved_deferred.shade".into())
    );
    let both = ["--technique", "deferred", "--technique", "interleaved_deferred", "-o", "out"];
    let ran = program.run_with(&[&plan[..], &both].concat(), &nowhere).fine();
    assert!(ran.out.contains("deferred: cornell on lavapipe-22.3.6") && ran.out.contains(" planned, "), "{}", ran.out);
    for file in ["memory-deferred.txt", "memory-deferred.json", "memory-interleaved_deferred.txt"] {
        assert!(Path::new(&program.path(&format!("out/{file}"))).exists(), "{file}");
    }
    program.fails(&[&plan[..], &["--caps", "voodoo"]].concat(), 2, &["voodoo", "lavapipe-22.3.6"]);
    program.fails(&[&plan[..], &["--technique", "deferred"]].concat(), 2, &["--vpls"]);
    program.fails(&[&plan[..], &["--pattern", "8x8"]].concat(), 2, &["32 lights for the 64 subsets"]);
}
