//! `tune` and presets: what is chosen is near enough, is what a render of the preset makes, and is said with its reasons.

use crate::support::program::Program;
use serde_json::Value;

const SMALL: [&str; 6] = ["cornell", "--size", "64x48", "--vpls", "16", "--quiet"];

fn read(program: &Program, name: &str) -> String {
    std::fs::read_to_string(program.path(name)).unwrap()
}

fn json(program: &Program, name: &str) -> Value {
    serde_json::from_str(&read(program, name)).unwrap()
}

/// The error of one picture against another, by `compare`.
fn flip(program: &Program, picture: &str, reference: &str) -> f64 {
    let ran = program.run(&["compare", picture, reference, "--json", "--quiet"]).fine();
    let found: Value = serde_json::from_str(&ran.out).unwrap();
    found["metrics"]["flip"].as_f64().unwrap_or_else(|| panic!("{}", ran.out))
}

#[test]
fn what_is_chosen_is_near_enough_and_a_render_of_the_preset_has_it() {
    let program = Program::new();
    let render = |name: &str, more: &[&str]| {
        let words =
            [&["render"][..], &SMALL, more, &["-o", &format!("{name}.exr"), "--report", &format!("{name}.json")]];
        program.run(&words.concat()).fine();
    };
    for (name, split, pattern) in [("plain", "none", "4x4"), ("small", "one-pass", "2x2"), ("large", "one-pass", "4x4")]
    {
        let more = if split == "none" { vec!["--split", "none"] } else { vec!["--split", split, "--pattern", pattern] };
        render(name, &more);
    }
    let [small, large] = ["small.exr", "large.exr"].map(|picture| flip(&program, picture, "plain.exr"));
    assert!(small < large, "{small} {large}: a smaller pattern has more lights a pixel");
    let bound = format!("flip={}", (small + large) / 2.0);
    let axes = ["split=one-pass,two-pass", "block=8,32", "pattern=2x2,4x4", "texels=1,4"];
    let axes = axes.iter().flat_map(|axis| ["--sweep", *axis]);
    let words: Vec<&str> = ["tune"].into_iter().chain(SMALL).chain(axes).collect();
    let words = [&words[..], &["--error-below", &bound, "--repeat", "3", "-o", "out"]].concat();
    program.run(&words).fine();
    let found = json(&program, "out/tune.json");
    let counts = &found["counts"];
    // Blocks are read with two passes alone: (1 + 2) x 2 patterns x 2 numbers of texels; half of them are too far off.
    let counted = ["combinations", "candidates", "pictures", "near_pictures", "near_candidates"]
        .map(|key| counts[key].as_u64().unwrap());
    assert_eq!(counted, [16, 12, 4, 2, 6]);
    for picture in found["pictures"].as_array().unwrap() {
        let is_small = picture["settings"].as_str().unwrap().contains("pattern=2x2");
        assert_eq!(picture["near"], is_small, "{picture}");
        let own = picture["errors"]["flip"].as_f64().unwrap();
        assert!((own - if is_small { small } else { large }).abs() < 1e-6, "{picture}: {small} {large}");
    }
    let chosen = found["chosen"]["settings"].as_object().unwrap();
    assert_eq!(chosen["pattern"], "2x2", "{chosen:?}");
    // Whatever differs from it in one setting stands beside it, with a verdict.
    let beside: Vec<(&str, &str)> = found["beside"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| (row["changed"].as_str().unwrap(), row["verdict"].as_str().unwrap()))
        .collect();
    assert!(beside.contains(&("pattern=4x4", "too far off")), "{beside:?}");
    assert_eq!(beside.iter().filter(|(_, verdict)| *verdict == "chosen").count(), 1, "{beside:?}");
    let rows = read(&program, "out/rows.jsonl");
    assert!(rows.lines().count() >= beside.len(), "{rows}");
    // A render of the preset is the chosen one.
    render("preset", &["--preset", "out/preset.toml"]);
    let typed: Vec<String> = chosen
        .iter()
        .flat_map(|(key, value)| [format!("--{key}"), value.to_string().trim_matches('"').to_owned()])
        .collect();
    render("typed", &typed.iter().map(String::as_str).collect::<Vec<_>>());
    let (report, typed) = (json(&program, "preset.json"), json(&program, "typed.json"));
    assert_eq!((&report["settings"], &report["image"]["hash"]), (&typed["settings"], &typed["image"]["hash"]));
    assert_eq!(report["presets"], serde_json::json!(["out/preset.toml"]));
    assert!((flip(&program, "preset.exr", "plain.exr") - small).abs() < 1e-6);
    // What was there stays unless it may be replaced.
    program.fails(&words, 2, &["rows.jsonl", "--force"]);
}

#[test]
fn where_no_picture_is_near_enough_the_nearest_is_named() {
    let program = Program::new();
    let tune = |axes: &str, bound: &str| {
        let words = [&["tune"][..], &SMALL, &["--sweep", axes, "--error-below", bound, "--repeat", "3", "--json"]];
        program.run(&words.concat())
    };
    let ran = tune("pattern=2x2,4x4", "flip=0.000001");
    assert_eq!(ran.code, 2);
    for word in ["none of the 2 pictures is near enough", "the nearest is that of pattern=2x2: flip 0."] {
        assert!(ran.err.contains(word), "{}", ran.err);
    }
    // The plain form is as near as can be.
    let found: Value = serde_json::from_str(&tune("split=none,one-pass", "flip=0.000001").fine().out).unwrap();
    assert_eq!(found["chosen"]["settings"], serde_json::json!({"split": "none"}));
    assert_eq!(found["chosen"]["errors"]["flip"], 0.0);
    // What was asked for, in other words.
    let found: Value = serde_json::from_str(&tune("texels=auto", "flip=1").fine().out).unwrap();
    let verdicts: Vec<_> =
        found["beside"].as_array().unwrap().iter().map(|row| row["verdict"].as_str().unwrap()).collect();
    assert_eq!(verdicts, ["the same settings", "chosen"]);
}

#[test]
fn a_search_that_cannot_be_is_refused() {
    let program = Program::new();
    let with = |more: &[&'static str]| [&["tune"][..], &SMALL, more].concat();
    for (more, words) in [
        (&["--error-below", "ssim=0.9"][..], &["ssim is greater where pictures are nearer", "rmse"][..]),
        (&["--error-below", "flip"], &["--error-below flip", "no ="]),
        (&["--error-below", "flip=0.1", "--sweep", "blocks=3"], &["--sweep blocks=", "no setting", "--block"]),
        (
            &["--error-below", "flip=0.1", "--sweep", "zmax=on,off"],
            &["--sweep zmax=: interleaved_deferred does not read it"],
        ),
        (&["--error-below", "flip=0.1", "--sweep", "kernel=98,99"], &["none of the 2 combinations is possible"]),
        (&["--error-below", "flip=0.1", "--sweep", "block=8,16"], &["block", "it has no blocks"]),
        (&["--error-below", "flip=0.1", "--search-time", "5"], &["--search-time", "s, m or h"]),
    ] {
        let ran = program.run(&with(more));
        assert_eq!(ran.code, 2, "{more:?}: {}", ran.err);
        assert!(words.iter().all(|word| ran.err.contains(word)), "{more:?}: {}", ran.err);
    }
    program.fails(
        &["tune", "cornell", "--technique", "deferred", "--error-below", "flip=0.1"],
        2,
        &["deferred has no plain form", "--reference auto"],
    );
}

#[test]
fn presets_are_for_every_verb_and_what_is_typed_comes_first() {
    let program = Program::new();
    let write = |name: &str, text: &str| std::fs::write(program.path(name), text).unwrap();
    write(
        "preset.toml",
        "technique = \"interleaved_deferred\"\n[settings]\nsplit = \"two-pass\"\nblock = 8\nzmax = \"on\"\n",
    );
    write("defaults.toml", "[settings]\nsize = \"64x48\"\nvpls = 16\nblock = 32\nkernel = 7\n");
    let mine = [("QUINCUNX_DEFAULTS", "defaults.toml")];
    let settings = |more: &[&str]| {
        let words = [&["render", "cornell", "-o", "out.png", "--report", "out.json"][..], more].concat();
        let ran = program.run_with(&words, &mine);
        assert_eq!(ran.code, 0, "{}", ran.err);
        let report = json(&program, "out.json");
        let text = |key: &str| report["settings"][key].to_string();
        (
            ["size", "split", "block", "kernel"].map(|key| text(key).trim_matches('"').to_owned()),
            report["presets"].clone(),
            ran.err,
        )
    };
    let (found, files, said) = settings(&["--preset", "preset.toml"]);
    assert_eq!(found, ["64x48", "two-pass", "8x8", "7"]);
    assert_eq!((files, said.as_str()), (serde_json::json!(["defaults.toml", "preset.toml"]), ""));
    let (found, _, said) = settings(&["--preset", "preset.toml", "--split", "one-pass", "--size", "32x32"]);
    assert_eq!((found[0].as_str(), found[1].as_str(), found[2].as_str()), ("32x32", "one-pass", "16"));
    assert!(
        said.contains("note: passed over of a preset: --block 8 with --split one-pass: it has no blocks"),
        "{said}"
    );
    // A typed value that nothing reads is refused as ever.
    let ran = program.run(&["render", "cornell", "--preset", "preset.toml", "--split", "one-pass", "--block", "8"]);
    assert!(ran.code == 2 && ran.err.contains("--block 8 with --split one-pass"), "{}", ran.err);
    // Other verbs: the rows and bytes of a benchmark and of a plan are those of the preset.
    let bench = ["bench", "frame", "cornell", "--preset", "preset.toml", "--repeat", "1", "--json", "--quiet"];
    let row: Value = serde_json::from_str(&program.run_with(&bench, &mine).fine().out).unwrap();
    assert_eq!((&row["settings"]["block"], &row["settings"]["size"]), (&"8x8".into(), &"64x48".into()));
    let command: Vec<String> = serde_json::from_value(row["command"].clone()).unwrap();
    assert!(command.join(" ").contains("--block 8 --kernel 7 --size 64x48 --split two-pass"), "{command:?}");
    let plan = |more: &[&str]| {
        program.run(&[&["memory", "cornell", "--plan", "--size", "64x48", "--json"][..], more].concat()).fine().out
    };
    assert_eq!(plan(&["--preset", "preset.toml"]), plan(&["--split", "two-pass", "--block", "8"]));
    assert_ne!(plan(&["--preset", "preset.toml"]), plan(&[]));
    write("preset.toml", "[settings]\nblocks = 8\n");
    program.fails(&["render", "cornell", "--preset", "preset.toml"], 2, &["preset.toml", "no setting blocks"]);
    program.fails(&["render", "cornell", "--preset", "nowhere.toml"], 2, &["nowhere.toml"]);
}
