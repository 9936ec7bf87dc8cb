//! Light in closed form: a plane under a point, a spot and a directional light, and the sum over virtual point lights.
//!
//! The plane, its camera and its lights are turned by one rotation, so that nothing lies along an axis; the formulas are
//! written in the plane's own space, where it is y = 0.

use crate::support;
use crate::support::Feature;
use crate::support::seen::point_at;
use crate::support::watched::{Changes, Watched, both};
use glam::{DVec3, Mat4, Quat, Vec3, dvec3, vec3};
use quincunx::bvh::Bvh;
use quincunx::lights::vpl;
use quincunx::sampling::pattern::Pattern;
use quincunx::scene::{Camera, Draw, Light, LightKind, Material, Mesh, Projection, Scene};
use quincunx::session::Renderer;
use quincunx::shading::light::vpl_irradiance;
use quincunx::techniques::interleaved_deferred::mapping::mapping;
use quincunx::techniques::interleaved_deferred::subsets::subsets;
use quincunx::units::Extent;
use std::f64::consts::PI;

/// Normals of 16 bits are off by up to 1.5e-5 a component, which at an incidence of 85 degrees is 2e-4 of the cosine;
/// albedo in half floats is off by 2.4e-4, positions in float by next to nothing. Their sum, doubled.
const RELATIVE_BOUND: f64 = 1e-3;
const ALBEDO: DVec3 = dvec3(0.5, 0.25, 0.8);
/// Odd: no SIMD width divides it.
const SIZE: &str = "61x37";

/// Where the plane's space stands in the world.
fn world_from_plane() -> Mat4 {
    let turn = Quat::from_axis_angle(vec3(1.0, 2.0, -0.5).normalize(), 0.7);
    Mat4::from_rotation_translation(turn, vec3(3.0, -1.0, 2.0))
}

/// A square in y = `y`, facing up.
fn square(y: f32, half: f32) -> Mesh {
    Mesh {
        positions: [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]
            .map(|(x, z)| vec3(x * half, y, z * half))
            .to_vec(),
        normals: vec![Vec3::Y; 4],
        tangents: vec![glam::Vec4::ZERO; 4],
        uvs: vec![glam::Vec2::ZERO; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    }
}

/// The plane, seen so that it fills the picture, under lights given in its own space.
fn plane(lights: &[Light]) -> Scene {
    let place = world_from_plane();
    let to_world = |light: &Light| Light {
        position: place.transform_point3(light.position),
        direction: place.transform_vector3(light.direction),
        ..light.clone()
    };
    let eye = vec3(1.0, 6.0, 5.0);
    let back = (eye - vec3(0.3, 0.0, -0.4)).normalize();
    let right = Vec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let view = Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), eye.extend(1.0));
    Scene {
        name: "plane".to_owned(),
        meshes: vec![square(0.0, 30.0)],
        draws: vec![Draw { mesh: 0, world_from_object: place }],
        materials: vec![Material::diffuse("grey", ALBEDO.as_vec3())],
        lights: lights.iter().map(to_world).collect(),
        cameras: vec![Camera {
            name: "above".to_owned(),
            world_from_view: place * view,
            projection: Projection::Perspective { y_fov: 0.9, aspect: None, z_near: 0.1, z_far: None },
        }],
        ..Scene::default()
    }
}

fn light(kind: LightKind, position: Vec3, direction: Vec3) -> Light {
    let (name, intensity) = (String::new(), vec3(120.0, 60.0, 30.0));
    Light { name, kind, intensity, position, direction: direction.normalize(), range: None, radius: 0.0 }
}

/// Whether a pixel's point is the one that its ray meets, as formulas need it; where not, the test is skipped.
fn points_are_exact() -> bool {
    support::has(&support::driver(), Feature::ExactPositions)
}

/// The plane's point at each pixel's middle, in the plane's space.
fn points(renderer: &Renderer) -> Vec<DVec3> {
    let plane_from_world = world_from_plane().as_dmat4().inverse();
    let Extent { width, height } = renderer.view.extent;
    let eye = plane_from_world.transform_point3(renderer.view.eye().as_dvec3());
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| {
            let seen = point_at(&renderer.view, [f64::from(x) + 0.5, f64::from(y) + 0.5]);
            let ray = plane_from_world.transform_point3(seen) - eye;
            let point = eye - ray * (eye.y / ray.y);
            assert!(ray.y < 0.0 && point.abs().max_element() < 30.0, "the plane fills the picture");
            point
        })
        .collect()
}

/// Irradiance of the plane at `point`: without the window of its range and the edge of its cone, and with them.
fn irradiance(light: &Light, cutoff_lux: f64, point: DVec3) -> (DVec3, DVec3) {
    let intensity = light.intensity.as_dvec3();
    let direction = light.direction.as_dvec3();
    if light.kind == LightKind::Directional {
        let received = intensity * (-direction.y).max(0.0);
        return (received, received);
    }
    let to_light = light.position.as_dvec3() - point;
    let distance = to_light.length();
    let bare = intensity * (to_light.y / distance).max(0.0) / (distance * distance);
    let range = match light.range {
        Some(range) => f64::from(range),
        None if cutoff_lux > 0.0 => (intensity.max_element() / cutoff_lux).sqrt(),
        None => f64::INFINITY,
    };
    let mut factor = (1.0 - (distance / range).powi(4)).clamp(0.0, 1.0);
    if let LightKind::Spot { inner_angle, outer_angle } = light.kind {
        let (inner, outer) = (f64::from(inner_angle).cos(), f64::from(outer_angle).cos());
        let cone = ((direction.dot(-to_light / distance) - outer) / (inner - outer)).clamp(0.0, 1.0);
        factor *= cone * cone;
    }
    (bare, bare * factor)
}

/// How much more than on software drivers light may be off, as a part of itself. GPUs interpolate between corners that they
/// have moved to the nearest 256th of a pixel, which a lamp's surroundings show, and some cut off what does not fit into a half
/// float: an H200 is 0.0015 off next to a lamp.
fn allowance(watched: &Watched) -> f64 {
    if watched.session.gpu.caps.identity.is_software() { 0.0 } else { 0.01 }
}

/// Renders the plane and holds every pixel against the formula. Returns how many pixels are lit and how many are not.
fn require_formula(lights: &[Light], cutoff_lux: &str) -> [usize; 2] {
    let watched = Watched::with_scene(plane(lights));
    let changes = [("size", SIZE), ("brdf", "lambert"), ("position", "float"), ("light-cutoff", cutoff_lux)];
    let renderer = watched.render("deferred", &changes);
    let picture = renderer.picture().unwrap();
    let mut counts = [0, 0];
    for (pixel, point) in picture.pixels.iter().zip(points(&renderer)) {
        let each = lights.iter().map(|light| irradiance(light, cutoff_lux.parse().unwrap(), point));
        let (bare, received) =
            each.fold((DVec3::ZERO, DVec3::ZERO), |(b, r), (bare, received)| (b + bare, r + received));
        let found = Vec3::from_array(*pixel).as_dvec3();
        let (bare, expected) = (ALBEDO / PI * bare, ALBEDO / PI * received);
        // Where a window or a cone ends it falls to 0, and no relative bound holds: the bound is of the light without.
        let bound = RELATIVE_BOUND + allowance(&watched);
        assert!((found - expected).abs().cmple(bare * bound).all(), "{point}: {found} for {expected}");
        // A thousandth of its way from its end a light is 0 or not by rounding; beyond, it is 0 exactly.
        if expected == DVec3::ZERO {
            counts[1] += 1;
            assert!(found == DVec3::ZERO || received_nearby(lights, cutoff_lux, point), "{point}: {found}, not 0");
        } else {
            counts[0] += 1;
        }
    }
    counts
}

fn received_nearby(lights: &[Light], cutoff_lux: &str, point: DVec3) -> bool {
    let steps = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z].map(|step| point + 1e-4 * step);
    let lit = |point| lights.iter().any(|light| irradiance(light, cutoff_lux.parse().unwrap(), point).1 != DVec3::ZERO);
    steps.into_iter().any(lit)
}

#[test]
fn a_point_light_falls_off_by_the_square_of_its_distance() {
    if !points_are_exact() {
        return;
    }
    let [lit, dark] = require_formula(&[light(LightKind::Point, vec3(0.5, 2.0, -0.5), Vec3::NEG_Y)], "0");
    assert!(lit > 0 && dark == 0);
    // Close to the plane, where it is brightest and most slanted.
    require_formula(&[light(LightKind::Point, vec3(0.2, 0.4, -0.3), Vec3::NEG_Y)], "0");
    // Below the plane it gives nothing.
    assert_eq!(require_formula(&[light(LightKind::Point, vec3(0.5, -2.0, -0.5), Vec3::NEG_Y)], "0")[0], 0);
}

#[test]
fn a_range_ends_a_light_and_beyond_it_all_is_exactly_0() {
    if !points_are_exact() {
        return;
    }
    let ranged = Light { range: Some(3.0), ..light(LightKind::Point, vec3(0.5, 2.0, -0.5), Vec3::NEG_Y) };
    let [lit, dark] = require_formula(&[ranged], "0");
    assert!(lit > 100 && dark > 100, "{lit} lit, {dark} dark");
    // Without a range of its own the cut-off gives one: 120 candela end at 7.5 lux after 4 m.
    let [lit, dark] = require_formula(&[light(LightKind::Point, vec3(0.5, 2.0, -0.5), Vec3::NEG_Y)], "7.5");
    assert!(lit > 100 && dark > 100, "{lit} lit, {dark} dark");
}

#[test]
fn a_spot_lights_its_cone() {
    if !points_are_exact() {
        return;
    }
    let kind = LightKind::Spot { inner_angle: 0.3, outer_angle: 0.6 };
    let [lit, dark] = require_formula(&[light(kind, vec3(0.5, 4.0, -0.5), vec3(0.2, -1.0, 0.1))], "0");
    assert!(lit > 100 && dark > 100, "{lit} lit, {dark} dark");
    let hard = LightKind::Spot { inner_angle: 0.0, outer_angle: std::f32::consts::FRAC_PI_2 };
    require_formula(&[light(hard, vec3(0.5, 2.0, -0.5), vec3(0.0, -1.0, 0.0))], "0");
}

#[test]
fn a_sun_gives_its_lux_times_the_cosine() {
    for direction in [vec3(0.0, -1.0, 0.0), vec3(1.0, -1.0, 0.5), vec3(2.0, -0.3, 1.0)] {
        let [lit, dark] = require_formula(&[light(LightKind::Directional, Vec3::ZERO, direction)], "0.002");
        assert!(lit > 0 && dark == 0);
    }
    let from_below = light(LightKind::Directional, Vec3::ZERO, Vec3::Y);
    assert_eq!(require_formula(&[from_below], "0.002")[0], 0);
}

#[test]
fn lights_add_up() {
    if !points_are_exact() {
        return;
    }
    let lights = [
        light(LightKind::Point, vec3(0.5, 2.0, -0.5), Vec3::NEG_Y),
        light(LightKind::Spot { inner_angle: 0.3, outer_angle: 0.6 }, vec3(-1.0, 4.0, 0.0), Vec3::NEG_Y),
        light(LightKind::Directional, Vec3::ZERO, vec3(1.0, -1.0, 0.5)),
    ];
    require_formula(&lights, "0");
}

/// Lights joined to the subsets of a pattern of one pixel are the same light: the plane's own virtual lights lie in it
/// and give it nothing.
#[test]
fn joined_lights_give_the_same_irradiance() {
    if !points_are_exact() {
        return;
    }
    let lights = [
        light(LightKind::Point, vec3(0.5, 2.0, -0.5), Vec3::NEG_Y),
        light(LightKind::Directional, Vec3::ZERO, vec3(1.0, -1.0, 0.5)),
    ];
    let watched = Watched::with_scene(plane(&lights));
    let changes = [
        ("size", SIZE),
        ("position", "float"),
        ("light-cutoff", "0"),
        ("direct", "interleaved"),
        ("pattern", "1x1"),
        ("vpls", "16"),
    ];
    let stages = ["gbuffer.normal", "shade.irradiance", "gather.irradiance"];
    let renderer = watched.render_stages("interleaved_deferred", &changes, &stages);
    for (found, point) in watched.rgb(&renderer, "gather.irradiance").iter().zip(points(&renderer)) {
        let expected: DVec3 = lights.iter().map(|light| irradiance(light, 0.0, point).1).sum();
        let found = Vec3::from_array(*found).as_dvec3();
        // Half floats: another 2^-11.
        assert!(
            (found - expected).abs().cmple(expected * (RELATIVE_BOUND + 2f64.powi(-11))).all(),
            "{found} {expected}"
        );
    }
}

/// Punctual lights under a ceiling that virtual ones shine down from: whatever the pattern of either, the mean over each
/// whole pattern is what `--split none` has there, all of them.
#[test]
fn the_mean_over_a_pattern_is_every_light() {
    let lights: Vec<Light> =
        (0..7).map(|i| light(LightKind::Point, vec3(i as f32 - 3.0, 2.0 + 0.5 * i as f32, 1.0), Vec3::NEG_Y)).collect();
    let mut scene = plane(&lights);
    scene.meshes.push(Mesh { normals: vec![Vec3::NEG_Y; 4], indices: vec![0, 2, 1, 0, 3, 2], ..square(9.0, 30.0) });
    scene.draws.push(Draw { mesh: 1, world_from_object: world_from_plane() });
    // The whole picture shows some 15 by 8 mm, so a pattern shows some 2 mm.
    scene.cameras[0].projection = Projection::Perspective { y_fov: 1e-3, aspect: None, z_near: 0.1, z_far: None };
    let watched = Watched::with_scene(scene);
    let shaded = |changes: Changes<'_>| {
        let common =
            [("size", "64x36"), ("position", "float"), ("light-cutoff", "0"), ("vpls", "96"), ("split", "branch")];
        let renderer = watched.render_stages("interleaved_deferred", &both(&common, changes), &["shade.irradiance"]);
        watched.rgb(&renderer, "shade.irradiance")
    };
    let means = |irradiance: &[[f32; 3]], [n, m]: [usize; 2]| -> Vec<DVec3> {
        let corners = (0..36).step_by(m).flat_map(|y| (0..64).step_by(n).map(move |x| [x, y]));
        let mean = |[left, top]: [usize; 2]| {
            let pixels = (0..m).flat_map(|y| (0..n).map(move |x| (top + y) * 64 + left + x));
            pixels.map(|pixel| Vec3::from_array(irradiance[pixel]).as_dvec3()).sum::<DVec3>() / (n * m) as f64
        };
        corners.map(mean).collect()
    };
    // Both kinds light the plane, each by far more than the bound below: the weight of neither can be wrong unseen.
    let every_light = shaded(&[("split", "none"), ("direct", "interleaved")]);
    let virtual_lights = shaded(&[("split", "none"), ("direct", "none")]);
    for (all, virtual_part) in every_light.iter().zip(&virtual_lights) {
        assert!(virtual_part[0] > 0.05 * all[0] && virtual_part[0] < 0.95 * all[0], "{virtual_part:?} of {all:?}");
    }
    for (pattern, size, direct_patterns) in
        [("8x6", [8, 6], ["auto", "4x3", "2x3", "1x1"]), ("4x4", [4, 4], ["auto", "2x2", "4x1", "1x1"])]
    {
        for direct_pattern in direct_patterns {
            let changes = [("direct", "interleaved"), ("pattern", pattern), ("direct-pattern", direct_pattern)];
            for (found, expected) in means(&shaded(&changes), size).into_iter().zip(means(&every_light, size)) {
                // Two halves, 2^-11 each; and over 2 mm a light 2 m away changes by at most 4 / 2 m of itself.
                let bound = expected * (2f64.powi(-10) + 4e-3);
                assert!((found - expected).abs().cmple(bound).all(), "{changes:?}: {found} for {expected}");
            }
        }
    }
}

#[test]
fn a_roof_keeps_the_sun_out_exactly() {
    let mut scene = plane(&[light(LightKind::Directional, Vec3::ZERO, vec3(0.3, -1.0, 0.2))]);
    scene.meshes.push(square(9.0, 40.0));
    scene.draws.push(Draw { mesh: 1, world_from_object: world_from_plane() });
    let watched = Watched::with_scene(scene);
    for technique in ["deferred", "interleaved_deferred"] {
        let lit = |shadow: &str| {
            let mut changes = vec![("size", SIZE), ("direct-shadow", shadow)];
            if technique == "interleaved_deferred" {
                // The roof's upper side gets all virtual lights, and shines away from the plane.
                changes.extend([("vpls", "16"), ("filter", "none")]);
            }
            let picture = watched.picture(technique, &changes);
            picture.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count()
        };
        assert_eq!(lit("sun"), 0, "{technique}");
        assert_eq!(lit("ray"), 0, "{technique}");
        assert_eq!(lit("none"), 61 * 37, "{technique}");
    }
}

/// shade.irradiance against the sum over the same virtual point lights on the host.
#[test]
fn irradiance_is_the_sum_over_the_virtual_point_lights() {
    if !points_are_exact() {
        return;
    }
    let watched = Watched::open("cornell");
    let session = &watched.session;
    let bvh = Bvh::build(&session.scene).unwrap();
    for (split, pattern, count) in [("none", [1, 1], 64), ("branch", [1, 1], 64), ("branch", [3, 2], 100)] {
        let (text, vpls) = (format!("{}x{}", pattern[0], pattern[1]), count.to_string());
        let changes = [
            ("size", SIZE),
            ("position", "float"),
            ("split", split),
            ("pattern", &text),
            ("vpls", &vpls),
            ("seed", "5"),
        ];
        let stages = ["gbuffer.normal", "shade.irradiance"];
        let renderer = watched.render_stages("interleaved_deferred", &changes, &stages);
        let walk = vpl::Walk { count, bounces: 1, emissive: false, starts: true, medium: None, seed: 5 };
        let vpls = vpl::walk(&session.scene, &bvh, &renderer.lights.lights, &walk).vpls;
        let mapping = mapping(renderer.view.extent, pattern, pattern);
        let grid = Pattern::grid(pattern);
        let subsets = subsets(&grid, &grid, count, 0);
        let diagonal = session.scene.bounds().diagonal();
        let found = watched.rgb(&renderer, "shade.irradiance");
        let normals = watched.rgb(&renderer, "gbuffer.normal");
        let (eye, Extent { width, height }) = (renderer.view.eye(), renderer.view.extent);
        let mut lit = 0;
        for (index, (found, normal)) in found.iter().zip(&normals).enumerate() {
            let (x, y) = (index as u32 % width, index as u32 / width);
            let seen = point_at(&renderer.view, [f64::from(x) + 0.5, f64::from(y) + 0.5]);
            let direction = (seen - eye.as_dvec3()).normalize().as_vec3();
            let Some(hit) = bvh.closest_hit(eye, direction, 100.0, |_| true) else {
                assert_eq!(*normal, [0.0; 3], "({x}, {y}) has a surface that no ray meets");
                continue;
            };
            let position = eye + direction * hit.distance;
            let subset = &subsets[mapping.subset_of([x, y]) as usize];
            let own = &vpls[subset.vpl_first as usize..][..subset.vpl_count as usize];
            let irradiance = |position: Vec3| {
                let received =
                    |vpl| vpl_irradiance(vpl, position, Vec3::from_array(*normal), (0.02 * diagonal).powi(2));
                own.iter().map(received).sum::<Vec3>() * mapping.subset_count() as f32
            };
            let expected = irradiance(position);
            lit += usize::from(expected.min_element() > 0.0);
            // A half float rounds by at most 2^-11 of itself. The rasteriser's point and the ray's are within 10 um of each
            // other, which a light that grazes the surface from nearby shows.
            let steps = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
            let step_m = if watched.session.gpu.caps.identity.is_software() { 1e-5 } else { 1e-3 };
            let moved = |step: Vec3| (irradiance(position + step_m * step) - expected).abs();
            let half = 2f32.powi(-11) + allowance(&watched) as f32;
            let bound = expected * (half + 1e-5) + steps.into_iter().map(moved).sum::<Vec3>();
            let difference = (Vec3::from_array(*found) - expected).abs();
            assert!(difference.cmple(bound).all(), "{split} {text} ({x}, {y}): {found:?} for {expected}");
        }
        assert!(lit > (width * height / 4) as usize, "{lit} pixels are lit");
    }
}
