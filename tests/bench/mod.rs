//! `bench` from outside: rows with their keys, what is skipped, what is resumed. Never how long anything takes.

mod allocate;
mod device;
mod file;
mod frames;
#[cfg(target_os = "linux")]
mod killed;
mod page;
mod rates;
mod rays;
mod rows;
mod shards;
mod stages;

use crate::support::benched::{bench, lines, read};
use crate::support::program::{Program, quincunx};
use serde_json::Value;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn variants(rows: &[Value]) -> Vec<&str> {
    rows.iter().map(|row| row["variant"].as_str().unwrap()).collect()
}

#[track_caller]
fn has_ratio(entry: &Value) {
    assert!(entry["mean"].as_f64().unwrap() > 0.0 && entry["pairs"] == 3, "{entry}");
    assert_eq!(entry["interval_95"].as_array().unwrap().len(), 2, "{entry}");
}

#[test]
fn each_benchmark_has_the_documented_keys() {
    let program = Program::new();
    for (what, axis, own) in [
        ("frame", "split=none,one-pass", &["frame_ms", "evaluation_ns", "overhead_evaluations_per_pixel"][..]),
        ("split", "pattern=2x2,4x4", &["stage_ms", "identity", "copy", "copied_bytes", "copied_gb_per_s"]),
        ("shade", "split=one-pass,branch", &["stage_ms", "ns_per_evaluation"]),
        ("gather", "pattern=2x2,4x4", &["stage_ms", "identity", "copy", "copied_bytes", "copied_gb_per_s"]),
        ("filter", "filter=gauss,gauss-fast", &["stage_ms", "ns_per_pixel", "ns_per_tap"]),
    ] {
        let ran = program.run(&bench(what, &["--sweep", axis, "--json", "--quiet", "--validate"])).fine();
        let rows = lines(&ran.out);
        assert_eq!(rows.len(), 2, "{what}");
        for row in &rows {
            let common = [
                "schema",
                "bench",
                "variant",
                "device",
                "commit",
                "scene",
                "technique",
                "asked",
                "settings",
                "group",
                "repeat",
                "baseline",
                "command",
                "image_hash",
                "pass_ms",
                "speed_up",
                "ratio",
                "bytes_written",
                "planned_bytes",
                "memory",
                "counters",
                "error_against_none",
            ];
            for key in common.iter().chain(own) {
                assert!(!row[*key].is_null(), "{what} has no {key}: {row:#}");
            }
            assert_eq!(row["bench"], what);
            // Nobody knows of the textures that a G-buffer reads without counting.
            assert_eq!(row["bytes_read"].is_null(), what == "frame", "{row:#}");
            assert_eq!(row["baseline"], rows[0]["variant"]);
            has_ratio(&row["ratio"]);
            has_ratio(&row["speed_up"]);
            let times = &row[if what == "frame" { "frame_ms" } else { "stage_ms" }];
            assert_eq!(times["samples"].as_array().unwrap().len(), 3, "{times}");
            for metric in ["rmse", "relmse", "ssim", "flip"] {
                assert!(row["error_against_none"][metric].is_f64(), "{row:#}");
            }
        }
        assert_eq!(rows[0]["ratio"]["mean"], 1.0, "the baseline is itself");
        assert_ne!(rows[0]["image_hash"], Value::Null);
    }
    assert_eq!(program.files(), [] as [&str; 0]);
}

#[test]
fn a_copy_is_held_against_its_identity_and_a_plain_copy_of_as_many_bytes() {
    let program = Program::new();
    // 64x48 divides by both: no padding. A position of 16-bit fractions and a normal take 8 bytes each.
    let splits = lines(&program.run(&bench("split", &["--sweep", "pattern=1x1,4x4", "--json", "--quiet"])).fine().out);
    for row in &splits {
        assert_eq!(row["copied_bytes"], 64 * 48 * 16, "{row:#}");
        assert_eq!((&row["bytes_read"], &row["bytes_written"]), (&row["copied_bytes"], &row["copied_bytes"]));
        let passes: Vec<&String> = row["pass_ms"].as_object().unwrap().keys().collect();
        assert_eq!(passes, ["interleaved_deferred.split"]);
        has_ratio(&row["identity"]);
        has_ratio(&row["copy"]);
    }
    // Both patterns share one identity.
    assert_eq!(splits[0]["identity"]["ms"], splits[1]["identity"]["ms"]);
    let gathers = lines(&program.run(&bench("gather", &["--json", "--quiet"])).fine().out);
    assert_eq!(gathers[0]["variant"], "defaults");
}

#[test]
fn the_impossible_is_skipped_with_its_reason() {
    let program = Program::new();
    let axes = ["--sweep", "split=branch,one-pass", "--sweep", "pattern=0x3,2x2,8x8", "--json", "--quiet"];
    let rows = lines(&program.run(&bench("split", &axes)).fine().out);
    let skipped = |variant: &str| {
        let row = rows.iter().find(|row| row["variant"] == variant).unwrap_or_else(|| panic!("no {variant}"));
        row["skipped"].as_str().unwrap_or_default().to_owned()
    };
    assert_eq!(rows.len(), 6);
    assert_eq!(skipped("split=branch pattern=2x2"), "--split branch makes no copy");
    assert!(skipped("split=one-pass pattern=0x3").contains("--pattern 0x3"));
    // 64 subsets and 16 lights.
    assert!(skipped("split=one-pass pattern=8x8").contains("16 lights for the 64 subsets"));
    assert_eq!(skipped("split=one-pass pattern=2x2"), "");
    assert!(rows.iter().all(|row| row["baseline"] == "split=one-pass pattern=2x2"));

    let filters = ["--sweep", "filter=none,gauss", "--sweep", "pattern=1x1,2x2", "--json", "--quiet"];
    let rows = lines(&program.run(&bench("filter", &filters)).fine().out);
    let reasons: Vec<&str> = rows.iter().filter_map(|row| row["skipped"].as_str()).collect();
    assert_eq!(reasons.len(), 3);
    assert!(reasons.contains(&"--filter none filters nothing"), "{reasons:?}");
    assert!(reasons.contains(&"--split one-pass --pattern 1x1 is not interleaved: nothing is filtered"), "{reasons:?}");

    // What this device cannot hold: not even alone.
    let rows = lines(
        &program.run(&bench("frame", &["--sweep", "size=48x32,16384x16384,32x32", "--json", "--quiet"])).fine().out,
    );
    assert_eq!(rows.len(), 3);
    for row in &rows {
        assert_eq!(row["skipped"].is_string(), row["variant"] == "size=16384x16384", "{row:#}");
        // Each size has its own reference.
        assert_eq!(row["error_against_none"]["rmse"].is_f64(), row["skipped"].is_null(), "{row:#}");
    }

    // A technique without subsets has no reference, and says so.
    let deferred = ["bench", "frame", "lamps:objects=3,lights=3", "--size", "33x17", "--technique", "deferred"];
    let rows = lines(&program.run(&[&deferred[..], &["--json", "--quiet"]].concat()).fine().out);
    assert!(rows[0]["reference_skipped"].as_str().unwrap().contains("--split"), "{:#}", rows[0]);

    // What is settled with the device or the scene is not swept.
    let rows =
        lines(&program.run(&bench("frame", &["--sweep", "allocation=linear,dedicated", "--json", "--quiet"])).out);
    assert!(rows.iter().any(|row| row["skipped"].as_str().is_some_and(|why| why.contains("when the device opens"))));
}

#[test]
fn a_bad_request_measures_nothing() {
    let program = Program::new();
    program.fails(&bench("split", &["--split", "branch"]), 2, &["--split branch makes no copy"]);
    program.fails(
        &bench("split", &["--sweep", "split=none,branch"]),
        2,
        &["none of the 2", "split=none: --split none"],
    );
    for stage in ["gather", "filter"] {
        program.fails(&bench(stage, &["--fuse", "on"]), 2, &["--fuse on", &format!("of the {stage} alone")]);
    }
    program.fails(&bench("gather", &["--technique", "deferred"]), 2, &["--vpls"]);
    let deferred = ["bench", "gather", "lamps:objects=3,lights=3", "--size", "33x17", "--technique", "deferred"];
    program.fails(&deferred, 2, &["deferred has no stage gather", "gbuffer, cull, shade, and frame"]);
    let sweep = ["--sweep", "pattern=2x2,0x1"];
    for (baseline, word) in
        [("pattern=4x4", "no such combination"), ("pattern=0x1", "--pattern 0x1"), ("4x4", "KEY=VALUE")]
    {
        program.fails(&bench("frame", &[&sweep[..], &["--baseline", baseline]].concat()), 2, &["--baseline", word]);
    }
    program.fails(&bench("frame", &["--sweep", "pattern=2x2,2x2"]), 2, &["there twice"]);
    program.fails(&bench("frame", &["--device", "no such device"]), 3, &["no such device"]);
    // What clap refuses.
    assert_eq!(program.run(&bench("frame", &["--resume"])).code, 2);
    assert_eq!(program.run(&bench("frame", &["-o", "out", "--resume", "--force"])).code, 2);
    assert_eq!(program.run(&["bench", "everything"]).code, 2);
    assert_eq!(program.files(), [] as [&str; 0]);
}

#[test]
fn the_baseline_is_the_named_one() {
    let program = Program::new();
    let ran = program
        .run(&bench("shade", &["--sweep", "pattern=1x1,2x2,4x4", "--baseline", "pattern=4x4", "--quiet", "--json"]));
    let rows = lines(&ran.fine().out);
    assert_eq!(rows.len(), 3);
    for row in &rows {
        assert_eq!(row["baseline"], "pattern=4x4");
        assert_eq!(row["ratio"]["mean"] == 1.0, row["variant"] == "pattern=4x4", "{row:#}");
    }
}

/// Each row's ratio is to the row that has its value of the axis that --baseline leaves out: to the second of each pair.
#[test]
fn a_baseline_that_leaves_an_axis_out_is_one_for_each_point_of_it() {
    let program = Program::new();
    let sweep = ["--sweep", "vpls=4,8", "--sweep", "pattern=1x1,2x2", "--baseline", "pattern=2x2", "-o", "out"];
    let first = program.run(&bench("shade", &[&sweep[..], &["--json", "--quiet"]].concat()));
    let rows = lines(&first.fine().out);
    assert_eq!(rows.len(), 4);
    for row in &rows {
        let vpls = row["settings"]["vpls"].as_u64().unwrap();
        assert_eq!(row["baseline"], format!("vpls={vpls} pattern=2x2"));
        assert_eq!(row["ratio"]["mean"] == 1.0, row["settings"]["pattern"] == "2x2", "{row:#}");
        let partner = rows.iter().find(|other| other["variant"] == row["baseline"]).unwrap();
        assert_eq!(row["group"], partner["group"], "measured in turn");
        let of = |row: &Value| -> Vec<f64> {
            row["stage_ms"]["samples"].as_array().unwrap().iter().map(|ms| ms.as_f64().unwrap()).collect()
        };
        let pairs: Vec<f64> = of(row).iter().zip(of(partner)).map(|(ours, theirs)| (ours / theirs).ln()).collect();
        let mean = (pairs.iter().sum::<f64>() / pairs.len() as f64).exp();
        assert!((row["ratio"]["mean"].as_f64().unwrap() / mean - 1.0).abs() < 1e-9, "{row:#}");
    }
    let summary: Value = serde_json::from_str(&read(&program, "out/summary.json")).unwrap();
    assert_eq!(summary["baseline"], serde_json::json!(["vpls=4 pattern=2x2", "vpls=8 pattern=2x2"]));
    assert!(read(&program, "out/summary.md").contains("ratios to vpls=4 pattern=2x2; vpls=8 pattern=2x2"));
    // All rows are known, whosever they are.
    let again = program.run(&bench("shade", &[&sweep[..], &["--resume", "--json", "--quiet"]].concat()));
    assert_eq!(again.fine().out, "");
}

#[test]
fn an_earlier_run_is_not_overwritten_and_a_torn_one_is_resumed() {
    let program = Program::new();
    // More than a group, and two that cannot be.
    let sweep = ["--sweep", "kernel=5,6,7,8,9,11,13,15,17", "--sweep", "pattern=2x2,3x2", "--quiet", "-o", "out"];
    let first = bench("filter", &sweep);
    assert_eq!(program.run(&first).fine().out, "");
    let whole = read(&program, "out/rows.jsonl");
    let rows = lines(&whole);
    assert_eq!(rows.len(), 18);
    assert_eq!(rows.iter().filter(|row| row["skipped"].is_string()).count(), 4);
    let summary: Value = serde_json::from_str(&read(&program, "out/summary.json")).unwrap();
    let table = summary["rows"].as_array().unwrap();
    assert_eq!(variants(table)[..3], ["kernel=5 pattern=2x2", "kernel=5 pattern=3x2", "kernel=6 pattern=2x2"]);
    assert!(table.iter().any(|row| row["pareto"] == true));
    assert!(read(&program, "out/summary.md").contains("| kernel=5 pattern=2x2 |"));

    let ran = program.run(&first);
    assert_eq!(ran.code, 2);
    assert!(
        ran.err.contains("out/rows.jsonl") && ran.err.contains("--resume") && ran.err.contains("--force"),
        "{}",
        ran.err
    );
    assert_eq!(read(&program, "out/rows.jsonl"), whole);

    // Everything is there: nothing is measured.
    let resume: Vec<&str> = first.iter().copied().chain(["--resume"]).collect();
    let json: Vec<&str> = resume.iter().copied().chain(["--json"]).collect();
    assert_eq!(program.run(&json).fine().out, "");
    assert_eq!(read(&program, "out/rows.jsonl"), whole);

    // Killed while it wrote the sixteenth.
    let ends: Vec<usize> = whole.match_indices('\n').map(|(end, _)| end + 1).collect();
    std::fs::write(program.path("out/rows.jsonl"), &whole[..ends[14] + 100]).unwrap();
    std::fs::remove_file(program.path("out/summary.json")).unwrap();
    let measured = lines(&program.run(&json).fine().out);
    let mut missing = variants(&rows[15..]);
    let mut found = variants(&measured);
    missing.sort();
    found.sort();
    assert_eq!(found, missing);
    let text = read(&program, "out/rows.jsonl");
    assert!(text.starts_with(&whole[..ends[14]]), "a kept line has changed");
    assert_eq!(lines(&text).len(), 18);
    let summary: Value = serde_json::from_str(&read(&program, "out/summary.json")).unwrap();
    assert_eq!(summary["rows"].as_array().unwrap().len(), 18);

    // Other rounds are another measurement; --force begins anew.
    let force = bench("filter", &["--sweep", "kernel=5", "--quiet", "-o", "out", "--force"]);
    program.run(&force).fine();
    assert_eq!(lines(&read(&program, "out/rows.jsonl")).len(), 1);
    let more: Vec<&str> = force
        .iter()
        .map(|word| match *word {
            "3" => "4",
            "--force" => "--resume",
            word => word,
        })
        .collect();
    program.run(&more).fine();
    assert_eq!(lines(&read(&program, "out/rows.jsonl")).len(), 2);
}

#[test]
fn a_table_and_plain_lines_of_progress_are_what_a_pipe_gets() {
    let program = Program::new();
    let ran = program.run(&bench("frame", &["--sweep", "split=none,one-pass"]));
    assert_eq!((ran.code, ran.err.as_str()), (0, "2 of 2 rows\n"));
    assert!(ran.out.contains("time ratios to split=none, of 3 rounds"), "{}", ran.out);
    assert!(ran.out.lines().any(|line| line.starts_with("split=one-pass ")), "{}", ran.out);
    assert_eq!(program.files(), [] as [&str; 0]);
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_finished_rows_and_resume_goes_on() {
    let program = Program::new();
    // Five groups, so that the second one is still far from the end when the first is done.
    let sizes: Vec<String> = (0..32).map(|index| format!("{}x48", 64 + index)).collect();
    let sweep = format!("size={}", sizes.join(","));
    let arguments = bench("shade", &["--sweep", &sweep, "--quiet", "-o", "out"]);
    let mut child =
        quincunx().current_dir(program.folder.path()).args(&arguments).stderr(Stdio::null()).spawn().unwrap();
    let rows = program.folder.path().join("out/rows.jsonl");
    let started = Instant::now();
    while !rows.exists() {
        assert!(started.elapsed() < Duration::from_secs(120) && child.try_wait().unwrap().is_none(), "no row came");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let before = read(&program, "out/rows.jsonl");
    let count = lines(&before).len();
    assert!((1..32).contains(&count), "{count} rows");
    let resume: Vec<&str> = arguments.iter().copied().chain(["--resume"]).collect();
    program.run(&resume).fine();
    let after = read(&program, "out/rows.jsonl");
    assert!(after.starts_with(&before));
    assert_eq!(lines(&after).len(), 32);
}

/// Techniques are an axis: what all of them read stays, what one does not read leaves out its points alone.
#[test]
fn techniques_are_measured_in_one_run() {
    let program = Program::new();
    let common =
        ["bench", "frame", "lamps:objects=10,lights=8", "--size", "64x48", "--repeat", "3", "--json", "--quiet"];
    let swept = ["--technique", "forward", "--sweep", "technique=forward,deferred", "--sweep", "msaa=1,4"];
    let ran = program.run(&[&common[..], &swept, &["--brdf", "lambert"]].concat()).fine();
    let mut rows = lines(&ran.out);
    rows.sort_by_key(|row| row["variant"].as_str().unwrap().to_owned());
    assert_eq!(
        variants(&rows),
        [
            "technique=deferred msaa=1",
            "technique=deferred msaa=4",
            "technique=forward msaa=1",
            "technique=forward msaa=4"
        ]
    );
    for row in &rows[..2] {
        assert!(row["skipped"].as_str().unwrap().contains("deferred does not read --msaa"), "{row}");
    }
    for row in &rows[2..] {
        has_ratio(&row["ratio"]);
        assert_eq!((&row["technique"], &row["settings"]["brdf"]), (&"forward".into(), &"lambert".into()));
    }
    let ran = program.run(&[&common[..], &swept[..4], &["--brdf", "lambert"]].concat()).fine();
    for row in lines(&ran.out) {
        has_ratio(&row["ratio"]);
        let technique = row["technique"].as_str().unwrap();
        assert_eq!(row["variant"], format!("technique={technique}"));
        let command: Vec<&str> = row["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        assert_eq!(command[3..5], ["--technique", technique]);
        assert!(command.join(" ").contains("--brdf lambert"), "{command:?}");
        assert!(row["settings"]["technique"].is_null());
    }
    // What one of them alone takes of a setting that both read leaves the other out.
    let mapped = ["--direct-shadow", "map", "--shadow-map-size", "64"];
    let rows = lines(&program.run(&[&common[..], &swept[..4], &mapped].concat()).fine().out);
    for row in &rows {
        let is_left_out = row["skipped"].as_str().is_some_and(|why| why.contains("deferred: --direct-shadow map"));
        assert_eq!(is_left_out, row["variant"] == "technique=deferred", "{row}");
    }
    assert_eq!(rows.len(), 2);
    let wrong = program.run(&[&common[..], &["--sweep", "technique=nothing"]].concat());
    assert_eq!(wrong.code, 2, "{}", wrong.err);
}
