//! Inferred lighting (Kircher 2009): where it must equal plain deferred shading, what its roads must share, what its filter
//! keeps apart.

mod support;

use glam::{Vec3, vec3};
use quincunx::report::picture::Picture;
use quincunx::scene::{self, AlphaMode, Light, Material, Projection, Scene};
use support::boxes::{camera, point_light, rectangle};
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
