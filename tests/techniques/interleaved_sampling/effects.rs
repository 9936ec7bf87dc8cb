//! Effects beyond places: moments of a shutter and places of lights, each a member's own.

use super::NAME;
use crate::support::difference::rmse;
use crate::support::moving::moving;
use crate::support::watched::{Changes, Watched, both};
use glam::Vec3;
use quincunx::picture::Picture;
use quincunx::scene::Scene;
use quincunx::techniques::patterns;

/// A box whose lamp and camera move, and whose blocks are bent, while the shutter is open.
fn bending() -> Scene {
    let mut scene = moving("cornell:motion=on", [0.0, 0.6]);
    let closing = scene.closing.as_mut().unwrap();
    closing.hash = "bent".to_owned();
    scene.hash = "straight".to_owned();
    let camera = closing.cameras[0].world_from_view;
    closing.cameras[0].world_from_view = glam::Mat4::from_translation(Vec3::new(0.1, 0.05, 0.0)) * camera;
    for mesh in &mut closing.meshes {
        for position in &mut mesh.positions {
            position.x += 0.1 * position.y;
        }
        for normal in &mut mesh.normals {
            *normal = (*normal + 0.2 * Vec3::X).normalize();
        }
    }
    scene
}

/// What stands at `part` of the way from `scene` to its closing, as a scene that stands still.
fn standing(scene: &Scene, part: f32) -> Scene {
    let close = scene.closing.as_deref().unwrap();
    let mut still = Scene { closing: None, hash: format!("at {part}"), ..scene.clone() };
    // What does not move stays where it is to the bit.
    let mix = |a: Vec3, b: Vec3| if a == b { a } else { a * (1.0 - part) + b * part };
    for (mesh, end) in still.meshes.iter_mut().zip(&close.meshes) {
        mesh.positions.iter_mut().zip(&end.positions).for_each(|(a, b)| *a = mix(*a, *b));
        mesh.normals.iter_mut().zip(&end.normals).for_each(|(a, b)| *a = mix(*a, *b));
    }
    for (draw, end) in still.draws.iter_mut().zip(&close.draws) {
        if draw.world_from_object != end.world_from_object {
            draw.world_from_object = draw.world_from_object * (1.0 - part) + end.world_from_object * part;
        }
    }
    for (light, end) in still.lights.iter_mut().zip(&close.lights) {
        light.position = mix(light.position, end.position);
        light.direction = mix(light.direction, end.direction).normalize();
    }
    let (camera, end) = (&mut still.cameras[0].world_from_view, close.cameras[0].world_from_view);
    // It does not turn.
    camera.w_axis = camera.w_axis * (1.0 - part) + end.w_axis * part;
    still
}

/// Members are the original algorithm at single moments (section 3.2): with samples in the middles of pixels and a basis of one,
/// the picture is the mean of forward-shaded ones of scenes that stand still. Geometry, normals, lights, camera, shadow maps and
/// the tree are all those of the moment.
#[test]
fn motion_is_the_mean_of_pictures_that_stand_still() {
    let scene = bending();
    let spec = "basis:basis=1x1,samples=4,sampler=random,effect=motion";
    let pattern = patterns::open(spec).unwrap().pattern;
    let times: Vec<f32> = pattern.samples_of([0, 0]).iter().map(|sample| sample.further[0]).collect();
    assert!(times.len() == 4 && times.iter().any(|time| *time < 0.4) && times.iter().any(|time| *time > 0.6));
    for shadow in ["none", "map", "ray"] {
        let shared = [("size", "61x47"), ("direct-shadow", shadow)];
        let own =
            [("effect", "motion"), ("basis", "1x1"), ("samples", "4"), ("sampler", "random"), ("shutter", "0,0.6")];
        let mut watched = Watched::with_scene(scene.clone());
        let moved = watched.picture(NAME, &both(&shared, &own));
        let mut sums = vec![Vec3::ZERO; moved.pixels.len()];
        let mut first = None;
        for time in &times {
            watched = watched.showing(standing(&scene, *time));
            let picture = watched.picture("forward", &shared);
            sums.iter_mut().zip(&picture.pixels).for_each(|(sum, pixel)| *sum += Vec3::from_array(*pixel));
            first.get_or_insert(picture);
        }
        let pixels = sums.iter().map(|sum| (*sum / times.len() as f32).to_array()).collect();
        let expected = Picture { extent: moved.extent, pixels };
        let is_apart = |(a, b): (&[f32; 3], &[f32; 3])| {
            (0..3).any(|channel| (a[channel] - b[channel]).abs() > 1e-4 * (1.0 + b[channel].abs()))
        };
        let apart = |other: &Picture| moved.pixels.iter().zip(&other.pixels).filter(|pair| is_apart(*pair)).count();
        let far = apart(&expected);
        println!("{shadow}: {far} of {} pixels apart, RMSE {}", moved.pixels.len(), rmse(&moved, &expected));
        if watched.session.gpu.caps.identity.is_software() {
            assert_eq!(rmse(&moved, &expected), 0.0, "{shadow}");
        }
        // Rays may graze an edge: corners are mixed in the world here and in objects there.
        assert!(far <= if shadow == "ray" { 29 } else { 3 } && rmse(&moved, &expected) < 0.02, "{shadow}: {far}");
        assert!(apart(first.as_ref().unwrap()) > 1000, "nothing moves");
    }
}

/// Every effect comes to what paths give as samples grow, and several of them at once; without the effect the picture stays several
/// times as far off.
#[test]
fn effects_converge_to_paths() {
    let cases: [(&str, &str, Changes<'_>, Changes<'_>, f64); 5] = [
        (
            "cornell:motion=on",
            "aa,motion",
            &[("direct-shadow", "ray"), ("shutter", "0,0.6")],
            &[("emissive", "off")],
            3.0,
        ),
        ("cornell", "aa,soft-shadow", &[("direct-shadow", "ray"), ("emissive", "on")], &[], 4.0),
        ("cornell", "aa,soft-shadow", &[("direct-shadow", "map"), ("emissive", "on")], &[], 4.0),
        (
            "chess:triangles=12000",
            "aa,soft-shadow",
            &[("direct-shadow", "map"), ("emissive", "off"), ("light-radius", "0.4")],
            &[],
            3.0,
        ),
        (
            "cornell:motion=on",
            "aa,motion,defocus,soft-shadow",
            &[("direct-shadow", "ray"), ("emissive", "on"), ("shutter", "0,0.6"), ("aperture", "0.2"), ("focus", "3")],
            &[],
            1.5,
        ),
    ];
    for (spec, effect, changes, of_paths, gain) in cases {
        let scene = match changes.iter().any(|(key, _)| *key == "shutter") {
            true => moving(spec, [0.0, 0.6]),
            false => moving(spec, [0.0, 0.0]),
        };
        let watched = Watched::with_scene(scene);
        let shared = [("size", "48x36"), ("background", "0"), ("brdf", "lambert")];
        let changes = both(&shared, changes);
        let paths =
            [("transport", "direct"), ("light-visibility", "on"), ("spp", "256"), ("ambient-visibility", "off")];
        let paths = both(&both(&changes, of_paths), &paths);
        let paths: Vec<_> = paths.into_iter().filter(|(key, _)| *key != "direct-shadow").collect();
        let reference = cut(watched.picture("path_traced", &paths));
        let error = |effect: &'static str, samples: &'static str| {
            let own = [("effect", effect), ("basis", "2x2"), ("samples", samples)];
            let read = changes.iter().copied().filter(|(key, _)| effect != "aa" || !UNREAD.contains(key));
            rmse(&cut(watched.picture(NAME, &both(&read.collect::<Vec<_>>(), &own))), &reference)
        };
        let errors = ["1", "4", "16"].map(|samples| error(effect, samples));
        let (exponent, without) = ((errors[2] / errors[0]).log2() / 4.0, error("aa", "16"));
        println!("{spec} {effect}: {errors:?}, exponent {exponent}, without {without}");
        assert!(exponent < -0.2, "{effect}: {errors:?}, exponent {exponent}");
        assert!(without > gain * errors[2], "{effect}: {} with, {without} without", errors[2]);
    }
}

/// Light up to white: the panel itself, thirty times as bright, would drown all else.
fn cut(mut picture: Picture) -> Picture {
    picture.pixels.iter_mut().flatten().for_each(|channel| *channel = channel.min(1.0));
    picture
}

/// What `aa` alone does not read.
const UNREAD: [&str; 5] = ["shutter", "emissive", "light-radius", "aperture", "focus"];
