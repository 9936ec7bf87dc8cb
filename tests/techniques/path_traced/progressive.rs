//! Pictures that grow by samples: how far off they say they are, when they end, and going on with one from a file.

use crate::support::program::Program;
use crate::support::watched::{Watched, both};
use quincunx::continuation::layers;
use quincunx::metrics;
use quincunx::picture::image_file::{Texts, WriteOptions};
use quincunx::picture::{Picture, image_file};
use quincunx::units::Extent;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::time::{Duration, Instant};

const NAME: &str = "path_traced";
const SMALL: [&str; 6] = ["render", "cornell", "--technique", NAME, "--size", "24x20"];

fn small<'a>(more: &[&'a str]) -> Vec<&'a str> {
    SMALL.iter().chain(more).copied().collect()
}

/// The estimate takes samples for independent; those of a scrambled Sobol sequence are better, the more so the more there
/// are (1.2 to 1.5 here). Fewer than it says are needed, then: never much more.
#[test]
fn the_estimated_error_is_that_against_a_long_picture() {
    let watched = Watched::open("cornell");
    let changes = [("size", "24x24"), ("punctual", "off")];
    let long = watched.picture(NAME, &both(&changes, &[("spp", "2048"), ("seed", "7")]));
    for spp in ["16", "64", "256"] {
        let renderer = watched.render(NAME, &both(&changes, &[("spp", spp)]));
        let estimated = renderer.estimated_error().unwrap().unwrap();
        let compared = metrics::compare(&renderer.picture().unwrap(), &long, metrics::DEFAULT_THRESHOLD).unwrap();
        let actual = compared.metrics.relmse.sqrt();
        let ratio = estimated / actual;
        println!("{spp} samples: {estimated:.5} estimated, {actual:.5} found, ratio {ratio:.3}");
        assert!((0.9..1.8).contains(&ratio), "{spp} samples: {estimated} estimated, {actual} found");
    }
}

#[test]
fn sampling_ends_where_the_error_is_small_enough() {
    let program = Program::new();
    let error_at = |spp: &str| {
        let report = program.run(&small(&["--spp", spp, "--json", "-o", "a.exr"])).fine().json();
        (report["counters"]["estimated_error"].as_f64().unwrap(), report["image"]["hash"].clone())
    };
    let [(before, _), (after, hash)] = ["32", "48"].map(error_at);
    assert!(after < before);
    // Between the errors of two neighbours: it ends at the second.
    let most = format!("{}", 0.5 * (before + after));
    let ran = program.run(&small(&["--until-error", &most, "--json", "-o", "b.exr"])).fine().json();
    assert_eq!((&ran["counters"]["samples"], &ran["image"]["hash"]), (&serde_json::json!(48.0), &hash));
    assert_eq!(ran["counters"]["estimated_error"], after);
    assert_eq!(ran["settings"]["spp"], 65_536, "--spp is the most there may be");
    // What is not reached is said, and is no failure.
    let ran = program.run(&small(&["--until-error", "0.0001", "--spp", "20", "-o", "c.exr"])).fine();
    assert!(ran.out.contains("20 samples a pixel, estimated error 0."), "{}", ran.out);
    assert!(ran.out.contains("note: --until-error 0.0001 is not reached"), "{}", ran.out);
    program.fails(&small(&["--until-error", "1.5"]), 2, &["--until-error 1.5", "0 to 1"]);
    program.fails(
        &["render", "cornell", "--technique", "deferred", "--until-error", "0.1"],
        2,
        &["does not read --until-error"],
    );
}

/// What an EXR of `extent` holds: picture, sums, and texts.
struct Kept {
    pixels: Vec<[f32; 7]>,
    texts: Texts,
}

const EXTENT: Extent = Extent { width: 24, height: 20 };

impl Kept {
    fn read(path: &str) -> Self {
        let channels = ["R", "G", "B", "sums.R", "sums.G", "sums.B", "sums.squares.Y"];
        let (pixels, texts) = image_file::read_exr_channels(Path::new(path), EXTENT, channels).unwrap();
        Self { pixels, texts }
    }

    fn write(&self, path: &str) {
        let pixels = self.pixels.iter().map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        let sums: Vec<[f32; 4]> = self.pixels.iter().map(|pixel| [pixel[3], pixel[4], pixel[5], pixel[6]]).collect();
        let attributes = self.texts.clone().into_iter().collect();
        let options = WriteOptions { aovs: &layers(&sums), attributes, ..WriteOptions::default() };
        image_file::write(Path::new(path), &Picture { extent: EXTENT, pixels }, &options).unwrap();
    }

    fn bits(&self) -> Vec<u32> {
        self.pixels.as_flattened().iter().map(|number| number.to_bits()).collect()
    }
}

/// Every number of the file, sums included: what comes next depends on them.
#[test]
fn going_on_comes_to_the_bits_of_one_run() {
    let program = Program::new();
    program.run(&small(&["--spp", "37", "-o", "whole.exr"])).fine();
    let whole = Kept::read(&program.path("whole.exr"));
    program.run(&small(&["--spp", "1", "-o", "a.exr"])).fine();
    // In steps, into the same file, with settings that do not show in it; a report counts all samples.
    for (spp, more) in [("5", ["--workgroup", "16x2"]), ("20", ["--exposure", "1"]), ("37", ["--tonemap", "aces"])] {
        let more = [&["--spp", spp, "--continue", "a.exr", "-o", "a.exr", "--json"], &more[..]].concat();
        let report = program.run(&small(&more)).fine().json();
        assert_eq!(report["counters"]["samples"].to_string(), format!("{spp}.0"));
    }
    let found = Kept::read(&program.path("a.exr"));
    assert!(found.bits() == whole.bits(), "other bits than one run");
    assert_eq!(found.texts["quincunx.samples"], "37");
    // And with an end by the error: the same end.
    let until = ["--until-error", "0.12", "--json"];
    let expected = program.run(&small(&[&until[..], &["-o", "b.exr"]].concat())).fine().json();
    program.run(&small(&["--spp", "17", "-o", "c.exr"])).fine();
    let found = program.run(&small(&[&until[..], &["--continue", "c.exr", "-o", "c.exr"]].concat())).fine().json();
    assert!(expected["counters"]["samples"].as_f64().unwrap() > 17.0, "{}", expected["counters"]);
    assert_eq!(found["counters"], expected["counters"]);
    assert_eq!(found["image"]["hash"], expected["image"]["hash"]);
}

#[test]
fn another_picture_s_samples_are_refused_with_both_values() {
    let program = Program::new();
    program.run(&small(&["--spp", "8", "-o", "a.exr"])).fine();
    program.run(&small(&["--spp", "8", "-o", "half.exr", "--exr", "half"])).fine();
    program.run(&small(&["--spp", "8", "-o", "a.png"])).fine();
    let refused = |more: &[&str], words: &[&str]| {
        let arguments = small(&[&["--continue", "a.exr", "-o", "b.exr"], more].concat());
        program.fails(&arguments, 2, &[&["--continue"], words].concat());
    };
    refused(&["--spp", "9", "--seed", "2"], &["a.exr: its setting \"seed\" is \"1\", and here it is \"2\""]);
    refused(&["--spp", "9", "--bounces", "3"], &["\"bounces\" is \"16\", and here it is \"3\""]);
    refused(&["--spp", "9", "--camera", "camera"], &["\"camera\" is \"0\""]);
    refused(&["--spp", "8"], &["there are 8 samples a pixel already, and --spp asks for 8 in all"]);
    refused(&["--until-error", "0.9"], &["estimated error is 0.", "after 8 samples", "--until-error 0.9 is reached"]);
    let other = |arguments: &[&str], words: &[&str]| program.fails(arguments, 2, &[&["--continue"], words].concat());
    let end = ["--size", "24x20", "-o", "b.exr", "--continue"];
    let size = ["render", "cornell", "--technique", NAME, "--size", "24x21", "--continue", "a.exr"];
    other(&size, &["a.exr: it is 24x20, where --size is 24x21"]);
    let lamps = [&["render", "lamps:objects=3,lights=3", "--technique", NAME], &end[..], &["a.exr"]].concat();
    other(&lamps, &["its quincunx.scene_hash is"]);
    let deferred = [&["render", "cornell", "--technique", "deferred"], &end[..], &["a.exr"]].concat();
    other(&deferred, &["its quincunx.technique is \"path_traced\", and here it is \"deferred\""]);
    let frames = small(&["--continue", "a.exr", "--frames", "0..1"]);
    assert_eq!(program.run(&frames).code, 2);
    for (file, word) in
        [("half.exr", "no flat part has the channels"), ("a.png", "it is not an EXR"), ("none.exr", "No such")]
    {
        program.fails(&small(&["--continue", file, "--spp", "9"]), 2, &["--continue", file, word]);
    }
}

#[test]
fn nothing_of_a_file_to_go_on_with_is_believed() {
    let program = Program::new();
    program.run(&small(&["--spp", "8", "-o", "a.exr"])).fine();
    let path = program.path("a.exr");
    let bytes = std::fs::read(&path).unwrap();
    let refused = |words: &[&str]| {
        program.fails(
            &small(&["--continue", "a.exr", "--spp", "9", "-o", "b.png"]),
            2,
            &[&["--continue"], words].concat(),
        );
    };
    let changed = |change: &dyn Fn(&mut Kept), words: &[&str]| {
        std::fs::write(&path, &bytes).unwrap();
        let mut kept = Kept::read(&path);
        change(&mut kept);
        kept.write(&path);
        refused(words);
    };
    let text = |name: &'static str, text: &'static str| {
        move |kept: &mut Kept| drop(kept.texts.insert(format!("quincunx.{name}"), text.to_owned()))
    };
    for count in ["0", "9223372036854775808", "18446744073709551616", "-1", "8.0", "", "65537"] {
        changed(&text("samples", count), &["quincunx.samples is", count, "it must be 1 to 65536"]);
    }
    // A count that is possible, and not that of the sums.
    changed(&text("samples", "4"), &["pixel (", "which 4 samples with the sums"]);
    changed(&text("version", "0.0.9"), &["its quincunx.version is \"0.0.9\", and here it is \"0.1.0\""]);
    changed(&text("estimator", "0"), &["its quincunx.estimator is \"0\""]);
    changed(&text("settings", "[["), &["quincunx.settings is not a JSON object"]);
    changed(&text("settings", "{}"), &["is not there, and here it is"]);
    for name in ["samples", "version", "technique", "estimator", "scene_hash", "settings"] {
        let remove = move |kept: &mut Kept| drop(kept.texts.remove(&format!("quincunx.{name}")));
        changed(&remove, &[&format!("there is no quincunx.{name} in its header")]);
    }
    for (channel, number) in [(0, f32::NAN), (3, f32::NAN), (4, f32::INFINITY), (6, f32::NEG_INFINITY), (2, -1.0)] {
        changed(&|kept| kept.pixels[70][channel] = number, &["pixel (22, 2) is"]);
    }
    // Sides by the header alone: two billion pixels of which there are none.
    let place = bytes.windows(17).position(|window| window == b"dataWindow\0box2i\0").unwrap() + 17 + 4 + 8;
    for (x, y) in [(20_000i32, 20_000i32), (i32::MAX, i32::MAX), (-1, -1), (30_000, 30_000)] {
        let mut huge = bytes.clone();
        huge[place..place + 4].copy_from_slice(&x.to_le_bytes());
        huge[place + 4..place + 8].copy_from_slice(&y.to_le_bytes());
        std::fs::write(&path, huge).unwrap();
        refused(&["a.exr"]);
    }
    for length in [0, 100, bytes.len() / 2, bytes.len() - 1] {
        std::fs::write(&path, &bytes[..length]).unwrap();
        refused(&["a.exr"]);
    }
}

/// A sum of samples is a picture at any time.
#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_leaves_the_samples_so_far_with_their_count_and_they_are_gone_on_with() {
    let program = Program::new();
    // Slow drivers take long before the first sample.
    let started = Instant::now();
    program.run(&small(&["--spp", "2", "-o", "first.png"])).fine();
    let wait = (3 * started.elapsed()).max(Duration::from_secs(3));
    let interrupted = |file: &str| {
        let started = Instant::now();
        let arguments = small(&["--spp", "65536", "-o", file, "--report", "a.json"]);
        let (code, said) = program.interrupted(&arguments, || started.elapsed() > wait);
        assert_eq!(code, Some(130), "{said}");
        let report: serde_json::Value =
            serde_json::from_slice(&std::fs::read(program.path("a.json")).unwrap()).expect("a report");
        let samples = report["counters"]["samples"].as_f64().unwrap() as u32;
        assert!((2..65_536).contains(&samples), "{samples}");
        let expected =
            format!("error: interrupted after {samples} of 65536 samples a pixel; {file} is the picture so far");
        assert!(said.starts_with(&expected), "{said}");
        samples
    };
    let samples = interrupted("a.png");
    let file = BufReader::new(File::open(program.path("a.png")).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    let chunks = reader.info().utf8_text.iter();
    let texts: Texts = chunks.map(|chunk| (chunk.keyword.clone(), chunk.get_text().unwrap())).collect();
    assert_eq!(texts["quincunx.samples"], samples.to_string());
    assert!(texts["quincunx.settings"].contains("\"bounces\":16"), "{texts:?}");

    let samples = interrupted("a.exr");
    assert_eq!(Kept::read(&program.path("a.exr")).texts["quincunx.samples"], samples.to_string());
    let more = (samples + 3).to_string();
    program.run(&small(&["--spp", &more, "--continue", "a.exr", "-o", "a.exr"])).fine();
    program.run(&small(&["--spp", &more, "-o", "whole.exr"])).fine();
    let [found, whole] = ["a.exr", "whole.exr"].map(|file| Kept::read(&program.path(file)).bits());
    assert!(found == whole, "other bits than one run of {more} samples");
}
