//! What rows of `bench` say: that it is what the report of their command says, that no rows differ only in settings
//! that are not read, and that few rounds prove nothing.

use crate::support::benched::{bench, lines, read};
use crate::support::program::Program;
use quincunx::bench::row::BenchRow;
use quincunx::bench::rows_file::{Existing, NAME, RowsFile};
use quincunx::bench::summary::Summary;
use quincunx::bench::sweep;
use quincunx::bench::what::What;
use serde_json::Value;

/// What a method draws into on the way, or writes twice, is not what is copied.
#[test]
fn every_method_copies_as_many_bytes() {
    let program = Program::new();
    let methods = ["--sweep", "split=one-pass,two-pass,tile,layered,fragment", "--sweep", "fragment-passes=2,1"];
    for (what, bytes) in [("split", 64 * 48 * 16), ("gather", 64 * 48 * 8)] {
        let rows = lines(&program.run(&bench(what, &[&methods[..], &["--json", "--quiet"]].concat())).fine().out);
        let measured: Vec<&Value> = rows.iter().filter(|row| row["skipped"].is_null()).collect();
        assert_eq!(measured.len(), 6, "{what}: a method each, and fragment's two");
        for row in measured {
            assert_eq!(row["copied_bytes"], bytes, "{what}: {row:#}");
            let ms = row["stage_ms"]["median"].as_f64().unwrap();
            let gb_per_s = row["copied_gb_per_s"].as_f64().unwrap();
            assert!((gb_per_s * ms * 1e6 / f64::from(bytes) - 1.0).abs() < 1e-9, "{what}: {row:#}");
        }
    }
}

/// Colour beside position and normal is copied too, whether anything reads it or not.
#[test]
fn colour_in_sub_buffers_is_copied() {
    let program = Program::new();
    let methods = ["--sweep", "split=one-pass,two-pass,fragment", "--sub-buffer-color", "on"];
    for more in [&[][..], &["--vpl-brdf", "ggx"]] {
        let rows = lines(&program.run(&bench("split", &[&methods, more, &["--json", "--quiet"]].concat())).fine().out);
        assert_eq!(rows.len(), 3);
        rows.iter().for_each(|row| assert_eq!(row["copied_bytes"], 64 * 48 * 24, "{row:#}"));
    }
}

/// Rows, each with the report of its command.
fn with_reports(program: &Program, axes: &[&str]) -> Vec<(Value, Value)> {
    let given = ["--pattern", "3x2", "--block", "20", "--vpl-clamp", "3%", "--json", "--quiet"];
    let rows = lines(&program.run(&bench("frame", &[axes, &given].concat())).fine().out);
    let report = |row: &Value| {
        let command: Vec<&str> = row["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        program.run(&[&command[1..], &["--json", "-o", "a.png"]].concat()).fine().json()
    };
    rows.into_iter().map(|row| (report(&row), row)).map(|(report, row)| (row, report)).collect()
}

#[test]
fn a_row_has_the_memory_of_its_report() {
    let program = Program::new();
    let axes = ["--sweep", "split=one-pass,two-pass", "--sweep", "alias=off,greedy,optimal"];
    let rows = with_reports(&program, &axes);
    assert_eq!(rows.len(), 6);
    for (row, report) in rows {
        let (memory, variant) = (&row["memory"], &row["variant"]);
        for key in ["planned_bytes", "allocated_bytes", "aliased_bytes", "peak_bytes", "peak_pass", "groups"] {
            assert!(!memory[key].is_null(), "{variant}: {key}");
            assert_eq!(memory[key], report["memory"][key], "{variant}: {key}");
        }
        // Without sharing everything stays bound.
        let is_off = report["settings"]["alias"] == "off";
        assert_eq!(memory["peak_bytes"] == memory["allocated_bytes"], is_off, "{variant}: {memory}");
    }
}

/// As they were used, not as they were typed.
#[test]
fn a_row_has_the_settings_of_its_report() {
    let rows = with_reports(&Program::new(), &["--sweep", "split=one-pass,two-pass"]);
    for (row, report) in &rows {
        assert_eq!(row["settings"], report["settings"], "{}", row["variant"]);
    }
    let (two_pass, _) = &rows[1];
    assert_eq!((&two_pass["settings"]["block"], &two_pass["asked"]["block"]), (&"21x20".into(), &"20".into()));
    assert!(two_pass["settings"]["sigma"].as_f64().unwrap() > 0.0 && two_pass["asked"]["sigma"].is_null());
}

#[test]
fn two_rounds_have_no_interval_and_say_so() {
    let program = Program::new();
    let few = ["bench", "frame", "cornell", "--size", "64x48", "--vpls", "16", "--repeat", "2"];
    let axes = ["--sweep", "split=none,one-pass"];
    for row in lines(&program.run(&[&few[..], &axes, &["--json", "--quiet"]].concat()).fine().out) {
        for entry in ["ratio", "speed_up"] {
            assert!(row[entry]["interval_95"].is_null() && row[entry]["pairs"] == 2, "{row:#}");
        }
    }
    let out = program.run(&[&few[..], &axes].concat()).out;
    assert!(out.contains("below 3 rounds") && !out.contains(" to 1."), "{out}");
}

#[test]
fn an_axis_that_nothing_reads_is_refused_or_its_points_are_one() {
    let program = Program::new();
    let blocks = ["--sweep", "block=8,16,32"];
    for what in ["split", "frame"] {
        let words =
            ["--sweep block=8,16,32", "--split one-pass: it has no blocks", "--split two-pass, tile or fragment"];
        program.fails(&bench(what, &blocks), 2, &words);
    }
    program.fails(&bench("frame", &["--filter", "none", "--kernel", "7"]), 2, &["--kernel 7 with --filter none"]);
    let methods = ["--sweep", "split=one-pass,two-pass"];
    let folder = ["--quiet", "-o", "out"];
    program.run(&bench("split", &[&methods[..], &blocks, &folder].concat())).fine();
    let summary: Value = serde_json::from_str(&read(&program, "out/summary.json")).unwrap();
    let rows = summary["rows"].as_array().unwrap();
    let measured: Vec<&Value> = rows.iter().filter(|row| row["skipped"].is_null()).collect();
    assert_eq!(measured.len(), 4, "one-pass is one kernel");
    assert_eq!(
        (&measured[0]["variant"], &measured[0]["unread_axes"][0]),
        (&"split=one-pass block=8".into(), &"block".into())
    );
    assert!(!measured[0]["command"].to_string().contains("--block"), "{}", measured[0]["command"]);
    let skipped: Vec<&str> = rows.iter().filter_map(|row| row["skipped"].as_str()).collect();
    assert!(
        skipped.len() == 2 && skipped.iter().all(|why| why.contains("the row with block=8 stands for it")),
        "{skipped:?}"
    );
    let best = summary["best_blocks"].as_array().unwrap();
    assert_eq!(best.len(), 1, "one-pass has no blocks: {best:#?}");
    assert_eq!(best[0]["of"], "split=two-pass");
    // All of them were measured in the same rounds, so their own ratio is known.
    assert!(best[0]["neighbours"].as_array().unwrap().iter().all(|one| one["paired"]["pairs"] == 3), "{best:#?}");
    assert!(best[0]["differs_from_neighbours"].is_boolean(), "{best:#?}");
}

#[test]
fn an_axis_that_no_technique_has_is_answered_with_one_that_is_like_it() {
    let program = Program::new();
    program.fails(&bench("frame", &["--sweep", "blocks=8,16"]), 2, &["--blocks", "a similar one exists: --block"]);
    program.fails(&bench("frame", &["--sweep", "paterns=2x2"]), 2, &["a similar one exists: --pattern"]);
    program.fails(&bench("frame", &["--sweep", "msaa=1,4"]), 2, &["does not read --msaa"]);
}

#[test]
fn fair_rows_shade_as_many_texels_a_thread() {
    let program = Program::new();
    let methods = ["--sweep", "split=none,branch,stencil,remap", "--json", "--quiet"];
    let large = ["bench", "shade", "cornell", "--size", "128x128", "--vpls", "16", "--repeat", "1"];
    let run = |more: &[&str]| lines(&program.run(&[&large[..], &methods, more].concat()).fine().out);
    let texels = |rows: &[Value]| rows.iter().map(|row| row["settings"]["texels"].clone()).collect::<Vec<_>>();
    assert_eq!(texels(&run(&["--fair"])), [1, 1, 1, 1]);
    // Each pixel of branch, and each fragment of stencil, has a thread of its own: rows say so, and are not fair with others.
    let unfair = run(&["--texels", "4"]);
    assert_eq!(texels(&unfair), [4, 1, 1, 4]);
    assert!(unfair.iter().all(|row| row["fair"].is_null() && row["asked"]["texels"] == "4"));
    let rows = run(&["--fair", "--texels", "4"]);
    for row in &rows {
        let split = row["asked"]["split"].as_str().unwrap();
        let why = row["skipped"].as_str().unwrap_or_default();
        assert_eq!(why.contains("--fair --texels 4"), ["branch", "stencil"].contains(&split), "{row:#}");
        assert_eq!(row["fair"], true);
    }
    program.fails(&[&large[..], &["--fair", "--sweep", "texels=1,2"]].concat(), 2, &["--fair", "--sweep texels="]);
    let forward = ["bench", "frame", "lamps:objects=3,lights=3", "--technique", "forward", "--size", "33x17", "--fair"];
    program.fails(&forward, 2, &["--fair: forward has no --texels"]);
}

/// Rows of earlier versions: what they hold is read, and a sweep continues behind them.
#[test]
fn kept_runs_are_read() {
    let runs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/runs");
    let folders = std::fs::read_dir(runs).unwrap().map(|entry| entry.unwrap().path());
    let files = folders.flat_map(|folder| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
    let kept: Vec<_> = files.filter(|path| path.extension().is_some_and(|extension| extension == "jsonl")).collect();
    assert!(kept.len() > 10, "{kept:?}");
    for path in kept {
        let program = Program::new();
        std::fs::copy(&path, program.path(NAME)).unwrap();
        let rows = lines(&read(&program, NAME));
        let file = RowsFile::open(program.folder.path(), Existing::Resume).unwrap();
        let what = What::all().into_iter().find(|what| rows[0]["bench"] == what.name()).unwrap();
        let rows: Vec<BenchRow> = rows
            .into_iter()
            .map(|row| {
                let read: BenchRow = serde_json::from_value(row.clone()).unwrap();
                // What a row says is what is written again: no key is lost, and none is added.
                assert_eq!(read.line(), row.to_string(), "{}", path.display());
                assert!(file.kept(&read) == Some(&read) && read.other.is_empty(), "{}", path.display());
                read
            })
            .collect();
        let axes = sweep::axes(&["pattern=2x2,4x4".to_owned(), "block=8,16".to_owned()]).unwrap();
        let text = Summary::new(what, &axes, rows, &[]).text();
        assert!(text.contains(" rounds"), "{}: {text}", path.display());
    }
}

/// Threads that count wait for each other; what is looked at and not timed is counted.
#[test]
fn what_is_timed_is_counted_only_where_that_is_asked_for() {
    let program = Program::new();
    let small = ["cornell", "--technique", "deep_shading", "--size", "33x17", "--spp", "2", "--json", "--quiet"];
    let frame = ["bench", "frame", "--repeat", "1"];
    let looked_at = ["render", "-o", "a.png"];
    let profiled = ["render", "-o", "a.png", "--profile"];
    for (verb, more, is_counted) in [
        (&frame[..], &[][..], false),
        (&frame, &["--instrument", "on"], true),
        (&profiled, &[], false),
        (&profiled, &["--instrument", "on"], true),
        (&looked_at, &[], true),
        (&looked_at, &["--instrument", "off"], false),
    ] {
        let json: Value = serde_json::from_str(&program.run(&[verb, &small, more].concat()).fine().out).unwrap();
        let is_on = json["settings"]["instrument"] == "on";
        let has_counters = !json["counters"]["samples_without_colour"].is_null();
        assert_eq!([is_on, has_counters], [is_counted; 2], "{verb:?} {more:?}: {json:#}");
    }
}
