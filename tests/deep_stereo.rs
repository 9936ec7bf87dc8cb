//! Two eyes that share one deep shading buffer: each has the bits of shading every sample by itself, what lies in the plane in
//! focus is in one place of both pictures and the rest as far apart as similar triangles say, and what both see is shaded once.

mod support;

use glam::{Mat4, Vec3, vec3};
use quincunx::gpu::commands::Submits;
use quincunx::metrics;
use quincunx::report::picture::Picture;
use quincunx::scene::{self, AnimationChoice, Camera, Projection, Scene};
use quincunx::session::Renderer;
use std::collections::BTreeMap;
use support::boxes::{camera, panel, rectangle};
use support::program::Program;
use support::watched::{Changes, Watched, both};

const DEEP: &str = "deep_shading";
const RIGHT: &str = "stereo.right";
const SIZE: (&str, &str) = ("size", "96x54");
const LEFT_ALONE: (&str, &str) = ("stereo-eyes", "left");
const RIGHT_ALONE: (&str, &str) = ("stereo-eyes", "right");

/// The pictures of the left eye and of the right one.
fn eyes_of(watched: &Watched, renderer: &Renderer) -> [Picture; 2] {
    let left = renderer.picture().unwrap();
    let right = Picture { extent: left.extent, pixels: watched.rgb(renderer, RIGHT) };
    [left, right]
}

fn eyes(watched: &Watched, changes: Changes<'_>) -> [Picture; 2] {
    eyes_of(watched, &watched.render_stages(DEEP, changes, &[RIGHT]))
}

fn hashes(watched: &Watched, changes: Changes<'_>) -> [String; 2] {
    eyes(watched, changes).map(|picture| picture.hash().unwrap())
}

/// The fence's rotor turns by a quarter of a turn, behind glass.
fn rotor() -> Watched {
    Watched::with_scene(scene::open("fence:lights=6", 1, &AnimationChoice::All).unwrap().exposed([0.0, 0.1]).unwrap())
}

/// Kinds of visibility that the driver has.
fn kinds(watched: &Watched) -> Vec<(&'static str, &'static str)> {
    let features = &watched.session.gpu.caps.features;
    let mut kinds = vec!["repeat-frame", "stochastic", "ray"];
    if features.layer_from_vertex_shader || features.geometry_shader {
        kinds.push("instancing");
    }
    if features.geometry_shader {
        kinds.push("replicate");
    }
    kinds.into_iter().map(|kind| ("visibility", kind)).collect()
}

#[test]
fn every_road_shades_both_eyes_as_every_sample_by_itself_would_be() {
    let hall: Changes<'_> = &[SIZE, ("spp", "2"), ("tuples", "8"), ("stereo", "0.2"), ("aperture", "0.05"), ("focus", "6")];
    let fence: Changes<'_> = &[("size", "65x37"), ("spp", "2"), ("stereo", "0.3"), ("camera", "rotor"), ("accumulate", "2")];
    for (watched, common) in [(Watched::open("hall:triangles=8000"), hall), (rotor(), fence)] {
        for kind in kinds(&watched) {
            let common = both(common, &[kind]);
            let [left, right] = hashes(&watched, &both(&common, &[("lists", "none")]));
            assert_ne!(left, right, "{common:?}");
            let direct = [("lists", "direct")];
            let mut roads: Vec<Changes<'_>> = vec![&[], &[("compaction", "off"), ("address-buffer", "off"), ("zmax", "off")]];
            match kind.1 {
                "repeat-frame" => roads.extend([&[("shading", "indirect-gbuffer")][..], &[("list-access", "addresses")]]),
                "ray" => roads.push(&direct),
                _ => {}
            }
            for road in roads {
                let renderer = watched.render_stages(DEEP, &both(&common, road), &[RIGHT]);
                let found = eyes_of(&watched, &renderer).map(|picture| picture.hash().unwrap());
                assert_eq!(found, [left.clone(), right.clone()], "{road:?} with {common:?}");
                assert_eq!(renderer.measured_counters().unwrap()["samples_without_colour"], 0.0, "{road:?} with {common:?}");
            }
        }
    }
}

/// Nothing between the eyes: both have the bits of the picture of one, in frames that the table of tuples does not divide too.
#[test]
fn eyes_in_one_place_see_what_one_eye_sees() {
    let nothing = ("stereo", "1e-30");
    let hall: Changes<'_> = &[("size", "97x55"), ("spp", "2"), ("tuples", "12"), ("aperture", "0.3"), ("focus", "6")];
    let fence: Changes<'_> = &[("size", "65x37"), ("spp", "2"), ("camera", "rotor"), ("accumulate", "2")];
    for (watched, common) in [(Watched::open("hall:triangles=8000"), hall), (rotor(), fence)] {
        for how in kinds(&watched).into_iter().chain([("shading", "ssaa"), ("shading", "indirect-gbuffer")]) {
            let common = both(common, &[how]);
            let one = watched.render(DEEP, &common);
            let two = watched.render_stages(DEEP, &both(&common, &[nothing]), &[RIGHT]);
            let hash = one.picture().unwrap().hash().unwrap();
            assert_eq!(eyes_of(&watched, &two).map(|picture| picture.hash().unwrap()), [hash.clone(), hash], "{common:?}");
            let [one, two] = [one, two].map(|renderer| renderer.measured_counters().unwrap());
            // What both see is listed once; supersampling knows no lists.
            let shares = if how.1 == "ssaa" { 2.0 } else { 1.0 };
            assert_eq!(two["shader_invocations"], shares * one["shader_invocations"], "{common:?}");
            assert_eq!(two["samples_seen"], 2.0 * one["samples_seen"], "{common:?}");
        }
    }
}

/// Metres before the camera of a red square, a green and a blue one.
const DEPTHS: [f32; 3] = [2.0, 4.0, 8.0];
const FOCUS: f32 = 4.0;
const STEREO: f32 = 0.1;

/// Squares beside each other on black, each of a colour of its own, whose places in the picture `slope` says: metres beside the
/// middle at a metre's depth, or at any.
fn squares(camera: Camera, across: impl Fn(f32) -> f32) -> Watched {
    let mut scene = Scene { name: "squares".to_owned(), ..Scene::default() };
    for (index, depth) in DEPTHS.into_iter().enumerate() {
        let (side, color) = (across(depth), [Vec3::X, Vec3::Y, Vec3::Z][index]);
        let center = vec3((index as f32 - 1.0) * 0.6 * side, (index as f32 - 1.0) * 0.2 * side, -depth);
        rectangle(&mut scene, center, 0.1 * side * Vec3::X, 0.1 * side * Vec3::Y, panel(color));
    }
    scene.cameras.push(camera);
    Watched::with_scene(scene)
}

/// The column around which each colour's light lies, pixels.
fn columns(picture: &Picture) -> [f64; 3] {
    [0, 1, 2].map(|channel| {
        let (mut light, mut moment) = (0.0, 0.0);
        for (index, pixel) in picture.pixels.iter().enumerate() {
            let value = f64::from(pixel[channel]);
            light += value;
            moment += value * ((index % picture.extent.width as usize) as f64 + 0.5);
        }
        assert!(light > 1.0, "colour {channel} is seen");
        moment / light
    })
}

/// By similar triangles the right eye sees a place at depth z by s (1/f - 1/z) further right than the left one, as a part of a
/// metre at a metre's depth, s between both and f the plane in focus; where rays are parallel by s (z/f - 1) metres.
#[test]
fn what_is_out_of_focus_is_as_far_apart_as_similar_triangles_say() {
    // Half of the frame's width is half a metre at a metre's depth, or two metres.
    let perspective = camera(Vec3::ZERO, -Vec3::Z, 2.0 * (0.5f32 * 54.0 / 96.0).atan());
    let projection = Projection::Orthographic { x_mag: 2.0, y_mag: 2.0 * 54.0 / 96.0, z_near: 0.5, z_far: 20.0 };
    let flat = Camera { name: "flat".to_owned(), world_from_view: Mat4::IDENTITY, projection };
    let cases = [
        (squares(perspective, |depth| 0.5 * depth), DEPTHS.map(|z| STEREO * (1.0 / FOCUS - 1.0 / z) * 48.0 / 0.5)),
        (squares(flat, |_| 2.0), DEPTHS.map(|z| STEREO * (z / FOCUS - 1.0) * 48.0 / 2.0)),
    ];
    let (focus, stereo) = (FOCUS.to_string(), STEREO.to_string());
    for (watched, expected_px) in cases {
        let common = [SIZE, ("spp", "16"), ("stereo", stereo.as_str()), ("focus", focus.as_str())];
        let alone = |technique: &str| {
            [LEFT_ALONE, RIGHT_ALONE].map(|eye| watched.picture(technique, &both(&common, &[eye])))
        };
        let middle = columns(&watched.picture(DEEP, &[SIZE, ("spp", "16")]));
        for (how, [left, right]) in [
            ("shared", eyes(&watched, &common)),
            ("shared under a lens", eyes(&watched, &both(&common, &[("aperture", "0.05")]))),
            ("stochastic", eyes(&watched, &both(&common, &[("visibility", "stochastic")]))),
            ("rays", eyes(&watched, &both(&common, &[("visibility", "ray")]))),
            ("supersampled", eyes(&watched, &both(&common, &[("shading", "ssaa")]))),
            ("alone", alone(DEEP)),
            ("alone, multisampled", {
                let msaa = both(&common, &[("shading", "msaa")]);
                [LEFT_ALONE, RIGHT_ALONE].map(|eye| watched.picture(DEEP, &both(&msaa, &[eye])))
            }),
            ("path traced", alone("path_traced")),
        ] {
            let [left, right] = [&left, &right].map(columns);
            println!("{how}: {left:?}, {middle:?}, {right:?}, apart by {expected_px:?}");
            for (index, expected_px) in expected_px.into_iter().enumerate() {
                let far = f64::from(expected_px);
                for (at, expected) in [(left, middle[index] - 0.5 * far), (right, middle[index] + 0.5 * far)] {
                    assert!((at[index] - expected).abs() < 0.06, "{how}, depth {}: {} for {expected}", DEPTHS[index], at[index]);
                }
            }
        }
    }
}

fn rmse(picture: &Picture, reference: &Picture) -> f64 {
    metrics::compare(picture, reference, 0.1).unwrap().metrics.rmse
}

/// Each eye alone, with highlights that it alone sees there, is what path tracing sees from there and not what the other one does;
/// shaded from between both it is nearly as near.
#[test]
fn each_eye_is_what_path_tracing_sees_from_there() {
    let watched = Watched::open("cornell");
    let common = [SIZE, ("spp", "64"), ("tuples", "64"), ("stereo", "0.3"), ("brdf", "ggx")];
    let direct = [("transport", "direct"), ("light-visibility", "off"), ("emissive", "off"), ("spp", "64")];
    let traced_common: Vec<_> = common.iter().filter(|(key, _)| *key != "tuples").copied().collect();
    let traced =
        [LEFT_ALONE, RIGHT_ALONE].map(|eye| watched.picture("path_traced", &both(&traced_common, &both(&direct, &[eye]))));
    let alone = [LEFT_ALONE, RIGHT_ALONE].map(|eye| watched.picture(DEEP, &both(&common, &[eye])));
    let shared = eyes(&watched, &common);
    let apart = rmse(&traced[0], &traced[1]);
    let [alone, shared] = [alone, shared].map(|eyes| [0, 1].map(|eye| rmse(&eyes[eye], &traced[eye])));
    println!("{alone:?} alone, {shared:?} shared, {apart} from eye to eye");
    for (alone, shared) in alone.into_iter().zip(shared) {
        assert!(alone < 0.15 * apart && shared < 0.3 * apart, "{alone}, {shared}, {apart}");
    }
}

/// As far as eyes are apart; `tools/clarberg-2014 stereo` has larger pictures.
#[test]
fn what_both_eyes_see_is_shaded_once() {
    let watched = Watched::open("chess:triangles=12000");
    let common = [("size", "160x90"), ("spp", "4"), ("stereo", "0.065")];
    let counted = |changes: Changes<'_>| watched.render(DEEP, &both(&common, changes)).measured_counters().unwrap();
    let [shared, left, right] = [&[][..], &[LEFT_ALONE], &[RIGHT_ALONE]].map(counted);
    let sum = |key: &str| left[key] + right[key];
    let part = shared["shader_invocations"] / sum("shader_invocations");
    println!("{part} of the executions of both alone, {} a pixel", shared["shaded_per_pixel"]);
    assert!((0.5..0.75).contains(&part), "{part}");
    assert_eq!(shared["shaded_per_pixel"], shared["shader_invocations"] / (160.0 * 90.0), "of one view's pixels");
    assert_eq!(shared["shader_invocations"], shared["listed_primitives"] + shared["samples_outside_shading_space"]);
    assert!((shared["samples_seen"] / sum("samples_seen") - 1.0).abs() < 1e-3);
    assert_eq!(shared["samples_without_colour"], 0.0);
}

/// Of as many samples as both eyes have; the picture of the right one is 16 bytes a pixel, and its sums as many.
#[test]
fn memory_is_planned_for_both_eyes() {
    let program = Program::new();
    let planned = |stereo: &str, sets: &str| -> BTreeMap<String, u64> {
        let arguments = ["memory", "cornell", "--technique", DEEP, "--plan", "--size", "64x36", "--spp", "2", "--json"];
        let settings = ["--stereo", stereo, "--accumulate", sets];
        let json = program.run(&[&arguments[..], &settings].concat()).fine().json();
        serde_json::from_value(json["techniques"][0]["memory"]["groups"].clone()).unwrap()
    };
    let pixels = 64 * 36;
    let space = (64 + 2 * 64) * (36 + 2 * 64);
    for (sets, group) in [("1", "picture"), ("3", "accumulation")] {
        let [one, two] = ["0", "0.1"].map(|stereo| planned(stereo, sets));
        assert_eq!(two["frame_buffer"], 2 * one["frame_buffer"]);
        assert_eq!(two["deep_shading_buffer"], 2 * 2 * pixels * (8 + 8) + space * 4);
        assert_eq!(two["auxiliary"] - one["auxiliary"], 2 * pixels * (4 + 4));
        assert_eq!(two[group], 2 * one[group]);
    }
}

#[test]
fn what_knows_of_one_eye_refuses_two() {
    let watched = Watched::open("cornell");
    let refusal = |changes: Changes<'_>| {
        let error = watched.try_renderer(DEEP, changes, &[], Submits::One).map(|_| ()).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{changes:?}");
        error.to_string()
    };
    let two = ("stereo", "0.065");
    for (with, why) in [(("shading", "msaa"), "which are one eye's"), (("reconstruct", "on"), "what one eye sees")] {
        let text = refusal(&[SIZE, two, with]);
        assert!(text.contains("--stereo 0.065 with") && text.contains(why) && text.contains("--stereo-eyes left"), "{text}");
        watched.render(DEEP, &[SIZE, ("spp", "2"), ("aperture", "0.1"), two, with, LEFT_ALONE]);
    }
    let layers = watched.session.gpu.caps.limits.max_image_layers;
    let tuples = layers.min(2048).to_string();
    let text = refusal(&[SIZE, two, ("spp", "1"), ("tuples", &tuples)]);
    let over = 2 * layers.min(2048) > layers;
    assert!(!over || text.contains(&format!("--tuples {tuples} of 2 eyes: this device has images of {layers}")), "{text}");
    let one = watched.render_stages(DEEP, &[SIZE, ("spp", "2"), two, RIGHT_ALONE], &[RIGHT]);
    let error = one.aov(RIGHT).unwrap_err();
    assert!(error.exit_code() == 2 && error.to_string().contains("--stereo-eyes both"), "{error}");
}
