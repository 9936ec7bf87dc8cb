//! The page of a sweep: plots, maps, pictures and rows that sort, in a browser.

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
