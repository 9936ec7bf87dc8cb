//! Deep shading buffers: every way to build and to read the lists gives the bits of shading every sample by itself; what is
//! shaded is what is listed, each once; blur equals what path tracing sees.

mod barycentrics;
mod baselines;
mod entries;
mod guard_band;
mod hostile;
mod looped;
mod orders;
mod own_samples;
mod rates;
mod reconstruct;
mod rivals;
mod samplers;
mod shading_rate;
mod stages;
mod stereo;
mod tessellation;
mod texture_space;
mod visibility;
mod zmax;

use crate::support::choices::{is_possible, words};
use crate::support::difference::require_same;
use crate::support::moving::{moving, unlit};
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, has};
use quincunx::error::Result;
use quincunx::metrics;
use quincunx::picture::Picture;
use quincunx::scene::Scene;
use quincunx::session::Renderer;
use std::collections::BTreeMap;

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "161x91");
const FOVEATED: (&str, &str) = ("shading-warp", "foveated");

/// The paper's way: shading space is drawn.
const FRAGMENT: (&str, &str) = ("shade-by", "fragment");

/// Ways to the same picture; the first shades every sample by itself.
const METHODS: [Changes<'_>; 16] = [
    &[("lists", "none")],
    &[],
    &[("compaction", "off")],
    &[FRAGMENT],
    &[FRAGMENT, ("zmax", "on")],
    &[FRAGMENT, ("shaded-triangles", "all")],
    &[("address-buffer", "off")],
    &[("compaction", "off"), ("address-buffer", "off")],
    &[("geometry", "all")],
    &[("texels", "1")],
    &[FRAGMENT, ("compaction", "off"), ("address-buffer", "off"), ("zmax", "on")],
    &[("compaction", "off"), ("duplicates", "tolerated")],
    &[("instrument", "off"), ("duplicates", "tolerated")],
    &[("list-access", "addresses")],
    &[("list-access", "addresses"), ("compaction", "off"), ("address-buffer", "off")],
    &[FRAGMENT, ("list-access", "addresses"), ("compaction", "off"), ("duplicates", "tolerated")],
];

/// Kinds of `--visibility` that go with a `--shading`.
fn visibilities(shading: &str) -> Vec<&'static str> {
    let goes = |kind: &&str| is_possible(DEEP, &[("shading", shading), ("visibility", kind)]);
    words(DEEP, "visibility").into_iter().filter(goes).collect()
}

/// Methods of conservative rasterisation that the driver has.
fn conservative(watched: &Watched) -> Vec<&'static str> {
    let mut methods = vec!["vertex"];
    if has(&watched.session.gpu.caps, Feature::GeometryShader) {
        methods.push("geometry");
    }
    if watched.session.gpu.caps.conservative.is_some() {
        methods.push("hardware");
    }
    methods
}

#[track_caller]
fn require_one_picture(watched: &Watched, common: Changes<'_>) {
    let common = &both(common, &[("size", "97x55")]);
    let first = watched.picture(DEEP, &both(common, METHODS[0]));
    // What a device rasterises conservatively is straight.
    let goes = |method: &&str| *method != "hardware" || !common.contains(&FOVEATED);
    let drawn = conservative(watched).into_iter().filter(goes).map(|method| vec![FRAGMENT, ("conservative", method)]);
    for method in METHODS[1..].iter().map(|method| method.to_vec()).chain(drawn) {
        let found = watched.picture(DEEP, &both(common, &method));
        require_same(&watched.session.gpu, &found, &first, &(&method, common));
    }
}

/// The fence's rotor turns by a quarter of a turn and a half.
fn turning(spec: &str) -> Scene {
    moving(spec, [0.0, 0.1])
}

#[test]
fn every_method_shades_as_every_sample_by_itself_would_be() {
    let watched = Watched::open("cornell");
    for common in [
        &[SIZE, ("spp", "4")][..],
        &[SIZE, ("spp", "2"), ("tuples", "12"), ("shading-scale", "0.5"), ("direct-shadow", "ray")],
        &[SIZE, ("spp", "1"), ("tuples", "1"), ("guard-band", "0")],
        &[SIZE, ("spp", "2"), ("aperture", "0.1"), ("guard-band", "8"), FOVEATED, ("warp-falloff", "3")],
    ] {
        require_one_picture(&watched, common);
    }
}

#[test]
fn every_method_is_one_under_a_lens_with_textures_and_glass() {
    let watched = Watched::open("hall:triangles=8000");
    require_one_picture(&watched, &[SIZE, ("spp", "4"), ("aperture", "0.3"), ("focus", "6")]);
}

#[test]
fn every_method_is_one_while_things_move_with_holes_and_glass() {
    for spec in ["fence:lights=6", "fence:lights=6,alpha=mask"] {
        let watched = Watched::with_scene(turning(spec));
        require_one_picture(&watched, &[SIZE, ("camera", "rotor"), ("spp", "4"), ("accumulate", "2")]);
    }
}

/// Under the paper's shadow-mapped lights, whose maps are of the middle of the exposure.
#[test]
fn every_method_is_one_under_shadow_maps() {
    let maps = [SIZE, ("direct-shadow", "map"), ("shadow-map-size", "128"), ("spp", "2"), ("tuples", "2")];
    let exposed = moving("chess:triangles=12000", [0.0, 0.2]);
    let watched = Watched::with_scene(exposed);
    require_one_picture(&watched, &maps);
    let unshadowed = watched.hash(DEEP, &both(&maps, &[("direct-shadow", "none")]));
    assert_ne!(unshadowed, watched.hash(DEEP, &maps), "the men have shadows");
}

/// Without a guard band, and with a lens that brings most of the scene in from outside.
#[test]
fn samples_that_shading_space_has_no_place_for_are_shaded_too() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [SIZE, ("spp", "4"), ("aperture", "3"), ("focus", "2"), ("guard-band", "0")];
    require_one_picture(&watched, &common);
    let counters = watched.render(DEEP, &common).measured_counters().unwrap();
    let (outside, seen) = (counters["samples_outside_shading_space"], counters["samples_seen"]);
    assert!(outside > 0.05 * seen && outside < seen, "{outside} of {seen}");
    assert_eq!(counters["samples_without_colour"], 0.0);
    let wide = both(&common, &[("guard-band", "400")]);
    let fewer = watched.render(DEEP, &wide).measured_counters().unwrap()["samples_outside_shading_space"];
    assert!(fewer < 0.5 * outside, "{fewer} with a guard band, {outside} without");
}

/// What the paper's table 2 takes as the cost of conservative rasterisation is against this.
#[test]
fn without_conservative_rasterisation_samples_at_rims_have_no_colour() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [SIZE, ("spp", "4"), ("aperture", "0.1"), ("brdf", "lambert")];
    let counted = |method| {
        let counters =
            watched.render(DEEP, &both(&common, &[FRAGMENT, ("conservative", method)])).measured_counters().unwrap();
        ["samples_without_colour", "shader_invocations", "shading_pixels_drawn", "listed_primitives", "samples_seen"]
            .map(|name| counters[name])
    };
    let [plainly_missing, plainly_shaded, plainly_drawn, plainly_listed, seen] = counted("none");
    for method in conservative(&watched) {
        let [missing, shaded, drawn, listed, _] = counted(method);
        assert_eq!([missing, listed], [0.0, plainly_listed], "{method}");
        assert!(shaded <= drawn, "{method}: {shaded} of {drawn}");
        assert!(drawn > 1.1 * plainly_drawn && plainly_shaded < shaded, "{method}: {drawn} and {plainly_drawn}");
    }
    assert!(plainly_missing > 0.0 && plainly_missing < 0.5 * seen, "{plainly_missing} of {seen}");
}

#[test]
fn triangles_without_a_list_are_not_drawn() {
    let watched = Watched::open("hall:triangles=8000");
    let counted = |triangles, method| {
        let drawn = [FRAGMENT, ("shaded-triangles", triangles), ("conservative", method)];
        let changes = both(&[SIZE, ("spp", "2"), ("brdf", "lambert")], &drawn);
        let counters = watched.render(DEEP, &changes).measured_counters().unwrap();
        ["shading_pixels_drawn", "shader_invocations"].map(|name| counters[name])
    };
    for method in conservative(&watched).into_iter().chain(["none"]) {
        let ([fewer, shaded], [all, as_many]) = (counted("listed", method), counted("all", method));
        println!("{method}: {fewer} of {all} drawn, {shaded} shaded");
        assert!(shaded == as_many && fewer < 0.7 * all, "{method}: {fewer} of {all}, {shaded} and {as_many}");
    }
}

/// Mean differences in the middle third of both sides and at the rim, between two pictures; light above 1 is cut.
fn middle_and_rim(one: &Picture, other: &Picture) -> [f64; 2] {
    let [width, height] = [one.extent.width as usize, one.extent.height as usize];
    let mut sums = [(0.0, 0.0); 2];
    for (index, (a, b)) in one.pixels.iter().zip(&other.pixels).enumerate() {
        let is_middle = |at: usize, side: usize| 3 * at >= side && 3 * at < 2 * side;
        let is_rim = !(is_middle(index % width, width) && is_middle(index / width, height));
        let far: f32 = (0..3).map(|channel| (a[channel].min(1.0) - b[channel].min(1.0)).abs()).sum();
        let (sum, count) = sums[usize::from(is_rim)];
        sums[usize::from(is_rim)] = (sum + f64::from(far) / 3.0, count + 1.0);
    }
    sums.map(|(sum, count): (f64, f64)| sum / count)
}

#[test]
fn a_foveated_space_shades_less_towards_the_rim() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [SIZE, ("spp", "4"), ("guard-band", "0"), ("brdf", "lambert")];
    let even = watched.render(DEEP, &common);
    let foveated = watched.render(DEEP, &both(&common, &[FOVEATED]));
    let shaded = |of: &Renderer| of.measured_counters().unwrap()["shader_invocations"];
    let lists = |of: &Renderer| of.measured_counters().unwrap()["lists"];
    // A quarter of the pixels.
    assert!((0.2..0.3).contains(&(lists(&foveated) / lists(&even))), "{} of {}", lists(&foveated), lists(&even));
    assert!(shaded(&foveated) < 0.8 * shaded(&even), "{} of {}", shaded(&foveated), shaded(&even));
    // As many pixels, laid out evenly.
    let halved = watched.picture(DEEP, &both(&common, &[("shading-scale", "0.5")]));
    let even = even.picture().unwrap();
    let [middle, rim] = middle_and_rim(&foveated.picture().unwrap(), &even);
    let [halved_middle, halved_rim] = middle_and_rim(&halved, &even);
    println!("{middle} in the middle, {rim} at the rim; {halved_middle} and {halved_rim} of an even space");
    assert!(middle < 0.8 * halved_middle && rim > halved_rim, "{middle}, {rim}; {halved_middle}, {halved_rim}");
    let text = refusal(&watched, &[FOVEATED, FRAGMENT, ("conservative", "hardware")]);
    let has_hardware = watched.session.gpu.caps.conservative.is_some();
    let why = if has_hardware { "are not straight" } else { "--conservative vertex works without it" };
    assert!(text.contains(why), "{text}");
}

#[test]
fn what_is_shaded_is_what_is_listed_and_nothing_is_missing() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [SIZE, ("spp", "8"), ("aperture", "0.2"), ("focus", "6")];
    for method in &METHODS[1..8] {
        let counters = watched.render(DEEP, &both(&common, method)).measured_counters().unwrap();
        assert_eq!(counters["shader_invocations"], counters["listed_primitives"], "{method:?}");
        for key in ["samples_without_colour", "listed_again"] {
            assert_eq!(counters[key], 0.0, "{method:?}: {key}");
        }
        let rate = counters["shaded_per_pixel"];
        assert!((1.0..2.5).contains(&rate), "{method:?}: {rate}");
    }
    let alone = watched.render(DEEP, &both(&common, METHODS[0])).measured_counters().unwrap();
    assert_eq!(alone["shader_invocations"], alone["samples_seen"]);
}

/// The order in which threads come must not show: neither in what is listed nor in the picture.
#[test]
fn ten_runs_list_and_show_the_same() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [("size", "96x54"), ("spp", "8"), ("aperture", "0.3"), ("focus", "6")];
    let renderer = watched.render_stages(DEEP, &common, &["count.lengths"]);
    let seen = || {
        renderer.frame().unwrap();
        let counters = renderer.measured_counters().unwrap();
        let lengths = watched.integers(&renderer, "count.lengths");
        let lists = ["longest_list", "listed_primitives", "listed_digest"].map(|key| counters[key]);
        (renderer.picture().unwrap().hash().unwrap(), lengths, lists)
    };
    let first = seen();
    assert!(first.1.iter().any(|length| *length > 1), "some pixels have several triangles");
    for _ in 0..9 {
        assert_eq!(seen(), first);
    }
}

/// Half floats keep 2^-12 of a colour at worst. Scenes without textures: those have their levels by other rates than a quad's.
#[test]
fn one_sample_in_the_middle_is_forward_shading() {
    for spec in ["cornell", "lamps:objects=40,lights=20"] {
        let watched = Watched::open(spec);
        if !has(&watched.session.gpu.caps, Feature::ExactPositions) {
            return;
        }
        let forward = watched.picture("forward", &[SIZE]);
        let far = rmse(&watched, &[SIZE, ("spp", "1"), ("tuples", "1")], &forward);
        println!("{spec}: {far}");
        // Other devices place corners between hulls and triangles otherwise, by parts of a pixel: 0.0025 on an H200.
        let most = if watched.session.gpu.caps.identity.is_software() { 1e-3 } else { 5e-3 };
        assert!(far > 0.0 && far < most, "{spec}: {far}");
    }
}

fn rmse(watched: &Watched, changes: Changes<'_>, reference: &Picture) -> f64 {
    metrics::compare(&watched.picture(DEEP, changes), reference, 0.1).unwrap().metrics.rmse
}

/// Four sets of as many samples halve the error of independent ones; these are better spread.
#[test]
fn blur_comes_to_what_path_tracing_sees() {
    let traced = [("transport", "direct"), ("light-visibility", "off"), ("emissive", "off"), ("spp", "1024")];
    // Light that falls on what moves is another one while it does: colours are not.
    for (scene, blur) in [
        (moving("cornell", [0.0, 0.1]), vec![("aperture", "0.15")]),
        (unlit(moving("fence:lights=6", [0.0, 0.05]), false), vec![("camera", "rotor"), ("aperture", "0.05")]),
    ] {
        let watched = Watched::with_scene(scene);
        if !has(&watched.session.gpu.caps, Feature::ExactPositions) {
            return;
        }
        let light = both(&[("size", "64x64"), ("brdf", "lambert")], &blur);
        let reference = watched.picture("path_traced", &both(&light, &traced));
        let errors: Vec<f64> = ["1", "4", "16", "64"]
            .iter()
            .map(|sets| rmse(&watched, &both(&light, &[("spp", "4"), ("accumulate", *sets)]), &reference))
            .collect();
        println!("{blur:?}, 4, 16, 64, 256 samples: {errors:?}");
        assert!(errors.windows(2).all(|pair| pair[1] < 0.75 * pair[0]), "{blur:?}: {errors:?}");
    }
}

/// The published table (Clarberg & Munkberg 2014, section 6), to the byte of its formulas.
#[test]
fn memory_is_what_the_paper_s_table_says() {
    let program = Program::new();
    let arguments = ["memory", "--technique", DEEP, "--plan", "--size", "1280x720", "--spp", "8"];
    let of_paper = ["--shade-by", "fragment", "--zmax", "on"];
    let json = program.run(&[&arguments[..], &of_paper, &["--json"]].concat()).fine().json();
    let groups: BTreeMap<String, u64> =
        serde_json::from_value(json["techniques"][0]["memory"]["groups"].clone()).unwrap();
    for (group, bytes, mebibytes) in [
        ("frame_buffer", 88_473_600, 84.4),
        ("deep_shading_buffer", 122_740_736, 117.1),
        ("auxiliary", 140_173_312, 133.7),
    ] {
        assert_eq!(groups[group], bytes, "{group}");
        assert!((groups[group] as f64 / f64::from(1 << 20) - mebibytes).abs() < 0.05, "{group}");
    }
    let rivals: Vec<u64> = json["techniques"][0]["rivals"]
        .as_array()
        .unwrap()
        .iter()
        .map(|rival| rival["bytes"].as_u64().unwrap())
        .collect();
    assert_eq!(rivals, [44_739_240, 357_913_920], "42.7 and 341.3");
    let text = program.run(&[&arguments[..], &of_paper].concat()).fine().out;
    assert!(
        text.contains("Andersson et al. 2014): 8 x 2048^2 texels x 8 B x 4/3") && text.contains("341 MiB"),
        "{text}"
    );
}

/// Buffers are as long as the worst case; what a frame touches of them is what its shaders count.
#[test]
fn touched_bytes_are_what_shaders_count() {
    let program = Program::new();
    let common = ["render", "cornell", "--technique", DEEP, "--size", "161x91", "--aperture", "0.2", "--json"];
    for method in [&[][..], &["--compaction", "off"], &["--address-buffer", "off", "--guard-band", "0"]] {
        let json = program.run(&[&common, method].concat()).fine().json();
        let count =
            |key: &str| json["counters"][key].as_u64().or(json["counters"][key].as_f64().map(|count| count as u64));
        let count = |key: &str| count(key).unwrap_or_else(|| panic!("{key}: {json:#}"));
        let resources = json["memory"]["resources"].as_array().unwrap();
        let touched = |name: &str, key: &str| {
            let name = format!("{DEEP}.{name}");
            let found = resources.iter().find(|row| row["name"] == name.as_str());
            found.map(|row| row[key].as_u64().unwrap())
        };
        let strays = count("samples_outside_shading_space") + count("samples_of_full_lists");
        let (listed, nodes) = (count("listed_primitives"), count("nodes_written"));
        assert!(nodes >= listed + strays && nodes <= count("samples_seen"), "{method:?}: {nodes} nodes of {listed}");
        let colors = listed + count("listed_again") + strays;
        assert_eq!(touched("lists.nodes", "touched_bytes"), Some(8 * nodes), "{method:?}");
        assert_eq!(touched("shade.colors", "touched_bytes"), Some(8 * colors), "{method:?}");
        assert_eq!(touched("entries.order", "touched_bytes"), Some(4 * colors), "{method:?}");
        assert_eq!(touched("lists.begins", "touched_bytes"), touched("lists.begins", "bytes"), "{method:?}");
        assert_eq!(count("lists_beyond_16"), 0);
        let rows = touched("lists.linear", "bytes").map(|_| 4 * (listed + count("lists")));
        assert_eq!(touched("lists.linear", "touched_bytes"), rows, "{method:?}");
        let addresses = touched("lists.addresses", "bytes").map(|_| 4 * count("samples_seen"));
        assert_eq!(touched("lists.addresses", "touched_bytes"), addresses, "{method:?}");
        let group = 8 * nodes + 8 * colors + touched("lists.begins", "bytes").unwrap();
        assert_eq!(json["memory"]["touched_groups"]["deep_shading_buffer"], group, "{method:?}");
        let all = json["memory"]["groups"]["deep_shading_buffer"].as_u64().unwrap();
        assert!(3 * group < 2 * all, "{method:?}: {group} of {all}");
    }
    // Nobody counts: nothing is said.
    let json = program.run(&[&common[..], &["--instrument", "off"]].concat()).fine().json();
    assert!(json["memory"]["touched_groups"].is_null() && json["memory"]["touched_bytes"].is_null());
}

fn refusal(watched: &Watched, changes: Changes<'_>) -> String {
    let made = watched.try_renderer(DEEP, changes, &[], quincunx::gpu::commands::Submits::One);
    let made: Result<_> = made.map(|_| ());
    made.unwrap_err().to_string()
}

#[test]
fn what_cannot_be_is_refused_with_what_can() {
    let watched = Watched::open("cornell");
    let text = refusal(&watched, &[("spp", "8"), ("tuples", "12")]);
    assert!(text.contains("--tuples 12: it must be a multiple of --spp 8") && text.contains("--tuples 16"), "{text}");
    let text = refusal(&watched, &[("size", "16384x16"), ("spp", "1"), ("shading-scale", "4"), ("guard-band", "64")]);
    assert!(text.contains("shading space has 65664 x 192 pixels"), "{text}");
}

/// Rows of 64 bytes a pixel of shading space, most of it guard band; nodes and colours of 36 million samples are as long.
#[test]
fn lists_longer_than_the_device_binds_are_reached_by_their_addresses() {
    let watched = Watched::open("cornell");
    let wide = [("size", "64x36"), ("spp", "1"), ("guard-band", "720")];
    let is_long = watched.session.gpu.caps.limits.max_storage_buffer_range_bytes < 1504 * 1476 * 64;
    if is_long {
        let text = refusal(&watched, &both(&wide, &[("list-access", "descriptors")]));
        assert!(
            text.contains("longest buffer has 142073856 bytes") && text.contains("--list-access addresses"),
            "{text}"
        );
    }
    let access = |changes: Changes<'_>| watched.render(DEEP, changes).resolved["list-access"].clone();
    assert_eq!(access(&wide), if is_long { "addresses" } else { "descriptors" });
    assert_eq!(access(&both(&wide, &[("compaction", "off")])), "descriptors");
    let short = watched.picture(DEEP, &both(&wide, &[("compaction", "off")]));
    require_same(&watched.session.gpu, &watched.picture(DEEP, &wide), &short, &wide);
    let of_rays = |lists| watched.picture(DEEP, &both(&wide, &[("visibility", "ray"), ("lists", lists)]));
    require_same(&watched.session.gpu, &of_rays("direct"), &of_rays("none"), &wide);
}
