//! What benchmarks time of techniques: that each stage is there, that its work is counted, and that src/bench/ itself
//! knows no technique.

use crate::support::benched::lines;
use crate::support::program::Program;
use proc_macro2::{TokenStream, TokenTree};
use quincunx::gpu::DeviceRequest;
use quincunx::gpu::commands::Submits;
use quincunx::job::Job;
use quincunx::session::Session;
use quincunx::techniques::bench_stage::BenchStage;
use quincunx::techniques::{ALL, Technique, settings_of};
use quincunx::volume::{self, VolumeRequest};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Full names of the passes of a small frame of `technique` with these settings.
fn passes(session: &Session, technique: &'static dyn Technique, changes: &[(&str, &str)]) -> Vec<String> {
    let mut job = Job::new("cornell", technique);
    let small = [("size", "33x17"), ("vpls", "16"), ("spp", "2")];
    let known = |key: &str| settings_of(technique).iter().any(|setting| setting.key == key);
    for (key, text) in small.iter().filter(|(key, _)| known(key)).chain(changes) {
        job.set(key, text).unwrap();
    }
    let renderer = session.renderer(technique, &job.values, &[], Submits::PerPass).unwrap();
    renderer.passes().iter().map(|pass| pass.name.clone()).collect()
}

type Changes = &'static [(&'static str, &'static str)];

/// Settings of other methods, whose passes a stage of a technique names too.
const OTHERS: &[(&str, &str, Changes)] = &[
    ("deep_shading", "shade", &[("shade-by", "fragment")]),
    ("deep_shading", "shade", &[("shading", "indirect-gbuffer"), ("shading-rate", "blur"), ("aperture", "0.2")]),
    ("inferred_lighting", "light", &[("volumes", "quad")]),
];

#[test]
fn every_stage_has_the_passes_that_it_names() {
    let scene = Job::new("cornell", ALL[0]).load_scene().unwrap();
    // What slices wants something to slice, and the others do not look at it.
    let volume = volume::open(&VolumeRequest { spec: "marschner-lobb:size=8", raw_size: None, seed: 1 }).unwrap();
    let session = Session::open(&DeviceRequest::default(), scene.holding(&Arc::new(volume))).unwrap();
    for technique in ALL {
        for stage in technique.bench_stages() {
            let what = format!("{} {}", technique.name(), stage.name);
            let own = passes(&session, *technique, stage.made_with);
            assert!(own.iter().any(|pass| stage.has(technique.name(), pass)), "{what}: not among {own:?}");
            let others = OTHERS.iter().filter(|(of, name, _)| (*of, *name) == (technique.name(), stage.name));
            let all: Vec<String> =
                others.flat_map(|(_, _, changes)| passes(&session, *technique, changes)).chain(own).collect();
            for name in stage.passes {
                let alone = BenchStage { passes: std::slice::from_ref(name), ..*stage };
                assert!(all.iter().any(|pass| alone.has(technique.name(), pass)), "{what}: no pass {name}: {all:?}");
            }
        }
    }
}

#[test]
fn a_stages_work_is_counted_in_its_unit() {
    let program = Program::new();
    let deep = ["--technique", "deep_shading", "--spp", "4"];
    for (stage, unit, more) in [
        ("visibility", "ns_per_sample", &deep[..]),
        ("lists", "ns_per_entry", &deep),
        ("shade", "ns_per_invocation", &deep),
        ("light", "ns_per_evaluation", &["--technique", "inferred_lighting"]),
        ("sample", "ns_per_sample", &["--technique", "path_traced", "--spp", "2"]),
    ] {
        let small = ["bench", stage, "cornell", "--size", "32x16", "--repeat", "3", "--json", "--quiet"];
        let rows = lines(&program.run(&[&small[..], more].concat()).fine().out);
        let (row, technique) = (&rows[0], more[1]);
        let passes: Vec<&String> = row["pass_ms"].as_object().unwrap().keys().collect();
        assert!(passes.iter().all(|pass| pass.starts_with(technique)) && !passes.is_empty(), "{row:#}");
        let ns: Vec<&str> =
            row.as_object().unwrap().keys().map(String::as_str).filter(|key| key.starts_with("ns_")).collect();
        assert_eq!(ns, [unit], "{row:#}");
        let (median, each) = (row["stage_ms"]["median"].as_f64().unwrap(), row[unit].as_f64().unwrap());
        let work = 1e6 * median / each;
        assert!((work - work.round()).abs() < 1e-6 * work, "{stage}: {work} is no count");
        // The picture has 512 pixels: four samples each, and a path.
        let expected = match (stage, technique) {
            ("visibility", _) => Some(4.0 * 512.0),
            ("sample", _) => Some(512.0),
            _ => None,
        };
        assert!(expected.is_none_or(|expected| work.round() == expected), "{stage}: {work}");
        // What is counted of a frame that is not timed is what its report counts.
        let counter = match stage {
            "lists" => Some("nodes_written"),
            "shade" => Some("shader_invocations"),
            "light" => Some("light_evaluations"),
            _ => None,
        };
        if let Some(counter) = counter {
            let render = ["render", "cornell", "--size", "32x16", "--json", "-o", "a.png"];
            let report = program.run(&[&render[..], more].concat()).fine().json();
            let reported = report["counters"][counter].as_f64().unwrap();
            // Two threads that find a list without their triangle at once may write a node that goes into no list.
            let chance = if stage == "lists" { 0.05 * reported } else { 0.0 };
            assert!((reported - work.round()).abs() <= chance, "{stage}: {reported}, {work}");
        }
        assert_eq!(row["skipped"], Value::Null);
    }
}

#[test]
fn a_stage_that_settings_leave_out_says_why() {
    let program = Program::new();
    let small = ["cornell", "--size", "33x17", "--repeat", "1"];
    for (stage, more, words) in [
        ("lists", &["--technique", "deep_shading", "--lists", "none"][..], &["--lists none makes no lists"][..]),
        ("shade", &["--technique", "deep_shading", "--shading", "ssaa"], &["--shading ssaa", "`bench draw`"]),
        ("cull", &["--technique", "deferred"], &["deferred has no pass deferred.cull", "--cull tiled makes it"]),
        ("visibility", &["--technique", "forward"], &["forward has no stage visibility", "depth, shade, shadow-maps"]),
    ] {
        program.fails(&[&["bench", stage], &small[..], more].concat(), 2, words);
    }
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { files(&path, found) } else { found.push(path) }
    }
}

/// The code of a file: no comments, and no tests, which stand at its end.
fn code(text: &str) -> String {
    let code = text.split("#[cfg(test)]").next().unwrap();
    code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// Texts between quotes.
fn literals(code: &str) -> Vec<String> {
    fn walk(tokens: TokenStream, found: &mut Vec<String>) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => walk(group.stream(), found),
                TokenTree::Literal(literal) => {
                    let text = syn::parse_str::<syn::LitStr>(&literal.to_string()).map(|text| text.value());
                    found.extend(text);
                }
                _ => {}
            }
        }
    }
    let mut found = Vec::new();
    walk(code.parse().unwrap_or_else(|error| panic!("{error}: {code}")), &mut found);
    found
}

/// Words of settings' letters.
fn words(text: &str) -> BTreeSet<&str> {
    text.split(|letter: char| !letter.is_ascii_alphanumeric() && !"-_=".contains(letter)).collect()
}

/// Passes of techniques as their shaders name them: the first word below the technique.
fn shader_passes() -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl/techniques");
    let mut shaders = Vec::new();
    files(&root, &mut shaders);
    let pass = |path: &PathBuf| {
        let below: Vec<_> =
            path.strip_prefix(&root).unwrap().with_extension("").iter().map(|part| part.to_owned()).collect();
        Some(below.get(1)?.to_str()?.to_owned())
    };
    // The others are included.
    shaders.retain(|path| path.extension().is_some_and(|extension| extension != "glsl"));
    shaders.iter().filter_map(pass).collect()
}

/// Names of what one technique alone has, which `code` has in it.
fn particulars(code: &str) -> Vec<String> {
    let mut readers: BTreeMap<&str, usize> = BTreeMap::new();
    for setting in ALL.iter().flat_map(|technique| settings_of(*technique)) {
        *readers.entry(setting.key).or_default() += 1;
    }
    let texts = literals(code);
    let of_one = readers.into_iter().filter(|(_, count)| *count == 1).map(|(key, _)| key);
    let settings = of_one.filter(|key| {
        let flag = format!("--{key}");
        let is_named = |literal: &String| {
            literal == key
                || words(literal)
                    .into_iter()
                    .any(|word| word == flag || word.split('=').next() == Some(key) && word.contains('='))
        };
        texts.iter().any(is_named)
    });
    let techniques = ALL.iter().map(|technique| technique.name()).filter(|name| {
        code.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').any(|word| word == *name)
    });
    let passes: BTreeSet<String> = shader_passes();
    let passes = passes.into_iter().filter(|pass| texts.contains(pass));
    settings.chain(techniques).map(str::to_owned).chain(passes).collect()
}

/// Words that benchmarks have of their own: `bench rays`, a row's `baseline`.
const OTHER_MEANINGS: &[&str] = &["rays", "baseline"];

#[test]
fn the_benchmarks_know_no_technique() {
    let mut found = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src/bench"), &mut found);
    assert!(found.len() > 20, "{found:?}");
    for path in found {
        let named = particulars(&code(&std::fs::read_to_string(&path).unwrap()));
        let named: Vec<String> = named.into_iter().filter(|name| !OTHER_MEANINGS.contains(&name.as_str())).collect();
        assert!(named.is_empty(), "{} names {named:?}", path.display());
    }
    for planted in [
        "let values = changed(job, values, [(\"split\", \"none\")]);",
        "Error::request(\"--pattern 1x1 copies nothing\")",
        "format!(\"fuse=on\")",
        "name.ends_with(\"composite\")",
        "vec![\"mask\"]",
        "use crate::techniques::interleaved_deferred;",
        "passes.contains(\"discontinuity\")",
    ] {
        assert!(!particulars(&code(planted)).is_empty(), "{planted}");
    }
    assert!(particulars(&code("// --split none\nlet split = 1;\n#[cfg(test)]\nmod tests { \"split\" }")).is_empty());
}
