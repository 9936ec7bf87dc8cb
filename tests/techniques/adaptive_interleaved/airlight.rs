//! The component `pm`: the march against a plain one on the host, and all components in a medium against paths.

use super::{CORNELL, EXTENT, NAME, agreeing_part, sampler, shown, xyz};
use crate::support::boxes::{camera, panel, point_light, rectangle};
use crate::support::difference::{require_same, rmse};
use crate::support::seen::point_at;
use crate::support::watched::{Watched, both};
use glam::{Vec3, vec3};
use quincunx::bvh::Bvh;
use quincunx::frame::View;
use quincunx::lights::area::area_lights;
use quincunx::picture::Picture;
use quincunx::sampling::pairs::in_order;
use quincunx::sampling::sampler::Sampler;
use quincunx::scene::{Material, Scene};
use quincunx::shading::medium::Medium;

const MEDIUM: Medium = Medium { scattering: 0.2, absorption: 0.05, asymmetry: 0.4 };
const TEXT: (&str, &str) = ("medium", "0.2,0.05,0.4");

/// Each place of each march with a ray to the lamp and to one point of the panel, and the eye behind all that the medium
/// takes.
#[test]
fn airlight_is_the_mean_of_the_pixel_s_own_marches() {
    let watched = Watched::open("cornell");
    let scene = &watched.session.scene;
    let bvh = Bvh::build(scene).unwrap();
    let offset = 1e-4 * scene.lasting_bounds().diagonal();
    let shown = shown(&watched, &bvh);
    let view = View::new(scene, "0", EXTENT).unwrap();
    let (eye, lamp) = (view.eye(), &scene.lights[0]);
    let block = MEDIUM.around(scene, eye, scene.lights.iter());
    let [x, y, most] = [3u32, 2, 5];
    let points = area_lights(scene, 16)[0].points(scene, &in_order(Sampler::Sobol, [x, y], most, 1 ^ 0x9e37_79b9));
    let step = (xyz(block.max_ws) - xyz(block.min_ws)).length() / 12.0;
    let sampler = sampler([x, y], most);
    let scattered_at = |place: Vec3, direction: Vec3, point: usize| {
        let light = |source: Vec3, irradiance: Vec3| {
            let to = source - place;
            let is_hidden = bvh.occluded(place, to.normalize(), to.length() - 2.0 * offset);
            let phase = MEDIUM.phase(f64::from(to.normalize().dot(direction))) as f32;
            let passed = (-(MEDIUM.extinction() as f32) * to.length()).exp();
            if is_hidden { Vec3::ZERO } else { irradiance * (phase * passed) }
        };
        let from_lamp = light(lamp.position, lamp.intensity / (lamp.position - place).length_squared());
        let point = &points[point];
        let to = xyz(point.position_ws) - place;
        let leaving = (-xyz(point.normal_ws).dot(to.normalize())).max(0.0);
        from_lamp + light(xyz(point.position_ws), xyz(point.intensity) * (leaving / to.length_squared()))
    };
    for (mode, iteration_count) in [("max", most), ("igi", 1)] {
        let own = [("components", "pm"), ("mode", mode), ("tile", "3x2"), ("pm-max", "5"), ("pm-steps", "12"), TEXT];
        let renderer = watched.render_stages(NAME, &both(&CORNELL, &own), &["irradiance.pm"]);
        let part = agreeing_part(&watched.rgb(&renderer, "irradiance.pm"), &shown, |shown| {
            let at = point_at(&view, shown.pixel.map(|side| f64::from(side) + 0.5)).as_vec3();
            let direction = (at - eye).normalize();
            let seen = (shown.position - eye).dot(direction);
            let slot = sampler.slot_of(shown.pixel);
            let march = |iteration: u32| {
                // The middle of the pixel's stretch first, then its neighbours in turns.
                let part = [2, 1, 3, 0, 4][iteration as usize];
                let first = step * (slot as f32 + (part as f32 + 0.5) / most as f32) / (x * y) as f32;
                let places = (0u32..).map(|place| (place, first + step * place as f32));
                let places = places.take_while(|(_, along)| *along < seen);
                let scattered = places.map(|(place, along)| {
                    let point = (iteration * x * y + slot + place) % (most * x * y);
                    let passed = (-(MEDIUM.extinction() as f32) * along).exp();
                    scattered_at(eye + direction * along, direction, point as usize) * passed
                });
                scattered.sum::<Vec3>() * step * MEDIUM.scattering as f32
            };
            (0..iteration_count).map(march).sum::<Vec3>() / iteration_count as f32
        });
        assert!(part > 0.985, "{mode}: {part}");
    }
}

/// A floor, a wall and a shelf, under a panel that the camera does not see and a lamp behind it: no pixel shows what
/// shines.
pub fn shelf() -> Scene {
    let mut scene = Scene { name: "shelf".to_owned(), hash: "shelf".to_owned(), ..Scene::default() };
    let material = |albedo| Material::diffuse("matt", albedo);
    rectangle(&mut scene, Vec3::ZERO, 9.0 * Vec3::X, -9.0 * Vec3::Z, material(vec3(0.7, 0.5, 0.3)));
    rectangle(&mut scene, vec3(0.0, 3.0, -3.0), 9.0 * Vec3::X, 6.0 * Vec3::Y, material(vec3(0.4, 0.6, 0.5)));
    rectangle(&mut scene, vec3(0.3, 1.0, -1.0), 1.1 * Vec3::X, -0.7 * Vec3::Z, material(Vec3::splat(0.5)));
    rectangle(&mut scene, vec3(-0.5, 4.0, 0.0), 0.8 * Vec3::X, 0.6 * Vec3::Z, panel(vec3(9.0, 7.0, 5.0)));
    scene.lights.push(point_light(vec3(3.0, 3.5, 1.5), 20.0));
    scene.cameras.push(camera(vec3(0.0, 2.0, 5.0), vec3(0.0, 0.7, -1.0), 0.6));
    scene
}

pub fn mean(picture: &Picture) -> f32 {
    picture.pixels.as_flattened().iter().sum::<f32>() / picture.pixels.len() as f32
}

/// Whatever of the components is there: the same light as paths give, dimmed by the same medium. Means agree, and every
/// other light is another mean.
#[test]
fn every_choice_of_components_has_the_light_of_its_paths() {
    let watched = Watched::with_scene(shelf());
    let shared = [("size", "64x48"), ("emissive", "on"), TEXT];
    let paths = [("brdf", "lambert"), ("ambient-visibility", "off"), ("spp", "256")];
    let one_bounce = ("transport", "one-bounce");
    let cases = [
        ("ss", [("transport", "direct"), ("airlight", "none"), ("direct-light", "on")]),
        ("id", [one_bounce, ("airlight", "none"), ("direct-light", "off")]),
        ("pm", [("transport", "direct"), ("airlight", "seen"), ("direct-light", "off")]),
        ("id,ss", [one_bounce, ("airlight", "none"), ("direct-light", "on")]),
        ("ss,pm", [("transport", "single-scatter"), ("airlight", "path"), ("direct-light", "on")]),
        ("auto", [one_bounce, ("airlight", "seen"), ("direct-light", "on")]),
    ];
    let mut expected_means = Vec::new();
    for (components, transport) in cases {
        let reference = watched.picture("path_traced", &both(&both(&shared, &paths), &transport));
        // Every texel has all of its samples to itself: nothing is filtered.
        let mut own = vec![("components", components), ("mode", "max"), ("tile", "1x1")];
        if components.contains("id") || components == "auto" {
            own.extend([("vpls", "4096"), ("vpl-clamp", "0.2%"), ("id-scale", "1"), ("id-max", "1")]);
        }
        let picture = watched.picture(NAME, &both(&shared, &own));
        let (found, expected) = (mean(&picture), mean(&reference));
        println!("{components}: {found} for {expected}, rmse {}", rmse(&picture, &reference));
        // Virtual lights are as many for all pixels.
        let bound = if components.contains("id") || components == "auto" { 0.01 } else { 0.005 };
        assert!((found / expected - 1.0).abs() < bound, "{components}: {found} for {expected}");
        expected_means.push(expected);
    }
    expected_means.sort_by(f32::total_cmp);
    assert!(expected_means.windows(2).all(|pair| pair[1] > 1.005 * pair[0]), "{expected_means:?}");
}

/// Listed and dispatched from the device, or each tile in a loop of its own.
#[test]
fn both_ways_to_refine_march_alike() {
    let watched = Watched::open("cornell");
    for own in [&[("tile", "3x3")][..], &[("tile", "8x4"), ("base", "2"), ("pm-steps", "7")]] {
        let picture =
            |refine| watched.picture(NAME, &both(&both(&both(&CORNELL, &[TEXT]), own), &[("refine", refine)]));
        require_same(&watched.session.gpu, &picture("fused"), &picture("indirect"), &own);
    }
}

/// Tiles are refined where a shadow passes through the air before them, or the halo of a light ends; and nowhere in an
/// even light without either.
#[test]
fn shadows_in_the_air_and_halos_are_refined() {
    let watched = Watched::open("cornell");
    let refined = |own: &[(&str, &str)]| {
        let changes = both(&both(&CORNELL, &[TEXT, ("components", "pm")]), own);
        watched.render(NAME, &changes).measured_counters().unwrap()["tiles_refined_pm"]
    };
    let [plain, far] = [&[][..], &[("pm-distance", "0")]].map(refined);
    assert!(plain > far && far > 0.02 && plain < 0.5, "{plain} {far}");
    // Without area lights the lamp's rays meet nothing above the blocks.
    let all = refined(&[("pm-distance", "100")]);
    assert!(all <= plain, "a halo over everything parts no tile: {all} {plain}");
}
