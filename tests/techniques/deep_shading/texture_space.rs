//! Shading in textures of draws (`--shading texture-space`; Andersson et al. 2014): on the same samples it gives
//! supersampling's bits where a draw has one colour, and near the lists' picture elsewhere, the nearer the finer it
//! shades; every sample finds its texels, however many textures there are.

use super::visibilities;
use crate::support::boxes::{camera, rectangle};
use crate::support::difference::{require_same, rmse};
use crate::support::moving::{moving, unlit};
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat4, Vec3};
use quincunx::gpu::commands::Submits;
use quincunx::scene::{self, Material, Scene};
use std::collections::BTreeMap;

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "97x55");
const TEXTURES: [(&str, &str); 2] = [("shading", "texture-space"), ("shading-texture-size", "512")];

/// What every frame keeps to: all samples have their texels.
fn counters(watched: &Watched, changes: Changes<'_>) -> BTreeMap<&'static str, f64> {
    let counted = watched.render(DEEP, &both(changes, &TEXTURES)).measured_counters().unwrap();
    assert_eq!(counted["samples_without_colour"], 0.0, "{changes:?}: {counted:?}");
    counted
}

/// Through a lens and in motion, by both kinds of visibility; panes of glass among the draws, which have one colour too.
#[test]
fn draws_of_one_colour_are_supersampling_to_the_bit() {
    let watched = Watched::with_scene(unlit(moving("fence:lights=6", [0.0, 0.1]), false));
    let lens = [SIZE, ("spp", "2"), ("accumulate", "2"), ("aperture", "0.1"), ("focus", "4"), ("camera", "rotor")];
    // Long charts of cables have as many texels as their lengths: in small textures they are few.
    let textures = [TEXTURES[0], ("shading-texture-size", "256")];
    for visibility in visibilities("texture-space") {
        let seen = both(&lens, &[("visibility", visibility)]);
        let supersampled = watched.render(DEEP, &both(&seen, &[("shading", "ssaa")]));
        let textured = watched.render(DEEP, &both(&seen, &textures));
        let [of_samples, of_textures] = [&supersampled, &textured].map(|frame| frame.measured_counters().unwrap());
        println!("{visibility}: {of_textures:?}");
        let [one, other] = [&textured, &supersampled].map(|frame| frame.picture().unwrap());
        require_same(&watched.session.gpu, &one, &other, &visibility);
        assert_eq!(of_textures["samples_seen"], of_samples["samples_seen"], "{visibility}");
        assert_eq!(of_textures["samples_without_colour"], 0.0, "{visibility}");
        assert!(of_textures["shader_invocations"] > 0.0);
    }
}

/// Its holes are a texture's, and the same samples go through them.
#[test]
fn holes_and_glass_let_the_same_samples_through() {
    for alpha in ["mask", "blend"] {
        let scene = unlit(moving(&format!("fence:lights=6,alpha={alpha}"), [0.0, 0.0]), true);
        let watched = Watched::with_scene(scene);
        let common = [SIZE, ("spp", "4")];
        let supersampled = counters_of(&watched, &both(&common, &[("shading", "ssaa")]));
        assert_eq!(counters(&watched, &common)["samples_seen"], supersampled["samples_seen"], "{alpha}");
    }
}

fn counters_of(watched: &Watched, changes: Changes<'_>) -> BTreeMap<&'static str, f64> {
    watched.render(DEEP, changes).measured_counters().unwrap()
}

/// A game of chess in motion, seen through a lens: again the same, and whatever turns draws take in textures.
#[test]
fn the_picture_is_the_same_again_and_with_any_number_of_textures() {
    let watched = Watched::with_scene(moving("chess:triangles=12000", [0.0, 0.1]));
    let common = [SIZE, ("spp", "2"), ("aperture", "0.02")];
    let counted = counters(&watched, &common);
    println!("{counted:?}");
    assert!(counted["samples_of_other_charts"] <= 0.01 * counted["samples_seen"], "{counted:?}");
    let hash = |textures: &str| watched.hash(DEEP, &both(&both(&common, &TEXTURES), &[("shading-textures", textures)]));
    let eight = hash("8");
    assert_eq!(hash("8"), eight);
    assert_eq!(hash("1"), eight);
    assert_eq!(hash("3"), eight);
}

/// Supersampling lacks the blur of texels, which finer texels remove: at a quarter of their area the picture is nearer,
/// and costs more. Not four times as much in so small a frame: charts of men a few pixels high stay a texel wide.
#[test]
fn finer_texels_come_nearer_to_supersampling() {
    let watched = Watched::open("chess:triangles=12000");
    let common = [SIZE, ("spp", "4")];
    let reference = watched.picture(DEEP, &both(&common, &[("shading", "ssaa")]));
    let deep = rmse(&watched.picture(DEEP, &common), &reference);
    let found = ["0.5", "1", "2"].map(|scale| {
        let changes = both(&both(&common, &TEXTURES), &[("shading-scale", scale)]);
        let frame = watched.render(DEEP, &changes);
        (rmse(&frame.picture().unwrap(), &reference), frame.measured_counters().unwrap()["shaded_per_pixel"])
    });
    println!("lists {deep}; textures, finer and finer: {found:?}");
    assert!(found.windows(2).all(|pair| pair[1].0 < 0.9 * pair[0].0 && pair[1].1 > 1.2 * pair[0].1), "{found:?}");
    assert!(found[1].0 < 1.5 * deep, "{found:?}, {deep}");
}

/// A wall that faces the camera is shaded; one that faces away, or is beside the frame, is not, unless the lens's rim
/// sees its front or the shutter closes on it inside.
#[test]
fn what_no_sample_can_see_is_not_shaded() {
    let wall = |center: Vec3, right: Vec3, closing: Option<Vec3>| {
        let mut scene = Scene { name: "wall".to_owned(), hash: "opening".to_owned(), ..Scene::default() };
        let white = Material { unlit: true, ..Material::diffuse("white", Vec3::ONE) };
        rectangle(&mut scene, center, 2.0 * right, 2.0 * Vec3::Y, white);
        scene.cameras.push(camera(20.0 * Vec3::Z, Vec3::ZERO, 1.0));
        if let Some(shift) = closing {
            let mut close = Scene { hash: "closing".to_owned(), ..scene.clone() };
            close.draws[0].world_from_object = Mat4::from_translation(shift);
            scene = scene.closing_as(close).unwrap();
        }
        Watched::with_scene(scene)
    };
    let shaded = |watched: &Watched, changes: Changes<'_>| {
        counters(watched, &both(&[SIZE, ("spp", "4"), ("rig", "none")], changes))["shader_invocations"]
    };
    // 10 pixels wide and high: 512 texels come nearest to that at the level with 8.
    assert_eq!(shaded(&wall(Vec3::ZERO, Vec3::X, None), &[]), 64.0);
    let turned = wall(Vec3::ZERO, -Vec3::X, None);
    let lens = [("aperture", "2"), ("focus", "20")];
    assert_eq!([shaded(&turned, &[]), shaded(&turned, &lens)], [0.0; 2]);
    // It shows its back to the middle of a lens that reaches a metre beyond it.
    let aside = wall(4.0 * Vec3::X, -4.0 * Vec3::Z, None);
    assert_eq!(shaded(&aside, &[]), 0.0);
    assert!(shaded(&aside, &[("aperture", "10"), ("focus", "20")]) > 0.0);
    let outside = 60.0 * Vec3::X;
    assert_eq!(shaded(&wall(outside, Vec3::X, None), &[]), 0.0);
    assert_eq!(shaded(&wall(outside, Vec3::X, Some(60.0 * Vec3::X)), &[]), 0.0);
    assert!(shaded(&wall(outside, Vec3::X, Some(-outside)), &[]) > 0.0);
}

/// The box's draws have a texture each, or share a few in sequence: a texel that several draws shade is touched once.
/// Owners are cleared in all textures that are used.
#[test]
fn touched_bytes_are_of_texels_that_were_shaded() {
    let program = Program::new();
    let run = |textures: &str, instrument: &str| {
        let common = ["render", "cornell", "--technique", DEEP, "--size", "97x55", "--spp", "1", "--json"];
        let own = ["--shading", "texture-space", "--shading-texture-size", "512", "--shading-textures", textures];
        program.run(&[&common[..], &own, &["--instrument", instrument]].concat()).fine().json()
    };
    let found = |textures: &str| {
        let json = run(textures, "on");
        let touched = |group: &str| json["memory"]["touched_groups"][group].as_u64().unwrap();
        let shaded = json["counters"]["shader_invocations"].as_f64().unwrap() as u64;
        (shaded, touched("texture_pool"), touched("texture_owners"))
    };
    // Texels of all levels.
    let texels = 349_525;
    let draw_count = scene::load("cornell", 1).unwrap().draws.len() as u64;
    let (shaded, apart, owners) = found("16");
    println!("{draw_count} draws shade {shaded} texels, {apart} bytes");
    assert!(shaded > 0 && draw_count < 16);
    assert_eq!((apart, owners), (8 * shaded, 4 * texels * draw_count));
    for textures in [1, 2] {
        let (again, together, owners) = found(&textures.to_string());
        println!("{textures}: {together} bytes");
        assert_eq!((again, owners), (shaded, 4 * texels * textures));
        assert!(together < apart && draw_count * together >= apart, "{together}, {apart}");
    }
    assert!(run("1", "off")["memory"]["touched_groups"].is_null(), "nobody counts");
}

/// Each object needs an atlas: repeated textures are none. The message names the mesh and what is wrong with it.
#[test]
fn a_scene_without_an_atlas_is_refused() {
    let mut scene = scene::load("cornell", 1).unwrap();
    scene.meshes.iter_mut().for_each(|mesh| mesh.atlas.clear());
    let watched = Watched::with_scene(scene);
    let error = watched.try_renderer(DEEP, &TEXTURES, &[], Submits::One).map(|_| ()).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    let text = error.to_string();
    println!("{text}");
    for said in [
        "deep_shading: --shading texture-space: mesh ",
        " has no atlas (first coordinates: triangle",
        "--shading deep needs none",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
}

#[test]
fn settings_that_it_does_not_read_or_that_do_not_fit_are_refused() {
    let watched = Watched::open("cornell");
    let [texture_space, _] = TEXTURES;
    for (changes, said) in [
        (&[texture_space, ("lists", "none")][..], "--lists none with --shading texture-space: it has no lists"),
        (&[texture_space, ("guard-band", "0")], "--guard-band 0 with --shading texture-space"),
        (&[texture_space, ("shading-warp", "foveated")], "--shading-warp foveated with --shading texture-space"),
        (&[texture_space, ("visibility", "ray")], "--visibility ray with --shading texture-space"),
        (&[texture_space, ("reconstruct", "on")], "--reconstruct on with --shading texture-space"),
        (&[("shading-textures", "2")], "--shading-textures 2 with --shading deep"),
        (&[("shading", "ssaa"), ("shading-texture-size", "512")], "--shading-texture-size 512 with --shading ssaa"),
    ] {
        let error = watched.try_renderer(DEEP, changes, &[], Submits::One).map(|_| ()).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{changes:?}");
        assert!(error.to_string().contains(said), "{changes:?}: {error}");
    }
    let range = watched.session.gpu.caps.limits.max_storage_buffer_range_bytes;
    if range < 715_827_880 {
        let changes = [texture_space, ("shading-texture-size", "8192")];
        let error = watched.try_renderer(DEEP, &changes, &[], Submits::One).map(|_| ()).unwrap_err();
        assert_eq!(error.exit_code(), 4);
        assert!(error.to_string().contains("--shading-texture-size 8192: a texture has 683 MiB"), "{error}");
        assert!(error.to_string().contains(" fits"), "{error}");
    }
}

/// The texture pool of Clarberg & Munkberg 2014, section 6, to the byte of its formula, beside the frame buffer's 84.4
/// MiB; owners are ours.
#[test]
fn the_pool_is_as_large_as_the_paper_says() {
    let groups = |more: &[&str]| -> BTreeMap<String, u64> {
        let mut arguments = vec!["memory", "--technique", DEEP, "--plan", "--size", "1280x720", "--spp", "8", "--json"];
        arguments.extend(["--shading", "texture-space"]);
        arguments.extend(more);
        let json = Program::new().run(&arguments).fine().json();
        serde_json::from_value(json["techniques"][0]["memory"]["groups"].clone()).unwrap()
    };
    let paper = groups(&[]);
    assert_eq!(paper["texture_pool"], 357_913_920);
    assert_eq!(paper["texture_owners"], 357_913_920 / 2);
    assert_eq!(paper["frame_buffer"], 88_473_600);
    assert!(!paper.contains_key("deep_shading_buffer") && !paper.contains_key("auxiliary"), "{paper:?}");
    assert_eq!(groups(&["--shading-textures", "1"])["texture_pool"], 44_739_240);
}
