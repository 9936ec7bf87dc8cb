//! Sweeps as files, rows beside the grid, and rounds until ratios are told.

use crate::support::benched::{bench, lines, read};
use crate::support::program::Program;
use quincunx::report::command_line::command_line;
use serde_json::Value;

const FILE: &str = r#"
bench = "frame"
scenes = ["cornell", "lamps:objects=5,lights=3"]
repeat = 3
baseline = "split=none vpls=16"

[settings]
size = "64x48"
direct = "none"

[sweep]
split = ["none", "one-pass"]
vpls = [16, 32]

[[point]]
name = "branched"
split = "branch"
pattern = "2x2"
"#;

fn variants(rows: &[Value]) -> Vec<&str> {
    rows.iter().map(|row| row["variant"].as_str().unwrap()).collect()
}

#[test]
fn a_file_says_what_flags_say() {
    let program = Program::new();
    std::fs::write(program.path("sweep.toml"), FILE).unwrap();
    let ran = program.run(&["bench", "run", "sweep.toml", "-o", "out", "--json"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let printed = lines(&ran.out);
    let mut said = Vec::new();
    for folder in ["cornell", "lamps-objects-5-lights-3"] {
        let rows = lines(&read(&program, &format!("out/{folder}/rows.jsonl")));
        let summary: Value = serde_json::from_str(&read(&program, &format!("out/{folder}/summary.json"))).unwrap();
        let found = variants(&rows);
        assert_eq!(found.len(), 5, "{found:?}");
        assert!(found.contains(&"split=one-pass vpls=32") && found.contains(&"split=branch pattern=2x2"), "{found:?}");
        let point = rows.iter().find(|row| row["variant"] == "split=branch pattern=2x2").unwrap();
        assert_eq!((&point["settings"]["pattern"], &point["settings"]["direct"]), (&"2x2".into(), &"none".into()));
        assert!(point["ratio"]["mean"].as_f64().unwrap() > 0.0 && point["baseline"] == "split=none vpls=16");
        // The command of a scene is one that a user can type, and comes to the same rows.
        let command: Vec<String> = serde_json::from_value(summary["command"].clone()).unwrap();
        assert!(ran.err.contains(&command_line(&command)), "{}", ran.err);
        assert!(ran.err.contains("--point \"branched: split=branch pattern=2x2\""), "{}", ran.err);
        assert_eq!(point["name"], "branched");
        let words: Vec<&str> = command[1..].iter().map(String::as_str).chain(["--resume", "--quiet"]).collect();
        assert_eq!(program.run(&words).fine().out, "", "nothing is missing");
        said.extend(rows);
    }
    assert_eq!(variants(&printed), variants(&said));
    assert_eq!(program.run(&["bench", "run", "sweep.toml", "-o", "out"]).code, 2, "rows are there");
    assert_eq!(
        program.run(&["bench", "run", "sweep.toml", "-o", "out", "--resume", "--json", "--quiet"]).fine().out,
        ""
    );
}

#[test]
fn a_file_that_is_no_sweep_is_refused() {
    let program = Program::new();
    for (text, words) in [
        ("nothing = 1", &["sweep.toml: line 1", "nothing"][..]),
        ("repeat = 3\nsweep = 7", &["sweep.toml: line 2"]),
        ("bench = \"nothing\"", &["sweep.toml", "nothing"]),
        ("[settings]\nnothing = 1", &["sweep.toml", "--nothing"]),
        ("[sweep]\nnothing = [1]", &["--sweep nothing=", "no setting"]),
        ("[[point]]\nnothing = 1", &["--point nothing=", "no setting"]),
        ("[[point]]\nname = \"a b\"\nkernel = 7", &["sweep.toml: [[point]]: name \"a b\"", "letters, digits"]),
        ("[[point]]\nname = \"\"\nkernel = 7", &["sweep.toml: [[point]]: name \"\"", "letters, digits"]),
        ("[[point]]\nname = 7\nkernel = 7", &["sweep.toml", "expected a string"]),
        ("[[point]]\nname = \"a\"", &["--point \"a:\"", "sets nothing"]),
        (
            "[[point]]\nname = \"a\"\nkernel = 7\n[[point]]\nname = \"a\"\nkernel = 9",
            &["--point \"kernel=9\"", "the name a is that of kernel=7"],
        ),
        ("repeat = 0", &["sweep.toml", "--repeat"]),
        ("until-interval = 2", &["sweep.toml", "--until-interval"]),
        ("scenes = [\"a/box.glb\", \"b/box.glb\"]", &["folder box", "b/box.glb"]),
        ("scenes = [\"nowhere.glb\"]", &["nowhere.glb"]),
    ] {
        std::fs::write(program.path("sweep.toml"), text).unwrap();
        let ran = program.run(&["bench", "run", "sweep.toml", "-o", "out"]);
        assert_eq!(ran.code, 2, "{text}: {}", ran.err);
        assert!(words.iter().all(|word| ran.err.contains(word)), "{text}: {}", ran.err);
    }
    program.fails(&["bench", "run", "nowhere.toml", "-o", "out"], 2, &["nowhere.toml"]);
}

#[test]
fn points_stand_beside_the_grid() {
    let program = Program::new();
    let sweep = ["--sweep", "split=one-pass,branch", "--json", "--quiet", "--point"];
    let run = |point: &str| program.run(&bench("frame", &[&sweep[..], &[point]].concat()));
    let rows = lines(&run("pattern=2x2 --kernel=7").fine().out);
    assert_eq!(variants(&rows), ["split=one-pass", "split=branch", "pattern=2x2 kernel=7"]);
    assert_eq!(rows[2]["baseline"], "split=one-pass");
    for (wrong, why) in
        [("split=branch", "already"), ("pattern", "KEY=VALUE"), ("kernel=5 kernel=7", "twice"), ("", "sets nothing")]
    {
        let ran = run(wrong);
        assert!(ran.code == 2 && ran.err.contains(why), "{wrong}: {}", ran.err);
    }
}

#[test]
fn a_name_stands_for_a_point_and_is_no_part_of_what_it_is() {
    let program = Program::new();
    let sweep = ["--sweep", "split=one-pass,branch", "-o", "out", "--point"];
    let run = |point: &str, more: &[&str]| program.run(&bench("frame", &[&sweep[..], &[point], more].concat()));
    let ran = run("wide: pattern=2x2 kernel=7", &["--baseline", "wide", "--fail-if", "median_ms > 0"]);
    assert!(ran.code == 1 && ran.err.contains("wide "), "{}", ran.err);
    assert!(
        ran.out.contains("time ratios to wide,") && ran.out.contains("\nwide: pattern=2x2 kernel=7\n"),
        "{}",
        ran.out
    );
    let rows = lines(&read(&program, "out/rows.jsonl"));
    assert_eq!(variants(&rows), ["pattern=2x2 kernel=7", "split=one-pass", "split=branch"]);
    assert_eq!(rows[0]["name"], "wide");
    for row in &rows {
        assert_eq!(row["baseline"], "pattern=2x2 kernel=7");
        assert_eq!(row.get("name").is_some(), *row == rows[0], "{row}");
    }
    assert!(read(&program, "out/summary.md").contains("\n| wide | "));
    let page = read(&program, "out/index.html");
    assert!(page.contains("<title>wide: ") && page.contains("wide: pattern=2x2 kernel=7"), "{page}");
    let mut table = csv::Reader::from_path(program.path("out/rows.csv")).unwrap();
    let column = table.headers().unwrap().iter().position(|title| title == "name").unwrap();
    let names: Vec<String> = table.records().map(|record| record.unwrap()[column].to_owned()).collect();
    assert_eq!(names, ["", "", "wide"]);
    // Called otherwise it is the same row, which is there.
    let again = run("broad: pattern=2x2 kernel=7", &["--baseline", "pattern=2x2 kernel=7", "--resume", "--json"]);
    assert_eq!((again.code, again.out.as_str()), (0, ""), "{}", again.err);
    assert!(read(&program, "out/summary.md").contains("\n| broad | "));
    for (point, baseline, why) in [
        ("a b: kernel=7", "split=branch", "letters, digits"),
        ("defaults: kernel=7", "split=branch", "without settings of its own"),
        ("a: kernel=7", "b", "the name of a point"),
    ] {
        let ran = run(point, &["--baseline", baseline, "--force"]);
        assert!(ran.code == 2 && ran.err.contains(why), "{point}: {}", ran.err);
    }
}

#[test]
fn rounds_go_on_until_intervals_are_narrow_or_it_is_enough() {
    let program = Program::new();
    let sweep = ["--sweep", "split=none,one-pass", "--json", "--quiet", "--until-interval"];
    let pairs = |part: &str| {
        let rows = lines(&program.run(&bench("frame", &[&sweep[..], &[part]].concat())).fine().out);
        assert_eq!(rows[1]["until_interval"].as_f64(), part.parse().ok());
        rows[1]["ratio"]["pairs"].as_u64().unwrap()
    };
    // No machine is so even.
    assert_eq!(pairs("1e-9"), 30);
    assert!((3..=30).contains(&pairs("0.9")));
}
