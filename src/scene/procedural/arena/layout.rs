//! Where the arena's parts stand, and how many triangles each gets.

use crate::scene::procedural::assembly::place;
use crate::scene::procedural::patch::{Detail, sin_cos_turns};
use glam::{DVec3, Mat4, dvec3};

pub const BAY_COUNT: u32 = 24;

/// From the middle to the faces of the walls.
pub const RADIUS_M: f64 = 13.0;

/// Half of a bay's width: the radius times the tangent of half of a twenty-fourth of a turn.
pub const HALF_BAY_M: f64 = RADIUS_M * 0.131_652_497_587_395_85;

/// Where the upper storey begins, and where the vault does.
pub const GALLERY_M: f64 = 5.6;

pub const VAULT_M: f64 = 9.8;

/// The lantern in the top of the vault.
pub const LANTERN_RADIUS_M: f64 = 2.2;

pub const LANTERN_M: f64 = 18.2;

/// How far the niches of the ground floor reach outward.
pub const NICHE_M: f64 = 3.2;

/// Height of the stage, and the middle of the armillary sphere on it.
pub const STAGE_M: f64 = 0.75;

pub const SPHERE: DVec3 = dvec3(0.0, 3.7, 0.0);

/// The edge lengths of the arena's parts, for one common scale.
#[derive(Clone, Copy)]
pub struct Details {
    /// Turned and carved pieces, which are seen closely.
    pub(super) fine: Detail,
    /// Mouldings and ribs.
    pub(super) middle: Detail,
    /// Flat walls.
    pub(super) broad: Detail,
}

impl Details {
    pub(super) fn new(edge_m: f64) -> Self {
        let detail = |factor: f64| Detail { edge_m: edge_m * factor };
        Self { fine: detail(0.4), middle: detail(1.0), broad: detail(3.0) }
    }
}

/// `count` places on a circle, `before` of a turn after +z, each with its own z toward the middle.
pub fn round(count: u32, before: f64, radius_m: f64, height_m: f64) -> Vec<Mat4> {
    let one = |index: u32| {
        let (sine, cosine) = sin_cos_turns(f64::from(index) / f64::from(count) + before);
        place([-sine, -cosine], 1.0, dvec3(radius_m * sine, height_m, radius_m * cosine))
    };
    (0..count).map(one).collect()
}

/// The walls, and the corners between them, where the piers stand.
pub fn bays() -> Vec<Mat4> {
    round(BAY_COUNT, 0.0, RADIUS_M, 0.0)
}

pub fn corners() -> Vec<Mat4> {
    round(BAY_COUNT, 0.5 / f64::from(BAY_COUNT), RADIUS_M + 0.05, 0.0)
}
