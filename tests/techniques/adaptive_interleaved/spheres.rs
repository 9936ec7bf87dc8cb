//! Punctual lights with a radius: closed forms, and paths.

use super::airlight::{mean, shelf};
use super::{EXTENT, NAME, shown};
use crate::support::boxes::{camera, point_light, rectangle};
use crate::support::difference::rmse;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, vec3};
use quincunx::bvh::Bvh;
use quincunx::scene::{Light, LightKind, Material, Scene};
use std::f32::consts::PI;

const HEIGHT: f32 = 3.0;

/// A light over a floor and, at a third of its height, half a plane that ends below it.
fn edge() -> Scene {
    let mut scene = Scene { name: "edge".to_owned(), hash: "edge of a sphere".to_owned(), ..Scene::default() };
    let grey = Material::diffuse("floor", Vec3::splat(0.5));
    rectangle(&mut scene, Vec3::ZERO, 9.0 * Vec3::X, -9.0 * Vec3::Z, grey.clone());
    rectangle(&mut scene, vec3(-4.0, HEIGHT / 3.0, 0.0), 4.0 * Vec3::X, -9.0 * Vec3::Z, grey);
    scene.lights.push(point_light(vec3(0.0, HEIGHT, 0.0), 40.0));
    scene.cameras.push(camera(vec3(1.2, 0.7, 0.0), Vec3::ZERO, 0.5));
    scene
}

/// The part of a disc on the far side of a line at this part of its radius from its middle.
fn part_of_disc(at: f32) -> f32 {
    let at = at.clamp(-1.0, 1.0);
    (at.acos() - at * (1.0 - at * at).sqrt()) / PI
}

/// Straight below the light, at `x` beside the edge of the shadow, the edge is seen at -2x of the light's place.
#[test]
fn the_penumbra_of_a_sphere_is_as_wide_as_it_is_seen() {
    let watched = Watched::with_scene(edge());
    let bvh = Bvh::build(&watched.session.scene).unwrap();
    let shown = shown(&watched, &bvh);
    let radius = 0.3f32;
    let text = radius.to_string();
    let shared = [("size", "97x53"), ("light-radius", &*text), ("light-cutoff", "0")];
    let own = [("components", "ss"), ("mode", "max"), ("tile", "1x1"), ("ss-max", "64"), ("position", "float")];
    let renderer = watched.render_stages(NAME, &both(&shared, &own), &["irradiance.ss"]);
    let own = watched.rgb(&renderer, "irradiance.ss");
    let paths = [("transport", "direct"), ("brdf", "lambert"), ("spp", "64")];
    let traced = watched.picture("path_traced", &both(&shared, &paths)).pixels;
    // Radiance of a diffuse surface of albedo 0.5 is its irradiance over 2 pi.
    let traced: Vec<[f32; 3]> = traced.into_iter().map(|pixel| pixel.map(|channel| channel * 2.0 * PI)).collect();
    for (name, irradiance, bound) in [(NAME, own, 0.03), ("path_traced", traced, 0.06)] {
        let (mut sum, mut count, mut dim_count) = (0.0, 0, 0);
        for shown in shown.iter().filter(|shown| shown.normal.y > 0.9 && shown.position.z.abs() < 0.3) {
            let Vec3 { x, y, z } = shown.position;
            if y > 1e-3 || x.abs() > 0.35 {
                continue;
            }
            let squared = (HEIGHT * HEIGHT + x * x + z * z).powf(1.5);
            let open = 40.0 * HEIGHT / squared;
            let expected = part_of_disc(-2.0 * x / radius);
            let [pixel_x, pixel_y] = shown.pixel;
            let found = irradiance[(pixel_y * EXTENT.width + pixel_x) as usize][0] / open;
            sum += (found - expected).powi(2);
            count += 1;
            dim_count += u32::from((0.05..0.95).contains(&expected));
        }
        let error = (sum / count as f32).sqrt();
        println!("{name}: {error} over {count}, {dim_count} in the penumbra");
        assert!(count > 500 && dim_count > 200, "{count}, {dim_count}");
        assert!(error < bound, "{name}: {error}");
    }
}

/// Surfaces, light that they hand on, and a medium, under a sphere and under a spot of the same size; and points are another
/// light.
#[test]
fn light_of_spheres_is_that_of_paths() {
    let spot = LightKind::Spot { inner_angle: 0.3, outer_angle: 0.9 };
    let medium = ("medium", "0.1,0,0.4");
    for (kind, bounds) in [(LightKind::Point, [0.03, 0.16, 0.06]), (spot, [0.09, 0.3, 0.2])] {
        let mut scene = shelf();
        scene.hash = format!("spheres {kind:?}");
        // Close above the shelf, so that much is in its penumbra.
        scene.lights = vec![Light { kind, ..point_light(vec3(0.3, 2.6, -1.0), 30.0) }];
        let watched = Watched::with_scene(scene);
        let cases: [(&str, Changes<'_>, Changes<'_>); 3] = [
            ("ss", &[("transport", "direct")], &[("ss-max", "64")]),
            (
                "id",
                &[("transport", "one-bounce"), ("direct-light", "off")],
                &[("vpls", "1024"), ("vpl-clamp", "0.2%"), ("id-scale", "1"), ("id-max", "1")],
            ),
            (
                "pm",
                &[("transport", "direct"), ("airlight", "seen"), ("direct-light", "off"), medium],
                &[("pm-max", "64"), ("pm-steps", "64"), medium],
            ),
        ];
        for ((components, transport, own), bound) in cases.into_iter().zip(bounds) {
            let shared = [("size", "64x48"), ("emissive", "off")];
            let paths = [("brdf", "lambert"), ("ambient-visibility", "off"), ("spp", "256"), ("light-radius", "0.4")];
            let reference = watched.picture("path_traced", &both(&both(&shared, &paths), transport));
            let expected = mean(&reference);
            let compared = |radius: &str| {
                let all = [("components", components), ("mode", "max"), ("tile", "1x1"), ("light-radius", radius)];
                let picture = watched.picture(NAME, &both(&both(&shared, &all), own));
                (mean(&picture) / expected - 1.0, rmse(&picture, &reference) / f64::from(expected))
            };
            let ((off, error), (_, of_points)) = (compared("0.4"), compared("0"));
            println!("{kind:?} {components}: mean off by {off}, rmse {error}, of points {of_points}");
            assert!(off.abs() < 0.03, "{kind:?} {components}: the mean is off by {off}");
            assert!(error < bound, "{kind:?} {components}: {error}");
            // Where the walk's start lies on a small light matters little to what surfaces hand on.
            assert!(components == "id" || error < 0.5 * of_points, "{kind:?} {components}: {error}, {of_points}");
        }
    }
}
