//! Path tracing against closed forms, and the other techniques against path tracing of the same transport.

mod direct_light;
mod medium;
mod progressive;
mod ray_query;
mod shutter;
mod twins;
mod walks;

use crate::support;
use crate::support::Feature;
use crate::support::boxes::{camera, closed_box, panel, point_light, rectangle};
use crate::support::choices::words_but;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, Vec4, vec3};
use quincunx::picture::Picture;
use quincunx::scene::{self, AlphaMode, Material, Scene};
use quincunx::settings::Brdf;
use quincunx::shading::brdf::{self, Surface};
use std::f32::consts::PI;

const NAME: &str = "path_traced";

/// Mean over the pixels, all of which see the same.
fn mean(picture: &Picture) -> Vec3 {
    picture.pixels.iter().map(|pixel| Vec3::from_array(*pixel)).sum::<Vec3>() / picture.pixels.len() as f32
}

fn require_within(found: Vec3, expected: Vec3, part: f32, what: &str) {
    let bound = expected * part;
    assert!((found - expected).abs().cmple(bound).all(), "{what}: {found} for {expected}");
}

/// A floor, facing up, and a camera that sees a hand's breadth of it around the origin.
fn floor(albedo: Vec3) -> Scene {
    let mut scene = Scene { name: "floor".to_owned(), ..Scene::default() };
    rectangle(&mut scene, Vec3::ZERO, 20.0 * Vec3::X, -20.0 * Vec3::Z, Material::diffuse("floor", albedo));
    scene.cameras.push(camera(vec3(0.0, 2.0, 1.0), Vec3::ZERO, 0.02));
    scene
}

#[test]
fn a_point_light_over_a_floor_and_a_shadow_under_a_roof() {
    let albedo = vec3(0.5, 0.25, 0.8);
    let mut scene = floor(albedo);
    scene.lights.push(point_light(vec3(1.0, 3.0, 0.5), 100.0));
    let changes = [("size", "8x8"), ("spp", "16"), ("brdf", "lambert"), ("light-cutoff", "0")];
    // E = I cos / d^2 = I y / d^3; where nothing else is, more bounces add nothing.
    let distance = vec3(1.0, 3.0, 0.5).length();
    let expected = albedo / PI * vec3(100.0, 50.0, 25.0) * 3.0 / distance.powi(3);
    let watched = Watched::with_scene(scene.clone());
    // Without a medium there is nothing to scatter in between.
    for transport in words_but(NAME, "transport", &["single-scatter"]) {
        let found = mean(&watched.picture(NAME, &both(&changes, &[("transport", transport)])));
        require_within(found, expected, 0.001, transport);
    }
    // A roof between, seen from its back by the light: dark. Its hole, cut by alpha, lets the light through; a roof that
    // stops a third of all rays lets two thirds through.
    let roof = |alpha: AlphaMode, opacity: f32| {
        let mut scene = scene.clone();
        let base_color = Vec4::new(0.0, 0.0, 0.0, opacity);
        let material = Material { base_color, alpha, ..Material::diffuse("roof", Vec3::ZERO) };
        rectangle(&mut scene, 1.5 * Vec3::Y, 0.7 * Vec3::X, 0.7 * Vec3::Z, material);
        mean(&Watched::with_scene(scene).picture(NAME, &both(&changes, &[("transport", "direct"), ("spp", "256")])))
    };
    assert_eq!(roof(AlphaMode::Opaque, 0.0), Vec3::ZERO);
    assert_eq!(roof(AlphaMode::Mask { cutoff: 0.5 }, 0.6), Vec3::ZERO);
    require_within(roof(AlphaMode::Mask { cutoff: 0.5 }, 0.4), expected, 0.001, "a hole");
    // 16384 rays, each through with two thirds: a standard error of 0.55 %.
    require_within(roof(AlphaMode::Blend, 1.0 / 3.0), expected * 2.0 / 3.0, 0.02, "a third");
    let watched = Watched::with_scene({
        let mut scene = scene.clone();
        rectangle(&mut scene, 1.5 * Vec3::Y, 0.7 * Vec3::X, 0.7 * Vec3::Z, Material::diffuse("roof", Vec3::ZERO));
        scene
    });
    let found = mean(&watched.picture(NAME, &both(&changes, &[("light-visibility", "off")])));
    require_within(found, expected, 0.001, "without visibility");
}

/// A light of no intensity stands in the list and is never chosen; those after it shine.
#[test]
fn a_dark_light_takes_nothing_from_the_others() {
    let changes = [("size", "8x8"), ("spp", "4"), ("brdf", "lambert"), ("transport", "direct")];
    let lit = |intensities: &[f32]| {
        let mut scene = floor(Vec3::ONE);
        scene.lights.extend(intensities.iter().map(|candela| point_light(vec3(1.0, 3.0, 0.5), *candela)));
        mean(&Watched::with_scene(scene).picture(NAME, &changes))
    };
    let expected = lit(&[100.0]);
    assert!(expected.min_element() > 0.0);
    require_within(lit(&[0.0, 100.0]), expected, 1e-5, "behind a dark one");
    assert_eq!(lit(&[0.0, 0.0]), Vec3::ZERO);
}

/// Irradiance of a point with normal y from a polygon of radiance 1 that is all above it (Lambert's sum over its edges).
fn polygon_irradiance(corners: &[Vec3]) -> f32 {
    let edge = |index: usize| {
        let (a, b) = (corners[index].normalize(), corners[(index + 1) % corners.len()].normalize());
        a.angle_between(b) * a.cross(b).normalize().y
    };
    0.5 * (0..corners.len()).map(edge).sum::<f32>().abs()
}

#[test]
fn a_rectangle_of_light_gives_what_lambert_s_formula_says() {
    let albedo = vec3(0.5, 0.25, 0.8);
    let (center, u, v) = (vec3(0.4, 1.5, -0.3), vec3(0.6, 0.2, 0.0), vec3(0.0, 0.1, 0.9));
    let radiance = vec3(3.0, 2.0, 1.0);
    let mut scene = floor(albedo);
    rectangle(&mut scene, center, u, v, panel(radiance));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| center + x * u + y * v);
    let expected = albedo / PI * radiance * polygon_irradiance(&corners);
    // It lights too little of the floor to do without the rig.
    let changes = [("size", "8x8"), ("spp", "1024"), ("transport", "direct"), ("rig", "none")];
    let watched = Watched::with_scene(scene);
    for more in [("brdf", "lambert"), ("light-visibility", "off")] {
        let found = mean(&watched.picture(NAME, &both(&changes, &[("brdf", "lambert"), more])));
        require_within(found, expected, 0.01, more.0);
    }
    // The panel's back gives nothing.
    let mut turned = floor(albedo);
    rectangle(&mut turned, center, v, u, panel(radiance));
    assert_eq!(mean(&Watched::with_scene(turned).picture(NAME, &changes)), Vec3::ZERO);
}

/// e + a e + a^2 e + ...: the walls of a closed box, whatever its shape.
#[test]
fn a_closed_box_that_shines_comes_to_its_geometric_sum() {
    for (albedo, bounces, spp) in [(0.5, 24, "64"), (0.8, 48, "256")] {
        let material = Material { emissive: vec3(1.0, 0.5, 0.25), ..Material::diffuse("wall", Vec3::splat(albedo)) };
        let mut scene = closed_box(&material);
        scene.cameras.push(camera(Vec3::ZERO, vec3(0.3, 0.2, -1.0), 1.0));
        let watched = Watched::with_scene(scene);
        let changes = [("size", "16x16"), ("brdf", "lambert"), ("spp", spp)];
        let bounces_text = format!("{bounces}");
        let full = mean(&watched.picture(NAME, &both(&changes, &[("bounces", &bounces_text)])));
        let sum = |count: i32| vec3(1.0, 0.5, 0.25) * (1.0 - f32::powi(albedo, count + 1)) / (1.0 - albedo);
        require_within(full, sum(bounces), 0.01, "full");
        let direct = mean(&watched.picture(NAME, &both(&changes, &[("transport", "direct")])));
        require_within(direct, sum(1), 0.01, "direct");
        let once = mean(&watched.picture(NAME, &both(&changes, &[("transport", "one-bounce")])));
        require_within(once, sum(2), 0.01, "one bounce");
    }
}

/// What a surface sends on towards `to_eye` of a radiance of 1 from everywhere above it, by a midpoint rule.
fn albedo_towards(kind: Brdf, surface: &Surface, to_eye: Vec3) -> Vec3 {
    let (rings, steps, mut sum) = (600, 600, Vec3::ZERO);
    for ring in 0..rings {
        // Equal steps of cos^2: each direction represents the same projected solid angle.
        let cosine = ((ring as f32 + 0.5) / rings as f32).sqrt();
        let sine = (1.0 - cosine * cosine).sqrt();
        for step in 0..steps {
            let angle = 2.0 * PI * (step as f32 + 0.5) / steps as f32;
            let to_light = vec3(sine * angle.cos(), cosine, sine * angle.sin());
            sum += brdf::evaluate(kind, surface, Vec3::Y, to_light, to_eye);
        }
    }
    sum * PI / (rings * steps) as f32
}

/// Under a sky of 1 a flat surface has the radiance of its albedo in that direction: diffuse 1 keeps all light, GGX as
/// glTF has it loses at most some 60 % (rough metals) and makes up to a tenth too much (white dielectrics, aslant).
#[test]
fn a_surface_under_an_even_sky_sends_on_what_its_brdf_says() {
    let white = Material::diffuse("white", Vec3::ONE);
    let cases = [
        ("lambert", Brdf::Lambert, white.clone()),
        ("ggx", Brdf::Ggx, white.clone()),
        ("ggx", Brdf::Ggx, Material { metallic: 1.0, roughness: 1.0, ..white.clone() }),
        ("ggx", Brdf::Ggx, Material { metallic: 1.0, roughness: 0.3, ..white.clone() }),
        ("ggx", Brdf::Ggx, Material { metallic: 0.5, roughness: 0.5, ..white.clone() }),
        ("blinn-phong", Brdf::BlinnPhong, Material { metallic: 0.5, roughness: 0.5, ..white.clone() }),
    ];
    for (word, kind, material) in cases {
        let color = vec3(0.9, 0.5, 0.2);
        let material = Material { base_color: color.extend(1.0), ..material };
        let mut scene = Scene { name: "sky".to_owned(), ..Scene::default() };
        rectangle(&mut scene, Vec3::ZERO, 20.0 * Vec3::X, -20.0 * Vec3::Z, material.clone());
        for eye in [vec3(0.0, 2.0, 0.5), vec3(0.0, 1.0, 2.0)] {
            scene.cameras = vec![camera(eye, Vec3::ZERO, 0.02)];
            let surface = Surface {
                base_color: color,
                metallic: material.metallic,
                roughness: material.roughness,
                dielectric_f0: material.dielectric_f0,
            };
            let expected = albedo_towards(kind, &surface, eye.normalize());
            let changes = [("size", "16x16"), ("spp", "64"), ("brdf", word), ("rig", "none")];
            let watched = Watched::with_scene(scene.clone());
            for sky in [("background", "1"), ("ambient", "1")] {
                let found = mean(&watched.picture(NAME, &both(&changes, &[sky])));
                let what = format!("{word}, metallic {}, roughness {}", material.metallic, material.roughness);
                require_within(found, expected, 0.01, &what);
            }
        }
    }
}

fn relative_rmse(found: &Picture, expected: &Picture) -> f64 {
    let (mut sum, mut all) = (0.0, 0.0);
    for (a, b) in found.pixels.iter().zip(&expected.pixels) {
        sum += (0..3).map(|channel| f64::from(a[channel] - b[channel]).powi(2)).sum::<f64>();
        all += (0..3).map(|channel| f64::from(b[channel]).powi(2)).sum::<f64>();
    }
    (sum / all).sqrt()
}

/// A built-in scene as rays and rasterised pictures agree on it. Its lamps are dark to look at: next to their radiance all
/// else would count for nothing. No normal maps, because coarser levels of one are flatter, and brighter, than the many
/// normals that they replace. No alpha, which the shadow rays of the others do not ask.
fn plain(spec: &str) -> Scene {
    let mut scene = scene::load(spec, 1).unwrap();
    for material in &mut scene.materials {
        material.emissive = Vec3::ZERO;
        material.normal_texture = None;
        material.alpha = AlphaMode::Opaque;
    }
    scene
}

/// Each pixel the mean of `factor` by `factor` others.
fn reduced(picture: &Picture, factor: u32) -> Picture {
    let extent = quincunx::units::Extent::new(picture.extent.width / factor, picture.extent.height / factor);
    let pixels = (0..extent.height)
        .flat_map(|y| (0..extent.width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let of = |i: u32, j: u32| ((y * factor + j) * picture.extent.width + x * factor + i) as usize;
            let inside = (0..factor).flat_map(|j| (0..factor).map(move |i| (i, j)));
            let sum: Vec3 = inside.map(|(i, j)| Vec3::from_array(picture.pixels[of(i, j)])).sum();
            (sum / (factor * factor) as f32).to_array()
        })
        .collect();
    Picture { extent, pixels }
}

#[test]
fn direct_light_is_deferred_shading_s() {
    // A hand's breadth from a lamp light is hundreds of times as strong: where vertices move by a 32nd of a pixel, so does
    // the mean.
    if !support::has(&support::driver(), Feature::ExactPositions) {
        return;
    }
    for (scene, spp, bound) in
        [("cornell", "1024", 0.02), ("lamps:objects=30,lights=20", "512", 0.05), ("hall:triangles=8000", "256", 0.2)]
    {
        let watched = Watched::with_scene(plain(scene));
        let changes: Changes<'_> = &[("size", "512x288"), ("direct-shadow", "ray"), ("position", "float")];
        let expected = reduced(&watched.picture("deferred", changes), 8);
        let found = watched.picture(NAME, &[("size", "64x36"), ("spp", spp), ("transport", "direct")]);
        let error = relative_rmse(&found, &expected);
        println!("{scene}: relative RMSE {error:.4}, means {} {}", mean(&found), mean(&expected));
        require_within(mean(&found), mean(&expected), 0.005, scene);
        assert!(error < bound, "{scene}: {error}");
    }
}

/// The wall behind the tall block, from which most virtual lights are hidden.
#[test]
fn virtual_lights_with_shadow_rays_come_to_path_tracing() {
    let mut scene = plain("cornell");
    scene.cameras = vec![camera(vec3(1.0, 1.2, 0.9), vec3(0.0, 1.2, 0.9), 0.5)];
    let watched = Watched::with_scene(scene);
    let common = [("emissive", "off"), ("brdf", "lambert"), ("size", "16x9")];
    let bounced = |transport| {
        let own = [("spp", "4096"), ("transport", transport), ("ambient-visibility", "off")];
        mean(&watched.picture(NAME, &both(&common, &own)))
    };
    let expected = bounced("one-bounce") - bounced("direct");
    let received = |vpls: &str, shadow: &str| {
        let own =
            [("vpls", vpls), ("vpl-shadow", shadow), ("direct", "none"), ("vpl-clamp", "0.05"), ("pattern", "8x8")];
        let exact = [("filter", "none"), ("position", "float")];
        mean(&watched.picture("interleaved_deferred", &both(&both(&common, &own), &exact)))
    };
    let (found, through) = (received("16384", "ray"), received("16384", "none"));
    println!("{found} of {expected}; {through} through walls");
    assert!(through.cmpgt(1.2 * expected).all(), "the block stops light: {through} and {expected}");
    require_within(found, expected, 0.02, "16384 virtual lights");
}

/// The error of N virtual point lights falls with their number, down to what the reference itself is off by.
#[test]
fn interleaved_shading_comes_to_the_light_walk_as_virtual_lights_grow() {
    let mut scene = plain("cornell");
    // The upper back wall, without an edge in sight: a pixel of one technique is a mean, of the other its middle.
    scene.cameras = vec![camera(vec3(2.78, 4.4, 5.0), vec3(2.78, 4.4, 0.0), 0.25)];
    let watched = Watched::with_scene(scene);
    let common = [("emissive", "off"), ("brdf", "lambert"), ("size", "16x16")];
    let reference = |seed: &str| {
        let own = [("spp", "4096"), ("transport", "one-bounce"), ("vpl-visibility", "off")];
        watched.picture(NAME, &both(&both(&common, &own), &[("seed", seed)]))
    };
    let [first, second] = ["1", "2"].map(reference);
    let expected = Picture {
        extent: first.extent,
        pixels: (first.pixels.iter().zip(&second.pixels))
            .map(|(a, b)| (0.5 * (Vec3::from_array(*a) + Vec3::from_array(*b))).to_array())
            .collect(),
    };
    // The mean of two is off by half of what they differ by, which is no error of virtual lights.
    let floor = 0.5 * relative_rmse(&first, &second);
    let errors = ["64", "256", "1024", "4096"].map(|vpls| {
        let own =
            [("vpls", vpls), ("split", "none"), ("filter", "none"), ("direct-shadow", "ray"), ("position", "float")];
        let found = watched.picture("interleaved_deferred", &both(&common, &own));
        let error = (relative_rmse(&found, &expected).powi(2) - floor.powi(2)).max(0.0).sqrt();
        println!("{vpls} virtual point lights: relative RMSE {error:.5}, means {} {}", mean(&found), mean(&expected));
        error
    });
    let slope = (errors[2] / errors[0]).ln() / 16f64.ln();
    println!("slope from 64 to 1024: {slope:.2}; the reference is off by {floor:.5}");
    assert!(errors[0] > errors[1] && errors[1] > errors[2], "{errors:?}");
    // Independent walks would have -0.5; these are of a low-discrepancy sequence.
    assert!(slope < -0.45, "{slope}");
    assert!(errors[3] < 0.005, "{errors:?}");
}
