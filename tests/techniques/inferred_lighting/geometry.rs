//! What inferred lighting's geometry pass leaves (Kircher 2009, sections 2.1 and 5): packings, what they lose, motion.

use crate::support::boxes::{camera, point_light, rectangle};
use crate::support::difference::greatest_part;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec2, Vec3, vec3};
use quincunx::picture::{AovChannels, Picture};
use quincunx::scene::procedural::Thing;
use quincunx::scene::{self, AnimationChoice, Material, Model, Scene, object_ids};
use quincunx::techniques::inferred_lighting::encoding::Packing;

const NAME: &str = "inferred_lighting";

/// Squares of which each has a normal and a depth of its own, both such that `packing` has them exactly, in a grid of `SIDE` a
/// row that fills the picture; and the normals, row by row.
fn exact_squares(packing: Packing) -> (Scene, Vec<Vec3>, Vec<f32>) {
    const RANGE: [f32; 2] = [2.0, 4.0];
    let mut scene = Scene { name: "squares".to_owned(), ..Scene::default() };
    let depth_steps = packing.nothing() - (packing.dsf_word(RANGE[0], RANGE, 0) & 0xffff) - 1;
    let (mut normals, mut depths) = (Vec::new(), Vec::new());
    for index in 0..SIDE * SIDE {
        // Depths from the first step to the last, so that the scene's own range is RANGE; both ends come once each.
        let step = u64::from(index) * u64::from(depth_steps) / u64::from(SIDE * SIDE - 1);
        let depth = RANGE[0] + step as f32 * (RANGE[1] / depth_steps as f32);
        // Any direction of which the word is, then the direction that the word encodes.
        let angle = index as f32 * 2.4;
        let slope = Vec3::new(angle.cos(), angle.sin(), 0.2 + 2.0 * index as f32 / (SIDE * SIDE) as f32).normalize();
        let normal = packing.view_normal(packing.normal_word(slope)).normalize();
        let at = |cell: u32| (2.0 * (cell as f32 + 0.5) / SIDE as f32 - 1.0) * depth;
        let center = vec3(at(index % SIDE), -at(index / SIDE), -depth);
        let half = 0.8 * depth / SIDE as f32;
        rectangle(&mut scene, center, half * Vec3::X, half * Vec3::Y, Material::diffuse("gray", Vec3::splat(0.5)));
        scene.meshes.last_mut().unwrap().normals = vec![normal; 4];
        normals.push(normal);
        depths.push(depth);
    }
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, std::f32::consts::FRAC_PI_2));
    scene.lights.push(point_light(vec3(0.0, 0.0, 1.0), 50.0));
    (scene, normals, depths)
}

const SIDE: u32 = 16;

/// What the device leaves of a normal, a depth and an id is what the twin makes of them, bit for bit, in every packing.
#[test]
fn every_packing_leaves_the_words_of_its_twin() {
    for (packing, changes) in [
        (Packing::Words, &[("packing", "words")][..]),
        (Packing::Bytes, &[("packing", "rgba8")]),
        (Packing::Fixed { steps: 65535 }, &[("packing", "fixed")]),
        (Packing::Fixed { steps: 2047 }, &[("packing", "fixed"), ("fixed-range", "1")]),
        (Packing::Fixed { steps: 20479 }, &[("packing", "fixed"), ("fixed-range", "10")]),
    ] {
        let (scene, normals, depths) = exact_squares(packing);
        let range = [depths[0], depths[depths.len() - 1] - depths[0]];
        let ids: Vec<u32> = object_ids::of(&scene).iter().map(|id| u32::from(*id) << 8).collect();
        let watched = Watched::with_scene(scene);
        let side = (10 * SIDE).to_string();
        let size = format!("{side}x{side}");
        let common = [("size", size.as_str()), ("light-size", size.as_str())];
        let names = ["geometry.normal", "geometry.dsf.id", "geometry.dsf.depth"];
        let renderer = watched.render_stages(NAME, &both(&common, changes), &names);
        let (found_normals, found_ids) = (watched.rgb(&renderer, names[0]), watched.integers(&renderer, names[1]));
        let AovChannels::Y(found_depths) = renderer.aov(names[2]).unwrap().channels else {
            panic!("depth has a number")
        };
        for (index, normal) in normals.iter().enumerate() {
            let (x, y) = (index as u32 % SIDE * 10 + 5, index as u32 / SIDE * 10 + 5);
            let pixel = (y * 10 * SIDE + x) as usize;
            let expected = packing.view_normal(packing.normal_word(*normal)).to_array();
            assert_eq!(found_normals[pixel], expected, "{packing:?}: normal of square {index}, {normal}");
            let word = packing.dsf_word(depths[index], range, ids[index]);
            assert_eq!(Some(found_depths[pixel]), packing.depth_m(word, range), "{packing:?}: depth of square {index}");
            assert_eq!(found_ids[pixel], packing.id(word), "{packing:?}: id of square {index}");
        }
        // Between the squares there is nothing.
        assert_eq!((found_normals[0], found_depths[0]), ([0.0; 3], 0.0), "{packing:?}");
    }
}

/// Bytes hold the same words. Fixed point that is scaled to its whole range has as many steps: normals are the same up to the
/// rounding of their arithmetic, and roughness has 16 bits instead of 8, half of a 255th nearer. Of what is not scaled a 32nd
/// of the steps is used, and neighbours of an id share a number, so that light leaks between them.
#[test]
fn packings_take_the_same_bytes_and_show_the_same_picture() {
    for spec in ["lamps:objects=30,lights=30", "fence:lights=40"] {
        let watched = Watched::open(spec);
        for brdf in ["lambert", "ggx"] {
            let common = [("size", "160x90"), ("brdf", brdf)];
            let of = |changes: Changes<'_>| {
                let renderer = watched.render(NAME, &both(&common, changes));
                (renderer.plan.bytes(), renderer.picture().unwrap())
            };
            let words = of(&[]);
            let bytes = of(&[("packing", "rgba8")]);
            assert!(bytes.1.pixels == words.1.pixels && bytes.0 == words.0, "{spec}, {brdf}: other bits or bytes");
            let mean = |picture: &Picture| {
                let apart = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|at| (a[at] - b[at]).abs()).sum::<f32>();
                let all: f32 = words.1.pixels.iter().flatten().sum();
                picture.pixels.iter().zip(&words.1.pixels).map(apart).sum::<f32>() / all
            };
            let whole_bound = if brdf == "lambert" { 1e-6 } else { 2e-3 };
            for (range, least, most) in [("32", 0.0, whole_bound), ("1", 1e-3, 0.1)] {
                let fixed = of(&[("packing", "fixed"), ("fixed-range", range)]);
                let apart = mean(&fixed.1);
                println!("{spec}, {brdf}, scaled to {range}: {apart:e} apart in the mean");
                assert_eq!(fixed.0, words.0, "{spec}, {brdf}: bytes");
                assert!((least..most).contains(&apart), "{spec}, {brdf}, scaled to {range}: {apart}");
            }
        }
    }
}

/// Fixed point of a range that holds all light is near half floats: of light at a 256th of the range it loses 0.2 %. What is
/// brighter than the range is held there and counted.
#[test]
fn light_in_fixed_point_is_near_half_floats_and_what_is_cut_is_counted() {
    let watched = Watched::open("lamps:objects=30,lights=30");
    for volumes in ["tiled", "scissor"] {
        let common = [("size", "160x90"), ("volumes", volumes), ("highlight", "intensity")];
        let names = ["light.l_buffer.irradiance", "light.l_buffer.highlight"];
        let halves = watched.render_stages(NAME, &common, &names);
        let AovChannels::Y(highlight) = halves.aov(names[1]).unwrap().channels else { panic!("it has a number") };
        let irradiance = watched.rgb(&halves, names[0]);
        let most = irradiance.iter().flatten().chain(&highlight).copied().fold(0f32, f32::max);
        let (picture, whole_bytes) = (halves.picture().unwrap(), halves.plan.bytes());
        for (part, is_cut) in [(1.01, false), (0.25, true)] {
            let range = (part * most).to_string();
            let changes = both(&common, &[("l-buffer", "fixed"), ("light-range", range.as_str())]);
            let fixed = watched.render_stages(NAME, &changes, &names);
            let cut = fixed.measured_counters().unwrap()["light_texels_cut"];
            assert_eq!(cut > 0.0, is_cut, "{volumes}, {part} of the most: {cut} texels are cut");
            assert_eq!(fixed.plan.bytes(), whole_bytes);
            let held = watched.rgb(&fixed, names[0]);
            let step = part * most / 65534.0;
            for (found, light) in held.iter().flatten().zip(irradiance.iter().flatten()) {
                let off = (found - light.min(part * most)).abs();
                assert!(off <= 0.51 * step + light / 2000.0, "{volumes}: {found} for {light}, a step is {step}");
            }
            let found = greatest_part(&fixed.picture().unwrap(), &picture);
            println!("{volumes}, range {range}: {found:e} of a pixel, {cut} texels cut");
            assert_eq!(found < 0.02, !is_cut, "{volumes}, {part} of the most: {found}");
        }
    }
}

/// The rotor of `fence` turns evenly: each of its texels was where the closed form of its turn has been, up to the 2^-11 of a
/// half float and what rounded depth and interpolation leave, a hundredth of a texel. All that stands has exactly 0, everything
/// has 0 in a scene that stands, and the picture is the same bits with vectors and without.
#[test]
fn motion_vectors_are_where_the_rotor_was() {
    let Model::BuiltIn(made) = scene::open("fence:lights=5", 1, &AnimationChoice::All).unwrap() else {
        panic!("fence is built in")
    };
    let [time_s, earlier_s] = [1.0, 1.0 - 1.0 / 30.0];
    let Thing::Draw(rotor) = made.motions[0].thing else { panic!("no camera of fence moves") };
    let name = made.motions[0].name.clone();
    let scene = made.as_ref().clone().into_pose(time_s);
    let earlier = made.as_ref().clone().into_pose(earlier_s);
    let [now_place, earlier_place] = [&scene, &earlier].map(|scene| scene.draws[rotor].world_from_object);
    let (ids, rotor_bounds) =
        (object_ids::of(&scene), scene.draws[rotor].bounds(&scene.meshes[scene.draws[rotor].mesh]));
    let changes = [
        ("size", "240x180"),
        ("light-size", "240x180"),
        ("camera", "rotor"),
        ("motion-vectors", "on"),
        ("direct-shadow", "none"),
        ("alpha", "test"),
    ];
    let stages = ["geometry.motion", "geometry.dsf.depth", "geometry.dsf.id"];
    let still = Watched::with_scene(scene.clone());
    let resting = still.render_stages(NAME, &changes, &stages);
    assert!(
        still.rgb(&resting, "geometry.motion").iter().all(|vector| *vector == [0.0; 3]),
        "one moment has no motion"
    );
    let moving = Watched::with_scene(scene.moved_from(earlier).unwrap());
    let renderer = moving.render_stages(NAME, &changes, &stages);
    assert!(renderer.picture().unwrap().pixels == resting.picture().unwrap().pixels, "{name} moves the picture");
    let vectors = moving.rgb(&renderer, "geometry.motion");
    let found_ids = moving.integers(&renderer, "geometry.dsf.id");
    let AovChannels::Y(depths) = renderer.aov("geometry.dsf.depth").unwrap().channels else {
        panic!("it has a number")
    };
    let view = &renderer.view;
    let clip_from_world = view.clip_from_world();
    let px = |point: Vec3| {
        let at = clip_from_world.project_point3(point);
        Vec2::new(0.5 + 0.5 * at.x, 0.5 + 0.5 * at.y) * Vec2::new(240.0, 180.0)
    };
    let forward = -view.camera.world_from_view.z_axis.truncate();
    let (mut turning, mut largest) = (0, 0f32);
    for (index, vector) in vectors.iter().enumerate() {
        let middle = Vec2::new((index % 240) as f32 + 0.5, (index / 240) as f32 + 0.5);
        let ndc = 2.0 * middle / Vec2::new(240.0, 180.0) - 1.0;
        let ray = clip_from_world.inverse().project_point3(ndc.extend(0.5)) - view.eye();
        let point = view.eye() + ray * (depths[index] / ray.dot(forward));
        let is_near =
            (point - rotor_bounds.center()).abs().cmple(0.5 * (rotor_bounds.max - rotor_bounds.min) + 0.01).all();
        let vector = Vec2::new(vector[0], vector[1]);
        if found_ids[index] >> 8 == u32::from(ids[rotor]) && depths[index] > 0.0 && is_near {
            let earlier_point = (earlier_place * now_place.inverse()).transform_point3(point);
            let expected = px(point) - px(earlier_point);
            let off = (vector - expected).length();
            assert!(off < 0.02 + expected.length() / 500.0, "texel {index}: {vector}, not {expected}");
            turning += 1;
            largest = largest.max(expected.length());
        } else {
            assert_eq!(vector, Vec2::ZERO, "texel {index} of what stands");
        }
    }
    println!("{turning} texels of {name} moved by up to {largest} texels");
    assert!(turning > 300 && largest > 1.5, "{turning} texels, up to {largest}");
}
