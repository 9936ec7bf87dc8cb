//! The reconstruction of deep shading: less error from few samples where something is blurred, the same bits where nothing is;
//! one colour stays one colour, and what is sharp takes nothing from what is behind it.

use super::FRAGMENT;
use crate::support::boxes::{camera, panel, rectangle};
use crate::support::choices::words_but;
use crate::support::difference::{require_same, rmse};
use crate::support::moving::moving;
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, has};
use glam::Vec3;
use quincunx::metrics::{DEFAULT_THRESHOLD, compare};
use quincunx::picture::Picture;
use quincunx::scene::{Material, Scene};
use std::collections::BTreeMap;

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "96x54");
const ON: (&str, &str) = ("reconstruct", "on");

/// The fence's rotor turns by a quarter of a turn.
fn rotor() -> Scene {
    moving("fence:lights=6", [0.0, 0.1])
}

/// A lens, and what moves under one.
const LENS: Changes<'_> = &[SIZE, ("aperture", "0.8"), ("focus", "5")];
const BOTH: Changes<'_> = &[SIZE, ("camera", "rotor"), ("aperture", "0.2"), ("focus", "4")];

/// The lists' ways to a sample's colour.
const METHODS: [Changes<'_>; 4] = [
    &[("lists", "none")],
    &[("list-access", "addresses")],
    &[("address-buffer", "off")],
    &[FRAGMENT, ("compaction", "off"), ("address-buffer", "off"), ("zmax", "on"), ("instrument", "off")],
];

#[test]
fn every_method_to_a_sample_s_colour_comes_to_one_picture() {
    for (watched, common) in [
        (Watched::open("hall:triangles=8000"), both(LENS, &[("spp", "2")])),
        (Watched::with_scene(rotor()), both(BOTH, &[("spp", "2"), ("accumulate", "2")])),
    ] {
        let common = both(&common, &[ON]);
        let first = watched.picture(DEEP, &common);
        let sharp = watched.picture(DEEP, &both(&common, &[("reconstruct", "off")]));
        assert_ne!(first.pixels, sharp.pixels, "something is blurred");
        for method in METHODS {
            let found = watched.picture(DEEP, &both(&common, method));
            require_same(&watched.session.gpu, &found, &first, &(method, &common));
        }
    }
}

/// Both kinds of samples, in which noise is another: interleaved ones in a dither pattern.
#[test]
fn eight_samples_have_less_error_than_the_mean_of_many_more() {
    let mean = |scene: &Watched, common: Changes<'_>, sets: &str| {
        scene.picture(DEEP, &both(common, &[("spp", "8"), ("accumulate", sets)]))
    };
    for (name, watched, common, least) in [
        ("lens", Watched::open("hall:triangles=8000"), LENS, 0.85),
        ("motion", Watched::with_scene(passing()), &[SIZE], 0.8),
        ("both", Watched::with_scene(passing()), FLAT, 0.8),
    ] {
        let reference = mean(&watched, common, "12");
        let errors = ["1", "2"].map(|sets| rmse(&mean(&watched, common, sets), &reference));
        let filtered = |kind| watched.picture(DEEP, &both(common, &[("spp", "8"), ON, ("visibility", kind)]));
        let far = ["repeat-frame", "stochastic"].map(|kind| rmse(&filtered(kind), &reference));
        println!("{name}: {far:?} reconstructed from 8 samples, {errors:?} the mean of 8, 16");
        // Each tuple draws triangles in other places, to a step of a pixel: coarse steps leave an error that no filter takes away.
        let most = if has(&watched.session.gpu.caps, Feature::ExactPositions) { errors[1] } else { errors[0] };
        assert!(far.iter().all(|far| *far < least * errors[0] && *far < most), "{name}: {far:?}, {errors:?}");
    }
}

/// Root mean square of what two by two pixels of a picture differ in from their mean (Haar's details of the finest level), of
/// luminance-like sums of channels.
fn details(picture: impl Fn(usize, usize) -> f64, [width, height]: [usize; 2]) -> f64 {
    let mut sum = 0.0;
    for (x, y) in (0..height / 2).flat_map(|y| (0..width / 2).map(move |x| (2 * x, 2 * y))) {
        let [a, b, c, d] = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[dx, dy]| picture(x + dx, y + dy));
        sum += [a - b + c - d, a + b - c - d, a - b - c + d].map(|detail| 0.25 * detail * detail).iter().sum::<f64>();
    }
    (sum / (width / 2 * (height / 2)) as f64).sqrt()
}

/// The pattern of the table of tuples: 2x2 pixels that have other tuples each. Against many samples of other tuples, which the
/// judged ones are not among.
#[test]
fn the_pattern_of_the_table_is_gone() {
    let side = [96, 54];
    let blurred =
        |lens: [&'static str; 2]| [SIZE, ("spp", "8"), ("tuples", "32"), ("aperture", lens[0]), ("focus", lens[1])];
    let cases = [
        ("lens", Watched::open("hall:triangles=8000"), blurred(["0.8", "5"]), 0.64),
        ("motion", Watched::with_scene(passing()), blurred(["0", "4"]), 0.305),
        ("motion and lens", Watched::with_scene(passing()), blurred(["0.1", "4"]), 0.335),
    ];
    for (name, watched, common, most) in cases {
        let of = |changes: Changes<'_>| watched.picture(DEEP, &both(&common, changes));
        let reference = of(&[("accumulate", "24"), ("seed", "77"), ("reconstruct", "off")]);
        let sum = |pixel: &[f32; 3]| pixel.iter().map(|channel| f64::from(channel.min(1.0))).sum::<f64>();
        let error = |picture: &Picture| {
            let difference = |x: usize, y: usize| {
                let [own, should] = [picture, &reference].map(|picture| sum(&picture.pixels[y * side[0] + x]));
                own - should
            };
            details(difference, side)
        };
        let [mean, filtered] = [("reconstruct", "off"), ("reconstruct", "on")].map(|is| error(&of(&[is])));
        println!("{name}: details of the error {mean} of the mean, {filtered} filtered");
        assert!(filtered < most * mean, "{name}: {filtered}, {mean}");
    }
}

/// Filters of what moves are longer than two pixels, which the table of tuples has; the panel's way is from the 20th to the 77th.
#[test]
fn nothing_is_drawn_beyond_its_way() {
    let watched = Watched::with_scene(passing());
    let [mean, filtered] =
        ["off", "on"].map(|is| watched.picture(DEEP, &[SIZE, ("spp", "8"), ("reconstruct", is)]).pixels);
    let mut changed = 0;
    for (index, (mean, filtered)) in mean.iter().zip(&filtered).enumerate() {
        if (17..79).contains(&(index % 96)) {
            changed += usize::from(mean != filtered);
        } else {
            assert_eq!(mean, filtered, "{}, {}", index % 96, index / 96);
        }
    }
    assert!(changed > 500, "{changed} pixels are filtered");
}

/// The integral itself, by another way to it: paths through the same lens while the same shutter is open. Colours that no light
/// changes are the same for both. Many samples come nearer still: it is their limit, too.
#[test]
fn eight_samples_come_nearer_to_what_paths_see() {
    let watched = Watched::with_scene(passing());
    let paths = [("transport", "direct"), ("light-visibility", "off"), ("emissive", "off"), ("spp", "512")];
    let reference = watched.picture("path_traced", &both(FLAT, &paths));
    let error = |changes: Changes<'_>| rmse(&watched.picture(DEEP, &both(FLAT, changes)), &reference);
    let [mean, filtered, many] = [&[][..], &[ON], &[("accumulate", "12")]].map(error);
    println!("8 samples {mean}, reconstructed {filtered}; 96 samples {many}");
    assert!(filtered < 0.8 * mean, "{filtered}, {mean}");
    assert!(many < 0.8 * filtered, "{many}, {filtered}");
}

/// Interleaved kinds see the same samples, to the bit. Others differ in few, on edges
/// (tests/techniques/deep_shading/visibility.rs): filtered pictures are apart as means are by them, and by half of that
/// again at most, as samples' depths also say where layers begin.
#[test]
fn every_kind_of_visibility_comes_to_one_picture_as_far_as_its_samples_agree() {
    for (watched, common) in [(Watched::open("hall:triangles=8000"), LENS), (Watched::with_scene(passing()), FLAT)] {
        let common = both(common, &[("size", "65x37"), ("spp", "2"), ("pixel-samples", "shared")]);
        let picture = |kind, reconstruct| {
            watched.picture(DEEP, &both(&common, &[("visibility", kind), ("reconstruct", reconstruct)]))
        };
        let [mean, filtered] = ["off", "on"].map(|is| picture("repeat-frame", is));
        let changed = rmse(&mean, &filtered);
        for kind in ["stochastic", "ray"] {
            let (means, filters) = (rmse(&picture(kind, "off"), &mean), rmse(&picture(kind, "on"), &filtered));
            println!("{kind}: means differ by {means}, filtered pictures by {filters}; the filter changes {changed}");
            // Coarse steps of vertices move stochastic samples' triangles against those of others.
            let part = if has(&watched.session.gpu.caps, Feature::ExactPositions) { 0.5 } else { 1.0 };
            assert!(filters <= 1.5 * means && filters < part * changed, "{kind}: {filters}, {means}, {changed}");
        }
        if watched.session.scene.closing.is_some() && has(&watched.session.gpu.caps, Feature::GeometryShader) {
            let hash = filtered.hash().unwrap();
            for kind in words_but(DEEP, "visibility", &["repeat-frame", "stochastic", "ray"]) {
                assert_eq!(picture(kind, "on").hash().unwrap(), hash, "{kind}");
            }
        }
    }
}

/// Whatever is blurred before whatever, and before nothing.
#[test]
fn one_colour_stays_one_colour() {
    let grey = 0.6015625;
    let mut scene = rotor();
    for material in &mut scene.materials {
        *material = Material { unlit: true, ..Material::diffuse("grey", Vec3::splat(grey)) };
    }
    let watched = Watched::with_scene(scene);
    let picture = watched.picture(DEEP, &both(BOTH, &[("spp", "4"), ("background", "0.6015625"), ON]));
    let far = picture.pixels.iter().flatten().map(|value| (value - grey).abs()).fold(0.0, f32::max);
    assert!(far < 1e-6, "{far}");
}

/// Stripes of `colors` one beside the other, that have this size together, `depth` metres before the eye.
fn stripes(scene: &mut Scene, colors: &[Vec3], half_size: [f32; 2], depth: f32) {
    let half = half_size[0] / colors.len() as f32;
    for (index, color) in colors.iter().enumerate() {
        let center = Vec3::new(half * (2.0 * index as f32 + 1.0) - half_size[0], 0.0, -depth);
        rectangle(scene, center, half * Vec3::X, half_size[1] * Vec3::Y, panel(*color));
    }
}

/// The frame is 4 m wide at 4 m before the eye.
fn eye(scene: &mut Scene) {
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, 2.0 * (0.5f32 * 54.0 / 96.0).atan()));
}

/// A panel that passes by a wall of stripes by a third of the frame's width.
fn passing() -> Scene {
    let at = |x: f32, hash: &str| {
        let mut scene = Scene { name: "passing".to_owned(), hash: hash.to_owned(), ..Scene::default() };
        let white = panel(Vec3::ONE);
        rectangle(&mut scene, Vec3::new(x, 0.0, -3.0), 0.4 * Vec3::X, 0.4 * Vec3::Y, white);
        stripes(&mut scene, &[Vec3::splat(0.4), Vec3::ZERO, Vec3::splat(0.2)], [10.0, 8.0], 8.0);
        eye(&mut scene);
        scene
    };
    at(-0.5, "open").closing_as(at(0.5, "closed")).unwrap()
}

const FLAT: Changes<'_> = &[SIZE, ("spp", "8"), ("aperture", "0.4"), ("focus", "4")];

/// What is in focus, sharp to its rim, before stripes that are blurred over 20 pixels: it keeps the bits of its samples' mean,
/// and so do those that see nothing else.
#[test]
fn what_is_sharp_takes_nothing_from_what_is_behind() {
    let mut scene = Scene { name: "sharp".to_owned(), ..Scene::default() };
    let (red, green) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
    stripes(&mut scene, &[red, 0.5 * red, red, 0.25 * red], [1.0, 0.6], 4.0);
    stripes(&mut scene, &[green, Vec3::ZERO, green, Vec3::ZERO, green, 3.0 * green], [12.0, 8.0], 16.0);
    eye(&mut scene);
    let watched = Watched::with_scene(scene);
    let [mean, filtered] = ["off", "on"].map(|is| watched.picture(DEEP, &both(FLAT, &[("reconstruct", is)])));
    let mut changed = 0;
    for (index, (mean, filtered)) in mean.pixels.iter().zip(&filtered.pixels).enumerate() {
        let at = [index % 96, index / 96];
        // Two metres of four, and 1.2 of 2.25.
        let is_sharp = (24..72).contains(&at[0]) && (13..41).contains(&at[1]);
        if is_sharp && mean[1] == 0.0 {
            assert_eq!(mean, filtered, "{at:?}");
        }
        // The rim shows as much of what is in focus as the pixel's own samples see.
        assert!((mean[0] - filtered[0]).abs() < 2e-6, "{at:?}: {mean:?}, {filtered:?}");
        changed += usize::from(mean != filtered);
    }
    assert!(changed > 96 * 54 / 10, "{changed} pixels are filtered");
}

/// A blurred panel before sharp stripes: half as much error as without the filter at least, and as much light.
#[test]
fn what_is_blurred_before_what_is_sharp_gets_smooth_and_no_darker() {
    let mut scene = Scene { name: "near".to_owned(), ..Scene::default() };
    stripes(&mut scene, &[Vec3::new(0.2, 0.4, 1.0)], [0.25, 0.25], 1.5);
    stripes(&mut scene, &[Vec3::ONE, Vec3::splat(0.8), Vec3::ONE, Vec3::splat(0.6)], [3.0, 2.0], 4.0);
    eye(&mut scene);
    let watched = Watched::with_scene(scene);
    let of = |changes: Changes<'_>| watched.picture(DEEP, &both(FLAT, changes));
    let (mean, filtered, reference) = (of(&[]), of(&[ON]), of(&[("accumulate", "64")]));
    let errors = [&mean, &filtered].map(|picture| rmse(picture, &reference));
    println!("{errors:?}, means {:?}, {:?}, {:?}", mean.mean(), filtered.mean(), reference.mean());
    assert!(errors[1] < 0.5 * errors[0], "{errors:?}");
    for (light, should) in filtered.mean().iter().zip(reference.mean()) {
        assert!((light - should).abs() < 2e-3 * should, "{light}, {should}");
    }
}

/// Without blur there is nothing to do: no pass, no memory.
#[test]
fn a_sharp_picture_is_the_mean_and_costs_nothing_more() {
    let program = Program::new();
    let json = |settings: &[&str]| {
        let common = ["render", "cornell", "--technique", DEEP, "--size", "33x17", "--spp", "2", "--json", "--quiet"];
        program.run(&[&common, settings].concat()).fine().json()
    };
    let (on, off) = (json(&["--reconstruct", "on"]), json(&[]));
    assert_eq!(on["settings"]["reconstruct"], "off");
    assert_eq!(on["image"]["hash"], off["image"]["hash"]);
    assert_eq!(on["memory"]["planned_bytes"], off["memory"]["planned_bytes"]);
}

/// What a user gets who says nothing of samples, and what the settings say of it.
#[test]
fn a_blurred_picture_has_all_tuples_in_every_pixel_and_is_filtered() {
    let program = Program::new();
    let resolved = |settings: &[&str]| {
        let common = ["render", "cornell", "--technique", DEEP, "--size", "32x32", "--json", "--quiet"];
        let json = program.run(&[&common, settings].concat()).fine().json();
        ["spp", "tuples", "reconstruct"].map(|key| json["settings"][key].to_string().trim_matches('"').to_owned())
    };
    let blurred = |settings: &[&str]| resolved(&[&["--aperture", "0.2"], settings].concat());
    assert_eq!(resolved(&[]), ["8", "8", "off"]);
    assert_eq!(blurred(&[]), ["32", "32", "on"]);
    // 32x32 pixels of 64 bytes a sample.
    assert_eq!(blurred(&["--sample-memory", "512KiB"]), ["8", "32", "on"]);
    assert_eq!(blurred(&["--sample-memory", "524287"]), ["4", "16", "on"]);
    assert_eq!(blurred(&["--accumulate", "2"]), ["32", "32", "off"]);
    assert_eq!(blurred(&["--lists", "direct", "--visibility", "ray"]), ["32", "32", "off"]);
    assert_eq!(blurred(&["--stereo", "0.1"]), ["32", "32", "off"]);
    assert_eq!(blurred(&["--spp", "8"]), ["8", "32", "off"]);
    assert_eq!(blurred(&["--tuples", "12"]), ["12", "12", "on"]);
    let unread = ["render", "cornell", "--technique", DEEP, "--spp", "8", "--sample-memory", "1GiB"];
    program.fails(&unread, 2, &["--sample-memory", "--spp"]);
}

/// What `--sample-memory` reckons is the most that any buffers have: by the difference that samples make, beside tiles and pixels.
#[test]
fn a_sample_takes_at_most_as_many_bytes_as_are_reckoned() {
    let program = Program::new();
    let planned = |settings: &[&str], spp: &str| {
        let common =
            ["memory", "cornell", "--technique", DEEP, "--plan", "--size", "640x360", "--aperture", "0.1", "--json"];
        let json = program.run(&[&common, settings, &["--spp", spp, "--tuples", "32"]].concat()).fine().json();
        json["techniques"][0]["memory"]["groups"]
            .as_object()
            .unwrap()
            .values()
            .map(|bytes| bytes.as_u64().unwrap())
            .sum::<u64>()
    };
    let fragment = ["--shade-by", "fragment", "--zmax", "on"];
    let mut most = 0;
    for settings in [
        &["--reconstruct", "on"][..],
        &[&fragment[..], &["--reconstruct", "on"]].concat(),
        &[&fragment[..], &["--reconstruct", "on", "--visibility", "stochastic"]].concat(),
        &[&fragment[..], &["--lists", "direct", "--visibility", "ray"]].concat(),
    ] {
        let bytes = (planned(settings, "16") - planned(settings, "8")) as f64 / (8.0 * 640.0 * 360.0);
        println!("{settings:?}: {bytes} bytes a sample");
        assert!(bytes <= 64.0, "{settings:?}: {bytes}");
        most = most.max(bytes.ceil() as u64);
    }
    assert!(most > 48, "{most}");
}

/// Against many samples of other tuples: less error than the paper's 8 of 32 have, filtered or not, and not more than the same samples
/// have without the filter, by RMSE and by HDR-FLIP.
#[test]
fn the_default_has_less_error_than_eight_samples_of_thirty_two_tuples_and_than_its_own_samples() {
    for (name, watched, common) in [
        ("lens", Watched::open("hall:triangles=8000"), LENS),
        ("motion and lens", Watched::with_scene(passing()), &[SIZE, ("aperture", "0.4"), ("focus", "4")]),
    ] {
        let of = |changes: Changes<'_>| watched.picture(DEEP, &both(common, changes));
        let reference = of(&[("spp", "8"), ("accumulate", "64"), ("seed", "77")]);
        let [default, own, mean, filtered] = [&[][..], &[("reconstruct", "off")], &[("spp", "8")], &[("spp", "8"), ON]]
            .map(|changes| {
                let metrics = compare(&of(changes), &reference, DEFAULT_THRESHOLD).unwrap().metrics;
                [metrics.rmse, metrics.hdr_flip]
            });
        println!("{name}: {default:?} by default, {own:?} unfiltered, {mean:?} of 8 samples, {filtered:?} filtered");
        assert!(default[0] < 0.9 * filtered[0].min(mean[0]), "{name}: {default:?}, {filtered:?}, {mean:?}");
        assert!(default[0] < own[0] && default[1] < own[1], "{name}: {default:?}, {own:?}");
    }
}

/// Two buffers of eight bytes a sample, whatever the table of tuples pads; 33 bins of 48 bytes and 96 more a tile of 16x16
/// pixels; four layers of 24 bytes a pixel; and the mean, from which the picture is made. The last ones are longer than the device
/// binds.
#[test]
fn memory_is_planned_to_the_byte() {
    let program = Program::new();
    let planned = |size: &str, reconstruct: &str| {
        let arguments = ["memory", "cornell", "--technique", DEEP, "--plan", "--size", size, "--spp", "8"];
        let settings = ["--aperture", "0.1", "--reconstruct", reconstruct, "--json"];
        let json = program.run(&[&arguments[..], &settings].concat()).fine().json();
        let memory = json["techniques"][0]["memory"].clone();
        let groups: BTreeMap<String, u64> = serde_json::from_value(memory["groups"].clone()).unwrap();
        (groups, memory["planned_bytes"].as_u64().unwrap())
    };
    for (size, pixels, tiles) in
        [("1280x720", 1280 * 720, 80 * 45), ("161x91", 161 * 91, 11 * 6), ("2048x1152", 2048 * 1152, 128 * 72)]
    {
        let ((off, all_off), (on, all_on)) = (planned(size, "off"), planned(size, "on"));
        let own = 2 * 8 * 8 * pixels + (33 * 48 + 96) * tiles + 4 * 24 * pixels;
        assert_eq!(on["reconstruction"], own, "{size}");
        // Groups have images as the driver pads them.
        assert_eq!(on["color"], off["picture"], "{size}");
        assert_eq!(all_on - all_off, own + 16 * pixels, "{size}");
        for group in ["frame_buffer", "deep_shading_buffer", "auxiliary"] {
            assert_eq!(on[group], off[group], "{size}: {group}");
        }
    }
}

#[test]
fn samples_without_spids_are_refused() {
    let watched = Watched::open("cornell");
    for (changes, said) in [
        (&[("lists", "direct"), ("visibility", "ray")][..], "--reconstruct on with --lists direct"),
        (&[("shading", "ssaa")], "--reconstruct on with --shading ssaa"),
        (&[("shading", "msaa")], "--reconstruct on with --shading msaa"),
    ] {
        let made =
            watched.try_renderer(DEEP, &both(changes, &[ON]), &[], quincunx::gpu::commands::Submits::One).map(|_| ());
        let error = made.unwrap_err();
        assert_eq!(error.exit_code(), 2, "{changes:?}");
        assert!(error.to_string().contains(said), "{changes:?}: {error}");
    }
}
