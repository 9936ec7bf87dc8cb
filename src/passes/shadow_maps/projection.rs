//! Cameras of shadow maps: from where, between which planes, along which axes.

use crate::scene::{Bounds, Camera, Projection};
use glam::{Mat4, Vec3};

/// A near plane is no nearer than this part of the far one: the depths of 32-bit floats stay finer than a part in 2^12 of
/// the distance, where triangles that cross the near plane are interpolated.
const NEAREST_PART: f32 = 1e-3;
/// What boxes and ranges are widened by, as a part of them: rounding.
const SLACK: f32 = 1e-3;

/// Distances of the near and the far plane of a light that ends after `range` metres (0: never), metres. `tangent`: of half
/// the angle across a side of its map.
pub fn depths(position: Vec3, range: f32, tangent: f32, bounds: &Bounds) -> [f32; 2] {
    let farthest = (bounds.min - position).abs().max((bounds.max - position).abs()).length();
    let ends = if range > 0.0 { range.min(farthest) } else { farthest };
    let far = ends.max(1e-6 * bounds.diagonal()).max(1e-9) * (1.0 + SLACK);
    let nearest = position.clamp(bounds.min, bounds.max).distance(position);
    // In a corner of the map a point is farther from the light than along the axis.
    let along_axis = nearest * (1.0 - SLACK) / (1.0 + 2.0 * tangent * tangent).sqrt();
    [along_axis.clamp(NEAREST_PART * far, 0.5 * far), far]
}

/// A square view from `position` whose half angles have this tangent.
pub fn perspective(position: Vec3, [right, up, back]: [Vec3; 3], tangent: f32, [z_near, z_far]: [f32; 2]) -> Camera {
    let y_fov = 2.0 * tangent.atan();
    camera([right, up, back], position, Projection::Perspective { y_fov, aspect: None, z_near, z_far: Some(z_far) })
}

/// A square that holds all of `bounds`, seen along `direction`.
pub(super) fn around(bounds: &Bounds, direction: Vec3, border: f32) -> Camera {
    let back = -direction;
    let (right, up) = across(direction);
    let (center, half) = (bounds.center(), (bounds.max - bounds.min) * 0.5);
    let reach = |axis: Vec3| axis.abs().dot(half);
    // A flat scene still needs a box with an inside.
    let least = 1e-6 * bounds.diagonal().max(1e-6);
    let side = reach(right).max(reach(up)).max(least) * (1.0 + SLACK) * border;
    let depth = reach(back).max(least) * (1.0 + SLACK);
    let projection = Projection::Orthographic { x_mag: side, y_mag: side, z_near: 0.0, z_far: 2.0 * depth };
    camera([right, up, back], center + back * depth, projection)
}

fn camera([right, up, back]: [Vec3; 3], position: Vec3, projection: Projection) -> Camera {
    let world_from_view = Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), position.extend(1.0));
    Camera { name: String::new(), world_from_view, projection }
}

/// Right and up of a view along the unit vector `direction`: the right is across the axis of the world that it is
/// least along.
pub fn across(direction: Vec3) -> (Vec3, Vec3) {
    let aside = Vec3::AXES[direction.abs().min_position()];
    let right = direction.cross(aside).normalize();
    (right, right.cross(direction))
}

/// Right, up and back of the camera of a cube's face, as shadow_maps.glsl takes faces for granted: +x -x +y -y +z -z.
pub(super) fn face_axes(face: usize) -> [Vec3; 3] {
    let sign = [1.0, -1.0][face % 2];
    let axis = |step: usize| Vec3::AXES[(face / 2 + step) % 3];
    [axis(1), -sign * axis(2), -sign * axis(0)]
}
