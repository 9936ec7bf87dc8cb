//! `quincunx sampling` from outside: what it lists, the numbers and files that it makes, and what it refuses.

use crate::support::program::Program;
use quincunx::picture::image_file;
use quincunx::sampling::pattern::{Dimension, Pattern, Sample};
use quincunx::sampling::periodogram::Periodogram;
use quincunx::techniques;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;

fn page() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/sampling.md")).unwrap()
}

/// Code of the first cells of the table under a heading of the page.
fn first_cells(heading: &str) -> BTreeSet<String> {
    let page = page();
    let section = page.split(&format!("\n## {heading}\n")).nth(1).unwrap().split("\n## ").next().unwrap();
    let cells = section.lines().filter_map(|line| line.strip_prefix("| `")?.split(" | ").next());
    cells.flat_map(|cell| cell.split(", ").map(|word| word.replace('`', ""))).collect()
}

#[test]
fn every_command_of_the_page_runs() {
    let program = Program::new();
    let page = page();
    let commands: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("    quincunx ")).collect();
    assert!(commands.len() >= 7, "{commands:?}");
    for command in commands {
        program.run(&command.split(' ').collect::<Vec<_>>()).fine();
    }
    let files =
        ["grid-spectrum.png", "grid.png", "spectrum.exr", "subset.csv", "tuples.csv", "tuples.json"].map(str::to_owned);
    assert_eq!(program.files(), files);
}

#[test]
fn the_list_has_every_pattern_with_the_settings_that_choose_it() {
    let program = Program::new();
    let text = program.run(&["sampling", "list"]).fine().out;
    let listed = program.run(&["sampling", "list", "--json"]).fine().json();
    let names: BTreeSet<String> =
        listed["patterns"].as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap().to_owned()).collect();
    assert_eq!((listed["schema"].clone(), names), (json!(1), first_cells("Which there are")));
    for pattern in listed["patterns"].as_array().unwrap() {
        let technique = techniques::find(pattern["technique"].as_str().unwrap()).unwrap();
        for setting in pattern["settings"].as_array().unwrap() {
            let (key, default) = (setting["key"].as_str().unwrap(), setting["default"].as_str().unwrap());
            assert_eq!(techniques::defaults(technique).text(key), default);
            assert!(text.contains(&format!("--{key} {default} (")), "{text}");
        }
    }
    assert_eq!(program.run(&["sampling", "list", "--quiet"]).fine().out, "");
}

#[test]
fn inspect_says_what_a_pattern_holds() {
    let program = Program::new();
    let grid = program.run(&["sampling", "inspect", "grid:pattern=8x6", "--json"]).fine().json();
    let expected = json!({
        "schema": 1, "name": "grid", "technique": "interleaved_deferred", "settings": {"pattern": "8x6"},
        "period_px": [8, 6], "samples": 48, "samples_per_pixel": {"least": 1, "most": 1}, "dimensions": ["x", "y"],
        "subsets": 48, "least_distance_px": 1.0, "least_subset_distance_px": 6.0,
        // Samples in the middles of pixels cannot tell a cycle a pixel from an even grey.
        "pixel_frequency": { "across": 1.0, "down": 1.0 },
    });
    assert_eq!(grid, expected);
    let tuples = program.run(&["sampling", "inspect", "tuples:spp=4,tuples=64", "--json"]).fine().json();
    assert_eq!((&tuples["period_px"], &tuples["samples"]), (&json!([4, 4]), &json!(64)));
    assert_eq!(tuples["samples_per_pixel"], json!({"least": 4, "most": 4}));
    assert_eq!(tuples["dimensions"], json!(["x", "y", "time", "lens_u", "lens_v"]));
    assert_eq!((&tuples["subsets"], &tuples["least_subset_distance_px"]), (&json!(64), &json!(4.0)));
    let text = program.run(&["sampling", "inspect", "stipple:stipple=4x4"]).fine().out;
    for words in ["stipple:stipple=4x4", "inferred_lighting", "period: 4x4 px", "16, 1 a pixel", "subset 4.0000 px"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    // The page names each key, and no other.
    let tuples = ["sampling", "inspect", "tuples", "--json", "--spectrum", "tuples.png"];
    let tuples = program.run(&tuples).fine().json();
    let told = first_cells("Numbers");
    let mut written = BTreeSet::new();
    for (key, value) in tuples.as_object().unwrap() {
        match value {
            Value::Array(_) => _ = written.insert(format!("{key}[]")),
            Value::Object(_) if key == "settings" => _ = written.insert("settings.*".to_owned()),
            Value::Object(own) => {
                for (own, value) in own {
                    match value.pointer("/0").and_then(Value::as_object) {
                        Some(entry) => written.extend(entry.keys().map(|inner| format!("{key}.{own}[].{inner}"))),
                        None => _ = written.insert(format!("{key}.{own}")),
                    }
                }
            }
            _ => _ = written.insert(key.clone()),
        }
    }
    assert_eq!(told, written);
}

/// The samples of a file are those of the library, and can be read back exactly.
#[test]
fn exported_samples_are_the_pattern() {
    let program = Program::new();
    let expected = Pattern::nets([2, 2], 2, 9, 0);
    program.run(&["sampling", "export", "tuples:spp=2,seed=9", "-o", "a.csv"]).fine();
    program.run(&["sampling", "export", "tuples:spp=2,seed=9", "-o", "a.json"]).fine();
    let text = std::fs::read_to_string(program.path("a.csv")).unwrap();
    let mut lines = text.lines();
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(columns.iter().map(|column| (*column).to_owned()).collect::<BTreeSet<_>>(), first_cells("Files"));
    let placed = |cells: Vec<f64>| {
        let sample = Sample {
            place_px: [cells[2] as f32, cells[3] as f32],
            subset: cells[4] as u32,
            further: Sample::further(cells[5..8].iter().map(|cell| *cell as f32)),
        };
        ([cells[0] as u32, cells[1] as u32], sample)
    };
    let of_csv: Vec<_> =
        lines.map(|line| placed(line.split(',').map(|cell| cell.parse().unwrap()).collect())).collect();
    let document: Value = serde_json::from_slice(&std::fs::read(program.path("a.json")).unwrap()).unwrap();
    let of_entry = |entry: &Value| placed(columns.iter().map(|column| entry[column].as_f64().unwrap()).collect());
    let of_json: Vec<_> = document["samples"].as_array().unwrap().iter().map(of_entry).collect();
    let dimensions = [Dimension::Time, Dimension::LensU, Dimension::LensV];
    for samples in [of_csv, of_json] {
        assert_eq!(Pattern::new([2, 2], &dimensions, samples), expected);
    }
    assert_eq!(document["pattern"], "tuples:spp=2,tuples=auto,sampler=sobol,seed=9");
    assert_eq!((&document["period_px"], &document["subsets"]), (&json!([2, 2]), &json!(8)));
    program.run(&["sampling", "export", "grid", "--subset", "6", "-o", "b.csv"]).fine();
    let text = std::fs::read_to_string(program.path("b.csv")).unwrap();
    assert_eq!(text, "pixel_x,pixel_y,place_x_px,place_y_px,subset\n2,1,0.5,0.5,6\n");
}

#[test]
fn the_spectrum_is_written_as_it_is_and_drawn() {
    let program = Program::new();
    program.run(&["sampling", "export", "grid:pattern=3x2", "--reach", "2", "-o", "a.exr"]).fine();
    let (picture, texts) = image_file::read_exr_with_texts(Path::new(&program.path("a.exr"))).unwrap();
    let expected = Periodogram::new(&Pattern::grid([3, 2]), [6, 4], |_| true);
    assert_eq!([picture.extent.width, picture.extent.height], expected.size());
    assert_eq!(picture.pixels, expected.powers().iter().map(|power| [*power; 3]).collect::<Vec<_>>());
    assert_eq!((texts["pattern"].as_str(), texts["reach_cycles_per_px"].as_str()), ("grid:pattern=3x2", "2"));
    let same =
        ["sampling", "inspect", "grid:pattern=3x2", "--reach", "2", "--spectrum", "b.exr", "--spectrum", "b.svg"];
    let document = program.run(&[&same[..], &["--json"]].concat()).fine().json();
    assert_eq!(image_file::read_exr_with_texts(Path::new(&program.path("b.exr"))).unwrap(), (picture, texts));
    let told = document["spectrum"]["rings"].as_array().unwrap();
    assert_eq!(told.len(), expected.rings().len());
    for (told, ring) in told.iter().zip(expected.rings()) {
        assert_eq!(
            (&told["cycles_per_px"], &told["frequencies"]),
            (&json!(ring.cycles_per_px), &json!(ring.frequency_count))
        );
        assert!((told["power"].as_f64().unwrap() - ring.power).abs() < 1e-12 * ring.power, "{told}");
    }
    assert!(std::fs::read_to_string(program.path("b.svg")).unwrap().contains("grid:pattern=3x2"));
    let both = ["sampling", "inspect", "grid", "-o", "a.png", "--spectrum", "b.png", "--reach", "1", "--quiet"];
    assert_eq!(program.run(&both).fine().out, "");
    let read = |name: &str| image_file::read(Path::new(&program.path(name))).unwrap();
    // Four pixels of 64 px a side; nine frequencies of 56 px.
    assert_eq!(
        (read("a.png").extent.to_string(), read("b.png").extent.to_string()),
        ("256x256".into(), "504x504".into())
    );
}

#[test]
fn what_cannot_be_is_refused_with_what_can() {
    let program = Program::new();
    let largest = "grid:pattern=64x64";
    for (arguments, words) in [
        (&["inspect", "gird"][..], &["gird", "grid, direct-grid, stipple, tuples"][..]),
        (&["inspect", "grid:pattern=65x1"], &["--pattern 65x1", "1 to 64"]),
        (&["inspect", "grid:size=3"], &["size=3", "grid:pattern=4x4"]),
        (&["inspect", "tuples:spp=3,tuples=4"], &["--tuples 4", "--tuples 6 works"]),
        (&["inspect", "grid", "--subset", "16"], &["--subset 16", "0 to 15"]),
        (&["inspect", "grid", "-o", "a.exr"], &["a.exr", ".png"]),
        (&["inspect", "grid", "--spectrum", "a.txt"], &["a.txt", ".png", ".exr", ".svg"]),
        (&["inspect", "grid", "-o", "a.png", "--spectrum", "nowhere/b.png"], &["nowhere/b.png", "does not exist"]),
        (&["inspect", "grid", "-o", "a.png", "--spectrum", "a.png"], &["a.png", "its own file"]),
        (
            &["inspect", largest, "-o", "a.png", "--spectrum", "b.png", "--reach", "64"],
            &["4096 samples", "--reach 7 works"],
        ),
        (&["inspect", "grid", "--reach", "2"], &["--spectrum"]),
        (&["export", "grid", "-o", "a.txt"], &["a.txt", ".csv or .json", ".exr"]),
        (&["export", "grid", "-o", "nowhere/a.csv"], &["nowhere/a.csv", "does not exist"]),
        (&["export", "grid", "-o", "a.csv", "--reach", "2"], &["--reach", "-o FILE.exr"]),
        (&["export", "grid", "-o", "a.exr", "--reach", "0"], &["--reach", "1..=64"]),
        (&["export", largest, "-o", "a.exr", "--reach", "40"], &["--reach 40", "works"]),
        (&["export", "grid"], &["--output"]),
    ] {
        program.fails(&[&["sampling"], arguments].concat(), 2, words);
    }
}
