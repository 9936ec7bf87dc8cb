//! BLEND surfaces in inferred lighting (Kircher 2009, section 4): each is lit by its own texels of the stipple.

use crate::support::boxes::{camera, point_light, rectangle};
use crate::support::choices::words;
use crate::support::difference::greatest_part;
use crate::support::gltf_file::GltfFile;
use crate::support::watched::{Watched, both};
use crate::support::{self, Feature};
use glam::{Vec3, vec3};
use quincunx::picture::AovChannels;
use quincunx::scene::{AlphaMode, Material, Scene};
use quincunx::units::Extent;
use serde_json::json;
use std::collections::BTreeSet;

const NAME: &str = "inferred_lighting";

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
            for stipple in words(NAME, "stipple") {
                for assignment in words(NAME, "assignment") {
                    for filter in words(NAME, "alpha-filter") {
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

/// The three nearest of the sheets that fill the screen have a layer of a 2x2 stipple each; those behind them share one
/// and are left without a texel, as is one behind the wall. One behind the eye is not on the screen and is not counted.
#[test]
fn the_report_counts_layers_that_are_lit_and_draws_that_are_not() {
    let behind_wall = -7.0;
    for (z_m, lit, unlit, shared) in [
        (&[-2.0][..], 1.0, 0.0, 0.0),
        (&[-2.0, -2.5, -3.0], 3.0, 0.0, 0.0),
        (&[-2.0, -2.5, -3.0, -3.5, -4.0], 3.0, 2.0, 2.0),
        (&[-2.0, behind_wall], 1.0, 1.0, 0.0),
        (&[-2.0, 3.0], 1.0, 0.0, 0.0),
        (&[-2.0, 3.0, 3.5, 4.0, 4.5], 1.0, 0.0, 0.0),
    ] {
        let watched = Watched::with_scene(sheets(z_m));
        for (packing, extras) in [("words", "on"), ("words", "off"), ("fixed", "on"), ("rgba8", "on")] {
            let size = [("size", "80x60"), ("light-size", "50x38"), ("stipple", "2x2")];
            let changes = both(&size, &[("packing", packing), ("extras", extras)]);
            let renderer = watched.render(NAME, &changes);
            let found = renderer.measured_counters().unwrap();
            let names = ["stipple_layers_lit", "stipple_draws_lit", "stipple_draws_unlit", "stipple_layers_shared"];
            assert_eq!(names.map(|name| found[name]), [lit, lit, unlit, shared], "{z_m:?}, {packing}: {names:?}");
        }
    }
}

/// What is as good as empty has no texel and adds nothing: the picture is that without it.
#[test]
fn glass_of_less_than_a_step_of_alpha_is_not_lit() {
    let size = [("size", "80x60"), ("light-size", "50x38")];
    for (steps, is_lit) in [(0.9, false), (1.1, true)] {
        let mut scene = sheets(&[-2.0]);
        scene.materials[1].base_color.w = steps / 255.0;
        let (sheet, wall) = (Watched::with_scene(scene), Watched::with_scene(sheets(&[])));
        let [sheet, wall] = [&sheet, &wall].map(|watched| watched.render(NAME, &size));
        assert_eq!(sheet.measured_counters().unwrap()["stipple_layers_lit"], f64::from(u8::from(is_lit)), "{steps}");
        let [sheet, wall] = [sheet, wall].map(|renderer| renderer.picture().unwrap().pixels);
        assert_eq!(sheet != wall, is_lit, "{steps} steps of alpha");
    }
}

/// The light of a pixel of glass is the mean of the four texels of its layer around it: bilinear, or by a cone that falls to 0 at
/// --cone-radius, in half sides of the stipple. Where the cone reaches none of them, all four count alike.
#[test]
fn a_pixel_of_glass_takes_the_texels_of_its_layer_by_the_filter_s_weights() {
    const RATIO: i32 = 4;
    let (extent, texels) = ([160, 120], [40, 30]);
    let mut scene = sheets(&[-3.0]);
    scene.materials[0] = Material::diffuse("wall", Vec3::ZERO);
    scene.lights = vec![point_light(vec3(0.3, 0.2, -2.2), 5.0)];
    let watched = Watched::with_scene(scene);
    let common = [("size", "160x120"), ("light-size", "40x30"), ("brdf", "lambert"), ("light-cutoff", "0")];
    let irradiance = "light.l_buffer.irradiance";
    for (stipple, side) in [("2x2", 2), ("4x4", 4)] {
        for radius in [None, Some(0.3), Some(1.0), Some(1.7)] {
            let radius_name = radius.unwrap_or(1.0).to_string();
            let filter = if radius.is_some() { "cone" } else { "bilinear" };
            let own = [("stipple", stipple), ("alpha-filter", filter), ("cone-radius", &radius_name)];
            let renderer =
                watched.render_stages(NAME, &both(&common, &own[..2 + usize::from(radius.is_some())]), &[irradiance]);
            let light = watched.rgb(&renderer, irradiance);
            // Layer 1 is the second texel of each cell's first row. Any pixel of a texel shows the texel.
            let offset = [1, 0];
            let of_texel = |[x, y]: [i32; 2]| {
                let at = (y * RATIO + RATIO / 2) * extent[0] + x * RATIO + RATIO / 2;
                Vec3::from_array(light[at as usize])
            };
            let mut far_from_all = 0;
            for (pixel, found) in renderer.picture().unwrap().pixels.iter().enumerate() {
                let at = [pixel as i32 % extent[0], pixel as i32 / extent[0]];
                let place = [0, 1]
                    .map(|axis| ((at[axis] as f32 + 0.5) / RATIO as f32 - 0.5 - offset[axis] as f32) / side as f32);
                let mut sums = [(Vec3::ZERO, 0.0); 2];
                for step in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                    let cell = [0, 1].map(|axis| place[axis].floor() as i32 + step[axis]);
                    let away = [0, 1].map(|axis| (place[axis] - cell[axis] as f32).abs());
                    let texel = of_texel([0, 1].map(|axis| {
                        let last = (texels[axis] - 1 - offset[axis]) / side;
                        cell[axis].clamp(0, last) * side + offset[axis]
                    }));
                    let weight = match radius {
                        None => (1.0 - away[0]) * (1.0 - away[1]),
                        Some(radius) => (1.0 - away[0].hypot(away[1]) * 2.0 / radius).max(0.0),
                    };
                    sums = [(sums[0].0 + texel * weight, sums[0].1 + weight), (sums[1].0 + texel, sums[1].1 + 1.0)];
                }
                far_from_all += usize::from(sums[0].1 == 0.0);
                let (sum, weights) = if sums[0].1 > 0.0 { sums[0] } else { sums[1] };
                let expected = sum / weights * (0.5 * 0.3 / std::f32::consts::PI);
                let off = (Vec3::from_array(*found) - expected).abs().max_element();
                let bound = 5e-4 * expected.max_element() + 1e-6;
                assert!(off <= bound, "{stipple}, {radius:?}, pixel {pixel}: {off} off {expected}");
            }
            assert_eq!(far_from_all > 0, radius.is_some_and(|radius| radius < 1.4), "{stipple}, {radius:?}");
        }
    }
}

/// A stipple of 2x2 where its three layers do for what is on the screen, and where the user names none beyond; else one of 4x4.
#[test]
fn the_stipple_is_as_coarse_as_the_scene_needs() {
    let size = [("size", "64x48"), ("light-size", "64x48")];
    let chosen = |watched: &Watched, more: &[(&str, &str)]| {
        let renderer = watched.render(NAME, &both(&size, more));
        renderer.resolved["stipple"].clone()
    };
    for (z_m, expected) in [
        (&[][..], "2x2"),
        (&[-2.0, -2.5, -3.0], "2x2"),
        (&[-2.0, -2.5, -3.0, -3.5], "4x4"),
        (&[-2.0, -2.5, -3.0, 3.0, 3.5], "2x2"),
    ] {
        let watched = Watched::with_scene(sheets(z_m));
        assert_eq!(chosen(&watched, &[]), expected, "{z_m:?}");
        assert_eq!(chosen(&watched, &[("alpha", "test")]), "2x2", "{z_m:?}: none is stippled");
        assert_eq!(chosen(&watched, &[("stipple", "2x2")]), "2x2", "{z_m:?}");
    }
    let watched = Watched::with_scene(panes().load().unwrap());
    for (layers, expected) in [("none", "2x2"), ("blue=3", "2x2"), ("blue=4", "4x4"), ("amber=2,blue=2", "2x2")] {
        let changes = [("assignment", "static"), ("stipple-layers", layers)];
        assert_eq!(chosen(&watched, &changes), expected, "{layers}");
    }
}

/// Panes one behind the other that are one primitive of a file are a draw each, so that each has a layer, and is drawn in its order.
#[test]
fn panes_of_one_primitive_are_lit_as_those_of_several() {
    let corners = |z: f32| {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x + 0.1 * z, y, z])
    };
    let file = |groups: &[&[f32]]| {
        let mut file = GltfFile::empty();
        let surface = json!({"baseColorFactor": [0.5, 0.5, 0.5, 0.5]});
        file.push("materials", json!({"name": "glass", "alphaMode": "BLEND", "pbrMetallicRoughness": surface}));
        for (mesh, group) in groups.iter().enumerate() {
            let all: Vec<f32> = group.iter().flat_map(|z| corners(*z)).flatten().collect();
            let positions = file.floats("VEC3", &all);
            file.push("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}, "material": 0}]}));
            file.root(json!({"mesh": mesh}));
        }
        file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
        file.root(json!({"camera": 0}));
        let mut scene = file.load().unwrap();
        scene.lights.push(point_light(vec3(0.5, 0.5, -1.0), 10.0));
        scene
    };
    let changes = [("size", "80x60"), ("light-size", "50x38")];
    // Nearest first, which as one draw would hide what is behind.
    let [one, several] = [file(&[&[-3.0, -4.0, -5.0]]), file(&[&[-3.0], &[-4.0], &[-5.0]])];
    assert_eq!([one.draws.len(), several.draws.len()], [3, 3]);
    let [one, several] = [one, several].map(|scene| {
        let watched = Watched::with_scene(scene);
        ["inferred_lighting", "forward"].map(|technique| {
            watched.picture(technique, if technique == NAME { &changes } else { &changes[..1] }).pixels
        })
    });
    assert!(one == several);
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

/// Extras of a material or a node, and the flag, say which texels a surface is lit at; the others follow in rotation.
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
        (&[("assignment", "static"), ("stipple", "2x2"), ("stipple-layers", "blue=4")], "layers 1 to 3"),
        (&[("assignment", "static"), ("stipple-layers", "blue=16")], "layers 1 to 15"),
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

/// A wall and, two millimetres over it, a decal of this alpha that lets `lean` of its normal point to the right.
fn decal(lean: f32, alpha: f32) -> Scene {
    let mut scene = Scene { name: format!("decal {lean} {alpha}"), ..Scene::default() };
    let wall = Material::diffuse("wall", Vec3::splat(0.5));
    rectangle(&mut scene, vec3(0.0, 0.0, -4.0), 5.0 * Vec3::X, 5.0 * Vec3::Y, wall);
    let decal = Material {
        base_color: vec3(0.8, 0.6, 0.2).extend(alpha),
        alpha: AlphaMode::Blend,
        ..Material::diffuse("decal", Vec3::ONE)
    };
    rectangle(&mut scene, vec3(0.2, 0.1, -3.998), Vec3::X, 0.8 * Vec3::Y, decal);
    scene.meshes[1].normals.fill(vec3(lean, 0.0, 1.0).normalize());
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, 0.9));
    scene.lights.push(point_light(vec3(3.0, 2.0, 2.0), 100.0));
    scene
}

/// A decal is a BLEND surface just over another (section 4): it is lit by texels of its own, and so by its own normal and not by
/// that of what it lies on.
#[test]
fn a_decal_is_lit_by_its_own_normal() {
    let common = [("size", "160x120"), ("brdf", "lambert"), ("light-cutoff", "0")];
    let pictures = [-1.0, 0.0, 1.0].map(|lean| {
        let watched = Watched::with_scene(decal(lean, 0.7));
        let forward = watched.picture("forward", &common);
        for stipple in words(NAME, "stipple") {
            let picture = watched.picture(NAME, &both(&common, &[("light-size", "160x120"), ("stipple", stipple)]));
            let found = greatest_part(&picture, &forward);
            println!("normal leans by {lean}, {stipple}: {found}");
            assert!(found < 0.03, "normal leans by {lean}, {stipple}: {found}");
        }
        forward
    });
    // The light comes from the right.
    assert!(greatest_part(&pictures[0], &pictures[1]) > 0.3, "a normal to the left darkens");
}

/// A decal's normal over that of the wall is one by its alpha (section 5.2): wall and decal are lit as by a normal between theirs,
/// which the map to the hemisphere adds up; nothing of it is stippled.
#[test]
fn normals_of_a_decal_are_blended_into_those_of_what_it_lies_on() {
    const LEAN: f32 = 0.8;
    const ALPHA: f32 = 0.6;
    let watched = Watched::with_scene(decal(LEAN, ALPHA));
    if !support::has(&watched.session.gpu.caps, Feature::BlendFixedPairs) {
        return;
    }
    let common = [("size", "160x120"), ("light-size", "160x120"), ("brdf", "lambert"), ("light-cutoff", "0")];
    let changes = both(&common, &[("packing", "fixed"), ("decals", "decal")]);
    let stages = ["geometry.normal", "geometry.dsf.depth", "geometry.dsf.id"];
    let renderer = watched.render_stages(NAME, &changes, &stages);
    let counters = renderer.measured_counters().unwrap();
    assert_eq!(counters["stipple_layers_used"], 0.0, "{counters:?}");
    let mapped = |normal: Vec3| (normal + Vec3::Z).truncate() / (normal + Vec3::Z).length();
    let own = vec3(LEAN, 0.0, 1.0).normalize();
    let between = mapped(own) * ALPHA + mapped(Vec3::Z) * (1.0 - ALPHA);
    let z = (1.0 - between.length_squared()).sqrt();
    let expected = (2.0 * z * between).extend(2.0 * z * z - 1.0);
    let (normals, ids) = (watched.rgb(&renderer, stages[0]), watched.integers(&renderer, stages[2]));
    assert!(ids.iter().all(|id| *id == ids[0]), "ids are the wall's");
    let picture = renderer.picture().unwrap();
    let plain = watched.picture(NAME, &both(&common, &[("packing", "fixed")]));
    let AovChannels::Y(depths_m) = renderer.aov(stages[1]).unwrap().channels else { panic!("one channel") };
    let places = super::places(&watched.session.scene, Extent::new(160, 120), &depths_m);
    let light = &watched.session.scene.lights[0];
    let mut seen = 0;
    for (pixel, (normal, found)) in normals.iter().zip(&picture.pixels).enumerate() {
        let is_decal = Vec3::from_array(*normal).distance(expected) < 1e-4;
        assert!(is_decal || Vec3::from_array(*normal).distance(Vec3::Z) < 1e-4, "pixel {pixel}: {normal:?}");
        if !is_decal {
            assert_eq!(*found, plain.pixels[pixel], "pixel {pixel} is of the wall");
            continue;
        }
        seen += 1;
        let to_light = light.position - places[pixel];
        let lux = light.intensity * expected.dot(to_light.normalize()) / to_light.length_squared();
        let albedo = vec3(0.8, 0.6, 0.2) * ALPHA + Vec3::splat(0.5) * (1.0 - ALPHA);
        let radiance = albedo * lux / std::f32::consts::PI;
        let off = ((Vec3::from_array(*found) - radiance) / radiance).abs().max_element();
        assert!(off < 0.01, "pixel {pixel}: {found:?} for {radiance}");
    }
    println!("{seen} pixels of the decal");
    assert!(seen > 1000, "{seen} pixels of the decal");
    let words = both(&common, &[("decals", "decal")]);
    let error = watched.try_renderer(NAME, &words, &[], quincunx::gpu::commands::Submits::One).err().unwrap();
    assert!(error.exit_code() == 2 && error.to_string().contains("--packing words"), "{error}");
}
