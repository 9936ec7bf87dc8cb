//! The camera of a scene that has none: from three quarters above, before the side that most front faces look to.

use crate::scene::{Bounds, Camera, Facing, Projection};
use crate::units::Extent;
use glam::{DVec3, Mat3, Mat4, Vec3};

/// Its name in reports, and what `--camera` calls it.
pub const NAME: &str = "framing";

const Y_FOV: f32 = 45.0 * std::f32::consts::PI / 180.0;
/// What is framed is smaller than the picture by this factor.
const MARGIN: f32 = 1.05;
/// Least distance of the eye to the box, as a part of half its diagonal: a near plane needs one.
const LEAST_DISTANCE: f32 = 1e-3;
/// Three quarters: so far the camera stands to the right of the side that it looks at, and so far above, radians.
const ASIDE: f64 = std::f64::consts::FRAC_PI_6;
const ABOVE: f64 = std::f64::consts::FRAC_PI_6;
/// Something flat that lies is seen from no higher up than this, radians, so that y stays up in the picture; 0.82 of its
/// width is still seen there.
const STEEPEST: f64 = 55.0 * std::f64::consts::PI / 180.0;
/// A scene is flat where this part of its area lies one way. A box is, where its third side is 5 % of the others.
const FLAT: f64 = 0.9;
/// Part of the area that looks sideways, net, from which on the front is where it looks to, and not +z. Closed shapes have
/// none; a tenth more on one side is a wall, or a body without a back.
const SIDED: f64 = 0.1;
/// Areas that are a smaller part of the whole are rounding.
const ROUNDING: f64 = 1e-3;
/// Part of the area that looks down, net, from which on the scene is seen from below: a ceiling. Where it is more, the
/// fronts are seen from above no more.
const HANGING: f64 = 0.5;

/// A camera that sees all of `bounds`, world space, with y up and 45 degrees from bottom to top, 5 % of margin around the
/// box: the nearest place from which that is so.
pub fn camera(bounds: &Bounds, facing: &Facing, extent: Extent) -> Camera {
    let bounds = if bounds.is_empty() { Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE } } else { *bounds };
    let (center, radius) = (bounds.center(), (0.5 * bounds.diagonal()).max(1e-6));
    let back = toward_eye(facing).as_vec3();
    let right = Vec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let corners = bounds.corners().map(|corner| corner - center);
    let aspect = extent.width as f32 / extent.height as f32;
    let tangent = (0.5 * Y_FOV).tan() / MARGIN;
    let across = Fit::new(right, back, tangent * aspect, &corners);
    let along = Fit::new(up, back, tangent, &corners);
    let nearest = corners.iter().map(|corner| back.dot(*corner)).fold(f32::NEG_INFINITY, f32::max);
    let distance = across.distance.max(along.distance).max(nearest + LEAST_DISTANCE * radius);
    let eye = center + across.middle * right + along.middle * up + distance * back;
    let world_from_view = Mat4::from_translation(eye) * Mat4::from_mat3(Mat3::from_cols(right, up, back));
    // Halfway to the nearest corner: what moves may come nearer than at the moments that were sampled.
    let z_near = 0.5 * (distance - nearest);
    let projection = Projection::Perspective { y_fov: Y_FOV, aspect: None, z_near, z_far: None };
    Camera { name: NAME.to_owned(), world_from_view, projection }
}

/// Where the eye stands, along one axis of the picture and away from the box's middle, so that the box fills the picture.
struct Fit {
    middle: f32,
    distance: f32,
}

impl Fit {
    /// The picture is wide as far as `tangent` on both sides. An eye at (e, d) on `axis` and `back` sees the corner (a, b) where
    /// |a - e| <= tangent (d - b): so a + tangent b is at most e + tangent d, and a - tangent b at least e - tangent d.
    fn new(axis: Vec3, back: Vec3, tangent: f32, corners: &[Vec3; 8]) -> Self {
        let ends = |sign: f32| corners.iter().map(move |corner| axis.dot(*corner) + sign * tangent * back.dot(*corner));
        let most = ends(1.0).fold(f32::NEG_INFINITY, f32::max);
        let least = ends(-1.0).fold(f32::INFINITY, f32::min);
        Self { middle: 0.5 * (most + least), distance: 0.5 * (most - least) / tangent }
    }
}

/// The unit vector from what is framed to the eye.
fn toward_eye(facing: &Facing) -> DVec3 {
    let (heading, above) = match flat_normal(facing) {
        // A slab that stands has no net front that a heading could be found by.
        Some(normal) if normal.y == 0.0 => (normal, 0.0),
        Some(normal) => (heading(facing), normal.y.asin().clamp(-STEEPEST, STEEPEST)),
        None => {
            let is_hanging = facing.net.y < -HANGING * facing.area;
            // To the right of the heading, as seen on the way from there.
            let heading = DVec3::Y.cross(heading(facing)) * ASIDE.sin() + heading(facing) * ASIDE.cos();
            (heading, if is_hanging { -ABOVE } else { ABOVE })
        }
    };
    heading * above.cos() + DVec3::Y * above.sin()
}

/// Where what is flat is seen from straight on; None where the scene is not flat.
fn flat_normal(facing: &Facing) -> Option<DVec3> {
    let Facing { net, along, area } = *facing;
    if net.length() > FLAT * area {
        return Some(net.normalize());
    }
    let axes = [DVec3::Z, DVec3::Y, DVec3::X];
    let axis = axes.into_iter().find(|axis| axis.dot(along) > FLAT * area)?;
    // Slabs, and what is seen from both sides, have no net front.
    let is_turned = axis.dot(net) < -ROUNDING * area;
    Some(if is_turned { -axis } else { axis })
}

/// The horizontal unit vector that the scene's front looks along: +z, as glTF says, unless its faces say otherwise.
fn heading(facing: &Facing) -> DVec3 {
    let net = DVec3::new(facing.net.x, 0.0, facing.net.z);
    let sideways = facing.along.x + facing.along.z;
    let is_sided = net.length() > SIDED * sideways && sideways > ROUNDING * facing.area;
    if is_sided { net.normalize() } else { DVec3::Z }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::View;

    const EXTENTS: [Extent; 4] =
        [Extent::new(640, 360), Extent::new(100, 300), Extent::new(256, 256), Extent::new(4000, 10)];

    /// Faces by area and direction, single-sided.
    fn faces(all: &[(f64, DVec3)]) -> Facing {
        let mut facing = Facing::default();
        for (area, direction) in all {
            let normal = direction.normalize();
            facing.net += *area * normal;
            facing.along += *area * normal.abs();
            facing.area += area;
        }
        facing
    }

    /// The same, seen from both sides.
    fn both_sides(all: &[(f64, DVec3)]) -> Facing {
        Facing { net: DVec3::ZERO, ..faces(all) }
    }

    fn closed() -> Facing {
        faces(&[DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z].map(|side| (2.0, side)))
    }

    /// Extent of the box on the picture, in halves of the picture: greatest x and greatest y.
    fn filled(bounds: &Bounds, facing: &Facing, extent: Extent) -> [f32; 2] {
        let clip = View { extent, camera: camera(bounds, facing, extent), made_up: true }.clip_from_world();
        bounds.corners().into_iter().fold([0.0f32; 2], |[x, y], corner| {
            let seen = clip.project_point3(corner);
            assert!((0.0..=1.0).contains(&seen.z), "{seen}");
            [x.max(seen.x.abs()), y.max(seen.y.abs())]
        })
    }

    #[test]
    fn the_box_is_in_the_picture_and_comes_to_its_margin() {
        let boxes = [
            Bounds { min: Vec3::new(-3.0, 1.0, -7.0), max: Vec3::new(5.0, 2.0, 1.0) },
            Bounds { min: Vec3::new(-1.0, 0.0, -2.0), max: Vec3::new(3.0, 0.0, 4.0) },
            Bounds { min: Vec3::new(0.0, 0.0, 0.0), max: Vec3::new(1.0, 1.0, 0.0) },
            Bounds { min: Vec3::new(999.0, -0.001, 5.0), max: Vec3::new(999.01, 40.0, 5.5) },
        ];
        let standing = faces(&[(1.0, DVec3::Z)]);
        let ceiling = faces(&[(1.0, -DVec3::Y)]);
        for bounds in &boxes {
            for facing in [closed(), standing, ceiling, Facing::default()] {
                for extent in EXTENTS {
                    let [x, y] = filled(bounds, &facing, extent);
                    let margin = 1.0 / MARGIN;
                    assert!(x <= margin + 1e-3 && y <= margin + 1e-3, "{bounds:?} {extent}: {x} {y}");
                    assert!(x.max(y) >= margin - 1e-3, "{bounds:?} {extent}: {x} {y}");
                }
            }
        }
    }

    #[test]
    fn what_is_nothing_and_what_is_a_point_have_a_camera_too() {
        let point = Bounds { min: Vec3::ONE, max: Vec3::ONE };
        for bounds in [Bounds::EMPTY, point] {
            let camera = camera(&bounds, &Facing::default(), EXTENTS[0]);
            let Projection::Perspective { z_near, .. } = camera.projection else { panic!("{camera:?}") };
            assert!(z_near > 0.0 && camera.world_from_view.is_finite(), "{camera:?}");
        }
    }

    #[test]
    fn a_closed_model_is_seen_from_before_it_to_the_right_and_above() {
        for facing in [closed(), Facing::default()] {
            let eye = toward_eye(&facing);
            assert!(eye.z > 0.7 && eye.x > 0.4 && (eye.y - 0.5).abs() < 1e-9, "{eye}");
            assert!((eye.length() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn no_wall_is_seen_from_behind_wherever_it_looks() {
        for step in 0..360 {
            let angle = f64::from(step).to_radians();
            let (sin, cos) = angle.sin_cos();
            // Round about, and over the pole to the other side.
            for normal in [DVec3::new(sin, 0.0, cos), DVec3::new(0.0, sin, cos), DVec3::new(sin, cos, 0.3)] {
                let normal = normal.normalize();
                let alone = toward_eye(&faces(&[(2.0, normal)])).dot(normal);
                assert!(alone > 0.8, "{normal}: {alone}");
            }
            // A wall on a floor that is much larger, and one beside a closed body.
            let wall = DVec3::new(sin, 0.0, cos);
            let on_floor = toward_eye(&faces(&[(100.0, DVec3::Y), (4.0, wall)]));
            assert!(on_floor.dot(wall) > 0.4 && on_floor.y > 0.4, "{wall}: {on_floor}");
            let mut behind = closed();
            behind.net += 3.0 * wall;
            behind.along += 3.0 * wall.abs();
            behind.area += 3.0;
            assert!(toward_eye(&behind).dot(wall) > 0.4, "{wall}");
        }
    }

    #[test]
    fn what_lies_flat_is_seen_from_the_side_that_it_shows() {
        for (facing, side) in [
            (faces(&[(1.0, DVec3::Y)]), 1.0),
            (faces(&[(1.0, -DVec3::Y)]), -1.0),
            (both_sides(&[(1.0, DVec3::Y)]), 1.0),
        ] {
            let eye = toward_eye(&facing);
            assert!((side * eye.y - STEEPEST.sin()).abs() < 1e-9 && eye.z > 0.5, "{eye}");
        }
        // What stands upright is seen straight on.
        for (facing, eye) in [
            (faces(&[(1.0, DVec3::Z)]), DVec3::Z),
            (faces(&[(1.0, -DVec3::Z)]), -DVec3::Z),
            (both_sides(&[(1.0, DVec3::Z)]), DVec3::Z),
            (both_sides(&[(1.0, DVec3::X)]), DVec3::X),
            // A slab.
            (faces(&[(20.0, DVec3::X), (20.0, -DVec3::X), (1.0, DVec3::Z), (1.0, -DVec3::Z)]), DVec3::X),
        ] {
            assert!(toward_eye(&facing).abs_diff_eq(eye, 1e-9), "{facing:?}: {}", toward_eye(&facing));
        }
        // A room without a floor is looked into from above, a ceiling with a lamp's cord from below.
        let walls = [DVec3::X, -DVec3::X, DVec3::Z, -DVec3::Z].map(|wall| (1.0, wall));
        assert!(toward_eye(&faces(&[&walls[..], &[(1.0, -DVec3::Y)]].concat())).y > 0.0);
        assert!(toward_eye(&faces(&[&walls[..], &[(9.0, -DVec3::Y)]].concat())).y < 0.0);
    }
}
