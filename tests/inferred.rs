//! Inferred lighting (Kircher 2009): where it must equal plain deferred shading, what its roads must share, what its filter
//! keeps apart.

mod support;

use glam::{Vec2, Vec3, vec3};
use quincunx::report::image_file::AovChannels;
use quincunx::report::picture::Picture;
use quincunx::scene::{self, AlphaMode, AnimationChoice, Light, Material, Model, Projection, Scene, object_ids};
use quincunx::techniques::inferred_lighting::encoding::Packing;
use serde_json::json;
use std::collections::BTreeSet;
use support::boxes::{camera, point_light, rectangle};
use support::gltf_file::GltfFile;
use support::watched::{Changes, Watched, both};

const NAME: &str = "inferred_lighting";

/// Greatest difference of two pictures, as a part of the brighter pixel's greatest channel and a hundredth of the picture's.
fn greatest_part(a: &Picture, b: &Picture) -> f32 {
    let brightest = |pixel: &[f32; 3]| pixel.iter().fold(0f32, |most, channel| most.max(*channel));
    let all = b.pixels.iter().map(brightest).fold(0f32, f32::max);
    let part = |(a, b): (&[f32; 3], &[f32; 3])| {
        let difference = (0..3).map(|channel| (a[channel] - b[channel]).abs()).fold(0f32, f32::max);
        difference / (brightest(a).max(brightest(b)) + 0.01 * all)
    };
    a.pixels.iter().zip(&b.pixels).map(part).fold(0f32, f32::max)
}

/// A light buffer of the frame's size is deferred shading with rounded normals and rounded light. A half float is off by at
/// most 2^-12 of itself, 2.5e-4. A normal's two 16-bit numbers are off by at most 2^-16 each, and twice that after the map back
/// from the hemisphere, some 5e-5 in all: cosines near 0 feel it most, where a light that grazes the surface is all there is.
/// Both are inside 2e-3 of a pixel, or of a hundredth of the brightest one.
#[test]
fn at_the_frame_s_size_it_is_deferred_shading() {
    const BOUND: f32 = 2e-3;
    for spec in ["hall:triangles=8000", "lamps:objects=30,lights=30", "cornell"] {
        let mut scene = scene::load(spec, 1).unwrap();
        let Scene { draws, meshes, materials, .. } = &mut scene;
        draws.retain(|draw| materials[meshes[draw.mesh].material].alpha != AlphaMode::Blend);
        let watched = Watched::with_scene(scene);
        for size in ["160x90", "161x91"] {
            let common = [("size", size), ("brdf", "lambert"), ("direct-shadow", "none")];
            let inferred = watched.picture(NAME, &both(&common, &[("light-size", size)]));
            let deferred = watched.picture("deferred", &both(&common, &[("position", "depth")]));
            let found = greatest_part(&inferred, &deferred);
            println!("{spec} at {size}: {found:e}");
            assert!(found <= BOUND, "{spec} at {size}: {found}");
        }
    }
}

#[test]
fn every_road_of_the_lights_leaves_the_same_l_buffer() {
    let roads: [Changes<'_>; 8] = [
        &[("volumes", "tiled")],
        &[("volumes", "tiled"), ("texels", "1"), ("workgroup", "8x8")],
        &[("volumes", "quad")],
        &[("volumes", "scissor")],
        &[("volumes", "stencil")],
        &[("volumes", "both")],
        &[("volumes", "auto")],
        &[("volumes", "auto"), ("stencil-least", "50")],
    ];
    for (spec, more) in [
        ("lamps:objects=30,lights=30", &[("brdf", "lambert")][..]),
        ("lamps:objects=30,lights=30", &[("ambient", "0.1,0.2,0.3"), ("brdf", "blinn-phong"), ("extras", "off")]),
        ("hall:triangles=8000", &[("direct-shadow", "ray")]),
        ("cornell", &[("lights", "20"), ("light-cutoff", "0.5")]),
    ] {
        let watched = Watched::open(spec);
        for size in [("160x90", "100x56"), ("97x53", "40x91")] {
            let common = both(&[("size", size.0), ("light-size", size.1)], more);
            let of = |road: Changes<'_>| {
                let names = ["light.l_buffer.irradiance", "light.l_buffer.highlight"];
                let renderer = watched.render_stages(NAME, &both(&common, road), &names);
                (names.map(|name| renderer.aov(name).unwrap().channels), renderer.picture().unwrap())
            };
            let first = of(roads[0]);
            for road in &roads[1..] {
                let found = of(road);
                assert!(found.0 == first.0, "{spec}, {size:?}, {road:?}: another L-buffer");
                assert!(found.1.pixels == first.1.pixels, "{spec}, {size:?}, {road:?}: another picture");
            }
        }
    }
}

/// The eye inside of a volume, volumes that cross the near plane and that reach beyond a far plane just behind the scene, and
/// one behind the eye: the stencil leaves out what adds nothing, and nothing else.
#[test]
fn volumes_are_right_around_the_eye_and_beyond_the_far_plane() {
    let mut scene = edge(300.0);
    let Projection::Perspective { z_far, .. } = &mut scene.cameras[0].projection else { panic!("edge has an eye") };
    *z_far = Some(6.5);
    for (position, range) in [
        (vec3(0.1, 0.0, 0.2), 30.0),
        (vec3(0.0, 0.5, -5.9), 4.0),
        (vec3(-1.0, 0.0, -0.5), 1.0),
        (vec3(0.0, 0.0, 9.0), 2.0),
        (vec3(2.0, 1.0, -4.0), 1.5),
    ] {
        scene.lights.push(Light { range: Some(range), ..point_light(position, 40.0) });
    }
    let watched = Watched::with_scene(scene);
    let changes = [("size", "160x120"), ("brdf", "blinn-phong"), ("light-cutoff", "0")];
    let first = watched.hash(NAME, &both(&changes, &[("volumes", "tiled")]));
    for volumes in ["quad", "scissor", "stencil", "both", "auto"] {
        assert_eq!(watched.hash(NAME, &both(&changes, &[("volumes", volumes)])), first, "{volumes}");
    }
}

/// A square that stands before a wall, from the paper's figure 4: between both runs an edge that no texel of the light
/// buffer follows. `wall_light`: candela of a light that reaches the wall and not the square.
fn edge(wall_light: f32) -> Scene {
    let mut scene =
        Scene { name: format!("edge {wall_light}"), hash: format!("edge {wall_light}"), ..Scene::default() };
    let gray = Material::diffuse("gray", Vec3::splat(0.5));
    rectangle(&mut scene, vec3(0.0, 0.0, -6.0), 6.0 * Vec3::X, 6.0 * Vec3::Y, gray.clone());
    let (u, v) = (vec3(0.9, 0.3, 0.0), vec3(-0.3, 0.9, 0.0));
    rectangle(&mut scene, vec3(-0.5, -0.4, -3.0), u, v, gray);
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, 0.9));
    let of_wall = Light { range: Some(2.0), ..point_light(vec3(0.3, 0.2, -5.0), wall_light) };
    scene.lights.push(point_light(Vec3::ZERO, 5.0));
    scene.lights.push(of_wall);
    scene
}

/// Samples of the wall are thrown out where the square is shaded, however bright they are; plain filtering lets them in.
#[test]
fn the_filter_keeps_another_surface_s_light_out() {
    let dark = Watched::with_scene(edge(0.0));
    let bright = Watched::with_scene(edge(500.0));
    let common = [("size", "160x120"), ("light-size", "50x38"), ("brdf", "lambert"), ("light-cutoff", "0")];
    // The square's own pixels, by a light buffer of the frame's size.
    let marked = both(&common, &[("light-size", "160x120")]);
    let renderer = dark.render_stages(NAME, &marked, &["geometry.dsf.id"]);
    let ids = dark.integers(&renderer, "geometry.dsf.id");
    let is_square = |index: &usize| ids[*index] >> 8 == 1;
    assert!((0..ids.len()).filter(is_square).count() > 1000);
    for (filter, leaks) in
        [("dsf", false), ("discontinuity", false), ("bilateral", false), ("bilinear", true), ("nearest", true)]
    {
        let changes = both(&common, &[("light-filter", filter)]);
        let [a, b] = [&dark, &bright].map(|watched| watched.picture(NAME, &changes).pixels);
        let changed = (0..ids.len()).filter(is_square).filter(|index| a[*index] != b[*index]).count();
        assert_eq!(changed > 0, leaks, "--light-filter {filter}: {changed} pixels of the square changed");
        let wall = (0..ids.len()).filter(|index| !is_square(index)).filter(|index| a[*index] != b[*index]).count();
        assert!(wall > 1000, "the light reaches the wall");
    }
}

/// The paper's figure 4, pixel by pixel: the light of a pixel is the bilinear mean of those of its four texels that show its
/// surface, by their ids; of all four where none does, which is counted. The sliver is too narrow to reach many texels.
#[test]
fn a_pixel_takes_the_texels_of_its_own_surface() {
    const RATIO: usize = 4;
    let (extent, texels) = ([160, 120], [40, 30]);
    let mut scene = edge(300.0);
    let gray = Material::diffuse("gray", Vec3::splat(0.5));
    rectangle(&mut scene, vec3(0.9, 0.3, -2.9), vec3(0.02, 0.0, 0.0), vec3(0.1, 0.7, 0.0), gray);
    let watched = Watched::with_scene(scene);
    let common = [("size", "160x120"), ("light-size", "40x30"), ("brdf", "lambert"), ("light-cutoff", "0")];
    let stages = ["geometry.dsf.id", "light.l_buffer.irradiance"];
    let low = watched.render_stages(NAME, &common, &stages);
    let full = watched.render_stages(NAME, &both(&common, &[("light-size", "160x120")]), &stages[..1]);
    let (low_ids, ids) = (watched.integers(&low, stages[0]), watched.integers(&full, stages[0]));
    let light = watched.rgb(&low, stages[1]);
    let picture = low.picture().unwrap();
    // Any pixel of a texel shows the texel.
    let shown = |[x, y]: [usize; 2]| (y * RATIO + RATIO / 2) * extent[0] + x * RATIO + RATIO / 2;
    let mut found = [0; 5];
    for (pixel, id) in ids.iter().enumerate() {
        let at = [pixel % extent[0], pixel / extent[0]].map(|at| (at as f32 + 0.5) / RATIO as f32 - 0.5);
        let [mut own, mut all] = [(Vec3::ZERO, 0.0, 0); 2];
        for corner in 0..4usize {
            let step = [corner & 1, corner >> 1];
            let texel = [0, 1].map(|side| {
                let place = at[side].floor() as i32 + step[side] as i32;
                place.clamp(0, texels[side] - 1) as usize
            });
            let weigh = |side: usize| {
                let part = at[side] - at[side].floor();
                if step[side] == 1 { part } else { 1.0 - part }
            };
            let (weight, irradiance) = (weigh(0) * weigh(1), Vec3::from_array(light[shown(texel)]));
            let add = |sum: &mut (Vec3, f32, usize)| {
                *sum = (sum.0 + irradiance * weight, sum.1 + weight, sum.2 + 1);
            };
            add(&mut all);
            if low_ids[shown(texel)] == *id {
                add(&mut own);
            }
        }
        found[own.2] += 1;
        let (sum, weights, _) = if own.2 > 0 { own } else { all };
        let expected = sum / weights * (0.5 / std::f32::consts::PI);
        let off = (Vec3::from_array(picture.pixels[pixel]) - expected).abs().max_element();
        assert!(off <= 1e-4 * expected.max_element() + 1e-6, "pixel {pixel}: {off} off {expected}, {} texels", own.2);
    }
    println!("pixels by how many of their four texels are their own: {found:?}");
    assert!(found.iter().all(|count| *count > 20), "{found:?}");
    assert_eq!(low.measured_counters().unwrap()["rejected_fragments"], f64::from(found[0]), "{found:?}");
}

/// Sheets of glass one behind the other before a wall. `lit`: the only one that is not black, where it is one.
fn glass(count: usize, lit: Option<usize>) -> Scene {
    let mut scene = Scene { name: format!("glass {count} {lit:?}"), ..Scene::default() };
    let wall = Material::diffuse("wall", Vec3::splat(if lit.is_some() { 0.0 } else { 0.5 }));
    rectangle(&mut scene, vec3(0.0, 0.0, -6.0), 6.0 * Vec3::X, 6.0 * Vec3::Y, wall);
    for sheet in 0..count {
        let color = vec3(0.9, 0.5, 0.3).lerp(vec3(0.2, 0.4, 0.9), sheet as f32 / 2.0).max(Vec3::splat(0.1));
        let color = if lit.is_none_or(|lit| lit == sheet) { color } else { Vec3::ZERO };
        let glass = Material {
            base_color: color.extend(0.4),
            alpha: AlphaMode::Blend,
            double_sided: true,
            ..Material::diffuse("glass", color)
        };
        let z = -3.0 - 0.5 * sheet as f32;
        rectangle(&mut scene, vec3(0.3 * sheet as f32 - 0.3, 0.0, z), Vec3::X, 0.8 * Vec3::Y, glass);
    }
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, 0.9));
    // Far enough that light changes little from sample to sample.
    scene.lights.push(point_light(vec3(2.0, 3.0, 2.0), 100.0));
    scene
}

/// Each sheet by itself, the others black: what it sends is what a forward renderer gives it, neither twice nor nothing, as long
/// as the stipple has a layer for each. A fourth sheet shares one of the three layers of a stipple of 2x2 with another: where the
/// nearer one has the texels, the farther one is lit by what is there.
#[test]
fn glass_is_lit_as_forward_lights_it() {
    let common = [("size", "160x120"), ("brdf", "lambert"), ("light-cutoff", "0")];
    for count in 1..=4 {
        for lit in (0..count).map(Some).chain([None]) {
            let watched = Watched::with_scene(glass(count, lit));
            let forward = watched.picture("deferred", &common);
            let brightest = |pixel: &[f32; 3]| pixel.iter().fold(0f32, |most, channel| most.max(*channel));
            for stipple in ["2x2", "4x4"] {
                for assignment in ["overlap", "depth", "static"] {
                    for filter in ["cone", "bilinear"] {
                        let changes = [("stipple", stipple), ("alpha-filter", filter), ("assignment", assignment)];
                        let size = [("light-size", "160x120")];
                        let picture = watched.picture(NAME, &both(&both(&common, &changes), &size));
                        let found = greatest_part(&picture, &forward);
                        println!("{lit:?} of {count} sheets, {stipple} {assignment} {filter}: {found}");
                        let shares = count == 4 && stipple == "2x2" && lit.is_none_or(|lit| lit == 3);
                        let bound = if shares { 0.4 } else { 0.03 };
                        assert!(found < bound, "{lit:?} of {count} sheets, {changes:?}: {found}");
                        let dark = |(a, b): (&[f32; 3], &[f32; 3])| brightest(a) < 0.5 * brightest(b);
                        let black = picture.pixels.iter().zip(&forward.pixels).filter(|pair| dark(*pair)).count();
                        assert_eq!(black, 0, "{lit:?} of {count} sheets, {changes:?}");
                    }
                }
            }
        }
    }
}

/// Sums that are rounded after each light are off by more the more lights there are, and by what rounding a driver has: to the
/// nearest half float, or towards 0, which darkens.
#[test]
fn blending_in_halves_is_near_the_float_sum() {
    let common = [("size", "160x90"), ("brdf", "lambert"), ("volumes", "scissor")];
    for (lights, bound) in [(1, 1e-3), (81, 0.02), (287, 0.06)] {
        let watched = Watched::open(&format!("lamps:objects=30,lights={lights}"));
        let mean = |picture: &Picture| picture.pixels.iter().flatten().map(|value| f64::from(*value)).sum::<f64>();
        let sums = watched.picture(NAME, &common);
        let halves = watched.picture(NAME, &both(&common, &[("l-buffer", "half")]));
        let bias = mean(&halves) / mean(&sums) - 1.0;
        println!("{lights} lights, blended in half floats against float sums: {bias:e}");
        assert!(bias.abs() < bound && (bias != 0.0 || lights == 1), "{lights} lights: {bias}");
    }
    let watched = Watched::open("lamps:objects=9,lights=1");
    let error = watched.try_renderer(NAME, &[("l-buffer", "half")], &[], quincunx::gpu::commands::Submits::One);
    assert_eq!(error.err().unwrap().exit_code(), 2);
}

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
        // Any direction of which the word is, then the direction that the word stands for.
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
        let common = [("size", "160x90"), ("volumes", volumes)];
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
    let (rotor, name) = (made.spins[0].draw, made.spins[0].name);
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

/// Sheets of glass before a wall, each of which fills the screen, nearest first at `z_m` meters.
fn sheets(z_m: &[f32]) -> Scene {
    let mut scene = Scene { name: format!("sheets {z_m:?}"), ..Scene::default() };
    let gray = Material::diffuse("wall", Vec3::splat(0.5));
    rectangle(&mut scene, vec3(0.0, 0.0, -6.0), 9.0 * Vec3::X, 9.0 * Vec3::Y, gray);
    for z in z_m {
        let glass = Material {
            base_color: Vec3::splat(0.5).extend(0.3),
            alpha: AlphaMode::Blend,
            ..Material::diffuse("glass", Vec3::ONE)
        };
        rectangle(&mut scene, vec3(0.0, 0.0, *z), 12.0 * Vec3::X, 12.0 * Vec3::Y, glass);
    }
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, 0.9));
    scene.lights.push(point_light(vec3(0.0, 0.0, -1.0), 10.0));
    scene
}

/// Of sheets that fill the screen the three nearest have a layer of a 2x2 stipple each; those behind them share it and are left
/// without a texel, as is one behind the wall. One behind the eye is not on the screen and is not counted.
#[test]
fn the_report_counts_layers_that_are_lit_and_draws_that_are_not() {
    let behind_wall = -7.0;
    for (z_m, lit, unlit, shared) in [
        (&[-2.0][..], 1.0, 0.0, 0.0),
        (&[-2.0, -2.5, -3.0], 3.0, 0.0, 0.0),
        (&[-2.0, -2.5, -3.0, -3.5, -4.0], 3.0, 2.0, 2.0),
        (&[-2.0, behind_wall], 1.0, 1.0, 0.0),
        (&[-2.0, 3.0], 1.0, 0.0, 0.0),
    ] {
        let watched = Watched::with_scene(sheets(z_m));
        for (packing, extras) in [("words", "on"), ("words", "off"), ("fixed", "on"), ("rgba8", "on")] {
            let changes = [("size", "80x60"), ("light-size", "50x38"), ("packing", packing), ("extras", extras)];
            let renderer = watched.render(NAME, &changes);
            let found = renderer.measured_counters().unwrap();
            let names = ["stipple_layers_lit", "stipple_draws_lit", "stipple_draws_unlit", "stipple_layers_shared"];
            assert_eq!(names.map(|name| found[name]), [lit, lit, unlit, shared], "{z_m:?}, {packing}: {names:?}");
        }
    }
}

/// Two panes side by side of one material each, from a file.
fn panes() -> GltfFile {
    let mut file = GltfFile::empty();
    for (index, (name, x)) in [("amber", -2.5f32), ("blue", 0.1)].into_iter().enumerate() {
        let corners =
            [x, -1.0, -4.0, x + 2.0, -1.0, -4.0, x, 1.0, -4.0, x + 2.0, -1.0, -4.0, x + 2.0, 1.0, -4.0, x, 1.0, -4.0];
        let positions = file.floats("VEC3", &corners);
        let surface = json!({"baseColorFactor": [0.5, 0.5, 0.5, 0.5]});
        file.push("materials", json!({"name": name, "alphaMode": "BLEND", "pbrMetallicRoughness": surface}));
        file.push("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}, "material": index}]}));
        file.root(json!({"mesh": index, "name": format!("{name} pane")}));
    }
    let eye = json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}});
    file.push("cameras", eye);
    file.root(json!({"camera": 0}));
    file
}

/// Extras of a material or a node, and the flag, say which texels a surface is lit at; what is not said goes by turns.
#[test]
fn the_user_names_layers_in_the_file_or_by_flag() {
    let layer = |layer: u32| json!({"quincunx_stipple_layer": layer, "other": [1]});
    let mut by_material = panes();
    by_material.json["materials"][0]["extras"] = layer(3);
    let mut by_node = by_material.clone();
    by_node.json["nodes"][0]["extras"] = layer(2);
    for (file, flag, expected) in [
        (panes(), "none", [1, 2]),
        (by_material.clone(), "none", [3, 1]),
        (by_node.clone(), "none", [2, 1]),
        (by_node.clone(), "amber=1", [1, 2]),
        (by_node.clone(), "blue pane=2,amber pane=2", [2, 2]),
    ] {
        let watched = Watched::with_scene(file.load().unwrap());
        let size = [("size", "64x48"), ("light-size", "64x48")];
        let changes = both(&size, &[("assignment", "static"), ("stipple-layers", flag)]);
        let renderer = watched.render_stages(NAME, &changes, &["geometry.dsf.id", "geometry.dsf.depth"]);
        let ids = watched.integers(&renderer, "geometry.dsf.id");
        let AovChannels::Y(depths) = renderer.aov("geometry.dsf.depth").unwrap().channels else { panic!("a number") };
        for draw in 0..2 {
            let texels = (0..ids.len()).filter(|index| depths[*index] > 0.0 && ids[*index] >> 8 == draw);
            let layers: BTreeSet<usize> = texels.map(|index| index / 64 % 2 * 2 + index % 64 % 2).collect();
            assert_eq!(layers, BTreeSet::from([expected[draw as usize]]), "pane {draw} with {flag}");
        }
    }
    let watched = Watched::with_scene(by_node.load().unwrap());
    for (changes, said) in [
        (&[("assignment", "static"), ("stipple-layers", "green=1")][..], "amber, amber pane, blue, blue pane"),
        (&[("assignment", "static"), ("stipple-layers", "blue=4")], "layers 1 to 3"),
        (&[("stipple-layers", "blue=2")], "--assignment static takes them"),
    ] {
        let error = watched.try_renderer(NAME, changes, &[], quincunx::gpu::commands::Submits::One).err().unwrap();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(said), "{changes:?}: {error}");
    }
    for (wrong, said) in
        [(json!(0), "from 1 to 15"), (json!("3"), "is \"3\""), (json!(16), "is 16"), (json!(1.5), "is 1.5")]
    {
        let mut file = panes();
        file.json["materials"][1]["extras"] = json!({"quincunx_stipple_layer": wrong});
        let error = file.load().unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains(said), "{error}");
        assert!(error.to_string().contains("material 1 \"blue\""), "{error}");
    }
}

#[test]
fn no_light_one_and_many() {
    for (lights, is_dark) in [("0", true), ("1", false), ("2000", false)] {
        let mut scene = scene::load("lamps:objects=9,lights=1", 1).unwrap();
        scene.lights.clear();
        let watched = Watched::with_scene(scene);
        let changes = [("size", "64x36"), ("lights", lights), ("rig", "none")];
        for volumes in ["tiled", "scissor"] {
            let picture = watched.picture(NAME, &both(&changes, &[("volumes", volumes)]));
            let lit = picture.pixels.iter().filter(|pixel| pixel.iter().any(|channel| *channel > 0.0)).count();
            assert_eq!(lit == 0, is_dark, "{lights} lights, {volumes}: {lit} pixels are lit");
        }
    }
}

/// Where the light buffer's nearest texel shows another surface than the pixel does, the filter is nearer to what many samples a
/// pixel come to than plain filtering is.
#[test]
fn on_edges_the_filter_is_nearer_to_the_supersampled_picture() {
    let (size, common) = ("200x112", [("brdf", "lambert"), ("size", "200x112")]);
    for spec in ["lamps:objects=101,lights=81", "fence:lights=20", "hall:triangles=8000"] {
        let watched = Watched::open(spec);
        let reference = watched.picture("forward", &both(&common, &[("supersample", "8")]));
        let ids = |light_size: &str| {
            let changes = both(&common, &[("light-size", light_size)]);
            let renderer = watched.render_stages(NAME, &changes, &["geometry.dsf.id"]);
            watched.integers(&renderer, "geometry.dsf.id")
        };
        let (low, high) = (ids("auto"), ids(size));
        let chosen: Vec<usize> = (0..low.len()).filter(|index| low[*index] != high[*index]).collect();
        assert!(chosen.len() > 500, "{spec}: {} pixels", chosen.len());
        let rmse = |filter: &str| {
            let picture = watched.picture(NAME, &both(&common, &[("msaa", "4"), ("light-filter", filter)]));
            let square = |index: &usize| {
                let channels = picture.pixels[*index].into_iter().zip(reference.pixels[*index]);
                channels.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / 3.0
            };
            (chosen.iter().map(square).sum::<f64>() / chosen.len() as f64).sqrt()
        };
        let [dsf, bilinear, nearest] = ["dsf", "bilinear", "nearest"].map(rmse);
        println!("{spec}: {} pixels, dsf {dsf:.4}, bilinear {bilinear:.4}, nearest {nearest:.4}", chosen.len());
        assert!(dsf < bilinear && bilinear < nearest, "{spec}: {dsf}, {bilinear}, {nearest}");
    }
}

/// A sampler may round a fetch's place: to one of 16 from texel to texel at the coarsest that Vulkan allows, of 256 on most GPUs,
/// not at all on lavapipe. A half float has 1024 steps from one power of two to the next.
#[test]
fn a_single_fetch_blends_as_four_do_but_for_the_sampler_s_steps() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [("size", "160x90"), ("brdf", "lambert")];
    let picture = |fetch: &str, filter: &str| {
        watched.picture(NAME, &both(&common, &[("light-fetch", fetch), ("light-filter", filter)])).pixels
    };
    for filter in ["dsf", "bilinear"] {
        let (four, single) = (picture("texels", filter), picture("sampler", filter));
        let step = |value: f32| 2f32.powi(value.max(1e-6).log2().floor() as i32 - 10);
        let steps = four.as_flattened().iter().zip(single.as_flattened()).map(|(a, b)| (a - b).abs() / step(a.max(*b)));
        let (mut most, mut sum) = (0f32, 0f64);
        for steps in steps {
            most = most.max(steps);
            sum += f64::from(steps);
        }
        println!("{filter}: {most} half-float steps at most, {} in the mean", sum / (3 * four.len()) as f64);
        assert!(most > 0.0, "{filter}: it is another way");
        assert!(most < 8.0, "{filter}: {most} half-float steps");
    }
}
