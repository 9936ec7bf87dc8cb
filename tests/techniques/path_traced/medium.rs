//! Path tracing in a homogeneous medium against integrals of double precision, along a ray and over a panel, and against
//! what holds in every medium that absorbs nothing.

use crate::support::boxes::{camera, closed_box, panel, point_light, rectangle};
use crate::support::watched::{Watched, both};
use glam::{DVec3, Vec3, dvec3, vec3};
use quincunx::gpu::commands::Submits;
use quincunx::picture::Picture;
use quincunx::scene::{Light, LightKind, Material, Scene};
use quincunx::shading::medium::Medium;

const NAME: &str = "path_traced";
/// How far the wall is from the eye, which is in the origin and looks along -z.
const WALL: f64 = 4.0;

/// Mean over the pixels, which all look along nearly the same ray.
fn mean(picture: &Picture) -> DVec3 {
    let sum: DVec3 = picture.pixels.iter().map(|pixel| Vec3::from_array(*pixel).as_dvec3()).sum();
    sum / picture.pixels.len() as f64
}

fn require_within(found: DVec3, expected: DVec3, part: f64, what: &str) {
    assert!((found - expected).abs().cmple(expected * part).all(), "{what}: {found} for {expected}");
}

/// A black wall before a camera that sees a spot of it.
fn wall() -> Scene {
    let mut scene = Scene { name: "wall".to_owned(), ..Scene::default() };
    let center = vec3(0.0, 0.0, -WALL as f32);
    rectangle(&mut scene, center, 3.0 * Vec3::X, 3.0 * Vec3::Y, Material::diffuse("wall", Vec3::ZERO));
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, 1e-3));
    scene
}

fn text(medium: &Medium) -> String {
    format!("{},{},{}", medium.scattering, medium.absorption, medium.asymmetry)
}

/// What `source` gives at each place of the ray to the wall, scattered towards the eye: radiance. `source`: irradiance of a
/// place that faces it, and where it is.
fn scattered_along(medium: &Medium, steps: u32, source: impl Fn(DVec3) -> (DVec3, DVec3)) -> DVec3 {
    let step = WALL / f64::from(steps);
    let place = |index: u32| {
        let along = (f64::from(index) + 0.5) * step;
        let place = dvec3(0.0, 0.0, -along);
        let (irradiance, light) = source(place);
        let to_light = light - place;
        let cosine = to_light.normalize().dot(-DVec3::Z);
        let passed = (-medium.extinction() * (along + to_light.length())).exp();
        irradiance * (medium.scattering * medium.phase(cosine) * passed)
    };
    (0..steps).map(place).sum::<DVec3>() * step
}

const MEDIA: [Medium; 4] = [
    Medium { scattering: 0.3, absorption: 0.0, asymmetry: 0.0 },
    Medium { scattering: 0.05, absorption: 0.2, asymmetry: 0.7 },
    Medium { scattering: 1.5, absorption: 0.5, asymmetry: -0.4 },
    Medium { scattering: 0.001, absorption: 0.0, asymmetry: 0.3 },
];

#[test]
fn the_airlight_of_a_point_light_is_its_integral_along_the_ray() {
    // Beside the ray, next to it, behind the eye.
    for position in [dvec3(0.3, 0.8, -1.5), dvec3(0.02, 0.0, -2.5), dvec3(1.0, 0.0, 1.0)] {
        let mut scene = wall();
        scene.lights.push(point_light(position.as_vec3(), 100.0));
        let watched = Watched::with_scene(scene);
        for medium in MEDIA {
            let expected = scattered_along(&medium, 100_000, |place| {
                (dvec3(100.0, 50.0, 25.0) / place.distance_squared(position), position)
            });
            let changes = [
                ("size", "16x16"),
                ("spp", "1024"),
                ("light-cutoff", "0"),
                ("transport", "single-scatter"),
                ("brdf", "lambert"),
            ];
            let found = mean(&watched.picture(NAME, &both(&changes, &[("medium", &text(&medium))])));
            println!("light at {position}, {medium:?}: {found} for {expected}");
            require_within(found, expected, 0.01, &format!("{position} {medium:?}"));
        }
    }
}

/// The stretch of the ray in a wall's shadow gives nothing; without shadows all of it does.
#[test]
fn airlight_stops_where_a_shadow_begins() {
    let medium = MEDIA[0];
    let position = dvec3(0.0, 2.0, -2.0);
    let mut scene = wall();
    scene.lights.push(point_light(position.as_vec3(), 100.0));
    // From the light, half way to the ray: the shadow on the ray is twice as long, from 1.5 to 3.
    rectangle(
        &mut scene,
        vec3(0.0, 1.0, -2.125),
        0.1 * Vec3::X,
        0.375 * Vec3::Z,
        Material::diffuse("roof", Vec3::ZERO),
    );
    let watched = Watched::with_scene(scene);
    let light = |place: DVec3| (dvec3(100.0, 50.0, 25.0) / place.distance_squared(position), position);
    let shadowed = |place: DVec3| if (1.5..3.0).contains(&-place.z) { (DVec3::ZERO, position) } else { light(place) };
    let changes = [
        ("size", "16x16"),
        ("spp", "256"),
        ("light-cutoff", "0"),
        ("transport", "single-scatter"),
        ("brdf", "lambert"),
    ];
    let medium_text = text(&medium);
    let changes = both(&changes, &[("medium", &medium_text)]);
    require_within(mean(&watched.picture(NAME, &changes)), scattered_along(&medium, 100_000, shadowed), 0.01, "shadow");
    let found = mean(&watched.picture(NAME, &both(&changes, &[("light-visibility", "off")])));
    require_within(found, scattered_along(&medium, 100_000, light), 0.01, "no shadow");
}

/// A panel is many small lights. Found by chance along scattered rays too, and weighed: without shadows, when no ray can
/// find it, the same comes out.
#[test]
fn the_airlight_of_a_panel_is_its_integral_over_the_panel() {
    let (center, half_u, half_v) = (dvec3(0.2, 1.0, -2.0), dvec3(0.0, 0.0, 0.6), dvec3(0.5, 0.1, 0.0));
    let radiance = dvec3(3.0, 2.0, 1.0);
    let mut scene = wall();
    let (u, v) = (half_v.as_vec3(), half_u.as_vec3());
    // It shines down on the ray.
    rectangle(&mut scene, center.as_vec3(), v, -u, panel(radiance.as_vec3()));
    let normal = half_u.cross(-half_v).normalize();
    assert!(normal.y < 0.0);
    let watched = Watched::with_scene(scene);
    for medium in MEDIA {
        let (cells, mut expected) = (24, DVec3::ZERO);
        let area = 4.0 * half_u.cross(half_v).length() / f64::from(cells * cells);
        for cell in 0..cells * cells {
            let part = |index: i32| (2.0 * f64::from(index) + 1.0) / f64::from(cells) - 1.0;
            let at = center + half_u * part(cell % cells) + half_v * part(cell / cells);
            expected += scattered_along(&medium, 400, |place| {
                let cosine = (place - at).normalize().dot(normal).max(0.0);
                (radiance * (cosine * area / place.distance_squared(at)), at)
            });
        }
        let changes = [("size", "16x16"), ("spp", "512"), ("transport", "single-scatter"), ("brdf", "lambert")];
        for visibility in ["on", "off"] {
            let more = [("medium", &text(&medium)[..]), ("light-visibility", visibility)];
            let found = mean(&watched.picture(NAME, &both(&changes, &more)));
            println!("{medium:?}, visibility {visibility}: {found} for {expected}");
            require_within(found, expected, 0.01, &format!("{medium:?}, visibility {visibility}"));
        }
        // The same light without what would shine on the wall, and as what any transport can be given.
        for more in [
            &[("direct-light", "off")][..],
            &[("airlight", "seen"), ("transport", "direct")],
            &[("airlight", "seen"), ("transport", "one-bounce"), ("direct-light", "off")],
            &[("airlight", "seen"), ("transport", "full"), ("light-visibility", "off")],
        ] {
            let found = mean(&watched.picture(NAME, &both(&both(&changes, &[("medium", &text(&medium))]), more)));
            require_within(found, expected, 0.01, &format!("{medium:?}, {more:?}"));
        }
    }
}

/// Light from the lamp to the floor and from there to the eye, and of the sun from where it enters the medium's box.
#[test]
fn a_medium_dims_what_surfaces_send_on() {
    let albedo = vec3(0.5, 0.25, 0.8);
    let floor = |light: Light| {
        let mut scene = Scene { name: "floor".to_owned(), ..Scene::default() };
        rectangle(&mut scene, Vec3::ZERO, 20.0 * Vec3::X, -20.0 * Vec3::Z, Material::diffuse("floor", albedo));
        scene.cameras.push(camera(vec3(0.0, 2.0, 1.0), Vec3::ZERO, 0.002));
        scene.lights.push(light);
        Watched::with_scene(scene)
    };
    let lamp = point_light(vec3(1.0, 3.0, 0.5), 100.0);
    let sun = Light { kind: LightKind::Directional, direction: vec3(0.6, -0.8, 0.0), ..lamp.clone() };
    let far = vec3(1.0, 3.0, 0.5).as_dvec3().length();
    let to_eye = dvec3(0.0, 2.0, 1.0).length();
    let intensity = dvec3(100.0, 50.0, 25.0);
    // The eye is the highest point of the box in which the sun shines, 2 m up.
    let cases = [(lamp, 3.0 / far.powi(3), far), (sun, 0.8, 2.0 / 0.8)];
    for (light, irradiance, way) in cases {
        let watched = floor(light);
        for (word, absorption, scattering) in [("direct", 0.0, 0.3), ("one-bounce", 0.2, 0.1), ("full", 0.3, 0.0)] {
            let passed = (-0.3 * (way + to_eye)).exp();
            let expected = albedo.as_dvec3() / std::f64::consts::PI * intensity * irradiance * passed;
            let medium = format!("{scattering},{absorption},0");
            let changes = [("size", "8x8"), ("spp", "16"), ("brdf", "lambert"), ("light-cutoff", "0")];
            let found = mean(&watched.picture(NAME, &both(&changes, &[("transport", word), ("medium", &medium)])));
            require_within(found, expected, 0.001, word);
        }
    }
}

/// Where nothing absorbs and everything shines alike, radiance is the same everywhere: e / (1 - albedo), whatever the medium.
#[test]
fn a_medium_that_absorbs_nothing_changes_nothing_in_an_even_box() {
    for (albedo, medium) in [(0.0, "1,0,0"), (0.0, "2,0,0.8"), (0.5, "0.5,0,-0.5")] {
        let material = Material { emissive: vec3(1.0, 0.5, 0.25), ..Material::diffuse("wall", Vec3::splat(albedo)) };
        let mut scene = closed_box(&material);
        scene.cameras.push(camera(Vec3::ZERO, vec3(0.3, 0.2, -1.0), 1.0));
        let watched = Watched::with_scene(scene);
        let changes = [("size", "16x16"), ("brdf", "lambert"), ("spp", "256"), ("bounces", "64"), ("medium", medium)];
        let found = mean(&watched.picture(NAME, &changes));
        let expected = dvec3(1.0, 0.5, 0.25) / f64::from(1.0 - albedo);
        println!("albedo {albedo}, --medium {medium}: {found} for {expected}");
        require_within(found, expected, 0.01, medium);
    }
}

#[test]
fn what_no_medium_can_give_is_refused() {
    let watched = Watched::with_scene(wall());
    for (changes, words) in [
        (&[("transport", "single-scatter"), ("brdf", "lambert")][..], "--medium 0.1,0,0"),
        (&[("transport", "single-scatter"), ("medium", "0,0,0.5")], "--medium 0.1,0,0"),
        (&[("medium", "1,0,0"), ("vpl-visibility", "off")], "--medium none"),
    ] {
        let error = watched.try_renderer(NAME, changes, &[], Submits::One).err().unwrap();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(words), "{error}");
    }
}
