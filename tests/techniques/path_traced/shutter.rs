//! Shutters: what moves while one is open against the time that it covers a pixel.

use crate::support;
use crate::support::boxes::{point_light, rectangle};
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat4, Quat, Vec3, vec3};
use quincunx::job::Job;
use quincunx::scene::{Camera, Material, Projection, Scene};
use quincunx::techniques;

const WIDTH: usize = 64;

/// A camera that sees 64 columns and 8 rows of a metre each, around the origin.
fn flat_camera() -> Camera {
    let projection = Projection::Orthographic { x_mag: 32.0, y_mag: 4.0, z_near: 1.0, z_far: 40.0 };
    Camera { name: "flat".to_owned(), world_from_view: Mat4::from_translation(20.0 * Vec3::Z), projection }
}

fn unlit() -> Material {
    Material { unlit: true, ..Material::diffuse("white", Vec3::ONE) }
}

/// What is `from` when the shutter opens and what `change` makes of it when it closes.
fn moving(mut from: Scene, change: impl FnOnce(&mut Scene)) -> Scene {
    from.hash = "opening".to_owned();
    let mut to = Scene { hash: "closing".to_owned(), ..from.clone() };
    change(&mut to);
    from.closing_as(to).unwrap()
}

/// White from x = 0 to 100.
fn half_plane() -> Scene {
    let mut scene = Scene { name: "edge".to_owned(), ..Scene::default() };
    rectangle(&mut scene, 50.0 * Vec3::X, 50.0 * Vec3::X, 50.0 * Vec3::Y, unlit());
    scene.cameras.push(flat_camera());
    scene
}

/// Mean of each column of the picture, from left to right.
fn columns(scene: Scene, changes: Changes<'_>) -> Vec<f64> {
    let common = [("size", "64x8"), ("spp", "1024"), ("rig", "none")];
    let picture = Watched::with_scene(scene).picture("path_traced", &both(&common, changes));
    (0..WIDTH).map(|x| (0..8).map(|y| f64::from(picture.pixels[y * WIDTH + x][0])).sum::<f64>() / 8.0).collect()
}

/// Part of the time, and of each column, that an edge leaves white to its right on its way from `from` to `to`, metres.
fn swept(from: f64, to: f64) -> Vec<f64> {
    let steps = 64;
    let column = |x: usize| {
        let at = |step: usize| x as f64 - WIDTH as f64 / 2.0 + (step as f64 + 0.5) / steps as f64;
        (0..steps).map(|step| ((at(step) - from) / (to - from)).clamp(0.0, 1.0)).sum::<f64>() / steps as f64
    };
    (0..WIDTH).map(column).collect()
}

/// The profile within 1 % of white, its width, which is that of a box (the integral of v (1 - v) is a sixth), within 1 %.
fn require_swept(found: &[f64], from: f64, to: f64, what: &str) {
    let expected = swept(from, to);
    let far = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let width = |values: &[f64]| 6.0 * values.iter().map(|value| value * (1.0 - value)).sum::<f64>();
    let (found_width, expected_width) = (width(found), width(&expected));
    println!("{what}: {found_width:.3} m wide for {expected_width:.3}, the profile off by at most {far:.5}");
    assert!(far < 0.01, "{what}: {far}");
    assert!((found_width / expected_width - 1.0).abs() < 0.01, "{what}: {found_width} for {expected_width}");
}

#[test]
fn a_moving_edge_is_blurred_over_its_way() {
    let moved = |scene: &mut Scene, by: f32| scene.draws[0].world_from_object = Mat4::from_translation(by * Vec3::X);
    let found = columns(moving(half_plane(), |scene| moved(scene, 13.0)), &[]);
    require_swept(&found, 0.0, 13.0, "a draw");
    let bent = moving(half_plane(), |scene| {
        scene.meshes[0].positions.iter_mut().for_each(|position| position.x += 7.5);
    });
    require_swept(&columns(bent, &[]), 0.0, 7.5, "a mesh");
    // The camera goes to the right: the edge to the left.
    let turned = moving(half_plane(), |scene| {
        scene.cameras[0].world_from_view = Mat4::from_translation(vec3(9.0, 0.0, 20.0));
    });
    let mirrored: Vec<f64> = columns(turned, &[]).into_iter().rev().map(|value| 1.0 - value).collect();
    require_swept(&mirrored, 0.0, 9.0, "the camera");
}

/// Under a sun a floor that turns its normal has the mean cosine over the way; a lamp that passes, its mean irradiance.
#[test]
fn normals_and_lights_move_too() {
    let floor = |turn: f32| {
        let mut scene = Scene { name: "floor".to_owned(), ..Scene::default() };
        let (u, v) = (200.0 * Vec3::X, 200.0 * Vec3::Y);
        rectangle(&mut scene, Vec3::ZERO, u, v, Material::diffuse("floor", Vec3::ONE));
        let turned = Quat::from_rotation_y(turn) * Vec3::Z;
        scene.meshes[0].normals.fill(turned);
        scene.cameras.push(flat_camera());
        scene.lights.push(point_light(vec3(0.0, 0.0, 1000.0), 1e6));
        scene
    };
    let common = [("transport", "direct"), ("brdf", "lambert"), ("light-cutoff", "0")];
    let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
    // Far away the lamp is a sun of 1 lux.
    let still = mean(columns(floor(0.0), &common));
    assert!((still * std::f64::consts::PI - 1.0).abs() < 2e-3, "{still}");
    let turn = 1.2;
    let found = mean(columns(
        moving(floor(0.0), |scene| scene.meshes[0].normals.fill(floor(turn).meshes[0].normals[0])),
        &common,
    ));
    let steps = 10_000;
    let integral = |value: &dyn Fn(f64) -> f64| {
        (0..steps).map(|step| value((f64::from(step) + 0.5) / f64::from(steps))).sum::<f64>() / f64::from(steps)
    };
    // The normal on the straight line, made unit length again.
    let to = vec3(f32::sin(turn), 0.0, f32::cos(turn));
    let cosine = |part: f64| f64::from(Vec3::Z.lerp(to, part as f32).normalize().z);
    assert!((found / (still * integral(&cosine)) - 1.0).abs() < 0.01, "{found}");
    let away = 3000.0;
    let found = mean(columns(moving(floor(0.0), |scene| scene.lights[0].position.x = away), &common));
    let irradiance = |part: f64| {
        let aside = part * f64::from(away);
        1e9 / (aside * aside + 1e6).powf(1.5)
    };
    assert!((found / (still * integral(&irradiance)) - 1.0).abs() < 0.01, "{found}");
}

/// A triangle that moves is met at every place between, wherever the tree's boxes are: many small ones, each in white as
/// long as it is before a pixel.
#[test]
fn the_tree_holds_the_way_of_every_triangle() {
    let mut scene = Scene { name: "bars".to_owned(), ..Scene::default() };
    for bar in 0..32 {
        let center = vec3(2.0 * bar as f32 - 31.5, 0.0, 0.1 * bar as f32);
        rectangle(&mut scene, center, 0.5 * Vec3::X, 50.0 * Vec3::Y, unlit());
    }
    scene.cameras.push(flat_camera());
    // Bars as wide as the gaps between them, moved by two of both: half white everywhere but at the ends.
    let scene = moving(scene, |scene| {
        scene.draws.iter_mut().for_each(|draw| draw.world_from_object = Mat4::from_translation(4.0 * Vec3::X));
    });
    let found = columns(scene, &[]);
    for (x, value) in found.iter().enumerate().skip(4) {
        // The bound is four and a half standard errors of 8192 samples in or out.
        assert!((value - 0.5).abs() < 0.025, "column {x}: {value}");
    }
}

fn job(scene: &str, settings: Changes<'_>) -> Job {
    let mut job = Job::new(scene, techniques::find("path_traced").unwrap());
    settings.iter().for_each(|(key, value)| job.set(key, value).unwrap());
    job
}

#[test]
fn what_does_not_move_needs_no_shutter() {
    let still = job("cornell", &[]).load_scene().unwrap();
    let open = job("cornell", &[("shutter", "-0.5,0.5")]).load_scene().unwrap();
    assert!(open.closing.is_none());
    assert_eq!(open.hash, still.hash);
    let error = job("cornell", &[("shutter", "0.5,0.25")]).load_scene().unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("--shutter 0.25,0.5"), "{error}");
    let mut from = Scene { hash: "opening".to_owned(), ..half_plane() };
    let mut to = Scene { hash: "closing".to_owned(), ..from.clone() };
    to.draws.clear();
    assert_eq!(from.clone().closing_as(to).unwrap_err().exit_code(), 2);
    from.hash = "closing".to_owned();
    assert!(from.clone().closing_as(from).unwrap().closing.is_none());
}

/// A file's animation: the pose at both ends, and another scene than without a shutter.
#[test]
fn a_file_is_read_at_both_ends_of_the_shutter() {
    let Some(folder) = support::shared_scenes() else { return };
    let path = folder.join("samples/BoxAnimated/BoxAnimated.gltf");
    let path = path.to_str().unwrap();
    let exposed = job(path, &[("time", "2"), ("shutter", "-0.25,0.5")]).load_scene().unwrap();
    let [from, to] = ["1.75", "2.5"].map(|time| job(path, &[("time", time)]).load_scene().unwrap());
    let places = |scene: &Scene| scene.draws.iter().map(|draw| draw.world_from_object).collect::<Vec<_>>();
    let closing = exposed.closing.as_ref().unwrap();
    assert_eq!((places(&exposed), places(closing)), (places(&from), places(&to)));
    assert_ne!(places(&from), places(&to));
    assert!(exposed.hash != from.hash && exposed.hash != to.hash);
}
