//! Where the fence's parts stand, and the colours of their lamps.

use glam::{DVec3, Mat4, Vec3, dvec3, vec3};

/// Length of one field of the fence, between two posts.
pub const FIELD_M: f64 = 2.7;

/// Height of the wire; posts are higher.
pub const FENCE_M: f64 = 2.3;

pub const WALL_Z_M: f64 = -6.0;

/// The loading platform before the wall: from its lower left front corner to its upper right back one.
pub const PLATFORM: [DVec3; 2] = [dvec3(2.6, 0.0, -3.4), dvec3(9.4, 1.0, WALL_Z_M)];

/// Middle of the rotor, and the lamp above it.
pub const ROTOR: DVec3 = dvec3(0.9, 2.95, 1.2);

pub const ROTOR_LAMP: DVec3 = dvec3(1.2, 4.25, 1.5);

pub const AMBER: [Vec3; 2] = [vec3(1.0, 0.62, 0.25), vec3(1.0, 0.76, 0.42)];

pub const WHITE: [Vec3; 2] = [vec3(1.0, 0.88, 0.68), vec3(1.0, 0.80, 0.55)];

pub const NEON: [Vec3; 2] = [vec3(1.0, 0.22, 0.55), vec3(0.25, 0.75, 1.0)];

pub const MINT: [Vec3; 2] = [vec3(0.35, 1.0, 0.6), vec3(0.3, 0.85, 0.9)];

pub const BLUE: [Vec3; 2] = [vec3(0.35, 0.5, 1.0), vec3(0.6, 0.45, 1.0)];

/// A row of lamps: along a parabola that hangs between its ends.
#[derive(Clone, Copy)]
pub struct Row {
    pub from: DVec3,
    pub to: DVec3,
    pub(super) sag_m: f64,
    /// From a light to its bulb, which would else stand in the way of its rays.
    pub(super) bulb: DVec3,
    pub(super) colors: [Vec3; 2],
}

/// Where bulbs are: on a cable, on the ground, on a wall or an edge behind their lights.
pub const HUNG: DVec3 = dvec3(0.0, 0.09, 0.0);

impl Row {
    /// `along` 0 to 1.
    pub fn at(&self, along: f64) -> DVec3 {
        self.from.lerp(self.to, along) - DVec3::Y * (4.0 * self.sag_m * along * (1.0 - along))
    }

    pub(super) fn length_m(&self) -> f64 {
        self.from.distance(self.to)
    }
}

/// Where something stands whose own y axis is to run from one place to another, and be `width` times as wide as it is.
pub fn between(from: DVec3, to: DVec3, width: f64) -> Mat4 {
    let up = to - from;
    let beside = if up.x.abs() < up.length() * 0.9 { DVec3::X } else { DVec3::Z };
    let x = up.cross(beside).normalize();
    let z = x.cross(up.normalize());
    let column = |vector: DVec3, w: f32| vector.as_vec3().extend(w);
    Mat4::from_cols(column(x * width, 0.0), column(up, 0.0), column(z * width, 0.0), column(from, 1.0))
}
