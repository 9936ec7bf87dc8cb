//! Sweeps in parts, joined again, judged by conditions, and as a table for other programs.

use crate::support::benched::{bench, lines, read};
use crate::support::program::Program;
use serde_json::Value;
use std::collections::BTreeSet;

const SWEEP: [&str; 4] = ["--sweep", "pattern=2x2,4x4", "--sweep", "split=none,one-pass,branch"];

fn variants(rows: &[Value]) -> Vec<String> {
    rows.iter().map(|row| row["variant"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn shards_are_each_row_once_and_merge_into_the_whole() {
    let program = Program::new();
    let whole = lines(&program.run(&bench("frame", &[&SWEEP[..], &["--json", "--quiet"]].concat())).fine().out);
    let whole: BTreeSet<String> = variants(&whole).into_iter().collect();
    let mut found = Vec::new();
    for shard in ["1/3", "2/3", "3/3"] {
        let folder = shard.replace('/', "-");
        let more = [&SWEEP[..], &["--shard", shard, "--quiet", "-o", &folder]].concat();
        program.run(&bench("frame", &more)).fine();
        let file = program.path(&format!("{folder}/rows.jsonl"));
        let rows = std::fs::read_to_string(file).map_or(Vec::new(), |text| lines(&text));
        println!("{shard}: {:?}", variants(&rows));
        found.extend(variants(&rows));
        // Nothing is missing: there is nothing to measure.
        let again = program.run(&bench("frame", &[&more[..], &["--resume", "--json"]].concat())).fine();
        assert_eq!(again.out, "", "{shard}");
    }
    assert_eq!(found.len(), whole.len(), "each row once: {found:?}");
    assert_eq!(found.iter().cloned().collect::<BTreeSet<_>>(), whole);
    let has_rows = |folder: &&str| std::path::Path::new(&program.path(&format!("{folder}/rows.jsonl"))).exists();
    let folders: Vec<&str> = ["1-3", "2-3", "3-3"].into_iter().filter(has_rows).collect();
    // One of them twice.
    let merge = [&["bench", "merge"], &folders[..], &folders[..1], &["-o", "all"]].concat();
    let ran = program.run(&merge);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("were there twice"), "{}", ran.err);
    let merged = lines(&read(&program, "all/rows.jsonl"));
    assert_eq!((merged.len(), variants(&merged).into_iter().collect()), (whole.len(), whole));
    let summary: Value = serde_json::from_str(&read(&program, "all/summary.json")).unwrap();
    assert_eq!(summary["rows"].as_array().unwrap().len(), merged.len());
    program.fails(&merge, 2, &["all/rows.jsonl", "earlier run"]);
    program.run(&[&merge[..], &["--force", "--quiet"]].concat()).fine();
    program.fails(&["bench", "merge", "nowhere", "-o", "all"], 2, &["nowhere"]);
    program.fails(&bench("frame", &["--shard", "4/3"]), 2, &["--shard", "I/N"]);
}

#[test]
fn conditions_fail_a_command_that_has_written_its_rows() {
    let program = Program::new();
    let sweep = ["--sweep", "split=none,one-pass", "--quiet"];
    let run = |more: &[&str]| program.run(&bench("frame", &[&sweep[..], more].concat()));
    run(&["--fail-if", "planned_bytes < 1", "--fail-if", "time_ratio > 1e9"]).fine();
    let failed = run(&["-o", "out", "--fail-if", "planned_bytes > 1"]);
    assert_eq!(failed.code, 1, "{}", failed.err);
    assert!(failed.err.contains("2 of 2 rows: split=none") && failed.err.contains("split=one-pass"), "{}", failed.err);
    assert_eq!(lines(&read(&program, "out/rows.jsonl")).len(), 2);
    // Rows that are there are judged too.
    let kept = run(&["-o", "out", "--resume", "--fail-if", "median_ms > 0"]);
    assert_eq!(kept.code, 1, "{}", kept.err);
    for wrong in ["nothing > 1", "time_ratio", "counters.nothing > 1"] {
        assert_eq!(run(&["--fail-if", wrong]).code, 2, "{wrong}");
    }
}

#[test]
fn rows_are_a_table_for_other_programs() {
    let program = Program::new();
    program.run(&bench("frame", &[&SWEEP[..], &["--quiet", "-o", "out"]].concat())).fine();
    let rows = lines(&read(&program, "out/rows.jsonl"));
    let mut table = csv::Reader::from_path(program.path("out/rows.csv")).unwrap();
    let titles: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    let records: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(records.len(), rows.len());
    for record in &records {
        let cell = |title: &str| record.get(titles.iter().position(|known| known == title).unwrap()).unwrap();
        let row = rows.iter().find(|row| row["variant"] == cell("variant")).unwrap();
        assert_eq!(cell("--split"), row["asked"]["split"]);
        assert_eq!(cell("skipped"), row["skipped"].as_str().unwrap_or_default());
        let median = row["frame_ms"]["median"].as_f64();
        assert_eq!(cell("median_ms").parse().ok(), median, "{row}");
        assert_eq!(cell("planned_bytes").parse().ok(), row["planned_bytes"].as_u64(), "{row}");
    }
}
