//! A guard band as wide as blur brings things in.

use super::DEEP;
use crate::support::boxes::{camera, panel, rectangle};
use crate::support::moving::moving;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, vec3};
use quincunx::scene::Scene;

const SIZE: (&str, &str) = ("size", "160x90");
const AUTO: (&str, &str) = ("guard-band", "auto");

/// Vertical angle of the camera, radians.
pub const Y_FOV: f32 = 0.9;

/// A wall in all of the picture, `aside` metres to the right.
pub fn wall(aside: f32) -> Scene {
    let name = format!("wall {aside}");
    let mut scene = Scene { name: name.clone(), hash: name, ..Scene::default() };
    rectangle(&mut scene, vec3(aside, 0.0, -4.0), 40.0 * Vec3::X, 40.0 * Vec3::Y, panel(Vec3::splat(0.25)));
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, Y_FOV));
    scene
}

fn width(watched: &Watched, changes: Changes<'_>) -> u32 {
    let common = [SIZE, ("spp", "1"), ("tuples", "4"), AUTO];
    watched.render(DEEP, &both(&common, changes)).resolved["guard-band"].parse().unwrap()
}

/// The circle of confusion of a wall, half of the way that it moves, both, and no more than 64 of 1280 pixels; and a pixel.
#[test]
fn it_is_as_wide_as_what_the_rim_sees_lies_out() {
    let px_of_m = 45.0 / (0.5 * Y_FOV).tan() / 4.0;
    let expected = |m: f32, scale: f32| (m * px_of_m * scale).ceil() as u32 + 1;
    let still = Watched::with_scene(wall(0.0));
    assert_eq!(width(&still, &[]), 1);
    // A wall twice as far as the plane in focus is spread as wide as the lens is; one at a quarter of that plane by 3/4.
    for (aperture, focus, m) in [("0.3", "2", 0.15), ("0.3", "16", 0.1125), ("0.3", "4", 0.0)] {
        assert_eq!(width(&still, &[("aperture", aperture), ("focus", focus)]), expected(m, 1.0), "{aperture} {focus}");
    }
    assert_eq!(width(&still, &[("aperture", "3"), ("focus", "2")]), 9);
    let moved = Watched::with_scene(wall(0.0).closing_as(wall(0.4)).unwrap());
    assert_eq!(width(&moved, &[]), expected(0.2, 1.0));
    assert_eq!(width(&moved, &[("shading-scale", "0.5")]), expected(0.2, 0.5));
    assert_eq!(width(&moved, &[("aperture", "0.15"), ("focus", "2")]), expected(0.275, 1.0));
    assert_eq!(width(&moved, &[("shading", "indirect-gbuffer")]), expected(0.2, 1.0));
}

/// Few samples lie outside of shading space, where many do without a guard band.
#[test]
fn samples_at_the_rim_have_a_place() {
    let common = [SIZE, ("spp", "8")];
    for (scene, changes) in [
        (Watched::open("chess:triangles=12000"), &[("aperture", "0.03"), ("focus", "3")][..]),
        (Watched::open("hall:triangles=8000"), &[("aperture", "0.2"), ("focus", "9")]),
        (Watched::with_scene(moving("arena:triangles=60000", [10.0, 10.02])), &[("camera", "flight")]),
    ] {
        let outside = |band| {
            let renderer = scene.render(DEEP, &both(&both(&common, changes), &[("guard-band", band)]));
            let width: u32 = renderer.resolved["guard-band"].parse().unwrap();
            (renderer.measured_counters().unwrap()["samples_outside_shading_space"], width)
        };
        let ((none, _), (auto, width)) = (outside("0"), outside("auto"));
        println!("{none} samples are outside without a band, {auto} with {width} pixels");
        assert!(none > 100.0 && auto < 0.02 * none && width < 9, "{none}, {auto} with {width}");
    }
}
