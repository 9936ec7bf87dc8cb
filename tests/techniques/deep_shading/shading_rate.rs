//! Triangles that are shaded as coarsely as blur lets them be (`--shading-rate blur`).

use super::guard_band::{Y_FOV, wall};
use super::{DEEP, FOVEATED, FRAGMENT, conservative, refusal, turning, visibilities};
use crate::support::difference::{self, require_same};
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat4, Vec3};
use quincunx::picture::Picture;
use quincunx::scene;
use std::collections::BTreeMap;

const BLUR: (&str, &str) = ("shading-rate", "blur");
const SIZE: (&str, &str) = ("size", "160x90");

/// A picture, and what was counted.
fn seen(watched: &Watched, changes: Changes<'_>) -> (Picture, BTreeMap<&'static str, f64>) {
    let renderer = watched.render(DEEP, changes);
    let counters = renderer.measured_counters().unwrap();
    assert_eq!(counters["samples_without_colour"], 0.0, "{changes:?}");
    assert_eq!(counters["samples_of_full_lists"], 0.0, "{changes:?}");
    (renderer.picture().unwrap(), counters)
}

fn counters(watched: &Watched, changes: Changes<'_>) -> BTreeMap<&'static str, f64> {
    seen(watched, changes).1
}

/// As many pixels of shading space as what is seen of the wall has, each as wide along an axis as a stated part of the blur there;
/// those at its rim are shaded whole, and those along its diagonal for both triangles.
#[test]
fn a_wall_out_of_focus_has_as_many_pixels_as_its_blur_lets_it() {
    let px_of_m = 45.0 / (0.5 * f64::from(Y_FOV)).tan() / 4.0;
    let common = [SIZE, ("spp", "8"), ("tuples", "32"), ("guard-band", "64"), BLUR];
    let still = Watched::with_scene(wall(0.0));
    let moved = Watched::with_scene(wall(0.0).closing_as(wall(1.0)).unwrap());
    // A wall twice as far as the plane in focus is spread as wide as the lens is.
    let lens = [("aperture", "2"), ("focus", "2")];
    for (watched, blur_m, changes, blur_pixels) in [
        (&still, [2.0, 2.0], &lens[..], 8.0),
        (&still, [2.0, 2.0], &both(&lens, &[("blur-pixels", "20")]), 20.0),
        (&still, [2.0, 2.0], &both(&lens, &[("shading-scale", "0.5")]), 8.0),
        (&moved, [1.0, 0.0], &[], 8.0),
        // Along the way the circle comes in addition.
        (&moved, [1.5, 0.5], &[("aperture", "0.5"), ("focus", "2")], 8.0),
    ] {
        let scale = if changes.contains(&("shading-scale", "0.5")) { 0.5 } else { 1.0 };
        let [width, height] = [(160.0, blur_m[0]), (90.0, blur_m[1])].map(|(side, blur_m)| {
            let blur_px = blur_m * px_of_m * scale;
            (side * scale + blur_px) * (blur_pixels / blur_px).clamp(0.0625, 1.0)
        });
        let found = counters(watched, &both(&common, changes))["listed_primitives"];
        println!("{changes:?}: {found} of {width} x {height} pixels");
        // Places on the lens leave out the corners of the box around it, and a little of its rim.
        let (least, most) = (0.88 * width * height, width * height + 2.0 * (width + height) + 4.0);
        assert!(found >= least && found <= most, "{changes:?}: {found}, {least} to {most}");
    }
}

/// What is sharp, in focus or at rest, keeps its bits; so does what turns, whose corners go different ways.
#[test]
fn what_is_sharp_is_shaded_at_each_pixel() {
    let common = [SIZE, ("spp", "8")];
    for (watched, changes) in [
        (Watched::open("chess:triangles=12000"), &[][..]),
        (Watched::with_scene(wall(0.0)), &[("aperture", "0.5"), ("focus", "4")]),
        (Watched::with_scene(turning("fence:lights=6")), &[("aperture", "0.001"), ("camera", "rotor")]),
    ] {
        let changes = both(&common, changes);
        let full = watched.picture(DEEP, &changes);
        require_same(&watched.session.gpu, &watched.picture(DEEP, &both(&changes, &[BLUR])), &full, &changes);
    }
}

/// Against many samples that are shaded at each pixel.
#[test]
fn coarse_shading_does_not_show_in_a_wide_blur() {
    let watched = Watched::open("chess:triangles=12000");
    let common = [("size", "320x180"), ("aperture", "0.05"), ("focus", "4"), ("spp", "32")];
    let reference = watched.picture(DEEP, &both(&common, &[("spp", "64"), ("tuples", "64"), ("accumulate", "4")]));
    let found = |changes: Changes<'_>| {
        let (picture, counters) = seen(&watched, &both(&common, changes));
        (difference::rmse(&picture, &reference), counters["shaded_per_pixel"])
    };
    let (full, full_rate) = found(&[]);
    let (blur, blur_rate) = found(&[BLUR]);
    let (coarse, coarse_rate) = found(&[BLUR, ("blur-pixels", "1")]);
    println!("RMSE, executions a pixel: {full} {full_rate}, {blur} {blur_rate}, {coarse} {coarse_rate}");
    assert!(blur_rate < 0.5 * full_rate && blur < 1.1 * full, "{blur}, {full}");
    assert!(coarse_rate < blur_rate && coarse > 1.1 * blur, "{coarse}, {blur}");
}

/// All that reads how coarse triangles are: entries, and fragments of every method that the driver has.
#[track_caller]
fn require_one_coarse_picture(watched: &Watched, common: Changes<'_>) {
    let sharp = &both(common, &[("size", "97x55")]);
    let common = &both(sharp, &[BLUR, ("blur-pixels", "2")]);
    let (alone, full) = (watched.picture(DEEP, &both(common, &[("lists", "none")])), counters(watched, sharp));
    let (listed, coarse) = seen(watched, common);
    require_same(&watched.session.gpu, &listed, &alone, common);
    let [coarse, full] = [coarse, full].map(|counters| counters["shaded_per_pixel"]);
    println!("{common:?}: {coarse} of {full} executions a pixel");
    assert!(coarse < 0.8 * full, "{common:?}: {coarse} of {full}");
    let goes = |method: &&str| *method != "hardware" || !common.contains(&FOVEATED);
    let drawn = conservative(watched).into_iter().filter(goes);
    let drawn = drawn.map(|method| vec![FRAGMENT, ("conservative", method), ("zmax", "on")]);
    for method in drawn.chain([vec![("shading", "indirect-gbuffer")]]) {
        let changes = both(common, &method);
        require_same(&watched.session.gpu, &watched.picture(DEEP, &changes), &alone, &changes);
    }
}

#[test]
fn every_method_shades_coarse_triangles_alike() {
    let lamps = Watched::open("lamps:objects=40,lights=8");
    let lens = [("spp", "2"), ("aperture", "0.4"), ("focus", "3")];
    require_one_coarse_picture(&lamps, &lens);
    require_one_coarse_picture(&lamps, &both(&lens, &[("guard-band", "8"), FOVEATED]));
    let mut closing = scene::load("cornell", 1).unwrap();
    // One of the same hash would be the same scene.
    closing.hash.push('\'');
    for draw in &mut closing.draws {
        draw.world_from_object = Mat4::from_translation(Vec3::X) * draw.world_from_object;
    }
    let pushed = Watched::with_scene(scene::load("cornell", 1).unwrap().closing_as(closing).unwrap());
    require_one_coarse_picture(&pushed, &[("spp", "4")]);
}

/// Whatever sees the samples, they have coarse pixels, and both eyes of two share them.
#[test]
fn every_visibility_finds_coarse_pixels() {
    let watched = Watched::open("lamps:objects=40,lights=8");
    let common = [SIZE, ("spp", "8"), ("aperture", "0.4"), ("focus", "3"), ("brdf", "lambert")];
    let coarse = both(&common, &[BLUR, ("blur-pixels", "4")]);
    let found = |changes: Changes<'_>| {
        let (picture, counters) = seen(&watched, &both(&coarse, changes));
        (picture, counters["shaded_per_pixel"])
    };
    let (frames, rate) = found(&[("visibility", "repeat-frame")]);
    let full = counters(&watched, &common)["shaded_per_pixel"];
    println!("{rate} of {full} executions a pixel");
    assert!(rate < 0.5 * full, "{rate} of {full}");
    let kinds = visibilities("deep").into_iter().filter(|kind| !["ray", "stochastic"].contains(kind));
    let stochastic = ["loop", "layers"]
        .map(|tests| vec![("visibility", "stochastic"), ("pixel-samples", "shared"), ("sample-tests", tests)]);
    for changes in kinds.map(|kind| vec![("visibility", kind)]).chain(stochastic) {
        let (picture, other) = found(&changes);
        let apart = difference::rmse(&picture, &frames);
        println!("{changes:?}: {other} executions a pixel, {apart} apart");
        assert!((other / rate - 1.0).abs() < 0.02 && apart < 0.02, "{changes:?}: {other} and {rate}, {apart}");
    }
    let eyes = [("stereo", "0.1")];
    let (_, both_eyes) = found(&eyes);
    let full = counters(&watched, &both(&common, &eyes))["shaded_per_pixel"];
    println!("two eyes: {both_eyes} of {full}");
    assert!(both_eyes < 0.6 * full, "{both_eyes} of {full}");
}

#[test]
fn rays_of_the_host_do_not_know_how_coarse_triangles_are() {
    let watched = Watched::open("cornell");
    let text = refusal(&watched, &[BLUR, ("visibility", "ray")]);
    assert!(
        text.contains("--shading-rate blur with --visibility ray") && text.contains("--visibility stoch"),
        "{text}"
    );
    let text = refusal(&watched, &[("blur-pixels", "4")]);
    assert!(text.contains("--blur-pixels 4") && text.contains("--shading-rate full"), "{text}");
}
