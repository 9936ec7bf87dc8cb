//! The note on a picture that shows nothing: the reason, as far as it is known, and what would help.

use crate::frame::View;
use crate::framing;
use crate::picture::Picture;
use crate::picture::tonemap::srgb_from_linear;
use crate::scene::{Draw, Mesh, Projection, Scene};
use glam::DVec3;

/// The brightest 8-bit code of a picture that counts as black: nobody can tell it from black.
const BLACK_CODE: u8 = 2;

/// A sentence, or None where something is visible. `exposure_ev`: exposure at which the picture is shown, in stops.
/// `has_rig`: the default rig lights it already.
pub fn of_nothing_seen(
    picture: &Picture,
    exposure_ev: f64,
    scene: &Scene,
    view: &View,
    has_rig: bool,
) -> Option<String> {
    let brightest = picture.pixels.iter().flatten().fold(0.0f32, |most, channel| most.max(*channel));
    // Tone maps leave dark light as dark or darker.
    let code = (255.0 * srgb_from_linear(f64::from(brightest) * exposure_ev.exp2()).min(1.0)).round() as u8;
    let is_black = code <= BLACK_CODE;
    let is_one_color = picture.pixels.iter().all(|pixel| *pixel == picture.pixels[0]);
    if !is_black && !is_one_color {
        return None;
    }
    // The shutter may open before something comes into view.
    let moments = [Some(scene), scene.closing.as_deref()].into_iter().flatten();
    let seen = moments.map(|scene| InView::of(scene, view)).fold(InView::default(), InView::and);
    let InView { facing_count, turned_count } = seen;
    if facing_count == 0 {
        let why = match turned_count {
            0 => format!("camera {} looks past all of the scene", view.camera.name),
            1 => "the only triangle in view is single-sided and turned away".to_owned(),
            count => format!("the {count} triangles in view are single-sided and turned away"),
        };
        let others = if scene.cameras.len() > 1 { "; `scene inspect` lists the scene's others" } else { "" };
        return Some(format!(
            "no surface is in view: {why}; --camera {} frames the scene from its front{others}",
            framing::NAME
        ));
    }
    if !is_black {
        return None;
    }
    let mut remedies = Vec::new();
    if !has_rig {
        remedies.push("--rig always adds light");
    }
    if brightest > 0.0 {
        remedies.push("--exposure auto makes what there is visible in a PNG");
    }
    if remedies.is_empty() {
        remedies.push("--ambient 1 shows what color there is");
    }
    let light = if brightest > 0.0 {
        format!("its brightest radiance is {brightest:.2e}, code {code} of 255 at --exposure {exposure_ev}")
    } else {
        "no light comes from what is in view".to_owned()
    };
    Some(format!("the picture is black: {light}; {}", remedies.join(", ")))
}

/// Triangles that are not outside of the picture, by which side of them is seen: more may be counted than are, none less.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct InView {
    /// With their front to the eye, or double-sided.
    facing_count: u64,
    turned_count: u64,
}

impl InView {
    fn of(scene: &Scene, view: &View) -> Self {
        let mut seen = Self::default();
        for draw in &scene.draws {
            let mesh = &scene.meshes[draw.mesh];
            let is_double_sided = scene.materials[mesh.material].double_sided;
            let clip_from_object = view.clip_from_world().as_dmat4() * draw.world_from_object.as_dmat4();
            for triangle in 0..mesh.triangle_count() {
                // Six distances, each inside from 0 on; depth is reversed, and never reaches an infinite far plane.
                let corners = mesh.triangle(triangle).map(|corner| {
                    let [x, y, z, w] = (clip_from_object * corner.as_dvec3().extend(1.0)).to_array();
                    [w + x, w - x, w + y, w - y, w - z, z]
                });
                if (0..6).any(|plane| corners.iter().all(|corner| corner[plane] < 0.0)) {
                    continue;
                }
                let is_seen = is_double_sided || shows_front(draw, mesh, triangle, view);
                *(if is_seen { &mut seen.facing_count } else { &mut seen.turned_count }) += 1;
            }
        }
        seen
    }

    fn and(self, other: Self) -> Self {
        Self {
            facing_count: self.facing_count + other.facing_count,
            turned_count: self.turned_count.max(other.turned_count),
        }
    }
}

fn shows_front(draw: &Draw, mesh: &Mesh, triangle: usize, view: &View) -> bool {
    let corner = draw.world_from_object.transform_point3(mesh.triangle(triangle)[0]);
    let toward_eye: DVec3 = match view.camera.projection {
        Projection::Perspective { .. } => view.eye().as_dvec3() - corner.as_dvec3(),
        Projection::Orthographic { .. } => view.camera.world_from_view.z_axis.truncate().as_dvec3(),
    };
    draw.front(mesh, triangle).dot(toward_eye) > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, Material};
    use crate::units::Extent;
    use glam::{Mat4, Vec3};

    const EXTENT: Extent = Extent { width: 4, height: 2 };

    /// A triangle in xy whose front looks to +z.
    fn scene() -> Scene {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        Scene {
            meshes: vec![Mesh { positions, indices: vec![0, 1, 2], ..Mesh::default() }],
            draws: vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }],
            materials: vec![Material::default()],
            ..Scene::default()
        }
    }

    /// An eye at `z` on the axis, which looks along -z or, turned, along z.
    fn eye(z: f32, is_turned: bool) -> View {
        let turn = Mat4::from_rotation_y(if is_turned { std::f32::consts::PI } else { 0.0 });
        let world_from_view = Mat4::from_translation(Vec3::Z * z) * turn;
        let projection = Projection::Perspective { y_fov: 0.8, aspect: None, z_near: 0.1, z_far: None };
        View { extent: EXTENT, camera: Camera { name: "door".to_owned(), world_from_view, projection }, made_up: false }
    }

    fn note(picture: &Picture, exposure_ev: f64, scene: &Scene, view: &View) -> Option<String> {
        of_nothing_seen(picture, exposure_ev, scene, view, false)
    }

    #[test]
    fn where_no_surface_is_in_view_it_is_said_why() {
        let background = Picture::filled(EXTENT, [0.25, 0.5, 0.75]);
        let past = note(&background, 0.0, &scene(), &eye(3.0, true)).unwrap();
        assert!(past.contains("no surface is in view: camera door looks past") && past.contains("--camera framing"));
        let behind = note(&background, 0.0, &scene(), &eye(-3.0, true)).unwrap();
        assert!(behind.contains("the only triangle in view is single-sided and turned away"), "{behind}");
        // Mirrored, that side is its front.
        let mut mirrored = scene();
        mirrored.draws[0].world_from_object = Mat4::from_scale(-Vec3::Z + Vec3::X + Vec3::Y);
        assert_eq!(note(&background, 0.0, &mirrored, &eye(-3.0, true)), None);
        let mut both = scene();
        both.materials[0].double_sided = true;
        assert_eq!(note(&background, 0.0, &both, &eye(-3.0, true)), None);
        // It comes into view while the shutter is open.
        let mut moving = scene();
        moving.draws[0].world_from_object = Mat4::from_translation(Vec3::X * 100.0);
        assert!(note(&background, 0.0, &moving, &eye(3.0, false)).is_some());
        moving.closing = Some(Box::new(scene()));
        assert_eq!(note(&background, 0.0, &moving, &eye(3.0, false)), None);
    }

    #[test]
    fn a_black_picture_says_how_dark_it_is_and_what_would_help() {
        let view = eye(3.0, false);
        let black = note(&Picture::filled(EXTENT, [0.0; 3]), 0.0, &scene(), &view).unwrap();
        assert!(black.contains("no light comes from what is in view; --rig always"), "{black}");
        assert!(!black.contains("--exposure"), "{black}");
        let mut dim = Picture::filled(EXTENT, [0.0; 3]);
        dim.pixels[3] = [0.0, 0.0007, 0.0];
        let said = note(&dim, 0.0, &scene(), &view).unwrap();
        assert!(said.contains("7.00e-4, code 2 of 255") && said.contains("--exposure auto"), "{said}");
        assert_eq!(note(&dim, 1.0, &scene(), &view), None, "code 5 is to be seen");
        dim.pixels[3] = [0.0, 0.001, 0.0];
        assert_eq!(note(&dim, 0.0, &scene(), &view), None, "code 3");
        let lit = of_nothing_seen(&Picture::filled(EXTENT, [0.0; 3]), 0.0, &scene(), &view, true).unwrap();
        assert!(lit.contains("--ambient") && !lit.contains("--rig"), "{lit}");
    }
}
