//! What lies behind all that samples see is not shaded (`--zmax on`): where hulls are placed for it (section 4.4).

use super::{DEEP, FRAGMENT, conservative};
use crate::support::boxes::{camera, panel, rectangle};
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, vec3};
use quincunx::scene::Scene;

const WIDTH: u32 = 96;
const HEIGHT: u32 = 54;
const SIZE: (&str, &str) = ("size", "96x54");
const ZMAX: (&str, &str) = ("zmax", "on");
const Y_FOV: f32 = 0.9;

/// Metres from the eye to a screen, which hides the left half of what is behind it, from 1 m below the eye on.
const SCREEN_M: f32 = 6.0;
/// To a wall, and to the floor's end.
const FAR_M: f32 = 40.0;

fn scene(name: &str, build: impl Fn(&mut Scene)) -> Watched {
    let mut scene = Scene { name: name.to_owned(), hash: name.to_owned(), ..Scene::default() };
    let (middle, half_height_m) = (vec3(-20.0, 9.5, -SCREEN_M), 10.5);
    rectangle(&mut scene, middle, 20.0 * Vec3::X, half_height_m * Vec3::Y, panel(Vec3::splat(0.25)));
    build(&mut scene);
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, Y_FOV));
    Watched::with_scene(scene)
}

/// A floor 1 m below the eye, from `first_m` before it on, and a wall that stands at its end.
fn floor(first_m: f32) -> Watched {
    scene(&format!("floor {first_m}"), |scene| {
        let (middle_m, half_m) = (0.5 * (first_m + FAR_M), 0.5 * (FAR_M - first_m));
        let grey = || panel(Vec3::splat(0.5));
        rectangle(scene, vec3(0.0, -1.0, -middle_m), 60.0 * Vec3::X, -half_m * Vec3::Z, grey());
        rectangle(scene, vec3(0.0, 59.0, -FAR_M), 60.0 * Vec3::X, 60.0 * Vec3::Y, grey());
    })
}

/// Rows of pixels from the picture's upper rim down to what lies 1 m below the eye, `far_m` before it.
fn rows_above(far_m: f32) -> f64 {
    let tangent = f64::from(0.5 * Y_FOV).tan();
    0.5 * f64::from(HEIGHT) * (1.0 + 1.0 / (f64::from(far_m) * tangent))
}

/// Pixels that nothing was drawn at because of zmax, with pictures of the same bits.
fn hidden(watched: &Watched, method: &str, changes: Changes<'_>) -> f64 {
    let plain = [SIZE, FRAGMENT, ("conservative", method), ("guard-band", "0"), ("shaded-triangles", "all")];
    let common = both(&both(&plain, &[("spp", "4")]), changes);
    let [all, fewer] = [&[][..], &[ZMAX]].map(|zmax| {
        let renderer = watched.render(DEEP, &both(&common, zmax));
        (renderer.picture().unwrap(), renderer.measured_counters().unwrap()["shading_pixels_drawn"])
    });
    if method != "none" {
        require_same(&watched.session.gpu, &fewer.0, &all.0, &(method, changes));
    }
    all.1 - fewer.1
}

/// `found` pixels are what lies in so many rows of the screen's half, but for those that two triangles touch and those at rims.
#[track_caller]
fn require_rows(found: f64, rows: f64, what: &str) {
    let columns = f64::from(WIDTH / 2);
    println!("{what}: {} of {rows} rows", found / columns);
    assert!((found / columns - rows).abs() < 2.0, "{what}: {} of {rows} rows", found / columns);
}

/// Whatever draws it: a wall lies at one depth.
#[test]
fn a_wall_is_hidden_where_a_screen_stands_before_it() {
    let watched = scene("wall", |scene| {
        rectangle(scene, -FAR_M * Vec3::Z, 60.0 * Vec3::X, 60.0 * Vec3::Y, panel(Vec3::splat(0.5)));
    });
    for method in conservative(&watched).into_iter().chain(["none"]) {
        require_rows(hidden(&watched, method, &[]), rows_above(SCREEN_M), method);
    }
}

/// The floor's nearest corners are nearer than the screen and its plane is not: it is hidden from the screen's foot to its end, and
/// the wall above that.
#[test]
fn hulls_lie_in_their_triangles_planes() {
    let watched = floor(2.0);
    for method in conservative(&watched).into_iter().filter(|method| *method != "hardware") {
        require_rows(hidden(&watched, method, &[]), rows_above(SCREEN_M), method);
    }
    // Triangles as they are have one depth, that of their nearest corner: the wall alone is hidden.
    require_rows(hidden(&watched, "none", &[]), rows_above(FAR_M), "none");
}

/// Where the hull would come before the near plane it lies there, and hides behind nothing.
#[test]
fn hulls_that_cross_the_near_plane_lie_there() {
    let watched = floor(-2.0);
    for method in conservative(&watched) {
        require_rows(hidden(&watched, method, &[]), rows_above(FAR_M), method);
    }
}

/// Samples of a lens lie anywhere in a pixel of shading space, and see the floor and the wall behind the screen's rim.
#[test]
fn nothing_that_a_lens_sees_is_hidden() {
    let watched = floor(2.0);
    for method in conservative(&watched) {
        let found = hidden(&watched, method, &[("aperture", "1"), ("focus", "12"), ("tuples", "32")]);
        println!("{method}: {found} pixels hidden");
        assert!(found > 0.5 * f64::from(WIDTH / 2) * rows_above(SCREEN_M), "{method}: {found} pixels");
    }
}
