//! `reproduce` from outside: what is listed, what is found, what is taken from an earlier run, what fails. Never how long
//! anything takes.

pub mod page;

use crate::support::benched::{lines, read};
use crate::support::program::Program;
use serde_json::Value;

fn document(program: &Program, name: &str) -> Value {
    serde_json::from_str(&read(program, name)).unwrap()
}

/// The cell of a row and a column of one of an item's tables.
#[track_caller]
fn cell<'a>(result: &'a Value, table: usize, row: &str, column: &str) -> &'a Value {
    let cells = result["tables"][table]["cells"].as_array().unwrap();
    let found = cells.iter().find(|cell| cell["row"] == row && cell["column"] == column);
    found.unwrap_or_else(|| panic!("there is no {row}, {column}: {cells:#?}"))
}

#[test]
fn the_list_has_every_paper_with_its_numbers_and_verdicts() {
    let program = Program::new();
    let text = program.run(&["reproduce", "--list"]).fine().out;
    for paper in ["keller-2001", "segovia-2006", "kircher-2009", "dubla-2009", "clarberg-2014"] {
        assert!(text.lines().any(|line| line.starts_with(&format!("{paper}  "))), "{text}");
    }
    for verdict in ["comparable", "shape only", "not here"] {
        assert!(text.contains(verdict), "{text}");
    }
    let list: Value = serde_json::from_str(&program.run(&["reproduce", "--list", "--json"]).fine().out).unwrap();
    let items = list["items"].as_array().unwrap();
    let table = items.iter().find(|item| item["paper"] == "segovia-2006" && item["item"] == "table-2").unwrap();
    let published = &table["published"][0];
    assert_eq!((&published["unit"], &published["rows"][2]["row"]), (&Value::from("ms"), &Value::from("17x17")));
    assert_eq!(published["rows"][2]["numbers"], serde_json::json!([51.8, 32.7]));
    // One paper alone.
    let one: Value =
        serde_json::from_str(&program.run(&["reproduce", "keller-2001", "--list", "--json"]).fine().out).unwrap();
    assert!(one["items"].as_array().unwrap().iter().all(|item| item["paper"] == "keller-2001"));
    assert_eq!(program.files(), [] as [&str; 0]);
}

/// Buffers come to the digits that the paper prints: 1280 x 720 pixels of 8 samples, with 8 bytes of SPID and 4 of depth a sample are
/// 84.375 MiB.
#[test]
fn buffers_of_deep_shading_come_out_as_published() {
    let program = Program::new();
    let ran = program.run(&["reproduce", "clarberg-2014/memory", "--only", "plan,rivals", "--quiet", "-o", "out"]);
    assert_eq!(ran.fine().out, "");
    let result = document(&program, "out/clarberg-2014/memory/result.json");
    assert_eq!((&result["verdict"], &result["device"]), (&Value::from("comparable"), &Value::Null));
    let frame_buffer = &cell(&result, 0, "frame buffer", "allocated")["ours"]["value"];
    assert_eq!(frame_buffer.as_f64().unwrap(), 1280.0 * 720.0 * 8.0 * 12.0 / 1_048_576.0);
    for row in
        ["frame buffer", "deep shading buffer", "auxiliary buffers", "one of Andersson's textures", "eight of them"]
    {
        let cell = cell(&result, 0, row, "allocated");
        let (ours, published) = (cell["ours"]["value"].as_f64().unwrap(), cell["published"].as_f64().unwrap());
        assert!((ours - published).abs() < 0.0501, "{row}: {ours}, published {published}");
        assert!((cell["ratio"]["value"].as_f64().unwrap() - ours / published).abs() < 1e-12);
    }
    // What was not asked for has no number, and is no failure.
    let accessed = cell(&result, 1, "1.5 executions a pixel", "accessed");
    assert!(accessed["ours"].is_null() && accessed["missing"].is_null(), "{accessed}");
    let text = read(&program, "out/clarberg-2014/memory/result.md");
    assert!(text.contains("| frame buffer ") && text.contains("84.38") && text.contains("**comparable.**"), "{text}");
}

/// Moments of a film are frames of one step, at the times at which pictures of their own would be.
#[test]
fn rates_along_a_flight_are_those_of_its_moments() {
    let program = Program::new();
    let asked =
        ["reproduce", "clarberg-2014/figure-6", "--quick", "--frames", "2", "--only", "2d-0", "--quiet", "-o", "out"];
    program.run(&asked).fine();
    let result = document(&program, "out/clarberg-2014/figure-6/result.json");
    let [least, mean, greatest] = ["least", "mean", "greatest"]
        .map(|column| cell(&result, 0, "still", column)["ours"]["value"].as_f64().unwrap());
    let command = read(&program, "out/clarberg-2014/figure-6/2d-0.command");
    let words =
        command.lines().skip_while(|line| *line != "render").filter(|line| *line != "--frames").collect::<Vec<_>>();
    let rate = |time: &str| {
        let mut words = words.clone();
        let range = words.iter().position(|word| *word == "0..1").expect("two frames");
        words[range] = "--time";
        words.insert(range + 1, time);
        let fps = words.iter().position(|word| *word == "--fps").unwrap();
        words.drain(fps..fps + 2);
        let report = words.iter().position(|word| *word == "--report").unwrap() + 1;
        words[report] = "one.json";
        words.push("--quiet");
        program.run(&words).fine();
        document(&program, "one.json")["counters"]["shaded_per_pixel"].as_f64().unwrap()
    };
    let [at_start, half_way] = ["0", "30"].map(rate);
    assert_ne!(at_start, half_way);
    assert_eq!((least, greatest), (at_start.min(half_way), at_start.max(half_way)));
    assert!((mean - 0.5 * (at_start + half_way)).abs() < 1e-12, "{mean} of {at_start} and {half_way}");
}

/// A table with rows: parts are those of the rows' own ratios, and what is there is not measured again.
#[test]
fn a_table_is_measured_once_and_goes_on_where_it_was_torn() {
    let program = Program::new();
    let command =
        ["reproduce", "segovia-2006/section-5.4", "--scene", "cornell", "--size", "48x32", "--quick", "-o", "out"];
    let ran = program.run(&command);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.out.contains("# segovia-2006/section-5.4") && ran.out.contains("| 17x17 "), "{}", ran.out);
    assert!(ran.err.contains("step 1 of 2: quincunx bench filter cornell --size 48x32"), "{}", ran.err);
    let folder = "out/segovia-2006/section-5.4/cornell";
    let result = document(&program, &format!("{folder}/result.json"));
    let rows = lines(&read(&program, &format!("{folder}/17/rows.jsonl")));
    let row = rows.iter().find(|row| row["variant"] == "walk-end=branch").unwrap();
    let cell = cell(&result, 0, "17x17", "branch");
    assert_eq!(cell["ours"]["value"], row["stage_ms"]["median"]);
    assert_eq!(cell["our_part"]["value"], row["ratio"]["mean"]);
    assert_eq!(cell["our_part"]["bounds"], row["ratio"]["interval_95"]);
    assert_eq!((&result["scene"], &result["effort"]), (&Value::from("cornell"), &Value::from("quick")));
    assert_eq!(result["device"]["name"], row["device"]["name"]);
    let steps = result["steps"].as_array().unwrap();
    assert!(steps.iter().all(|step| step["failed"].is_null() && step["command"][0] == "bench"), "{steps:#?}");

    // Nothing is missing: files stay as they are.
    let file = format!("{folder}/17/rows.jsonl");
    let whole = read(&program, &file);
    program.run(&command);
    assert_eq!(read(&program, &file), whole);

    // Killed in the second row of the second step: the first row stays.
    std::fs::write(program.path(&file), &whole[..whole.len() - 20]).unwrap();
    std::fs::remove_file(program.path(&format!("{folder}/17/summary.json"))).unwrap();
    assert_eq!(program.run(&command).code, 0);
    let resumed = read(&program, &file);
    let first = whole.lines().next().unwrap();
    assert!(resumed.starts_with(first) && resumed != whole && lines(&resumed).len() == 2, "{resumed}");

    // Another setting is another measurement.
    let other: Vec<&str> = command.iter().map(|word| if *word == "48x32" { "32x32" } else { word }).collect();
    assert_eq!(program.run(&other).code, 0);
    assert_eq!(lines(&read(&program, &file))[0]["settings"]["size"], "32x32");
}

#[test]
fn pictures_are_rendered_compared_and_named() {
    let program = Program::new();
    let command = [
        "reproduce",
        "segovia-2006/figure-6",
        "--scene",
        "cornell",
        "--size",
        "32x32",
        "--vpls",
        "32",
        "--quiet",
        "-o",
        "out",
    ];
    program.run(&command).fine();
    let folder = "out/segovia-2006/figure-6/cornell";
    let result = document(&program, &format!("{folder}/result.json"));
    let pictures = result["pictures"].as_array().unwrap();
    // Four, and a close-up of each, its pixels enlarged.
    assert_eq!(pictures.len(), 8);
    for (index, picture) in pictures.iter().enumerate() {
        let file = program.folder.path().join(folder).join(picture["file"].as_str().unwrap());
        let shown = image::open(file).unwrap().into_rgba8();
        assert_eq!(shown.height() > 32, index >= 4, "{picture}");
        assert_eq!(shown.get_pixel(0, 0), shown.get_pixel(u32::from(index >= 4), 0), "{picture}");
    }
    // The filter is what takes the pattern away.
    let rmse = |row: &str| cell(&result, 0, row, "rmse")["ours"]["value"].as_f64().unwrap();
    let [unfiltered, filtered] =
        ["(c) 4x4 interleaving without a filter", "(d) 4x4 interleaving with the filter"].map(rmse);
    assert!(0.0 < filtered && filtered < unfiltered, "{filtered} {unfiltered}");
}

#[test]
fn a_command_that_fails_leaves_its_reason_and_the_others_run() {
    let program = Program::new();
    let file = program.path("broken.glb");
    std::fs::write(&file, "nothing").unwrap();
    let command = ["reproduce", "segovia-2006/section-5.4", "--scene", &file, "--quick", "--quiet", "-o", "out"];
    let ran = program.run(&command);
    assert_eq!((ran.code, ran.out.as_str()), (2, ""));
    assert!(ran.err.contains("step 5: ") && ran.err.contains("broken.glb"), "{}", ran.err);
    let result = document(&program, "out/segovia-2006/section-5.4/broken/result.json");
    for step in result["steps"].as_array().unwrap() {
        assert!(step["failed"].as_str().unwrap().contains("broken.glb") && step["exit_code"] == 2, "{step}");
    }
    assert!(cell(&result, 0, "5x5", "flag")["missing"].as_str().unwrap().contains("broken.glb"));
    // The reason is not the result: where the file is mended, the same command works.
    let report = program.run(&[
        "reproduce",
        "clarberg-2014/memory",
        "--only",
        "plan",
        "--min-ratio",
        "1.5",
        "--quiet",
        "-o",
        "out",
    ]);
    assert_eq!(report.code, 1);
    assert!(report.err.contains("--min-ratio 1.5: 5 ratios are less"), "{}", report.err);
    // A gate without a number is none.
    let without = program.run(&["reproduce", "dubla-2009/figure-6", "--only", "nothing", "--min-ratio", "nan"]);
    assert!(without.code == 2 && without.err.contains("it must be a number"), "{}", without.err);
    let plan = ["reproduce", "kircher-2009/bytes", "--min-ratio", "1", "--quiet", "-o", "out"];
    program.fails(&plan, 1, &["--min-ratio 1: it has no ratio"]);
}

#[test]
fn what_cannot_be_asked_is_refused_before_anything_is_written() {
    let program = Program::new();
    for (arguments, words) in [
        (&[][..], &["--list or --all"][..]),
        (&["segovia-2006/table-9"], &["no item table-9", "table-1, table-2"]),
        (&["segovia-1906/table-1"], &["no paper segovia-1906", "keller-2001"]),
        (&["segovia-2006/figure-4"], &["cannot be made here", "drawing"]),
        (&["segovia-2006/table-1", "--split", "none"], &["--split", "measures several of it", "4x4"]),
        (&["segovia-2006/table-1", "--aperture", "1"], &["--aperture", "no command of segovia-2006/table-1 reads it"]),
        (&["segovia-2006/table-1", "--frames", "9"], &["--frames 9", "is of no film"]),
        (&["clarberg-2014/table-1", "--repeat", "9"], &["--repeat 9", "measures no times"]),
        (&["segovia-2006/table-1", "--only", "8x8"], &["--only 8x8", "there are the steps 4x4, 2x2"]),
    ] {
        program.fails(&[&["reproduce"], arguments].concat(), 2, words);
    }
    assert_eq!(program.files(), [] as [&str; 0]);
    // Where a folder cannot be made.
    std::fs::write(program.path("out"), "a file").unwrap();
    program.fails(&["reproduce", "segovia-2006/section-5.4", "-o", "out"], 2, &["-o out/segovia-2006/section-5.4"]);
}
