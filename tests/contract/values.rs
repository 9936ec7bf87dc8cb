//! What the numbers of a report mean, by arithmetic of its own: each is made again from the picture, the scene, the request
//! or the other numbers (docs/report.md).

use crate::support::known_driver;
use crate::support::program::Program;
use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
use quincunx::picture::image_file;
use quincunx::{scene, techniques};
use serde_json::Value;
use std::collections::BTreeMap;

/// Odd: rows and patterns are padded.
const WIDTH: u64 = 33;
const HEIGHT: u64 = 17;
const PIXELS: u64 = WIDTH * HEIGHT;
/// Neither square nor a divisor of either side.
const PATTERN: [u64; 2] = [4, 2];
const INTERLEAVED: &str = "interleaved_deferred";
const LAMPS: &str = "lamps:objects=10,lights=20";
const LAMP_COUNT: u64 = 20;

fn command<'a>(verb: &[&'a str], scene: &'a str, technique: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    // A frame in which every light is summed reads no pattern.
    let is_even = more.windows(2).any(|pair| pair == ["--split", "none"]);
    let own: &[&str] = match technique == INTERLEAVED {
        true if is_even => &["--vpls", "32"],
        true => &["--vpls", "32", "--pattern", "4x2"],
        false => &[],
    };
    [verb, &[scene, "--technique", technique, "--size", "33x17"], own, more].concat()
}

/// The report of a picture that goes into a.exr.
fn render(program: &Program, scene: &str, technique: &str, more: &[&str]) -> Value {
    let more = [more, &["-o", "a.exr", "--json"]].concat();
    program.run(&command(&["render"], scene, technique, &more)).fine().json()
}

#[track_caller]
fn count(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("no count: {value}"))
}

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

#[track_caller]
fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_else(|| panic!("no text: {value}"))
}

#[track_caller]
fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("no list: {value}"))
}

fn hash(words: impl IntoIterator<Item = [u8; 4]>) -> String {
    let bytes: Vec<u8> = words.into_iter().flatten().collect();
    blake3::hash(&bytes).to_hex().to_string()
}

#[test]
fn the_image_is_the_file() {
    let program = Program::new();
    let stages = "gbuffer.normal,gbuffer.color.id,split.normal,discontinuity.flags,filter.irradiance";
    let report = render(&program, "cornell", INTERLEAVED, &["--aov", stages]);
    let (image, file) = (&report["image"], program.path("a.exr"));
    assert_eq!((count(&image["width"]), count(&image["height"]), text(&image["path"])), (WIDTH, HEIGHT, "a.exr"));
    let picture = image_file::read(file.as_ref()).unwrap();
    assert_eq!((picture.extent.width, picture.extent.height), (WIDTH as u32, HEIGHT as u32));
    for channel in 0..3 {
        let sum: f64 = picture.pixels.iter().map(|pixel| f64::from(pixel[channel])).sum();
        let (mean, reported) = (sum / PIXELS as f64, number(&image["mean"][channel]));
        assert!(mean > 0.0 && (mean - reported).abs() < 1e-12, "channel {channel}: {reported} for {mean}");
    }
    assert_eq!(list(&image["mean"]).len(), 3);
    let sides = [WIDTH as u32, HEIGHT as u32].map(u32::to_le_bytes);
    let channels = picture.pixels.iter().flatten().map(|channel| (channel + 0.0).to_le_bytes());
    assert_eq!(text(&image["hash"]), hash(sides.into_iter().chain(channels)));

    // A layer's channels, as the file has them.
    let layers = read_first_flat_layer_from_file(&file).unwrap().layer_data.channel_data.list;
    let samples = |name: String| {
        let channel = layers.iter().find(|channel| channel.name.to_string() == name);
        channel.map(|channel| match &channel.sample_data {
            FlatSamples::F32(values) => ("float", values.iter().map(|value| value.to_le_bytes()).collect::<Vec<_>>()),
            FlatSamples::U32(values) => ("uint", values.iter().map(|value| value.to_le_bytes()).collect()),
            FlatSamples::F16(_) => panic!("{name} was cut to halves"),
        })
    };
    let aovs = list(&report["aovs"]);
    assert_eq!(aovs.iter().map(|aov| text(&aov["name"])).collect::<Vec<_>>().join(","), stages);
    for aov in aovs {
        let name = text(&aov["name"]);
        assert_eq!(text(&aov["extent"]), "33x17", "{name}");
        let (format, words) = match ["R", "G", "B"].map(|channel| samples(format!("{name}.{channel}"))) {
            [Some((format, red)), Some((_, green)), Some((_, blue))] => {
                let pixels = red.into_iter().zip(green).zip(blue).flat_map(|((r, g), b)| [r, g, b]);
                (format!("rgb {format}"), pixels.collect())
            }
            _ => {
                let (format, words) = samples(format!("{name}.Y")).unwrap_or_else(|| panic!("no layer {name}"));
                (format.to_owned(), words)
            }
        };
        assert_eq!((text(&aov["format"]), text(&aov["hash"])), (&*format, &*hash(words)), "{name}");
    }
}

#[test]
fn the_scene_and_the_settings_are_those_of_the_request() {
    let program = Program::new();
    let lamps = scene::load(LAMPS, 1).unwrap();
    let first = render(&program, LAMPS, INTERLEAVED, &[]);
    let described = |key: &str| count(&first["scene"][key]);
    assert_eq!(described("triangles"), lamps.triangle_count());
    assert_eq!(described("draws"), lamps.draws.len() as u64);
    assert_eq!(described("materials"), lamps.materials.len() as u64);
    assert_eq!(described("lights"), LAMP_COUNT);
    // The scene's hash is of the scene alone; the picture's is of the picture.
    let same = render(&program, LAMPS, "deferred", &["--light-cutoff", "0.01"]);
    assert_eq!(first["scene"]["hash"], same["scene"]["hash"]);
    assert_ne!(first["image"]["hash"], same["image"]["hash"]);
    assert_eq!(text(&first["scene"]["hash"]), lamps.hash);
    let other = render(&program, "lamps:objects=10,lights=21", "deferred", &[]);
    assert_ne!(first["scene"]["hash"], other["scene"]["hash"]);
    assert_eq!(count(&other["scene"]["lights"]), LAMP_COUNT + 1);

    // As used: parts of the scene's diagonal in metres, what `auto` is, what is rounded up to whole patterns.
    let blocks = render(&program, LAMPS, INTERLEAVED, &["--split", "two-pass", "--block", "15x9", "--kernel", "7"]);
    let settings = &blocks["settings"];
    let clamp = 0.02 * f64::from(lamps.bounds().diagonal());
    assert!((number(&settings["vpl-clamp"]) - clamp).abs() < 1e-6 * clamp, "{} for {clamp}", settings["vpl-clamp"]);
    assert!((number(&settings["sigma"]) - 7.0 / 3.0).abs() < 1e-6, "{}", settings["sigma"]);
    assert_eq!((text(&settings["block"]), text(&settings["pattern"])), ("16x10", "4x2"));

    // Its command makes it again.
    let words: Vec<&str> = list(&blocks["command"]).iter().skip(1).map(text).collect();
    assert_eq!(program.run(&words).fine().json()["image"]["hash"], blocks["image"]["hash"]);
}

/// Median, least and greatest are those of the samples, of which there are `samples`.
#[track_caller]
fn require_spread(spread: &Value, samples: usize) {
    let mut sorted: Vec<f64> = list(&spread["samples"]).iter().map(number).collect();
    assert_eq!(sorted.len(), samples, "{spread}");
    sorted.sort_by(f64::total_cmp);
    let median = 0.5 * (sorted[(samples - 1) / 2] + sorted[samples / 2]);
    let expected = [("median", median), ("min", sorted[0]), ("max", sorted[samples - 1])];
    for (key, expected) in expected {
        assert!((number(&spread[key]) - expected).abs() <= 1e-12 * expected, "{key} of {spread}");
    }
    assert!(sorted[0] > 0.0, "{spread}");
}

#[test]
fn times_follow_from_their_samples() {
    let program = Program::new();
    let report = render(&program, "cornell", INTERLEAVED, &["--profile"]);
    require_spread(&report["total_ms"], 3);
    let mut passes_ms = [0.0; 3];
    for pass in list(&report["passes"]) {
        let is_once = pass["where"].is_string();
        require_spread(&pass["ms"], if is_once { 1 } else { 3 });
        if !is_once {
            require_spread(&pass["timestamp_ms"], 3);
            for (sum, sample) in passes_ms.iter_mut().zip(list(&pass["ms"]["samples"])) {
                *sum += number(sample);
            }
        }
    }
    for (passes, whole) in passes_ms.iter().zip(list(&report["total_ms"]["samples"])) {
        assert!(*passes <= number(whole), "passes of {passes} ms in a frame of {whole} ms");
    }
    let once = render(&program, "cornell", INTERLEAVED, &[]);
    require_spread(&once["total_ms"], 1);
    assert_eq!((count(&once["warmup_frames"]), count(&report["warmup_frames"])), (0, 1));
}

/// A table's sums are those of its rows.
fn require_sums(memory: &Value, what: &str) {
    let resources = list(&memory["resources"]);
    let sum = |key: &str| resources.iter().map(|row| count(&row[key])).sum::<u64>();
    let (planned, allocated) = (count(&memory["planned_bytes"]), count(&memory["allocated_bytes"]));
    assert_eq!((planned, allocated), (sum("bytes"), sum("bound_bytes")), "{what}");
    let mut groups: BTreeMap<String, Value> = BTreeMap::new();
    for row in resources {
        let (bytes, bound, alignment) =
            (count(&row["bytes"]), count(&row["bound_bytes"]), count(&row["alignment_bytes"]));
        assert!(bytes > 0 && bytes <= bound && alignment.is_power_of_two(), "{what}: {row}");
        assert_eq!(
            count(&row["alignment_waste_bytes"]),
            bound.div_ceil(alignment) * alignment - bound,
            "{what}: {row}"
        );
        let group = groups.entry(text(&row["group"]).to_owned()).or_insert_with(|| 0.into());
        *group = (count(group) + bound).into();
        assert_eq!(row["first_pass"].is_null(), row["last_pass"].is_null(), "{what}: {row}");
        assert!(row["arena"].is_null() || row["first_pass"].is_string(), "{what}: what is kept shares nothing: {row}");
    }
    assert_eq!(memory["groups"].as_object().unwrap().clone().into_iter().collect::<BTreeMap<_, _>>(), groups, "{what}");
    let mut aliased = 0;
    for (index, arena) in list(&memory["arenas"]).iter().enumerate() {
        let parts: Vec<&Value> = resources.iter().filter(|row| row["arena"]["index"] == index).collect();
        let parts_bytes: u64 = parts.iter().map(|row| count(&row["bound_bytes"])).sum();
        assert_eq!((count(&arena["parts"]), count(&arena["parts_bytes"])), (parts.len() as u64, parts_bytes), "{what}");
        let end = |row: &&Value| count(&row["arena"]["offset"]) + count(&row["bound_bytes"]);
        assert!(parts.iter().map(end).max().unwrap() <= count(&arena["bytes"]), "{what}: a part ends behind its arena");
        aliased += parts_bytes.saturating_sub(count(&arena["bytes"]));
    }
    assert_eq!(count(&memory["aliased_bytes"]), aliased, "{what}");
}

/// The greatest sum of what lives in one pass, in the order of `passes`; what is kept lives in all.
fn most_live_bytes(memory: &Value, passes: &[String]) -> u64 {
    let place = |name: &Value| {
        let name = text(name);
        passes.iter().position(|pass| pass == name).unwrap_or_else(|| panic!("{name} is none of {passes:?}"))
    };
    let lives = |row: &Value, pass: usize| {
        row["first_pass"].is_null() || (place(&row["first_pass"]) <= pass && pass <= place(&row["last_pass"]))
    };
    let live = |pass: usize| {
        let rows = list(&memory["resources"]).iter().filter(|row| lives(row, pass));
        rows.map(|row| count(&row["bound_bytes"])).sum::<u64>()
    };
    (0..passes.len()).map(live).max().unwrap()
}

/// Resources lie in their memory blocks, on their alignment, and in bytes of their own unless both say that they share.
fn require_places(memory: &Value, what: &str) {
    let resources = list(&memory["resources"]);
    let blocks: BTreeMap<u64, &Value> =
        list(&memory["memory_blocks"]).iter().map(|block| (count(&block["index"]), block)).collect();
    let sum = |key: &str| blocks.values().map(|block| count(&block[key])).sum::<u64>();
    assert_eq!(count(&memory["memory_block_bytes"]), sum("bytes"), "{what}");
    assert_eq!(count(&memory["allocated_bytes"]) - count(&memory["aliased_bytes"]), sum("used_bytes"), "{what}");
    let range = |row: &Value| (count(&row["offset"]), count(&row["offset"]) + count(&row["bound_bytes"]));
    for (index, row) in resources.iter().enumerate() {
        let block = blocks[&count(&row["memory_block"])];
        assert!(range(row).1 <= count(&block["bytes"]), "{what}: {row} ends behind {block}");
        assert_eq!(range(row).0 % count(&row["alignment_bytes"]), 0, "{what}: {row}");
        for other in &resources[..index] {
            let overlap = row["memory_block"] == other["memory_block"]
                && range(row).0 < range(other).1
                && range(other).0 < range(row).1;
            let says = |row: &Value, other: &Value| {
                row["arena"]["shares_with"].as_array().is_some_and(|names| names.contains(&other["name"]))
            };
            assert_eq!((says(row, other), says(other, row)), (overlap, overlap), "{what}: {row} and {other}");
        }
    }
}

#[test]
fn memory_adds_up() {
    let program = Program::new();
    let names = techniques::ALL.iter().map(|technique| (technique.name(), &[][..]));
    let caps = known_driver();
    let alone: [(&str, &[&str]); 2] = [(INTERLEAVED, &["--alias", "off"]), ("deferred", &["--cull", "tiled"])];
    for (technique, more) in names.chain(alone) {
        let what = format!("{technique} with {more:?}");
        let report = render(&program, "cornell", technique, more);
        let memory = &report["memory"];
        require_sums(memory, &what);
        require_places(memory, &what);
        let shares = count(&memory["aliased_bytes"]) > 0;
        assert!(
            shares || technique != INTERLEAVED || more.contains(&"off"),
            "{what}: a frame of many passes shares bytes"
        );
        assert!(!shares || !more.contains(&"off"), "{what}");
        let device_passes = list(&report["passes"]).iter().filter(|pass| pass["where"].is_null());
        let mut passes: Vec<String> = device_passes.map(|pass| text(&pass["name"]).to_owned()).collect();
        passes.push("readback".to_owned());
        let (most, peak) = (most_live_bytes(memory, &passes), count(&memory["peak_bytes"]));
        assert!(most <= peak && peak <= count(&memory["allocated_bytes"]), "{what}: {most} live, a peak of {peak}");
        assert!(passes.iter().any(|pass| *pass == text(&memory["peak_pass"])), "{what}: {}", memory["peak_pass"]);
        // The same request without a device, by the caps of the one that the tests run on; and once on one, without a frame.
        let planned = caps.map(|name| ["--plan", "--json", "--caps", name]);
        let mut studied: Vec<&[&str]> = planned.iter().map(|arguments| &arguments[..]).collect();
        if more.contains(&"off") {
            studied.push(&["--json"]);
        }
        for own in studied {
            let study = program.run(&command(&["memory"], "cornell", technique, &[more, own].concat())).fine().json();
            let table = &study["techniques"][0]["memory"];
            require_sums(table, &what);
            assert_eq!(table["planned_bytes"], memory["planned_bytes"], "{what}");
            assert_eq!(list(&table["resources"]).len(), list(&memory["resources"]).len(), "{what}");
        }
    }
}

/// Bytes of a resource by its name.
fn bytes_of(report: &Value, name: &str) -> u64 {
    let row = list(&report["memory"]["resources"]).iter().find(|row| row["name"] == format!("{INTERLEAVED}.{name}"));
    count(&row.unwrap_or_else(|| panic!("no resource {name}"))["bytes"])
}

/// Bytes read, bytes written and threads of a pass; those that it does not say are 0.
fn traffic_of(report: &Value, name: &str) -> [u64; 3] {
    let pass = list(&report["passes"]).iter().find(|pass| pass["name"] == format!("{INTERLEAVED}.{name}"));
    let pass = pass.unwrap_or_else(|| panic!("no pass {name}"));
    ["bytes_read", "bytes_written", "invocations"].map(|key| pass[key].as_u64().unwrap_or_default())
}

/// Resources and traffic of passes whose texels can be counted on paper.
#[test]
fn bytes_of_simple_passes_are_their_texels() {
    let program = Program::new();
    let report = render(&program, LAMPS, INTERLEAVED, &[]);
    // Rows of frame order are even; sub-buffers are padded to the pattern, and even again.
    let frame = (WIDTH + 1) * HEIGHT;
    let sub_buffer = WIDTH.div_ceil(PATTERN[0]).next_multiple_of(2) * HEIGHT.div_ceil(PATTERN[1]);
    let split = sub_buffer * PATTERN[0] * PATTERN[1];
    for (name, bytes) in [
        ("gbuffer.normal", PIXELS * 8),
        ("gbuffer.color", PIXELS * 8),
        ("gbuffer.position", PIXELS * 8),
        ("gbuffer.depth", PIXELS * 4),
        ("split.normal", split * 8),
        ("split.position", split * 8),
        ("shade.irradiance", split * 8),
        ("gather.irradiance", frame * 8),
        ("discontinuity.flags", frame * 4),
        ("filter.irradiance", frame * 8),
        ("composite.color", PIXELS * 16),
        ("vpls", 32 * 48),
        ("lights", LAMP_COUNT * 64),
        ("subsets", PATTERN[0] * PATTERN[1] * 16),
    ] {
        assert_eq!(bytes_of(&report, name), bytes, "{name}");
    }
    // Nobody knows how often a driver makes a vertex, and which texels triangles cover.
    assert_eq!(traffic_of(&report, "gbuffer"), [0, PIXELS * 28, 0]);
    // Position and normal; on processors two texels a thread.
    let texels = if report["device"]["type"] == "cpu" { 2 } else { 1 };
    assert_eq!(traffic_of(&report, "split"), [split * 16, split * 16, split / texels]);
    // Each thread reads the lights of its subset, of 48 bytes.
    let light_bytes = 32 * 48 / (PATTERN[0] * PATTERN[1]);
    let [read, written, threads] = traffic_of(&report, "shade");
    assert_eq!([read, written], [split * 16 + threads * light_bytes, split * 8]);
    assert_eq!(traffic_of(&report, "gather"), [frame * 8, frame * 8, frame / 2]);
    assert_eq!(traffic_of(&report, "discontinuity")[1], PIXELS * 4);
    // Along the rows, and along the columns.
    assert_eq!(traffic_of(&report, "filter")[1], 2 * PIXELS * 8);
    // Tiles decide how many lights are read.
    assert_eq!(traffic_of(&report, "composite")[..2], [0, PIXELS * 16]);

    let one_texel = ["--texels", "1", "--split", "subsample", "--position", "float", "--workgroup", "64x1"];
    let subsample = render(&program, LAMPS, INTERLEAVED, &one_texel);
    assert_eq!(bytes_of(&subsample, "shade.irradiance"), sub_buffer * 8);
    let threads = sub_buffer.next_multiple_of(64);
    let shaded = [sub_buffer * 24 + threads * 32 * 48, sub_buffer * 8, threads];
    assert_eq!(traffic_of(&subsample, "shade"), shaded);
    assert_eq!(traffic_of(&subsample, "upscale"), [4 * PIXELS * 8, PIXELS * 8, PIXELS]);
    assert_eq!(bytes_of(&subsample, "gbuffer.position"), PIXELS * 16);
}

fn require_counters(report: &Value, expected: &[(&str, f64)]) {
    for (name, value) in expected {
        assert_eq!(number(&report["counters"][*name]), *value, "{name} of {}", report["command"]);
    }
}

#[test]
fn counters_follow_from_the_request() {
    let program = Program::new();
    let [pixels, lamps] = [PIXELS, LAMP_COUNT].map(|count| count as f64);
    let render = |scene: &str, technique: &str, more: &[&str]| render(&program, scene, technique, more);
    let plain = render(LAMPS, INTERLEAVED, &["--geometry", "all"]);
    let triangles = number(&plain["scene"]["triangles"]);
    require_counters(
        &plain,
        &[
            ("lights", lamps),
            ("vpls", 32.0),
            ("shaded_pixels", pixels),
            ("subset_lights_per_pixel", 32.0 / 8.0),
            ("light_evaluations", pixels * lamps),
            ("light_evaluations_culled", 0.0),
            ("triangles_drawn", triangles),
            ("clusters_culled", 0.0),
            ("blended_draws", 0.0),
        ],
    );
    let counter = |report: &Value, name: &str| number(&report["counters"][name]);
    // A walk of one bounce finds one place at most.
    assert!(counter(&plain, "vpls_found") <= 32.0 && counter(&plain, "light_walks") >= counter(&plain, "vpls_found"));
    let joined = render(LAMPS, INTERLEAVED, &["--direct", "interleaved", "--direct-pattern", "2x1"]);
    require_counters(&joined, &[("subset_lights_per_pixel", 32.0 / 8.0 + lamps / 2.0), ("lights", lamps)]);
    require_counters(&render(LAMPS, INTERLEAVED, &["--direct", "none"]), &[("lights", 0.0), ("vpls", 32.0)]);
    // The middles of the cells, an even number a row, under every light.
    let subsample = render(LAMPS, INTERLEAVED, &["--split", "subsample"]);
    require_counters(&subsample, &[("shaded_pixels", 10.0 * 9.0), ("subset_lights_per_pixel", 32.0)]);
    require_counters(
        &render(LAMPS, INTERLEAVED, &["--split", "none"]),
        &[("shaded_pixels", pixels), ("subset_lights_per_pixel", 32.0)],
    );
    let tiled = render(LAMPS, "deferred", &["--cull", "tiled", "--light-cutoff", "0.5"]);
    let [evaluated, culled] = ["", "_culled"].map(|end| counter(&tiled, &format!("light_evaluations{end}")));
    assert!(evaluated > 0.0 && culled > 0.0, "{evaluated} and {culled}");
    assert_eq!(evaluated + culled, pixels * lamps);
    assert!(counter(&tiled, "triangles_drawn") < triangles, "what is behind the eye is left out");

    // The one light of the box reaches all of it: a forward frame shades each pixel of a surface with it once.
    let normals = render("cornell", "deferred", &["--aov", "gbuffer.normal"]);
    let layers = read_first_flat_layer_from_file(program.path("a.exr")).unwrap().layer_data.channel_data.list;
    let of_normal = layers.iter().filter(|channel| channel.name.to_string().starts_with("gbuffer.normal."));
    let channels: Vec<Vec<f32>> = of_normal.map(|channel| channel.sample_data.values_as_f32().collect()).collect();
    let surfaces = (0..PIXELS as usize).filter(|at| channels.iter().any(|channel| channel[*at] != 0.0)).count() as f64;
    require_counters(&normals, &[("light_evaluations", pixels)]);
    let forward = render("cornell", "forward", &[]);
    require_counters(
        &forward,
        &[
            ("light_evaluations", surfaces),
            ("light_evaluations_culled", pixels - surfaces),
            ("lights_per_pixel", surfaces / pixels),
            ("lights_per_object", 1.0),
            ("objects", number(&forward["scene"]["draws"])),
            ("draws", number(&forward["scene"]["draws"])),
        ],
    );
    let traced = render("cornell", "path_traced", &["--spp", "3"]);
    require_counters(&traced, &[("samples", 3.0), ("triangles_traced", number(&traced["scene"]["triangles"]))]);
    let deep = render("cornell", "deep_shading", &[]);
    require_counters(&deep, &[("shaded_per_pixel", counter(&deep, "shader_invocations") / pixels)]);
    assert!(counter(&deep, "shader_invocations") >= 0.5 * surfaces, "most surfaces are shaded");
}

/// A row of a benchmark says of its frame what the frame's report says.
#[test]
fn a_benchmarks_row_is_its_frame() {
    let program = Program::new();
    let more = ["--repeat", "2", "--json", "--quiet", "--direct", "interleaved"];
    let row = program.run(&command(&["bench", "frame"], LAMPS, INTERLEAVED, &more)).fine().json();
    let report = render(&program, LAMPS, INTERLEAVED, &more[4..]);
    assert_eq!(row["image_hash"], report["image"]["hash"]);
    assert_eq!(row["scene"]["hash"], report["scene"]["hash"]);
    assert_eq!(row["counters"], report["counters"]);
    let passes: Vec<&Value> = list(&report["passes"]).iter().filter(|pass| pass["where"].is_null()).collect();
    assert_eq!(count(&row["bytes_written"]), passes.iter().map(|pass| count(&pass["bytes_written"])).sum::<u64>());
    // Nobody knows of the textures that a G-buffer reads without counting.
    assert!(passes.iter().any(|pass| pass["bytes_read"].is_null()) && row["bytes_read"].is_null());
    let named: Vec<&str> = row["pass_ms"].as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(named, passes.iter().map(|pass| text(&pass["name"])).collect::<Vec<_>>());
    require_spread(&row["frame_ms"], 2);
    // Without what is kept with the scene.
    let resources = list(&report["memory"]["resources"]).iter();
    let own = resources.filter(|row| !text(&row["name"]).starts_with("scene."));
    assert_eq!(count(&row["planned_bytes"]), own.map(|row| count(&row["bytes"])).sum::<u64>());
    // Its command makes its picture.
    let words = list(&row["command"]).iter().skip(1).map(text);
    let again = program.run(&words.chain(["-o", "b.exr", "--json"]).collect::<Vec<_>>()).fine().json();
    assert_eq!(again["image"]["hash"], row["image_hash"]);
}

/// The numbers of a comparison that have one formula, from the two files.
#[test]
fn a_comparison_is_made_of_both_files() {
    let program = Program::new();
    for (file, seed) in [("a.exr", "1"), ("b.exr", "2")] {
        program.run(&command(&["render"], "cornell", INTERLEAVED, &["--seed", seed, "-o", file, "--quiet"])).fine();
    }
    let compared = program.run(&["compare", "a.exr", "b.exr", "--max", "rmse=1", "--json"]).fine().json();
    assert_eq!((count(&compared["width"]), count(&compared["height"])), (WIDTH, HEIGHT));
    let [a, b] = ["a.exr", "b.exr"].map(|file| image_file::read(program.path(file).as_ref()).unwrap().pixels);
    let pairs = || a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    let samples = 3.0 * PIXELS as f64;
    let rmse = (pairs().map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / samples).sqrt();
    let relmse = pairs().map(|(a, b)| (a - b) * (a - b) / (b * b + 0.01)).sum::<f64>() / samples;
    for (name, expected) in [("rmse", rmse), ("relmse", relmse)] {
        let found = number(&compared["metrics"][name]);
        assert!(expected > 0.0 && (found - expected).abs() < 1e-6 * expected, "{name}: {found} for {expected}");
    }
    assert_eq!(compared["gates"][0]["measured"], compared["metrics"]["rmse"]);
    assert_eq!((number(&compared["gates"][0]["value"]), text(&compared["gates"][0]["bound"])), (1.0, "max"));
}
