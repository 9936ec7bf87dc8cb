//! What blends is lit from lists of its pieces: the picture of every light, of a technique with a G-buffer as of forward.

use crate::support;
use crate::support::boxes::{camera, rectangle};
use crate::support::difference::require_same;
use crate::support::square::{matt, square};
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat3, Mat4, Vec3, Vec4};
use quincunx::scene::{AlphaMode, Camera, Light, LightKind, Material, Projection, Scene};

const TECHNIQUES: [&str; 3] = ["deferred", "interleaved_deferred", "forward"];

/// Lists and no lists make one picture; returns it.
#[track_caller]
fn require_one_picture(watched: &Watched, technique: &str, common: Changes<'_>) -> Vec<[f32; 3]> {
    let listed = watched.picture(technique, common);
    let every = watched.picture(technique, &both(common, &[("light-lists", "none")]));
    require_same(&watched.session.gpu, &listed, &every, &(technique, common));
    listed.pixels
}

/// A draw of two panes 40 m apart, 2 m a side, and a lamp of each colour 1 m before each, which reaches 5 m.
fn panes() -> Scene {
    let mut scene = square(matt(Vec4::new(1.0, 1.0, 1.0, 0.5)));
    scene.materials[0].alpha = AlphaMode::Blend;
    let mesh = &mut scene.meshes[0];
    let far: Vec<Vec3> = mesh.positions.iter().map(|at| *at + Vec3::X * 40.0).collect();
    mesh.positions.extend(far);
    mesh.normals.extend_from_within(..);
    mesh.uvs.extend_from_within(..);
    let second: Vec<u32> = mesh.indices.iter().map(|vertex| vertex + 4).collect();
    mesh.indices.extend(second);
    let lamp = |index: u32| Light {
        name: String::new(),
        kind: LightKind::Point,
        intensity: Vec3::AXES[index as usize % 3],
        position: Vec3::new(if index < 3 { 0.0 } else { 40.0 }, 0.0, 1.0),
        direction: Vec3::NEG_Y,
        range: Some(5.0),
        radius: 0.0,
    };
    scene.lights = (0..6).map(lamp).collect();
    let projection = Projection::Orthographic { x_mag: 21.0, y_mag: 1.0, z_near: 0.1, z_far: 9.0 };
    let world_from_view = Mat4::from_translation(Vec3::new(20.0, 0.0, 2.0));
    scene.cameras = vec![Camera { name: String::new(), world_from_view, projection }];
    scene
}

#[test]
fn a_pane_has_the_lamps_that_reach_it() {
    let watched = Watched::with_scene(panes());
    // Ten pixels a metre: the panes' middles are the pixels about 10 and 410 of the middle row.
    let common = [("size", "420x20"), ("brdf", "lambert"), ("rig", "none")];
    for technique in TECHNIQUES {
        let counters = watched.render(technique, &common).measured_counters().unwrap();
        assert_eq!((counters["blended_pieces"], counters["blended_lights_per_piece"]), (2.0, 3.0), "{technique}");
        let pixels = require_one_picture(&watched, technique, &common);
        for x in [10, 410] {
            // 1 cd at 1 m and nearly head-on, under glTF's window, on white of half coverage.
            let expected = 0.5 / std::f32::consts::PI * (1.0 - 0.2f32.powi(4));
            let found = Vec3::from_array(pixels[10 * 420 + x]);
            assert!((found / expected - 1.0).abs().max_element() < 0.01, "{technique} at {x}: {found} for {expected}");
        }
    }
}

/// A shape of one draw that is closed but for its rim: a wall that faces the eye, 1 m from a lamp, and 1 m behind it one that
/// faces away. The nearer one's triangles come first in the mesh.
fn two_walls() -> Scene {
    let mut scene = square(matt(Vec4::new(1.0, 1.0, 1.0, 0.5)));
    scene.materials[0].alpha = AlphaMode::Blend;
    scene.materials[0].double_sided = true;
    let mesh = &mut scene.meshes[0];
    let behind: Vec<Vec3> = mesh.positions.iter().map(|at| *at - Vec3::Z).collect();
    mesh.positions.extend(behind);
    mesh.normals.extend(mesh.normals.clone().iter().map(|normal| -*normal));
    mesh.uvs.extend_from_within(..);
    let turned: Vec<u32> = mesh.indices.iter().rev().map(|vertex| vertex + 4).collect();
    mesh.indices.extend(turned);
    scene.lights = vec![Light {
        name: String::new(),
        kind: LightKind::Point,
        intensity: Vec3::ONE,
        position: Vec3::Z,
        direction: Vec3::NEG_Y,
        range: None,
        radius: 0.0,
    }];
    let projection = Projection::Orthographic { x_mag: 0.4, y_mag: 0.4, z_near: 0.1, z_far: 9.0 };
    let world_from_view = Mat4::from_translation(2.0 * Vec3::Z);
    scene.cameras = vec![Camera { name: String::new(), world_from_view, projection }];
    scene
}

#[test]
fn the_far_wall_of_a_closed_shape_is_behind_the_near_one() {
    let watched = Watched::with_scene(two_walls());
    let common = [("size", "41x41"), ("brdf", "lambert"), ("rig", "none"), ("light-cutoff", "0")];
    for technique in TECHNIQUES.into_iter().chain(["inferred_lighting"]) {
        // 1 cd at 1 m and at 2 m, head-on, on white; half of it over half of the other.
        let expected = (0.5 + 0.25 / 4.0) / std::f32::consts::PI;
        let found = Vec3::from_array(watched.picture(technique, &common).pixels[20 * 41 + 20]);
        assert!((found / expected - 1.0).abs().max_element() < 0.02, "{technique}: {found} for {expected}");
    }
}

#[test]
fn lists_change_no_pixel_of_what_blends() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [("size", "160x90"), ("lights", "60")];
    for technique in TECHNIQUES {
        for more in [&[][..], &[("direct-shadow", "ray"), ("size", "64x36")]] {
            require_one_picture(&watched, technique, &both(&common, more));
        }
    }
    require_one_picture(&watched, "interleaved_deferred", &both(&common, &[("direct", "none")]));
    require_one_picture(&watched, "interleaved_deferred", &both(&common, &[("direct", "interleaved")]));
}

/// Glass, beams and force fields all over a map, each kind one draw, under a thousand lights of the file.
#[test]
fn lists_of_real_maps_are_short_and_change_no_pixel() {
    let Some(folder) = support::shared_scenes() else { return };
    for (map, camera) in [("maps/pul1duel-oa.glb", "0"), ("maps/oa_thor.glb", "0")] {
        let watched = Watched::open(folder.join(map).to_str().unwrap());
        let common = [("size", "96x64"), ("camera", camera), ("sun", "off"), ("texture-limit", "64")];
        for technique in ["deferred", "interleaved_deferred"] {
            require_one_picture(&watched, technique, &common);
        }
        let counters = watched.render("deferred", &common).measured_counters().unwrap();
        let (mean, lights) = (counters["blended_lights_per_piece"], counters["lights"]);
        println!("{map}: {counters:?}");
        assert!(mean < 0.2 * lights, "{map}: {mean} of {lights} lights a piece");
    }
}

/// A wall that glows green and a decal in its plane, of other triangles, that glows red and lets nothing through; `tilt` of the
/// plane towards the eye, radians.
fn decal(tilt: f32, has_wall: bool) -> Scene {
    let mut scene = Scene::default();
    let turned = |along: Vec3| Mat3::from_rotation_x(-tilt) * Mat3::from_rotation_y(0.4) * along;
    let glowing = |color: Vec3| Material { emissive: color, ..Material::diffuse("glowing", Vec3::ZERO) };
    let middle = Vec3::new(0.1, -0.2, -6.0);
    if has_wall {
        rectangle(&mut scene, middle, 7.0 * turned(Vec3::X), 5.0 * turned(Vec3::Y), glowing(Vec3::Y));
    }
    let [u, v] = [Vec3::new(1.2, 0.7, 0.0), Vec3::new(-0.6, 1.1, 0.0)].map(turned);
    let place = middle + 0.3 * u + 0.1 * v;
    rectangle(&mut scene, place, u, v, Material { alpha: AlphaMode::Blend, ..glowing(Vec3::X) });
    scene.cameras = vec![camera(Vec3::ZERO, Vec3::NEG_Z, 0.9)];
    scene
}

#[test]
fn a_decal_in_the_plane_of_a_wall_is_seen_whole() {
    for tilt in [0.0, 0.3, 0.9, 1.35] {
        let [alone, on_wall] = [false, true].map(|has_wall| Watched::with_scene(decal(tilt, has_wall)));
        let common = [("size", "160x120"), ("rig", "none"), ("background", "0,0,0")];
        for technique in TECHNIQUES.into_iter().chain(["inferred_lighting"]) {
            let [alone, on_wall] = [&alone, &on_wall].map(|watched| watched.picture(technique, &common).pixels);
            let seen: Vec<_> = alone.iter().zip(&on_wall).filter(|(alone, _)| alone[0] > 0.0).collect();
            let lost = seen.iter().filter(|(alone, on_wall)| alone != on_wall).count();
            assert!(seen.len() > 200 && lost == 0, "{technique}, tilt {tilt}: {lost} of {} pixels", seen.len());
        }
    }
}
