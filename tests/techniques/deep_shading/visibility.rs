//! Stochastic rasterisation and rays of the same samples see what interleaved rasterisation does: what differs lies on edges, which the
//! rasteriser places to a 256th of a layer's pixel and their tests to a float. Lists and strays give the same bits as
//! without them.

use super::FRAGMENT;
use crate::support::difference::require_same;
use crate::support::moving::moving;
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, has, placing_steps};
use glam::Mat4;
use quincunx::scene::{self, AlphaMode, Projection, Scene};

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "161x91");
const STOCHASTIC: (&str, &str) = ("visibility", "stochastic");
const RAY: (&str, &str) = ("visibility", "ray");
const SHARED: (&str, &str) = ("pixel-samples", "shared");
/// A sample a pixel, so that the stage has all of them.
const SAMPLES: [(&str, &str); 4] = [SIZE, ("spp", "1"), ("tuples", "16"), SHARED];

/// The fence's rotor turns by a quarter of a turn.
fn rotor(spec: &str) -> Watched {
    Watched::with_scene(moving(spec, [0.0, 0.1]))
}

/// The triangles that samples see.
fn seen(watched: &Watched, changes: Changes<'_>) -> Vec<u32> {
    let stage = "visibility.spids";
    watched.integers(&watched.render_stages(DEEP, &both(&SAMPLES, changes), &[stage]), stage)
}

/// Samples that see another triangle are few, and most samples see one.
#[track_caller]
fn require_agreement(watched: &Watched, changes: Changes<'_>) {
    let interleaved = seen(watched, changes);
    let has_holes = watched.session.scene.drawn_materials().any(|material| material.alpha != AlphaMode::Opaque);
    for kind in [STOCHASTIC, RAY] {
        let others = seen(watched, &both(changes, &[kind]));
        let other = interleaved.iter().zip(&others).filter(|(a, b)| a != b).count() as f64 / interleaved.len() as f64;
        let hit = others.iter().filter(|id| **id != u32::MAX).count() as f64 / others.len() as f64;
        println!("{kind:?}, {changes:?}: {other} see another triangle, {hit} see one");
        if kind == STOCHASTIC && has(&watched.session.gpu.caps, Feature::GeometryShader) {
            let made = |stage| seen(watched, &both(changes, &[kind, ("polygon-from", stage)]));
            assert_eq!(made("geometry"), others, "{changes:?}: it is what auto comes to");
            let apart = made("vertex").iter().zip(&others).filter(|(a, b)| a != b).count();
            // Drivers may round otherwise after a geometry shader.
            assert!(apart as f64 <= 1e-4 * others.len() as f64, "{changes:?}: {apart} of {}", others.len());
        }
        assert!(hit > 0.3, "{kind:?}, {changes:?}: {hit}");
        let most = if has_holes && kind == RAY { MOST_OTHERS_BESIDE_HOLES } else { MOST_OTHERS };
        // Seen with 4 bits: 0.057 in the hall, 0.042 beside the rotor.
        let most = most * placing_steps(&watched.session.gpu.caps);
        assert!(other <= most, "{kind:?}, {changes:?}: {other} differ");
    }
}

/// With a rasteriser that places corners to 8 bits, an edge is up to 1/512 of a layer's pixel elsewhere, along x and
/// along y, so that a layer's pixel with an edge through it differs in one of some 300 cases; where a few edges go
/// through each, that is one in a hundred.
const MOST_OTHERS: f64 = 0.01;

/// Rays read alpha from the finest texture level, where layers, whose pixels are apart, read it from coarser ones.
const MOST_OTHERS_BESIDE_HOLES: f64 = 0.03;

#[test]
fn all_see_the_same_samples_sharp_and_under_a_lens() {
    let watched = Watched::open("cornell");
    require_agreement(&watched, &[]);
    require_agreement(&watched, &[("aperture", "0.2")]);
    let watched = Watched::open("hall:triangles=8000");
    require_agreement(&watched, &[]);
    require_agreement(&watched, &[("aperture", "0.3"), ("focus", "6")]);
}

#[test]
fn all_see_the_same_samples_while_things_move_with_holes_and_glass() {
    for spec in ["fence:lights=6", "fence:lights=6,alpha=mask"] {
        let watched = rotor(spec);
        let camera = [("camera", "rotor")];
        require_agreement(&watched, &camera);
        require_agreement(&watched, &both(&camera, &[("aperture", "0.1"), ("focus", "4")]));
    }
}

#[test]
fn lists_come_to_the_bits_of_every_sample_by_itself() {
    require_the_same_bits(STOCHASTIC, &[&[], &[FRAGMENT, ("compaction", "off"), ("zmax", "on")]]);
}

/// Rays may insert by themselves, without SPIDs.
#[test]
fn lists_of_rays_come_to_the_bits_of_every_sample_by_itself() {
    let direct = ("lists", "direct");
    require_the_same_bits(
        RAY,
        &[
            &[],
            &[direct],
            &[direct, FRAGMENT],
            &[direct, FRAGMENT, ("compaction", "off"), ("zmax", "on"), ("shaded-triangles", "all")],
        ],
    );
}

#[track_caller]
fn require_the_same_bits(kind: (&str, &str), methods: &[Changes<'_>]) {
    // Polygons as large as a layer are tested in each of its pixels.
    let blurred = [("size", "65x37"), kind, ("spp", "2"), ("tuples", "8")];
    let watched = Watched::open("hall:triangles=8000");
    // The second brings samples in from outside shading space.
    for lens in [
        [("aperture", "0.3"), ("focus", "6"), ("guard-band", "64")],
        [("aperture", "2"), ("focus", "2"), ("guard-band", "0")],
    ] {
        require_one_picture(&watched, &both(&blurred, &lens), methods);
    }
    require_one_picture(
        &rotor("fence:lights=6"),
        &both(&blurred, &[("camera", "rotor"), ("accumulate", "2")]),
        methods,
    );
}

#[track_caller]
fn require_one_picture(watched: &Watched, changes: Changes<'_>, methods: &[Changes<'_>]) {
    let alone = watched.picture(DEEP, &both(changes, &[("lists", "none")]));
    let mut listed = None;
    for method in methods {
        let renderer = watched.render(DEEP, &both(changes, method));
        require_same(&watched.session.gpu, &renderer.picture().unwrap(), &alone, &(method, changes));
        let counters = renderer.measured_counters().unwrap();
        assert_eq!(counters["samples_without_colour"], 0.0, "{method:?} with {changes:?}");
        // The pairs of triangle and shading pixel: the host's lists, made otherwise, have those of the device.
        let pairs = ["samples_outside_shading_space", "listed_primitives", "listed_digest"].map(|key| counters[key]);
        assert_eq!(*listed.get_or_insert(pairs), pairs, "{method:?} with {changes:?}");
    }
}

/// A camera that turns while the shutter is open moves corners on straight lines of the screen: rays must see them there.
#[test]
fn rays_see_a_turning_camera_as_the_rasteriser_does_without_perspective_too() {
    for name in ["perspective", "orthographic"] {
        let watched = Watched::with_scene(turning(name == "orthographic"));
        require_agreement(&watched, &[("aperture", "0.1"), ("focus", "3")]);
    }
}

/// Polygons grow with blur and triangles do not (section 4.2, table 3); the rasteriser's own tests are nobody's to count.
#[test]
fn tests_grow_with_the_aperture() {
    let watched = Watched::open("cornell");
    // A sharp triangle's polygon is the triangle, but for how far it reaches because corners are snapped (those of the ceiling
    // are seen as slivers); a rectangle, where that is small. Where all of a pixel's samples are tested, it reaches to the
    // middles of pixels.
    let ways = [("layers", 1.12 + 0.03 * placing_steps(&watched.session.gpu.caps)), ("auto", 1.3)];
    for (way, most) in ways {
        let common = both(&[SIZE, ("spp", "4"), ("sample-tests", way), SHARED], &[STOCHASTIC]);
        let counted: Vec<[f64; 2]> = ["0", "0.1", "0.2", "0.4"]
            .iter()
            .map(|aperture| {
                let changes = both(&common, &[("aperture", *aperture)]);
                let counters = watched.render(DEEP, &changes).measured_counters().unwrap();
                ["sample_tests", "sample_tests_hit"].map(|key| counters[key])
            })
            .collect();
        println!("{way}: tests and hits: {counted:?}");
        let [tests, hits] = counted[0];
        assert!(hits > 0.0 && tests < most * hits, "{way}: {counted:?}");
        assert!(counted.windows(2).all(|pair| pair[1][0] > 1.02 * pair[0][0]), "{way}: {counted:?}");
        assert!(counted.iter().all(|[_, now]| (now / hits - 1.0).abs() < 0.2), "{way}: {counted:?}");
    }
    let interleaved = watched.render(DEEP, &[SIZE, ("spp", "4"), ("aperture", "0.4")]).measured_counters().unwrap();
    assert!(!interleaved.contains_key("sample_tests"), "{interleaved:?}");
}

/// Walls and floors beside and behind the eye cross the near plane's level: what lies before it is cut off, and what is left of
/// them is beside the picture. Triangles of the arena are smaller than these pixels, all samples of which a loop tests, and polygons
/// reach as far as a driver may snap them: with 4 bits the arena has 11.8 tests a hit.
#[test]
fn what_passes_the_eye_is_not_tested_everywhere() {
    for (spec, camera) in [("hall:triangles=8000", "nave"), ("arena:triangles=60000", "flight")] {
        let watched = Watched::open(spec);
        let layered = 7.0 + placing_steps(&watched.session.gpu.caps);
        for (way, most) in [("layers", layered), ("auto", 16.0)] {
            let changes = [SIZE, ("camera", camera), ("spp", "2"), ("aperture", "0.1"), ("brdf", "lambert")];
            let changes = both(&changes, &[STOCHASTIC, ("sample-tests", way), SHARED]);
            let counters = watched.render(DEEP, &changes).measured_counters().unwrap();
            let [tests, hits] = ["sample_tests", "sample_tests_hit"].map(|key| counters[key]);
            println!("{spec}, {way}: {tests} tests, {hits} hits");
            assert!(hits > 0.0 && tests < most * hits, "{spec}, {way}: {tests} tests, {hits} hits");
        }
    }
}

/// The box, before a camera that turns by a few degrees.
fn turning(is_orthographic: bool) -> Scene {
    let moment = |degrees: f32| {
        let mut scene = scene::load("cornell", 1).unwrap();
        scene.hash = format!("{} {degrees}", scene.hash);
        let camera = &mut scene.cameras[0];
        camera.world_from_view *= Mat4::from_rotation_y(degrees.to_radians());
        if is_orthographic {
            let eye = camera.world_from_view.w_axis.truncate().length();
            let (z_near, z_far) = (0.01, 3.0 * eye);
            camera.projection = Projection::Orthographic { x_mag: 0.2 * eye, y_mag: 0.2 * eye, z_near, z_far };
        }
        scene
    };
    moment(-2.0).closing_as(moment(3.0)).unwrap()
}
