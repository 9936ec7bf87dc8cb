//! Lenses: the edge of what is out of focus against the edge spread of a disc.

use crate::support::boxes::{camera, rectangle};
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat4, Vec3, vec3};
use quincunx::scene::{Camera, Material, Projection, Scene};

const WIDTH: usize = 64;

/// A white half plane to the right of x = 0, at z = 0, before a black one that is seen nowhere else.
fn edge(camera: Camera) -> Scene {
    let mut scene = Scene { name: "edge".to_owned(), ..Scene::default() };
    let white = Material { unlit: true, ..Material::diffuse("white", Vec3::ONE) };
    rectangle(&mut scene, 50.0 * Vec3::X, 50.0 * Vec3::X, 50.0 * Vec3::Y, white);
    scene.cameras.push(camera);
    scene
}

/// Mean of each column of the picture, from left to right.
fn columns(scene: &Watched, changes: Changes<'_>) -> Vec<f64> {
    let common = [("size", "64x8"), ("spp", "1024"), ("rig", "none")];
    let picture = scene.picture("path_traced", &both(&common, changes));
    (0..WIDTH).map(|x| (0..8).map(|y| f64::from(picture.pixels[y * WIDTH + x][0])).sum::<f64>() / 8.0).collect()
}

/// Part of a disc of radius 1 around `middle` that lies right of 0.
fn right_of_edge(middle: f64) -> f64 {
    let s = middle.clamp(-1.0, 1.0);
    0.5 + (s.asin() + s * (1.0 - s * s).sqrt()) / std::f64::consts::PI
}

/// What the columns are if a disc of radius `blur` metres blurs the edge and a pixel is `pixel` metres wide at it.
fn expected(blur: f64, pixel: f64) -> Vec<f64> {
    let steps = 64;
    let column = |x: usize| {
        let at = |step: usize| (x as f64 - WIDTH as f64 / 2.0 + (step as f64 + 0.5) / steps as f64) * pixel;
        (0..steps).map(|step| right_of_edge(at(step) / blur)).sum::<f64>() / steps as f64
    };
    (0..WIDTH).map(column).collect()
}

fn rms(found: &[f64], expected: &[f64]) -> f64 {
    let sum: f64 = found.iter().zip(expected).map(|(a, b)| (a - b).powi(2)).sum();
    (sum / found.len() as f64).sqrt()
}

/// The radius whose edge is nearest to what was found.
fn fitted(found: &[f64], blur: f64, pixel: f64) -> f64 {
    let candidates = (0..=400).map(|step| blur * (0.8 + 0.001 * f64::from(step)));
    let error = |blur: f64| rms(found, &expected(blur, pixel));
    candidates.min_by(|a, b| error(*a).total_cmp(&error(*b))).unwrap()
}

fn require_edge(found: &[f64], blur: f64, pixel: f64, what: &str) {
    let (error, fit) = (rms(found, &expected(blur, pixel)), fitted(found, blur, pixel));
    println!("{what}: blurred over {fit:.5} m, {blur:.5} by the formula; the profile is off by {error:.5}");
    assert!((fit / blur - 1.0).abs() < 0.01, "{what}: {fit} for {blur}");
    assert!(error < 0.01, "{what}: {error}");
}

/// By similar triangles the disc has the radius R |z - f| / f at the distance z, f the distance in focus and R half the
/// aperture; of an orthographic camera too.
#[test]
fn an_edge_out_of_focus_is_blurred_over_the_circle_of_confusion() {
    let away = 3.0;
    let aperture = 0.4;
    let eye = vec3(0.0, 0.0, away as f32);
    let half_height: f32 = 0.05;
    let perspective = camera(eye, Vec3::ZERO, 2.0 * (half_height / away as f32).atan());
    let projection =
        Projection::Orthographic { x_mag: 8.0 * half_height, y_mag: half_height, z_near: 0.5, z_far: 100.0 };
    let orthographic = Camera { name: "flat".to_owned(), world_from_view: Mat4::from_translation(eye), projection };
    // Each of 8 rows is this high at the edge, and each column as wide.
    let pixel = f64::from(half_height) / 4.0;
    for (word, camera) in [("perspective", perspective), ("orthographic", orthographic)] {
        let watched = Watched::with_scene(edge(camera));
        for focus in [2.0, 2.7, 4.0, 9.0] {
            let blur = 0.5 * aperture * f64::abs(away - focus) / focus;
            let found = columns(&watched, &[("aperture", "0.4"), ("focus", &format!("{focus}"))]);
            require_edge(&found, blur, pixel, &format!("{word}, focus at {focus}"));
        }
        // In focus, and through a pinhole, the edge is where a column begins.
        let sharp: Vec<f64> = (0..WIDTH).map(|x| if x < WIDTH / 2 { 0.0 } else { 1.0 }).collect();
        let focused = columns(&watched, &[("aperture", "0.4"), ("focus", "3")]);
        assert!(rms(&focused, &sharp) < 1e-3, "{word}: {focused:?}");
        assert_eq!(columns(&watched, &[("aperture", "0")]), sharp, "{word}");
    }
}

/// The middle of the picture, of what is drawn there, decides; the middle of the scene where it sees nothing.
#[test]
fn the_lens_finds_its_focus() {
    let mut scene = edge(camera(vec3(1.0, 0.0, 3.0), vec3(1.0, 0.0, 0.0), 0.1));
    // Seen from its back, which is not drawn.
    rectangle(&mut scene, vec3(1.0, 0.0, 1.0), Vec3::Y, Vec3::X, Material::diffuse("back", Vec3::ONE));
    scene.cameras.push(camera(vec3(-1.0, 0.0, 3.0), vec3(-1.0, 0.0, 0.0), 0.1));
    // From behind the scene, away from it.
    scene.cameras.push(camera(vec3(0.0, 0.0, -3.0), vec3(0.0, 0.0, -4.0), 0.1));
    let half_diagonal = 0.5 * scene.bounds().diagonal();
    let watched = Watched::with_scene(scene);
    for (index, expected) in [("0", 3.0), ("1", 2.5), ("2", half_diagonal)] {
        let renderer =
            watched.render("path_traced", &[("size", "8x8"), ("spp", "1"), ("camera", index), ("aperture", "0.1")]);
        let focus: f32 = renderer.resolved["focus"].parse().unwrap();
        assert!((focus - expected).abs() < 1e-4 * expected, "camera {index}: {focus} for {expected}");
        let pinhole = watched.render("path_traced", &[("size", "8x8"), ("spp", "1"), ("camera", index)]);
        assert!(!pinhole.resolved.contains_key("focus"));
    }
}
