//! Where the hall's parts stand, and how many triangles each gets.

use crate::scene::procedural::assembly::place;
use crate::scene::procedural::patch::Detail;
use glam::{Mat4, dvec3};

pub const BAY_M: f64 = 4.0;

pub const BAY_COUNT: u32 = 8;

pub const LENGTH_M: f64 = BAY_M * BAY_COUNT as f64;

/// From the middle of the nave to its walls.
pub const NAVE_M: f64 = 3.7;

pub const WALL_M: f64 = 0.6;

/// From the middle of the nave to the outer walls: an aisle is as wide as a bay is long, for square groin vaults.
pub const OUTER_M: f64 = NAVE_M + WALL_M + BAY_M;

/// Where the arches of the arcade and the vaults of the aisles begin.
pub const SPRINGING_M: f64 = 4.6;

/// Where the vault of the nave begins.
pub const VAULT_M: f64 = 8.2;

/// The edge lengths of the hall's parts, for one common scale.
#[derive(Clone, Copy)]
pub struct Details {
    /// Turned and carved pieces, which are seen closely.
    pub(super) fine: Detail,
    /// Arches and vaults.
    pub(super) middle: Detail,
    /// Flat walls.
    pub(super) broad: Detail,
    /// So few triangles that mouldings and furniture would take them all: they are left out.
    pub(super) sketch: bool,
}

impl Details {
    pub(super) fn new(edge_m: f64) -> Self {
        let detail = |factor: f64| Detail { edge_m: edge_m * factor };
        Self { fine: detail(0.5), middle: detail(1.0), broad: detail(3.0), sketch: edge_m > 1.5 }
    }
}

/// The middles of the bays along z.
pub fn bays() -> impl Iterator<Item = f64> {
    (0..BAY_COUNT).map(|bay| (f64::from(bay) + 0.5) * BAY_M - LENGTH_M * 0.5)
}

/// Where the columns stand along z: between the bays and at both ends.
pub fn column_lines() -> impl Iterator<Item = f64> {
    (0..=BAY_COUNT).map(|line| f64::from(line) * BAY_M - LENGTH_M * 0.5)
}

/// Both sides of the hall, for pieces that face +z in their own space: turned toward the middle of the nave, or away.
pub fn both_sides(x_m: f64, y_m: f64, inward: bool, along: impl Iterator<Item = f64>) -> Vec<Mat4> {
    let mut places = Vec::new();
    for z in along {
        for side in [-1.0, 1.0] {
            let sine = if inward { -side } else { side };
            places.push(place([sine, 0.0], 1.0, dvec3(side * x_m, y_m, z)));
        }
    }
    places
}
