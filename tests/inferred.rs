//! Inferred lighting (Kircher 2009): where it must equal plain deferred shading, and what its roads must share.

mod support;

use glam::vec3;
use quincunx::report::picture::Picture;
use quincunx::scene::{self, AlphaMode, Light, Projection, Scene};
use support::boxes::{edge, point_light};
use support::difference::greatest_part;
use support::watched::{Changes, Watched, both};

const NAME: &str = "inferred_lighting";

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
