//! Two eyes that share one deep shading buffer: each has the bits of shading every sample by itself, what lies in the plane in
//! focus is in one place of both pictures and the rest as far apart as similar triangles say, and what both see is shaded once.

use super::FRAGMENT;
use crate::support::boxes::{camera, panel, point_light, rectangle};
use crate::support::difference::require_same;
use crate::support::moving::moving;
use crate::support::placing_steps;
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat4, Vec3, vec3};
use quincunx::gpu::commands::Submits;
use quincunx::picture::Picture;
use quincunx::scene::{Camera, Material, Projection, Scene};
use quincunx::session::Renderer;
use std::collections::BTreeMap;

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

/// The fence's rotor turns by a quarter of a turn, behind glass.
fn rotor() -> Watched {
    Watched::with_scene(moving("fence:lights=6", [0.0, 0.1]))
}

/// Both eyes' layers drawn into at once, where the driver can.
fn layered(watched: &Watched) -> Option<(&'static str, &'static str)> {
    let features = &watched.session.gpu.caps.features;
    (features.layer_from_vertex_shader || features.geometry_shader).then_some(("visibility", "instancing"))
}

/// The bits that every sample shaded by itself makes, by `methods`.
#[track_caller]
fn require_one_pair(watched: &Watched, common: Changes<'_>, methods: &[Changes<'_>]) {
    let alone = eyes(watched, &both(common, &[("lists", "none")]));
    assert_ne!(alone[0].pixels, alone[1].pixels, "{common:?}");
    for method in methods {
        let renderer = watched.render_stages(DEEP, &both(common, method), &[RIGHT]);
        for (found, alone) in eyes_of(watched, &renderer).iter().zip(&alone) {
            require_same(&watched.session.gpu, found, alone, &(method, common));
        }
        assert_eq!(renderer.measured_counters().unwrap()["samples_without_colour"], 0.0, "{method:?} with {common:?}");
    }
}

#[test]
fn every_method_shades_both_eyes_as_every_sample_by_itself_would_be() {
    let watched = Watched::open("cornell");
    let common =
        [("size", "49x29"), ("spp", "2"), ("tuples", "8"), ("stereo", "0.2"), ("aperture", "0.05"), ("focus", "3")];
    let plain: Changes<'_> = &[FRAGMENT, ("compaction", "off"), ("address-buffer", "off"), ("zmax", "on")];
    let indirect: Changes<'_> = &[("shading", "indirect-gbuffer")];
    require_one_pair(&watched, &common, &[&[], plain, indirect, &[("list-access", "addresses")]]);
    require_one_pair(&watched, &both(&common, &[("visibility", "ray")]), &[&[("lists", "direct")]]);
    if let Some(instancing) = layered(&watched) {
        require_one_pair(&watched, &both(&common, &[instancing]), &[&[]]);
    }
    let moving = [("size", "49x29"), ("spp", "2"), ("stereo", "0.3"), ("camera", "rotor"), ("accumulate", "2")];
    require_one_pair(&rotor(), &both(&moving, &[("visibility", "stochastic")]), &[&[]]);
}

/// Nothing between the eyes: both have the bits of the picture of one, with glass that some samples see, in a frame that the table of
/// tuples does not divide.
#[test]
fn eyes_in_one_place_see_what_one_eye_sees() {
    let watched = rotor();
    let common = [("size", "33x19"), ("spp", "2"), ("tuples", "12"), ("aperture", "0.05"), ("accumulate", "2")];
    let drawn = layered(&watched).unwrap_or(("visibility", "repeat-frame"));
    for how in [drawn, ("visibility", "stochastic"), ("visibility", "ray"), ("shading", "ssaa")] {
        require_one_eye(&watched, &both(&common, &[("camera", "rotor"), how]));
    }
}

#[track_caller]
fn require_one_eye(watched: &Watched, common: Changes<'_>) {
    let one = watched.render(DEEP, common);
    let two = watched.render_stages(DEEP, &both(common, &[("stereo", "1e-30")]), &[RIGHT]);
    for eye in eyes_of(watched, &two) {
        require_same(&watched.session.gpu, &eye, &one.picture().unwrap(), &common);
    }
    let [one, two] = [one, two].map(|renderer| renderer.measured_counters().unwrap());
    // What both see is listed once; supersampling has no lists.
    let shares = if common.contains(&("shading", "ssaa")) { 2.0 } else { 1.0 };
    assert_eq!(two["shader_invocations"], shares * one["shader_invocations"], "{common:?}");
    assert_eq!(two["samples_seen"], 2.0 * one["samples_seen"], "{common:?}");
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
    // What the driver rounds vertices by.
    let placing = 0.5 / f64::from(1u32 << crate::support::driver().limits.sub_pixel_bits);
    let common = [SIZE, ("spp", "16"), ("stereo", stereo.as_str()), ("focus", focus.as_str())];
    for (index, (watched, expected_px)) in cases.into_iter().enumerate() {
        let together = |changes: Changes<'_>| eyes(&watched, &both(&common, changes));
        let alone = |technique: &str, changes: Changes<'_>| {
            let of = |eye| watched.picture(technique, &both(&both(&common, changes), &[eye]));
            [LEFT_ALONE, RIGHT_ALONE].map(of)
        };
        let middle = columns(&watched.picture(DEEP, &common[..2]));
        let mut pairs =
            vec![("shared", together(&[])), ("alone", alone(DEEP, &[])), ("path traced", alone("path_traced", &[]))];
        pairs.extend(match index {
            0 => [
                ("stochastic", together(&[("visibility", "stochastic")])),
                ("supersampled", together(&[("shading", "ssaa")])),
                ("multisampled", alone(DEEP, &[("shading", "msaa")])),
            ]
            .to_vec(),
            _ => vec![("rays", together(&[("visibility", "ray")]))],
        });
        for (how, pictures) in pairs {
            let [left, right] = pictures.each_ref().map(columns);
            println!("{how}: {left:?}, {middle:?}, {right:?}, apart by {expected_px:?}");
            for (color, far) in expected_px.map(f64::from).into_iter().enumerate() {
                for (at, expected) in [(left, middle[color] - 0.5 * far), (right, middle[color] + 0.5 * far)] {
                    let (at, depth) = (at[color], DEPTHS[color]);
                    assert!((at - expected).abs() < 0.06 + placing, "{how}, depth {depth}: {at} for {expected}");
                }
            }
        }
    }
}

/// A shiny square before a shiny wall, turned away from each other, and a light between; cameras in the middle and beside it.
fn shiny(beside: f32) -> Watched {
    let mut scene = Scene { name: "shiny".to_owned(), ..Scene::default() };
    let shiny = |red| Material { roughness: 0.3, ..Material::diffuse("shiny", vec3(red, 0.4, 0.3)) };
    rectangle(&mut scene, vec3(0.0, 0.0, -6.0), vec3(5.0, 0.0, 1.0), 4.0 * Vec3::Y, shiny(0.2));
    rectangle(&mut scene, vec3(0.3, -0.2, -3.0), vec3(0.6, 0.1, -0.2), vec3(-0.1, 0.5, 0.1), shiny(0.8));
    scene.lights.push(point_light(vec3(0.5, 1.0, -1.0), 20.0));
    for at in [0.0, beside] {
        scene.cameras.push(camera(at * Vec3::X, at * Vec3::X - Vec3::Z, 2.0 * (0.5f32 * 54.0 / 96.0).atan()));
    }
    Watched::with_scene(scene)
}

/// An eye alone is a camera beside, whose picture is moved so that what is in focus stays: here by two whole pixels, in each of
/// which samples have the same places. With highlights, which that eye alone sees there; shared ones are not far off.
#[test]
fn an_eye_alone_sees_what_a_camera_beside_sees() {
    // A metre at a metre's depth is 96 pixels.
    let (moved_px, focus) = (2, 4.0);
    let beside = moved_px as f32 * focus / 96.0;
    let watched = shiny(beside);
    let (stereo, focus) = ((2.0 * beside).to_string(), focus.to_string());
    let common = [SIZE, ("spp", "8"), ("tuples", "8"), ("brdf", "ggx")];
    let right = both(&common, &[("stereo", &stereo), ("focus", &focus)]);
    let alone = watched.picture(DEEP, &both(&right, &[RIGHT_ALONE]));
    let camera = watched.picture(DEEP, &both(&common, &[("camera", "1")]));
    let middle = watched.picture(DEEP, &common);
    let [_, shared] = eyes(&watched, &right);
    let far = |picture: &Picture, by: usize| {
        let rows = picture.pixels.chunks(96).zip(camera.pixels.chunks(96));
        let pairs = rows.flat_map(|(row, beside)| row[by..].iter().zip(&beside[..96 - by]));
        let squares: Vec<f32> =
            pairs.map(|(a, b)| (0..3).map(|channel| (a[channel] - b[channel]).powi(2)).sum()).collect();
        (squares.iter().sum::<f32>() / squares.len() as f32).sqrt()
    };
    let [alone, shared, middle] = [(&alone, moved_px), (&shared, moved_px), (&middle, 0)].map(|(of, by)| far(of, by));
    println!("alone {alone}, shared {shared}, from the middle {middle}");
    let steps = placing_steps(&watched.session.gpu.caps) as f32;
    assert!(
        alone < 0.02 * steps * middle && alone < 0.3 * shared && shared < 0.5 * middle,
        "{alone}, {shared}, {middle}"
    );
}

/// As far as eyes are apart; `reproduce clarberg-2014/section-7` has larger pictures.
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

/// The plan holds the samples of both eyes; the picture of the right eye is 16 bytes a pixel, and its sums as many.
#[test]
fn memory_is_planned_for_both_eyes() {
    let program = Program::new();
    let planned = |stereo: &str, sets: &str| -> BTreeMap<String, u64> {
        let arguments =
            ["memory", "cornell", "--technique", DEEP, "--plan", "--size", "256x128", "--spp", "2", "--json"];
        let settings = ["--stereo", stereo, "--accumulate", sets, "--shade-by", "fragment", "--zmax", "on"];
        let json = program.run(&[&arguments[..], &settings].concat()).fine().json();
        serde_json::from_value(json["techniques"][0]["memory"]["groups"].clone()).unwrap()
    };
    let pixels = 256 * 128;
    let space = (256 + 2 * 64) * (128 + 2 * 64);
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
        assert!(
            text.contains("--stereo 0.065 with") && text.contains(why) && text.contains("--stereo-eyes left"),
            "{text}"
        );
        watched.render(DEEP, &[SIZE, ("spp", "2"), ("aperture", "0.1"), two, with, LEFT_ALONE]);
    }
    let layers = watched.session.gpu.caps.limits.max_image_layers;
    let tuples = layers.min(2048).to_string();
    let text = refusal(&[SIZE, two, ("spp", "1"), ("tuples", &tuples)]);
    let over = 2 * layers.min(2048) > layers;
    assert!(
        !over || text.contains(&format!("--tuples {tuples} of 2 eyes: this device has images of {layers}")),
        "{text}"
    );
    let one = watched.try_renderer(DEEP, &[SIZE, ("spp", "2"), two, RIGHT_ALONE], &[RIGHT], Submits::One);
    let error = one.map(|_| ()).unwrap_err();
    assert!(error.exit_code() == 2 && error.to_string().contains("--stereo-eyes both"), "{error}");
}
