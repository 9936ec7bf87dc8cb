//! The component `ao`: a closed form, and paths.

use super::NAME;
use super::airlight::shelf;
use crate::support::boxes::{camera, rectangle};
use crate::support::difference::rmse;
use crate::support::watched::{Watched, both};
use glam::{Vec3, vec3};
use quincunx::scene::{Material, Scene};

/// Before a wall without end a floor sees half of the sky, and wholly open it sees all.
#[test]
fn a_wall_without_end_takes_half_of_the_sky() {
    for (has_wall, openness) in [(true, 0.5), (false, 1.0)] {
        let mut scene = Scene { name: "wall".to_owned(), hash: format!("wall {has_wall}"), ..Scene::default() };
        let grey = Material::diffuse("floor", vec3(0.5, 0.25, 0.75));
        rectangle(&mut scene, Vec3::ZERO, 900.0 * Vec3::X, -900.0 * Vec3::Z, grey.clone());
        if has_wall {
            rectangle(&mut scene, vec3(0.0, 900.0, -4.0), 900.0 * Vec3::X, 900.0 * Vec3::Y, grey);
        }
        scene.cameras.push(camera(vec3(0.0, 3.0, 1.0), Vec3::ZERO, 0.3));
        let watched = Watched::with_scene(scene);
        let own = [("components", "ao"), ("ambient", "0.2"), ("rig", "none"), ("tile", "8x8"), ("ao-max", "64")];
        let changes = both(&own, &[("size", "32x32"), ("mode", "max"), ("position", "float")]);
        let picture = watched.picture(NAME, &changes);
        let sum: Vec3 = picture.pixels.iter().map(|pixel| Vec3::from_array(*pixel)).sum();
        let found = sum / picture.pixels.len() as f32;
        let expected = vec3(0.5, 0.25, 0.75) * 0.2 * openness;
        assert!((found / expected - 1.0).abs().max_element() < 0.01, "{has_wall}: {found} for {expected}");
    }
}

/// Ambient light that the shelf stops, alone and beside what the lights give, in the air and in a medium.
#[test]
fn occlusion_is_that_of_paths() {
    let watched = Watched::with_scene(shelf());
    for (components, direct, medium) in [("ao", "off", "none"), ("ao,ss", "on", "none"), ("ss,ao", "on", "0.1,0.1,0")] {
        let shared = [("size", "64x48"), ("emissive", "on"), ("ambient", "0.3"), ("medium", medium)];
        let paths = [("brdf", "lambert"), ("ambient-visibility", "seen"), ("spp", "512"), ("transport", "direct")];
        let reference = watched.picture("path_traced", &both(&both(&shared, &paths), &[("direct-light", direct)]));
        let own = [("components", components), ("mode", "max"), ("tile", "1x1"), ("ao-max", "64")];
        let picture = watched.picture(NAME, &both(&shared, &own));
        let mean = |pixels: &[[f32; 3]]| pixels.as_flattened().iter().sum::<f32>() / pixels.len() as f32;
        let (found, expected) = (mean(&picture.pixels), mean(&reference.pixels));
        let error = rmse(&picture, &reference) / f64::from(expected);
        println!("{components} {medium}: {found} for {expected}, {error}");
        // All pixels have the same 64 directions.
        assert!((found / expected - 1.0).abs() < 0.01, "{components} {medium}: {found} for {expected}");
        assert!(error < 0.03, "{components} {medium}: {error}");
    }
}

/// A tile of the open floor needs no more than it has, one under the shelf does.
#[test]
fn tiles_that_see_part_of_the_sky_are_refined() {
    let mut scene = Scene { name: "open".to_owned(), hash: "open".to_owned(), ..Scene::default() };
    let grey = Material::diffuse("floor", Vec3::splat(0.5));
    rectangle(&mut scene, Vec3::ZERO, 9.0 * Vec3::X, -9.0 * Vec3::Z, grey.clone());
    rectangle(&mut scene, vec3(0.3, 0.5, -1.0), 1.1 * Vec3::X, -0.7 * Vec3::Z, grey);
    scene.cameras.push(camera(vec3(0.0, 2.0, 5.0), vec3(0.0, 0.0, -1.0), 0.6));
    let watched = Watched::with_scene(scene);
    let own = [("components", "ao"), ("ambient", "0.3"), ("rig", "none"), ("size", "64x48")];
    let renderer = watched.render_stages(NAME, &own, &["guidance.ao.iterations"]);
    let iterations = watched.integers(&renderer, "guidance.ao.iterations");
    let refined = iterations.iter().filter(|count| **count > 1).count() as f64 / iterations.len() as f64;
    assert!((0.1..0.8).contains(&refined), "{refined}");
}
