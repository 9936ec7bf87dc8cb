//! The page of a sweep: plots, maps, pictures and rows that sort, in a browser; and `--group`, whose rows are on disk one by one.

use crate::papers::page::shown;
use crate::support::benched::{bench, lines, read};
use crate::support::program::Program;
use crate::support::{browser, skip};

const GRID: [&str; 4] = ["--sweep", "split=one-pass,branch", "--sweep", "pattern=2x2,4x4"];

#[test]
fn a_page_has_the_rows_their_maps_and_their_pictures() {
    let program = Program::new();
    let words = bench("frame", &[&GRID[..], &["--point", "kernel=9", "--pictures", "-o", "out", "--quiet"]].concat());
    program.run(&words).fine();
    let rows = lines(&read(&program, "out/rows.jsonl"));
    let html = read(&program, "out/index.html");
    // One map of two axes; a point beside the grid has no place on it.
    assert_eq!(html.matches("<rect class=\"ours\"").count(), 4, "{html}");
    assert!(html.contains("Time by split and pattern"), "{html}");
    for row in &rows {
        let hash = &row["image_hash"].as_str().unwrap()[..16];
        let picture = format!("out/pictures/{hash}.png");
        let command: Vec<String> = serde_json::from_value(row["command"].clone()).unwrap();
        let render: Vec<&str> = command[1..].iter().map(String::as_str).chain(["-o", "own.png", "--quiet"]).collect();
        program.run(&render).fine();
        let compared = program.run(&["compare", "own.png", &picture, "--max", "rmse=0", "--quiet"]);
        assert_eq!(compared.code, 0, "{picture} is not of {command:?}: {}", compared.err);
    }
    // Both splits make one picture of each pattern.
    assert_eq!(std::fs::read_dir(program.path("out/pictures")).unwrap().count(), 3);
    assert_eq!(html.matches("<figure>").count(), 3);
    assert!(html.contains("split=one-pass pattern=4x4; split=branch pattern=4x4"), "{html}");
    // Merged folders keep them.
    program.run(&["bench", "merge", "out", "-o", "all", "--quiet"]).fine();
    assert_eq!(read(&program, "all/index.html").matches("<figure>").count(), 3);
    let Some(browser) = browser() else { return skip("there is no chromium") };
    let ratios: Vec<f64> = rows.iter().map(|row| row["ratio"]["mean"].as_f64().unwrap()).collect();
    for width in [390, 1280] {
        let found = shown(&program, "out/index.html", &browser, width);
        assert_eq!((&found["errors"], &found["overflow"]), (&serde_json::json!([]), &0.into()), "{found:#}");
        let numbers = |key: &str| -> Vec<f64> {
            found[key].as_array().unwrap().iter().map(|value| value.as_str().unwrap().parse().unwrap()).collect()
        };
        let mut sorted = ratios.clone();
        sorted.sort_by(f64::total_cmp);
        let are_close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(one, other)| (one - other).abs() < 1e-9);
        assert!(are_close(&numbers("before"), &ratios) && are_close(&numbers("ascending"), &sorted), "{found:#}");
        assert!(found["sizes"].as_array().unwrap().iter().all(|size| size[0] == 64), "{found:#}");
    }
}

/// Rows appear one after the other, and a run that is killed between two of them has lost none.
#[test]
#[cfg(target_os = "linux")]
fn with_groups_of_one_a_killed_run_loses_one_measurement_at_most() {
    use crate::support::program::quincunx;
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    let program = Program::new();
    let kernels = "kernel=5,7,9,11,13,15,17";
    let words =
        bench("frame", &["--sweep", kernels, "--sweep", "pattern=2x2,4x4", "--group", "1", "-o", "out", "--quiet"]);
    let rows = || read(&program, "out/rows.jsonl").lines().count();
    let mut before = 0;
    // Killed after the third row, and after the eighth.
    for (turn, killed_after) in [3, 8].into_iter().enumerate() {
        let resume = if turn == 0 { vec![] } else { vec!["--resume"] };
        let mut child = quincunx()
            .current_dir(program.folder.path())
            .args(words.iter().chain(&resume))
            .stderr(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let begun = Instant::now();
        while !std::path::Path::new(&program.path("out/rows.jsonl")).exists() || rows() < killed_after {
            assert!(begun.elapsed() < Duration::from_secs(120) && child.try_wait().unwrap().is_none(), "{}", rows());
            std::thread::sleep(Duration::from_millis(2));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let after = rows();
        // What was on disk stays, and what came is what was seen.
        assert!(after >= killed_after.max(before), "{before} {after}");
        before = after;
    }
    let ran = program.run(
        &[&words[..], &["--resume", "--json"]]
            .concat()
            .iter()
            .filter(|word| **word != "--quiet")
            .copied()
            .collect::<Vec<_>>(),
    );
    assert_eq!(ran.code, 0, "{}", ran.err);
    // Only what was missing is measured; a line that was torn counts as missing.
    assert!(ran.out.lines().count() <= 14 - before + 1, "{} rows were there, {} came", before, ran.out.lines().count());
    let all = lines(&read(&program, "out/rows.jsonl"));
    let variants: std::collections::BTreeSet<&str> = all.iter().map(|row| row["variant"].as_str().unwrap()).collect();
    assert_eq!((all.len(), variants.len()), (14, 14));
    // No two rows waited for each other, but the baseline's and the one that it was first measured beside.
    let groups: std::collections::BTreeSet<&str> = all.iter().map(|row| row["group"].as_str().unwrap()).collect();
    assert_eq!(groups.len(), 13, "{groups:?}");
}
