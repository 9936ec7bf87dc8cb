//! Virtual point lights that surfaces stop (`--vpl-shadow ray`).

use super::NAME;
use crate::support::boxes::{camera, closed_box, point_light, rectangle};
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, vec3};
use quincunx::picture::AovChannels;
use quincunx::scene::{AlphaMode, Material, Scene};

const RAY: (&str, &str) = ("vpl-shadow", "ray");
const COMMON: [(&str, &str); 4] = [("size", "64x36"), ("vpls", "64"), ("direct", "none"), ("position", "float")];

/// A box that a wall from side to side makes two rooms of; a lamp hangs in the left one, a pane in the right one. `eye_x`: in which
/// room the camera looks away from the wall.
pub fn rooms(eye_x: f32) -> Watched {
    let grey = Material { double_sided: true, ..Material::diffuse("grey", Vec3::splat(0.6)) };
    let mut scene = closed_box(&grey);
    rectangle(&mut scene, Vec3::ZERO, Vec3::Y, Vec3::Z, grey.clone());
    let mut pane = Material { alpha: AlphaMode::Blend, ..grey };
    pane.base_color.w = 0.5;
    rectangle(&mut scene, vec3(0.7, 0.0, 0.0), 0.3 * Vec3::Y, 0.3 * Vec3::Z, pane);
    scene.lights = vec![point_light(vec3(-0.5, 0.3, 0.1), 4.0)];
    scene.cameras = vec![camera(vec3(eye_x, 0.0, 0.0), vec3(2.0 * eye_x, 0.1, 0.1), 1.4)];
    let name = format!("rooms {eye_x}");
    Watched::with_scene(Scene { name: name.clone(), hash: name, ..scene })
}

/// No light comes through the wall, to what is solid or blended, by lights of subsets or all of them.
#[test]
fn a_room_behind_a_wall_is_dark() {
    let watched = rooms(0.1);
    let ways: [Changes<'_>; 4] =
        [&[], &[("split", "none")], &[("split", "subsample")], &[("blend-lights", "all"), ("split", "branch")]];
    for way in ways {
        let lit = watched.picture(NAME, &both(&COMMON, way));
        let lit_count = lit.pixels.iter().filter(|pixel| pixel[0] > 0.0).count();
        println!("{way:?}: {lit_count} of {} pixels are lit through the wall", lit.pixels.len());
        assert!(lit_count > lit.pixels.len() / 2, "{way:?}: {lit_count} pixels");
        let dark = watched.picture(NAME, &both(&both(&COMMON, way), &[RAY]));
        assert!(dark.pixels.iter().flatten().all(|channel| *channel == 0.0), "{way:?}: rays are stopped");
    }
}

/// Light that a wall stops is light that it hides: in a room behind it every pixel of 64 lights a pixel has hidden ones, which stage
/// and picture agree on; in the lit room nothing hides any.
#[test]
fn hidden_lights_are_counted() {
    for (eye_x, split) in [(0.1, "none"), (0.1, "stencil"), (0.1, "subsample"), (-0.1, "one-pass")] {
        let watched = rooms(eye_x);
        let way = both(&COMMON, &[("split", split), ("filter", "none"), RAY]);
        let lit = watched.picture(NAME, &both(&way, &[("vpl-shadow", "none")]));
        let renderer = watched.render_stages(NAME, &way, &["vpl_shadow.hidden"]);
        let AovChannels::YU32(counts) = renderer.aov("vpl_shadow.hidden").unwrap().channels else { panic!("counts") };
        assert_eq!(counts.len(), lit.pixels.len());
        let most = if split == "none" || split == "subsample" { 64 } else { 4 };
        assert!(counts.iter().all(|count| *count <= most), "{split}");
        let hidden = counts.iter().filter(|count| **count > 0).count();
        println!("{split} from {eye_x}: {hidden} of {} pixels do not see lights", counts.len());
        if eye_x < 0.0 {
            assert_eq!(hidden, 0, "{split}");
        } else if split == "subsample" {
            assert!(hidden > counts.len() / 2, "{split}: {hidden}");
        } else {
            let differing = counts.iter().zip(&lit.pixels).filter(|(count, pixel)| (**count > 0) != (pixel[0] > 0.0));
            assert!(differing.count() <= counts.len() / 100, "{split}: what is lit is what is hidden");
        }
    }
}

/// From everywhere in a convex room all that the lamp lights in it is seen, and nothing else is lit.
#[test]
fn in_a_convex_room_rays_change_no_bit() {
    let watched = rooms(-0.1);
    for split in ["one-pass", "none"] {
        let [free, shadowed] =
            [&[][..], &[RAY]].map(|own| watched.picture(NAME, &both(&both(&COMMON, &[("split", split)]), own)));
        require_same(&watched.session.gpu, &shadowed, &free, &split);
    }
}
