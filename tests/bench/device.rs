//! `bench device`: each work does what it says, and passes are held against it.

use crate::support::program::Program;
use crate::support::watched::{require_silence, watched_device};
use crate::support::{Feature, driver, has};
use quincunx::bench::device::triangles::{Drawing, Drawn, Grid};
use quincunx::bench::device::work::{Buffers, Work, Worked};
use quincunx::bench::rounds::Probe;
use quincunx::gpu::Gpu;
use quincunx::gpu::shader::bench::device::DEVICE_SOUGHT;
use quincunx::report::run::RunReport;
use serde_json::{Value, json};
use std::rc::Rc;

const BYTES: u64 = 1 << 20;

/// What the target holds after a run over a source of this word.
fn target(gpu: &std::sync::Arc<Gpu>, work: Work, fill: u32) -> Vec<u32> {
    let buffers = Rc::new(Buffers::new(gpu, BYTES).unwrap());
    let worked = Worked::new(gpu, work, &buffers, fill).unwrap();
    assert_eq!(worked.measure().unwrap().len(), 1);
    worked.target(gpu).unwrap()
}

#[test]
fn each_work_touches_what_it_says() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let words = (BYTES / 4) as usize;
    assert_eq!(target(&gpu, Work::Clear, 7), vec![7; words]);
    assert_eq!(target(&gpu, Work::CopyCommand, 8), vec![8; words]);
    assert_eq!(target(&gpu, Work::Copy, 9), vec![9; words]);
    let written = target(&gpu, Work::Write, 0);
    assert!(written.chunks(4).enumerate().all(|(index, element)| element == [index as u32, 1, 2, 3]));
    // What reads finds the word that is everywhere, and none that is nowhere.
    for work in [Work::Read, Work::Stride(1), Work::Stride(64), Work::Random] {
        assert_eq!([target(&gpu, work, DEVICE_SOUGHT)[0], target(&gpu, work, 7)[0]], [1, 0], "{work:?}");
    }
    for counters in [1, 64] {
        let counted = target(&gpu, Work::Atomic(counters), 0);
        let each = (words / counters as usize) as u32;
        assert!(counted[..counters as usize].iter().all(|count| *count == each), "{counters}: {:?}", &counted[..4]);
        assert!(counted[counters as usize..].iter().all(|count| *count == 0));
    }
    require_silence(&gpu, "bench device");
}

/// Every pixel lies in one triangle, as the middle of none lies on an edge: it holds the number of the last draw, and of triangles that
/// are turned away nothing.
#[test]
fn triangles_cover_the_pixels_that_they_lie_on() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    for (side_px, squares, draws) in [(16, 16, 1), (16, 16, 3), (64, 8, 2), (32, 1, 255), (512, 512, 2)] {
        let grid = Grid { side_px, squares, draws };
        for drawn in Drawn::ALL {
            let drawing = Drawing::new(&gpu, drawn, grid).unwrap();
            assert_eq!(drawing.measure().unwrap().len(), 1);
            let number = if drawn == Drawn::TurnedAway { 0 } else { draws as u8 };
            let target = drawing.target(&gpu).unwrap();
            let others = target.iter().filter(|pixel| **pixel != number).count();
            assert_eq!((target.len(), others), ((side_px * side_px) as usize, 0), "{drawn:?} of {grid:?}");
        }
    }
    require_silence(&gpu, "triangles of bench device");
}

#[test]
fn passes_are_a_share_of_what_the_device_can_do() {
    let program = Program::new();
    let render = [
        "render",
        "cornell",
        "--size",
        "320x180",
        "--vpls",
        "16",
        "--profile",
        "--report",
        "report.json",
        "-o",
        "out.png",
        "--quiet",
    ];
    program.run(&render).fine();
    let words = [
        "bench",
        "device",
        "--bytes",
        "4MiB",
        "--repeat",
        "2",
        "--explain",
        "report.json",
        "--json",
        "--quiet",
        "--validate",
    ];
    let lines: Vec<Value> =
        program.run(&words).fine().out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let (rows, of_reports) = lines.split_at(lines.len() - 1);
    let works: Vec<&str> = rows.iter().map(|row| row["work"].as_str().unwrap()).collect();
    assert_eq!(works.len(), 14, "{works:?}");
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap();
        let median = row["ms"]["median"].as_f64().unwrap();
        let moved = number("bytes_read") + number("bytes_written");
        assert!((number("gb_per_s") - moved / median / 1e6).abs() < 1e-6 * number("gb_per_s"), "{row}");
        assert_eq!(row["ms"]["samples"].as_array().unwrap().len(), 2);
    }
    let row = |work: &str| rows.iter().find(|row| row["work"] == work).unwrap();
    for (work, key, count) in [
        ("triangles", "triangles_per_s", 8 * 2 * 512 * 512),
        ("triangles turned away", "triangles_per_s", 8 * 2 * 512 * 512),
        ("fill", "pixels_per_s", 64 * 2048 * 2048),
    ] {
        let rate = 1e3 * f64::from(count) / row(work)["ms"]["median"].as_f64().unwrap();
        assert!((row(work)[key].as_f64().unwrap() - rate).abs() < 1e-6 * rate, "{}", row(work));
    }
    let has_rate = |row: &&Value| !row["triangles_per_s"].is_null() || !row["pixels_per_s"].is_null();
    assert_eq!(rows.iter().filter(has_rate).count(), 3);
    let rate = |work: &str| row(work)["gb_per_s"].as_f64().unwrap();
    // What a copy reads can be read alone.
    let read = rate("read").max(0.5 * rate("shader copy")).max(0.5 * rate("copy command"));
    let report: Value = serde_json::from_str(&std::fs::read_to_string(program.path("report.json")).unwrap()).unwrap();
    let passes = of_reports[0]["passes"].as_array().unwrap();
    assert!(passes.len() > 4, "{passes:?}");
    for pass in passes {
        let timed = report["passes"].as_array().unwrap().iter().find(|one| one["name"] == pass["pass"]).unwrap();
        let least = pass["least_ms"].as_f64().unwrap();
        // At least what it is known to read at the rate of reading; nobody has counted its triangles.
        assert!(least >= 0.999 * timed["bytes_read"].as_f64().unwrap_or_default() / read / 1e6, "{pass}");
        assert_eq!(pass["bound"], "memory", "{pass}");
        let share = least / timed["ms"]["median"].as_f64().unwrap();
        assert!((pass["share"].as_f64().unwrap() - share).abs() < 1e-6 * share.max(1.0), "{pass}");
        assert_eq!(pass["impossible"], share > 1.1, "{pass}");
    }
    // What would be faster than memory is called impossible.
    let mut fast = report.clone();
    for pass in fast["passes"].as_array_mut().unwrap() {
        for key in ["median", "min", "max"] {
            pass["ms"][key] = 1e-6.into();
        }
    }
    std::fs::write(program.path("fast.json"), fast.to_string()).unwrap();
    let ran = program.run(&["bench", "device", "--bytes", "1MiB", "--repeat", "1", "--explain", "fast.json"]);
    assert!(ran.code == 0 && ran.out.contains("impossible: not all of these bytes came from memory"), "{}", ran.out);
    let mut other = report.clone();
    other["device"]["name"] = "another".into();
    std::fs::write(program.path("other.json"), other.to_string()).unwrap();
    for (words, said) in [
        (&["--bytes", "3MiB"][..], "a power of two"),
        (&["--bytes", "1GiB"], "512 MiB"),
        (&["--bytes", "1MiB", "--explain", "other.json"], "the device of the report is another"),
        (&["--explain", "nowhere.json"], "nowhere.json"),
        (&["--explain", "out.png"], "out.png"),
    ] {
        let ran = program.run(&[&["bench", "device"][..], words].concat());
        assert!(ran.code == 2 && ran.err.contains(said), "{words:?}: {}", ran.err);
    }
}

/// A render of which each pass is timed and counted, and what more is asked for.
fn timed<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let small = ["render", "cornell", "--technique", "deferred", "--size", "97x55", "--quiet", "-o", "a.png"];
    [&small[..], more].concat()
}

#[test]
fn a_report_has_the_share_of_each_pass() {
    if !has(&driver(), Feature::PipelineStatistics) {
        return;
    }
    let program = Program::new();
    let counted = ["--profile", "--statistics", "--json", "--device-rows", "rows.jsonl"];
    let device = program.run(&timed(&["--json"])).fine().json()["device"].clone();
    let row = |work: &str, gb_per_s: f64, key: &str, per_s: f64| {
        let ms = json!({ "median": 1.0, "min": 1.0, "max": 1.0, "samples": [1.0] });
        json!({
            "schema": 1, "bench": "device", "device": device, "commit": "unknown", "work": work, "buffer_bytes": 1024, "repeat": 1,
            "ms": ms, "bytes_read": 0, "bytes_written": 0, "gb_per_s": gb_per_s, key: per_s,
        })
    };
    let write = |file: &str, rows: &[Value]| {
        let lines: String = rows.iter().map(|row| format!("{row}\n")).collect();
        std::fs::write(program.path(file), lines).unwrap();
    };
    // Reads and writes take turns: a pass takes its bytes at a rate at least.
    let rows = |gb_per_s: f64, triangles_per_s: f64, pixels_per_s: f64| {
        [
            row("read", gb_per_s, "none", 0.0),
            row("write", gb_per_s, "none", 0.0),
            row("shader copy", gb_per_s, "none", 0.0),
            row("triangles", 1.0, "triangles_per_s", triangles_per_s),
            row("fill", 1.0, "pixels_per_s", pixels_per_s),
        ]
    };
    for (gb_per_s, triangles_per_s, pixels_per_s, bound) in
        [(1.0, 1e15, 1e15, "memory"), (1e9, 1e3, 1e15, "triangles"), (1e9, 1e15, 1e3, "fragments")]
    {
        write("rows.jsonl", &rows(gb_per_s, triangles_per_s, pixels_per_s));
        let report = program.run(&timed(&counted)).fine().json();
        let read: RunReport = serde_json::from_value(report.clone()).unwrap();
        assert_eq!(read.json(), report);
        let mut bounds = Vec::new();
        for pass in report["passes"].as_array().unwrap() {
            if !pass["where"].is_null() {
                assert!(pass["share"].is_null(), "{pass}");
                continue;
            }
            let number = |value: &Value| value.as_f64().unwrap();
            let count = |name: &str| number(&pass["statistics"][name]);
            // What the pass cannot tell of its bytes takes no time.
            let bytes = |key: &str| pass[key].as_f64().unwrap_or_default();
            let least = [
                (bytes("bytes_read") + bytes("bytes_written")) / gb_per_s / 1e6,
                1e3 * count("input_assembly_primitives") / triangles_per_s,
                1e3 * count("fragment_shader_invocations") / pixels_per_s,
            ];
            let least_ms = least.iter().copied().fold(0.0, f64::max);
            assert!((number(&pass["least_ms"]) - least_ms).abs() <= 1e-6 * least_ms, "{bound}: {pass}");
            let share = least_ms / number(&pass["ms"]["median"]);
            assert!((number(&pass["share"]) - share).abs() <= 1e-6 * share, "{bound}: {pass}");
            assert_eq!(pass["impossible"], number(&pass["share"]) > 1.1, "{bound}: {pass}");
            bounds.push(pass["bound"].as_str().unwrap().to_owned());
        }
        assert!(bounds.iter().any(|one| one == bound), "{bound}: {bounds:?}");
    }
    // A triangle takes a thousand seconds.
    write("rows.jsonl", &rows(1e9, 1e-3, 1e15));
    let loud: Vec<&str> = timed(&counted).into_iter().filter(|word| !["--quiet", "--json"].contains(word)).collect();
    let said = program.run(&loud).fine().out;
    assert!(said.contains(" % by triangles, impossible") && said.contains("  %: the least time"), "{said}");
    let frames = [&counted[..], &["--frames", "0..1"]].concat();
    let sequence = program.run(&timed(&frames)).fine().json();
    let has_share = |frame: &Value| frame["passes"].as_array().unwrap().iter().any(|pass| pass["share"].is_f64());
    assert!(sequence["frames"].as_array().unwrap().iter().all(has_share), "{sequence}");

    let whole = rows(1.0, 1.0, 1.0);
    write("lacking.jsonl", &whole[1..]);
    write("none.jsonl", &[]);
    write("bad.jsonl", &[whole[0].clone(), json!({ "work": "read" })]);
    let mut other = whole.clone();
    other.iter_mut().for_each(|row| row["device"]["name"] = "another".into());
    write("other.jsonl", &other);
    for (file, words) in [
        ("lacking.jsonl", &["lacking.jsonl", "`read`"][..]),
        ("none.jsonl", &["none.jsonl", "no rows"]),
        ("bad.jsonl", &["bad.jsonl:2: it is no row of `bench device`", "bench device --json"]),
        ("other.jsonl", &["--device-rows: this device is", "of another"]),
        ("nowhere.jsonl", &["nowhere.jsonl"]),
    ] {
        program.fails(&timed(&["--profile", "--device-rows", file]), 2, words);
    }
    program.fails(&timed(&["--device-rows", "rows.jsonl"]), 2, &["--device-rows", "--profile"]);
}
