//! Inferred lighting (Kircher 2009): where it must equal plain deferred shading, and what its methods must share.

mod filter;
mod geometry;
mod glass;
mod highlight;
mod shadow_volumes;

use crate::support::boxes::{edge, point_light};
use crate::support::choices::{ways, words_but};
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use crate::support::{self, Feature};
use glam::{Vec3, vec3};
use quincunx::picture::{AovChannels, Picture};
use quincunx::scene::{self, AlphaMode, Light, LightKind, Projection, Scene};
use quincunx::units::Extent;

const NAME: &str = "inferred_lighting";

/// Where the surface of each pixel is, world space, by its `depths_m`: linear, row-major.
fn places(scene: &Scene, extent: Extent, depths_m: &[f32]) -> Vec<Vec3> {
    let camera = &scene.cameras[0];
    let Projection::Perspective { y_fov, .. } = camera.projection else { panic!("an eye") };
    let half = [extent.width, extent.height].map(|side| side as f32 * 0.5);
    let tangent = (0.5 * y_fov).tan() / half[1];
    let of_pixel = |(pixel, depth): (usize, &f32)| {
        let [x, y] = [pixel as u32 % extent.width, pixel as u32 / extent.width].map(|at| at as f32 + 0.5);
        let along = vec3((x - half[0]) * tangent, (half[1] - y) * tangent, -1.0);
        camera.world_from_view.transform_point3(along * *depth)
    };
    depths_m.iter().enumerate().map(of_pixel).collect()
}

/// Light that falls on each pixel's place from everywhere, were every light straight above it: what a cosine that is off by one
/// would be off by. Brightest channel; `depths_m`: linear.
fn light_from_above(scene: &Scene, extent: Extent, depths_m: &[f32]) -> Vec<f32> {
    let of_place = |place: Vec3| {
        let from = |light: &Light| match light.kind {
            LightKind::Directional => light.intensity.max_element(),
            _ => light.intensity.max_element() / light.position.distance_squared(place).max(1e-4),
        };
        scene.lights.iter().map(from).sum()
    };
    places(scene, extent, depths_m).into_iter().map(of_place).collect()
}

/// Without surfaces that either buffer cannot hold exactly: the G-buffer has 8 bits for what is metal, of which a step at 95 % is
/// 8 % of the rest, and the light pass 5 a channel of a metal's F0; both have 8 for roughness, of which a step at 0.1 is 4 % of a
/// highlight.
fn held_exactly(spec: &str) -> Scene {
    let mut scene = scene::load(spec, 1).unwrap();
    let Scene { draws, meshes, materials, .. } = &mut scene;
    draws.retain(|draw| materials[meshes[draw.mesh].material].alpha != AlphaMode::Blend);
    for material in materials {
        material.metallic = 0.0;
        material.metallic_roughness_texture = None;
        material.roughness = (material.roughness.max(0.4) * 255.0).round() / 255.0;
    }
    scene
}

/// A light buffer of the frame's size is deferred shading with rounded normals and rounded light. Three channels with a common
/// exponent are off by at most 2^-9 of the brightest, or a half float by 2^-11 of itself where a driver cuts it off, and so is
/// the G-buffer's color; floats of another order are off by less. A normal's two 16-bit numbers are off by
/// at most 2^-16 each, and twice that after the map back from the hemisphere, which with the G-buffer's own three is 8e-5: of the
/// light that would fall on the surface from straight above, over pi, because no albedo is above 1. A highlight
/// has a common exponent of its own, and half of the cosine's part more.
#[test]
fn at_the_frame_s_size_it_is_deferred_shading() {
    for (spec, brdf) in ["hall:triangles=8000", "lamps:objects=30,lights=30", "cornell"]
        .into_iter()
        .flat_map(|spec| ["lambert", "blinn-phong", "ggx"].map(|brdf| (spec, brdf)))
    {
        let watched = Watched::with_scene(held_exactly(spec));
        let [relative, lobe] = if brdf == "lambert" { [1.5e-3, 0.0] } else { [4e-3, 0.5] };
        for extent in [Extent::new(160, 90), Extent::new(161, 91)] {
            let size = extent.to_string();
            let common = [("size", &size[..]), ("brdf", brdf), ("direct-shadow", "none"), ("rig", "none")];
            let changes = both(&common, &[("light-size", &size)]);
            let renderer = watched.render_stages(NAME, &changes, &["geometry.dsf.depth"]);
            let (inferred, depth) = (renderer.picture().unwrap(), renderer.aov("geometry.dsf.depth").unwrap());
            let AovChannels::Y(depths_m) = depth.channels else { panic!("one channel") };
            let deferred = watched.picture("deferred", &both(&common, &[("position", "depth")]));
            let above = light_from_above(&watched.session.scene, extent, &depths_m);
            let mut most = 0f32;
            for (pixel, (a, b)) in inferred.pixels.iter().zip(&deferred.pixels).enumerate() {
                let brightest = b.iter().copied().fold(0f32, f32::max);
                for (a, b) in a.iter().zip(b) {
                    let of_all = if brdf == "lambert" { *b } else { brightest };
                    let bound = relative * of_all + 8e-5 * above[pixel] * (1.0 / std::f32::consts::PI + lobe) + 1e-6;
                    most = most.max((a - b).abs() / bound);
                    let what = format!("{spec}, {brdf} at {size}, pixel {pixel}");
                    assert!((a - b).abs() <= bound, "{what}: {a} for {b}, bound {bound}");
                }
            }
            println!("{spec}, {brdf} at {size}: {most} of the bound at most");
        }
    }
}

#[test]
fn every_method_of_the_lights_leaves_the_same_l_buffer() {
    let mut ways = ways(NAME, &["volumes", "cull-by"]);
    ways.extend([
        vec![("volumes", "tiled"), ("texels", "1"), ("workgroup", "8x8")],
        vec![("volumes", "auto")],
        vec![("volumes", "auto"), ("stencil-least", "50")],
    ]);
    for (spec, more) in [
        ("lamps:objects=30,lights=30", &[("brdf", "lambert")][..]),
        ("lamps:objects=30,lights=30", &[("ambient", "0.1,0.2,0.3"), ("brdf", "blinn-phong"), ("extras", "off")]),
        ("hall:triangles=8000", &[("direct-shadow", "ray")]),
        ("cornell", &[("lights", "20"), ("light-cutoff", "0.5")]),
    ] {
        let watched = Watched::open(spec);
        for size in [("160x90", "100x56"), ("97x53", "40x91")] {
            let common = both(&[("size", size.0), ("light-size", size.1)], more);
            let of = |method: Changes<'_>| {
                let names = ["light.l_buffer.irradiance", "light.l_buffer.highlight"];
                let renderer = watched.render_stages(NAME, &both(&common, method), &names);
                (names.map(|name| renderer.aov(name).unwrap().channels), renderer.picture().unwrap())
            };
            let first = of(&ways[0]);
            for way in &ways[1..] {
                let found = of(way);
                assert!(found.0 == first.0, "{spec}, {size:?}, {way:?}: another L-buffer");
                assert!(found.1.pixels == first.1.pixels, "{spec}, {size:?}, {way:?}: another picture");
            }
        }
    }
}

/// Lights with the eye inside of their volume, with volumes that cross the near plane and that reach beyond a far plane just
/// behind the scene, and one behind the eye.
fn lights_around_the_eye() -> Scene {
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
    scene
}

/// The stencil leaves out what adds nothing, and nothing else.
#[test]
fn volumes_are_right_around_the_eye_and_beyond_the_far_plane() {
    let watched = Watched::with_scene(lights_around_the_eye());
    let changes = [("size", "160x120"), ("brdf", "blinn-phong"), ("light-cutoff", "0")];
    let first = watched.picture(NAME, &both(&changes, &[("volumes", "tiled")]));
    for volumes in words_but(NAME, "volumes", &["tiled"]).into_iter().chain(["auto"]) {
        let found = watched.picture(NAME, &both(&changes, &[("volumes", volumes)]));
        require_same(&watched.session.gpu, &found, &first, &volumes);
    }
}

/// A light is evaluated at the texels of its rectangle, or at those whose surface lies in the icosahedron around its sphere,
/// which lies between that sphere and one of 1.26 times the radius. A light without an end is evaluated everywhere.
#[test]
fn the_stencil_leaves_of_a_light_what_its_volume_holds() {
    /// Corners' distance over faces'.
    const OUTER: f32 = 1.902_113 / 1.511_522_6;
    let watched = Watched::with_scene(lights_around_the_eye());
    if !support::has(&watched.session.gpu.caps, Feature::PreciseOcclusion) {
        return;
    }
    let extent = Extent::new(160, 120);
    let changes = [("size", "160x120"), ("light-size", "160x120"), ("light-cutoff", "0")];
    let evaluated = |volumes: &str| {
        let renderer = watched.render_stages(NAME, &both(&changes, &[("volumes", volumes)]), &["geometry.dsf.depth"]);
        let AovChannels::Y(depths_m) = renderer.aov("geometry.dsf.depth").unwrap().channels else { panic!() };
        (renderer.measured_counters().unwrap()["light_evaluations"], depths_m)
    };
    let scene = &watched.session.scene;
    let (everywhere, depths_m) = evaluated("quad");
    let shown = scene.lights.len() - 1;
    assert_eq!(everywhere, (shown as u64 * extent.pixel_count()) as f64, "but for the light behind the eye");
    let places = places(scene, extent, &depths_m);
    let within = |part: f32| -> usize {
        let of_light = |light: &Light| match light.range {
            Some(range) => places.iter().filter(|place| place.distance(light.position) < part * range).count(),
            None => places.len(),
        };
        scene.lights.iter().map(of_light).sum()
    };
    let (least, most) = (within(0.999) as f64, within(1.002 * OUTER) as f64);
    let (by_rectangles, _) = evaluated("scissor");
    for volumes in ["stencil", "both"] {
        let (found, _) = evaluated(volumes);
        println!("{volumes}: {found} of {everywhere}, rectangles {by_rectangles}, spheres {least} to {most}");
        assert!(least <= found && found <= most, "{volumes}: {found}, but {least} to {most} lie in the spheres");
        assert!(found < by_rectangles, "{volumes}: {found} of {by_rectangles}");
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
