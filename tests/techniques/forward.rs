//! Forward shading: its plain ways give its own bits, it is deferred shading but for what a G-buffer rounds, and several
//! samples bring edges nearer to what every place of a pixel shows.

use crate::support;
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use quincunx::gpu::commands::Submits;
use quincunx::picture::{AovChannels, Picture};

const FORWARD: &str = "forward";
const SIZE: (&str, &str) = ("size", "161x91");

/// All of `variants` make the picture of the first.
#[track_caller]
fn require_one_picture(watched: &Watched, common: Changes<'_>, variants: &[Changes<'_>]) -> String {
    let first = watched.picture(FORWARD, &both(common, variants[0]));
    for variant in &variants[1..] {
        let found = watched.picture(FORWARD, &both(common, variant));
        require_same(&watched.session.gpu, &found, &first, &(variant, common));
    }
    first.hash().unwrap()
}

/// Part by which two channels differ, the darkest taken for 0.01.
fn relative(a: f32, b: f32) -> f64 {
    f64::from((a - b).abs()) / (f64::from(b.abs()) + 0.01)
}

/// The root of the mean of the squares over pixels that `counts` names, and how many these are.
fn rmse(a: &Picture, b: &Picture, counts: impl Fn(usize) -> bool) -> (f64, usize) {
    let named: Vec<usize> = (0..a.pixels.len()).filter(|index| counts(*index)).collect();
    let squares = named.iter().flat_map(|index| a.pixels[*index].iter().zip(&b.pixels[*index]));
    let sum: f64 = squares.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    ((sum / (3 * named.len()) as f64).sqrt(), named.len())
}

/// The G-buffer holds base colours in half floats (2^-12 of them are lost at most), normals in steps of 2^-15, roughness
/// and metallic in 255ths, and here positions as they are. Only the steps of roughness can be seen: a highlight's peak goes
/// with its fourth power, so that half a step at roughness 0.1 is 8 % of it, while its surroundings stay. Hence a tight
/// bound on 99 % of the channels, a wide one on all, and one on the mean of each picture.
#[test]
fn with_one_sample_it_is_deferred_shading_but_for_what_a_g_buffer_rounds() {
    for (scene, changes) in [
        ("cornell", &[][..]),
        ("lamps:objects=40,lights=60", &[]),
        ("lamps:objects=40,lights=60", &[("direct-shadow", "ray"), ("ambient", "0.1")]),
        ("lamps:objects=40,lights=60", &[("brdf", "lambert")]),
        ("hall:triangles=8000", &[]),
        ("hall:triangles=8000", &[("background", "0.2"), ("brdf", "blinn-phong")]),
    ] {
        let watched = Watched::open(scene);
        let changes = both(changes, &[SIZE]);
        let forward = watched.picture(FORWARD, &changes);
        let deferred = watched.picture("deferred", &both(&changes, &[("position", "float")]));
        let pairs = || forward.pixels.iter().flatten().zip(deferred.pixels.iter().flatten());
        let mut parts: Vec<f64> = pairs().map(|(a, b)| relative(*a, *b)).collect();
        parts.sort_by(f64::total_cmp);
        let (most, usual) = (parts[parts.len() - 1], parts[parts.len() * 99 / 100]);
        let [ours, theirs] = [&forward, &deferred].map(|picture| picture.mean().iter().sum::<f64>());
        let mean = (ours / theirs - 1.0).abs();
        println!("{scene} {changes:?}: most {most:.5}, 99 % {usual:.5}, means {mean:.6} apart");
        assert!(most < 0.1 && usual < 0.02 && mean < 1e-3, "{scene} {changes:?}: {most} {usual} {mean}");
        assert!(most > 0.0, "two techniques that are one would prove nothing");
    }
}

#[test]
fn lists_of_lights_change_no_pixel() {
    let lists: [Changes<'_>; 4] = [
        &[("light-lists", "none"), ("light-buffer", "storage")],
        &[("light-lists", "object"), ("light-buffer", "storage")],
        &[("light-lists", "none"), ("light-buffer", "uniform")],
        &[("light-lists", "object"), ("light-buffer", "uniform")],
    ];
    let watched = Watched::open("lamps:objects=40,lights=60");
    for common in [&[SIZE][..], &[SIZE, ("msaa", "4")], &[("size", "64x36"), ("direct-shadow", "ray")]] {
        require_one_picture(&watched, common, &lists);
    }
    let counter = |changes: Changes<'_>, key: &str| {
        watched.render(FORWARD, &both(&[SIZE], changes)).measured_counters().unwrap()[key]
    };
    assert_eq!(counter(&[("light-lists", "none")], "lights_per_object"), 60.0);
    assert!(counter(&[], "lights_per_object") < 40.0);
    assert_eq!(counter(&[], "lights_per_object_most"), 60.0, "the floor is one object");
    assert!(counter(&[], "lights_per_pixel") < counter(&[("light-lists", "none")], "lights_per_pixel"));
    // Blended surfaces have lists too.
    let watched = Watched::open("hall:triangles=8000");
    let scattered = [SIZE, ("lights", "60")];
    assert!(watched.render(FORWARD, &scattered).counters["blended_draws"] > 0.0);
    for common in [&scattered[..], &both(&scattered, &[("msaa", "4")])] {
        require_one_picture(&watched, common, &lists);
    }
}

/// Holes, vertex colours, textures of many sizes, sixty lamps.
#[test]
fn real_maps_have_one_picture_too() {
    let Some(folder) = support::shared_scenes() else { return };
    for map in ["maps/kaos.glb", "maps/pul1duel-oa.glb"] {
        let watched = Watched::open(folder.join(map).to_str().unwrap());
        let variants: [Changes<'_>; 3] =
            [&[], &[("light-lists", "none")], &[("depth-prepass", "off"), ("light-buffer", "storage")]];
        let common = [SIZE, ("lights", "60"), ("sun", "off")];
        require_one_picture(&watched, &common, &variants);
        require_one_picture(&watched, &both(&common, &[("msaa", "4")]), &variants[..2]);
    }
}

#[test]
fn samples_bring_edges_nearer_to_what_every_place_of_a_pixel_shows() {
    let watched = Watched::open("lamps:objects=40,lights=24");
    let plain = watched.render_as(FORWARD, &[SIZE], &["depth.reversed"], Submits::One);
    let AovChannels::Y(depths) = plain.aov("depth.reversed").unwrap().channels else { panic!("depth is one number") };
    let plain = plain.picture().unwrap();
    // The distance jumps by a tenth to the right or below.
    let width = plain.extent.width as usize;
    let jumps = |a: f32, b: f32| a.max(b) > 1.1 * a.min(b);
    let is_edge = |index: usize| {
        let near = [index + 1, index + width];
        near.iter().any(|other| depths.get(*other).is_some_and(|depth| jumps(depths[index], *depth)))
    };
    let reference = watched.picture(FORWARD, &[SIZE, ("supersample", "8")]);
    let (jagged, edge_count) = rmse(&plain, &reference, is_edge);
    assert!(edge_count > 300, "{edge_count} pixels on edges");
    let four = watched.picture(FORWARD, &[SIZE, ("msaa", "4")]);
    let (smooth, _) = rmse(&four, &reference, is_edge);
    let (nine, _) = rmse(&watched.picture(FORWARD, &[SIZE, ("supersample", "3")]), &reference, is_edge);
    println!(
        "{edge_count} pixels on edges: RMSE {jagged:.4} with one sample, {smooth:.4} with four, {nine:.4} of 3x3 runs"
    );
    assert!(smooth < 0.7 * jagged && nine < 0.5 * jagged, "{jagged} {smooth} {nine}");
    // One run of supersampling is the plain picture, and a mean of runs is one of light.
    assert_eq!(watched.hash(FORWARD, &[SIZE, ("supersample", "1")]), plain.hash().unwrap());
    let means = [&plain, &reference].map(|picture| picture.mean().iter().sum::<f64>());
    assert!((means[0] / means[1] - 1.0).abs() < 0.01, "{means:?}");
}

#[test]
fn no_light_and_one_and_two_thousand() {
    let dark = Watched::with_scene({
        let mut scene = quincunx::scene::load("cornell", 1).unwrap();
        scene.lights.clear();
        scene
    });
    let changes = [SIZE, ("ambient", "0.5"), ("rig", "none")];
    let counters = dark.render(FORWARD, &changes).measured_counters().unwrap();
    assert_eq!((counters["lights"], counters["lights_per_pixel"]), (0.0, 0.0));
    assert!(dark.picture(FORWARD, &changes).mean()[1] > 0.01, "ambient light is there");
    for (count, buffer) in [("1", "uniform"), ("2000", "storage")] {
        let changes = [("size", "64x36"), ("lights", count), ("rig", "none")];
        let renderer = dark.render(FORWARD, &changes);
        assert_eq!(
            (renderer.counters["lights"].to_string().as_str(), &*renderer.resolved["light-buffer"]),
            (count, buffer)
        );
        let pictures = [FORWARD, "deferred"].map(|technique| dark.picture(technique, &changes).mean()[1]);
        assert!((pictures[0] / pictures[1] - 1.0).abs() < 2e-3, "{count} lights: {pictures:?}");
    }
    let refused = dark.try_renderer(FORWARD, &[("lights", "1025"), ("light-buffer", "uniform")], &[], Submits::One);
    let error = refused.err().expect("a uniform buffer holds 1024");
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("1025 lights: it holds 1024"), "{error}");
}

#[test]
fn samples_that_a_device_has_not_are_refused() {
    let watched = Watched::open("cornell");
    if watched.session.gpu.caps.formats.float_color_sample_counts.contains(&8) {
        return support::skip("the device has 8 samples a pixel");
    }
    let error = watched.try_renderer(FORWARD, &[("msaa", "8")], &[], Submits::One).err().unwrap();
    let text = error.to_string();
    assert_eq!(error.exit_code(), 3);
    assert!(text.contains("--msaa 8 needs 8 samples") && text.contains("--msaa 4 works"), "{text}");
}

/// Aliased bytes, submits and stages are those of every technique.
#[test]
fn submits_and_shared_bytes_change_no_pixel() {
    let watched = Watched::open("hall:triangles=8000");
    for more in [&[][..], &[("msaa", "4")], &[("msaa", "4"), ("supersample", "2")], &[("supersample", "2")]] {
        let modes: [Changes<'_>; 3] = [&[("alias", "off")], &[("alias", "greedy")], &[("alias", "optimal")]];
        let hash = require_one_picture(&watched, &both(&[SIZE], more), &modes);
        let apart = watched.render_as(FORWARD, &both(&[SIZE], more), &[], Submits::PerPass);
        assert_eq!(apart.picture().unwrap().hash().unwrap(), hash, "{more:?}");
    }
    let made = watched.try_renderer(FORWARD, &[SIZE, ("msaa", "4")], &["depth.reversed"], Submits::One);
    assert_eq!(made.map(|_| ()).unwrap_err().exit_code(), 2);
}
