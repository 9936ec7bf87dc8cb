//! Deep shading of geometry that nobody would model: without an area, through the near plane, larger than the picture, thousands
//! in one pixel; and lenses so wide that nothing stays where it was. Every sample that sees something has its colour, which is
//! the one it has by itself, and what shading space has no place for is counted.

use super::FRAGMENT;
use crate::support::difference::require_same;
use crate::support::gltf_file::{GltfFile, U32};
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, has};
use quincunx::scene::{AnimationChoice, Model, Scene};
use serde_json::json;
use std::collections::BTreeMap;

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "97x61");

type Triangle = [[f32; 3]; 3];

/// Triangles seen from both sides by an eye at the origin that looks along -z, with a lamp beside it. Node 0 draws them.
fn file_of(triangles: &[Triangle]) -> GltfFile {
    let mut file = GltfFile::empty();
    let positions = file.floats("VEC3", triangles.as_flattened().as_flattened());
    let indices = file.indices(U32, &(0..3 * triangles.len() as u32).collect::<Vec<_>>());
    let material = file.push("materials", json!({"doubleSided": true}));
    let primitive = json!({"attributes": {"POSITION": positions}, "indices": indices, "material": material});
    file.push("meshes", json!({"primitives": [primitive]}));
    file.root(json!({"mesh": 0}));
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 40.0}]}});
    file.root(json!({"translation": [1, 2, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}));
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}));
    file.root(json!({"camera": 0}));
    file
}

/// The same while `path` of the node that draws changes from one value to the other.
fn moving(triangles: &[Triangle], path: &str, from: [f32; 3], to: [f32; 3]) -> Scene {
    let mut file = file_of(triangles);
    file.animate(0, path, "LINEAR", &[0.0, 1.0], ("VEC3", [from, to].as_flattened()));
    Model::File(Box::new(file.model(&AnimationChoice::All).unwrap())).exposed([0.0, 1.0]).unwrap()
}

type Counters = BTreeMap<&'static str, f64>;

/// Every method gives the bits of shading each sample by itself, none without a colour. Returns what the first one
/// counts. Where each shader rounds for itself (other drivers than software ones), what such triangles show depends on
/// rounding: their colours are numbers.
#[track_caller]
fn require_whole(watched: &Watched, common: Changes<'_>) -> Counters {
    let mut plain = vec![FRAGMENT, ("compaction", "off"), ("address-buffer", "off"), ("zmax", "on")];
    // The other one than `auto` chooses.
    plain.extend(has(&watched.session.gpu.caps, Feature::GeometryShader).then_some(("conservative", "vertex")));
    let mut first = None;
    for (visibility, methods) in [("repeat-frame", &[&[][..], &[FRAGMENT], &plain][..]), ("stochastic", &[&[]])] {
        let common = both(&[SIZE, ("spp", "4"), ("tuples", "8"), ("visibility", visibility)], common);
        let counted = |method: Changes<'_>| {
            let renderer = watched.render(DEEP, &both(&common, method));
            (renderer.picture().unwrap(), renderer.measured_counters().unwrap())
        };
        let (picture, alone) = counted(&[("lists", "none")]);
        assert_eq!(alone["samples_without_colour"], 0.0, "{common:?} without lists: {alone:?}");
        assert_eq!(alone["shader_invocations"], alone["samples_seen"], "{common:?}");
        for method in methods {
            let (found, counters) = counted(method);
            assert_eq!(counters["samples_without_colour"], 0.0, "{common:?} {method:?}: {counters:?}");
            assert_eq!(counters["samples_seen"], alone["samples_seen"], "{common:?} {method:?}");
            let strays = counters["samples_outside_shading_space"] + counters["samples_of_full_lists"];
            let asked = counters["listed_primitives"] + strays;
            assert_eq!(counters["shader_invocations"], asked, "{common:?} {method:?}: {counters:?}");
            if watched.session.gpu.caps.identity.is_software() {
                assert_eq!(found.hash().unwrap(), picture.hash().unwrap(), "{common:?} {method:?}");
            } else {
                assert!(found.pixels.iter().flatten().all(|channel| channel.is_finite()), "{common:?} {method:?}");
            }
            first.get_or_insert(counters);
        }
    }
    println!("{common:?}: {first:?}");
    first.unwrap()
}

/// Triangles without an area, hardly wider than none, smaller than samples are apart, twice in one place.
fn slivers() -> Vec<Triangle> {
    let mut triangles = vec![
        [[0.3, 0.2, -4.0]; 3],
        [[-1.0, 0.0, -4.0], [0.0, 0.0, -4.0], [1.0, 0.0, -4.0]],
        [[0.0, -1.0, -3.0], [0.0, -1.0, -3.0], [0.5, 1.0, -5.0]],
        [[0.0, 0.5, -3.0], [0.0, 0.5, -30.0], [1e-6, 0.5, -300.0]],
    ];
    for index in 0..60 {
        let turn = 0.1047 * index as f32;
        let (x, y) = (turn.cos(), turn.sin());
        let width = 10f32.powi(-(index % 8));
        triangles.push([[0.0, 0.0, -4.0], [1.6 * x, 1.2 * y, -4.0], [1.6 * x - width * y, 1.2 * y + width * x, -4.5]]);
        // All but edge-on.
        triangles.push([[x, y, -3.0], [2.0 * x, 2.0 * y, -6.0 - width], [3.0 * x, 3.0 * y + 0.1 * width, -9.0]]);
        let (x, y) = (1.4 * x, 1.1 * y);
        triangles.push([[x, y, -4.2], [x + 1e-3 * width, y, -4.2], [x, y + 1e-3, -4.2]]);
    }
    let again: Vec<Triangle> = triangles.iter().step_by(5).copied().collect();
    triangles.extend(again);
    triangles
}

#[test]
fn slivers_have_all_their_colours() {
    let watched = Watched::with_scene(file_of(&slivers()).load().unwrap());
    assert!(require_whole(&watched, &[])["samples_seen"] > 500.0);
    require_whole(&watched, &[("aperture", "0.4"), ("focus", "8")]);
    require_whole(&watched, &[("guard-band", "0"), ("shading-scale", "0.3"), ("shading-warp", "foveated")]);
}

#[test]
fn slivers_in_motion_have_all_their_colours() {
    let watched = Watched::with_scene(moving(&slivers(), "translation", [-1.5, -0.2, 2.0], [1.0, 0.3, -1.0]));
    assert!(require_whole(&watched, &[])["samples_seen"] > 500.0);
    require_whole(&watched, &[("aperture", "0.4"), ("focus", "8"), ("guard-band", "3")]);
    // From no size at all, and turned inside out.
    let watched = watched.showing(moving(&slivers(), "scale", [0.0; 3], [1.0; 3]));
    require_whole(&watched, &[("aperture", "0.1")]);
    let watched = watched.showing(moving(&slivers(), "scale", [1.0, -1.0, 1.0], [1.0; 3]));
    require_whole(&watched, &[]);
}

/// Plates whose planes pass the eye at many distances, at an angle of the screen.
fn plates(angle: f32) -> Vec<Triangle> {
    let (x, y) = (angle.cos(), angle.sin());
    let plate = |index: i32| {
        let off = 0.0001 * index as f32;
        let at = |along: f32, z: f32| [3.0 * along * x - off * y, 3.0 * along * y + off * x, z];
        [at(-1.0, -2.0), at(1.0, -2.0), at(0.0, -40.0)]
    };
    (-5000..5000).map(plate).collect()
}

/// While they pass the eye some samples see them so nearly edge-on that what lies a 500th of a pixel beside a plate is far away in
/// shading space, where each is broad.
#[test]
fn plates_that_pass_the_eye_have_all_their_colours() {
    for angle in [0.3f32, 1.2] {
        let (x, y) = (-0.5 * angle.sin(), 0.5 * angle.cos());
        let watched = Watched::with_scene(moving(&plates(angle), "translation", [-x, -y, 0.0], [x, y, 0.0]));
        let common = [SIZE, ("spp", "4"), ("tuples", "8"), ("visibility", "repeat-frame")];
        let fragments = watched.render(DEEP, &both(&common, &[FRAGMENT]));
        let counters = fragments.measured_counters().unwrap();
        assert_eq!(counters["samples_without_colour"], 0.0, "{angle}: {counters:?}");
        assert!(counters["samples_seen"] > 5000.0, "{angle}: {counters:?}");
        let alone = watched.picture(DEEP, &both(&common, &[("lists", "none")]));
        require_same(&watched.session.gpu, &fragments.picture().unwrap(), &alone, &angle);
    }
}

/// One corner behind the eye, two, all; in the eye's own plane; on the near plane; in the eye.
fn through_the_eye() -> Vec<Triangle> {
    let mut triangles = vec![
        [[-2.0, -0.5, -6.0], [2.0, -0.5, -6.0], [0.1, -0.4, 3.0]],
        [[0.0, 0.9, -9.0], [-4.0, 0.5, 2.0], [4.0, 0.6, 2.0]],
        [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 1.0]],
        [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
        [[0.0; 3], [0.3, 1.0, -5.0], [0.5, 1.0, -5.0]],
        [[-0.05, -0.02, -0.1], [0.01, -0.03, -0.1], [0.0, 0.02, -0.1]],
        [[-3.0, 2.0, -5.0], [-2.5, 2.0, -5.0], [-2.5, 2.0, 5e3]],
        // Edge-on, through the eye.
        [[0.0, 0.0, 1.0], [0.4, 0.0, -7.0], [0.8, 1e-7, -7.0]],
    ];
    for index in 0..40 {
        let turn = 0.157 * index as f32;
        let (x, y) = (turn.cos(), turn.sin());
        let near = 0.1 + 1e-6 * index as f32;
        triangles.push([[0.1 * x, 0.1 * y, 0.2], [0.3 * x - 0.1 * y, 0.2 * y + 0.1 * x, -near], [x, y, -3.0]]);
    }
    triangles
}

#[test]
fn triangles_through_the_eye_have_all_their_colours() {
    let watched = Watched::with_scene(file_of(&through_the_eye()).load().unwrap());
    assert!(require_whole(&watched, &[])["samples_seen"] > 5000.0);
    let counters = require_whole(&watched, &[("aperture", "0.2"), ("focus", "4"), ("guard-band", "0")]);
    assert!(counters["samples_outside_shading_space"] > 0.0, "{counters:?}");
}

#[test]
fn triangles_that_fly_through_the_eye_have_all_their_colours() {
    let watched = Watched::with_scene(moving(&through_the_eye(), "translation", [0.0, 0.0, -1.0], [0.2, 0.0, 1.5]));
    let counters = require_whole(&watched, &[]);
    assert!(counters["samples_outside_shading_space"] > 0.0, "{counters:?}");
    let warped = [("shading-warp", "foveated"), ("warp-falloff", "4")];
    require_whole(&watched, &both(&warped, &[("aperture", "0.3"), ("focus", "2"), ("guard-band", "0")]));
}

/// Corners at these coordinates, over all of the screen.
fn over_all(size: f32) -> Triangle {
    [[-size, -size, -5.0], [2.0 * size, -size, -5.0], [0.0, 2.0 * size, -5.0]]
}

#[test]
fn a_triangle_over_all_of_the_screen_is_shaded_once_a_pixel() {
    for size in [20.0, 1e4] {
        let watched = Watched::with_scene(file_of(&[over_all(size)]).load().unwrap());
        let counters = require_whole(&watched, &[]);
        let pixels = 97.0 * 61.0;
        assert_eq!((counters["samples_seen"], counters["listed_primitives"]), (4.0 * pixels, pixels), "{size}");
        assert_eq!((counters["longest_list"], counters["samples_outside_shading_space"]), (1.0, 0.0), "{size}");
    }
}

/// Floats do not place it: samples that see it have colours of it, wherever those are.
#[test]
fn a_triangle_too_large_to_be_placed_has_all_its_colours() {
    for size in [1e8, 1e15] {
        let watched = Watched::with_scene(file_of(&[over_all(size)]).load().unwrap());
        let counters = require_whole(&watched, &[]);
        assert!(counters["samples_seen"] > 0.0, "{size}: {counters:?}");
        require_whole(&watched, &[("aperture", "1"), ("focus", "3")]);
        let watched = watched.showing(moving(&[over_all(size)], "translation", [-1.0, 0.0, 0.0], [1.0, 0.5, 4.0]));
        require_whole(&watched, &[]);
    }
}

/// So many squares of two triangles a side, over `half_width` to either side, half a metre and more before each other.
fn crowd(squares: usize, half_width: f32) -> Vec<Triangle> {
    let at = |index: usize| half_width * (2.0 * index as f32 / squares as f32 - 1.0);
    let cells = (0..squares).flat_map(|row| (0..squares).map(move |column| (row, column)));
    cells
        .flat_map(|(row, column)| {
            let (left, right, low, high) = (at(column), at(column + 1), at(row), at(row + 1));
            let deep = -5.0 - 0.5 * (row * 7 + column * 3).rem_euclid(5) as f32;
            [
                [[left, low, deep], [right, low, deep], [right, high, deep]],
                [[left, low, deep], [right, high, deep], [left, high, deep]],
            ]
        })
        .collect()
}

/// A pixel of shading space is twenty of the frame wide. What a full list has no room for is shaded by itself.
#[test]
fn a_crowd_in_one_pixel_has_all_its_colours() {
    let coarse = [("shading-scale", "0.05")];
    let watched = Watched::with_scene(file_of(&crowd(40, 0.5)).load().unwrap());
    let counters = require_whole(&watched, &both(&coarse, &[("aperture", "0.02"), ("focus", "4")]));
    assert!(counters["longest_list"] > 100.0 && counters["samples_of_full_lists"] == 0.0, "{counters:?}");
    let flying = moving(&crowd(60, 0.6), "translation", [-0.2, 0.0, 0.3], [0.2, 0.1, -0.3]);
    let counters = require_whole(&watched.showing(flying), &both(&coarse, &[("spp", "16"), ("tuples", "16")]));
    assert!(counters["longest_list"] == 1024.0 && counters["samples_of_full_lists"] > 100.0, "{counters:?}");
}

/// The plane in focus is hardly before the lens: what is seen was anywhere before it.
#[test]
fn a_lens_that_leaves_nothing_in_its_place_loses_nothing() {
    let mut triangles = crowd(6, 6.0);
    triangles.extend(through_the_eye());
    let wide = [("aperture", "30"), ("focus", "0.4")];
    let outside = |watched: &Watched, guard| {
        let counters = require_whole(watched, &both(&wide, &[("guard-band", guard)]));
        counters["samples_outside_shading_space"] / counters["samples_seen"]
    };
    let watched = Watched::with_scene(file_of(&triangles).load().unwrap());
    assert!(outside(&watched, "0") > 0.2);
    let watched = watched.showing(moving(&triangles, "translation", [-0.5, 0.0, 0.0], [0.5, 0.2, 0.8]));
    let (without, with) = (outside(&watched, "0"), outside(&watched, "300"));
    assert!(without > 0.2 && with < 0.8 * without, "{without} of the samples without a guard band, {with} with one");
    // The greatest that the settings take.
    require_whole(&watched, &[("aperture", "1000000"), ("focus", "0.000001")]);
}
