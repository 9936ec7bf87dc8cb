//! What closed rooms share: floor, ceiling and walls that let no light through, panels below the ceiling, and things
//! that stand on something.
//!
//! x runs to the right, z from the far wall to the near one, y up; metres. Solids reach a little into what they
//! touch, so that no two faces lie in one plane and no ray finds its way between them.

use glam::{DAffine3, DVec3, Mat4, Vec3, dvec2, dvec3};

use super::assembly::{Assembly, place};
use super::patch::{Detail, Patch, around_y, placed, sin_cos_turns};
use super::shapes::{Mapping, cuboid, face};
use super::solids::{chamfered, pierced};
use crate::scene::Material;

/// How deep things reach into what they stand on.
pub const SUNK_M: f64 = 0.001;

/// Repeats of textures on walls, and on floors: four boards.
const TILE_M: f64 = 2.0;
const FLOOR_TILE_M: f64 = 0.6;

/// Where a window is in the right wall.
#[derive(Clone, Copy)]
pub struct Window {
    pub z_m: [f64; 2],
    pub y_m: [f64; 2],
}

/// The inside of a closed room.
#[derive(Clone, Copy)]
pub struct Room {
    pub min: DVec3,
    pub max: DVec3,
    /// How thick walls, floor and ceiling are, and how deep a window's reveal is.
    pub wall_m: f64,
}

/// Index of each material of a room.
#[derive(Clone, Copy)]
pub struct Walls {
    pub floor: usize,
    pub ceiling: usize,
    pub far: usize,
    pub near: usize,
    pub left: usize,
    pub right: usize,
}

impl Room {
    /// A room on y = 0 around the middle of its floor.
    pub fn new(size_m: DVec3, wall_m: f64) -> Self {
        let half = dvec3(0.5 * size_m.x, 0.0, 0.5 * size_m.z);
        Self { min: -half, max: half.with_y(size_m.y), wall_m }
    }

    /// Its six sides, the right one with `window`, if any. The hole leads outside: what fills it closes the room.
    pub fn build(&self, assembly: &mut Assembly, walls: Walls, window: Option<Window>) {
        let Self { min, max, wall_m } = *self;
        let solid = |low: DVec3, high: DVec3| cuboid(low, high, TILE_M, Detail::COARSE);
        // Walls end inside the slabs, the side walls inside the far and the near one, and these within the sides'
        // outer faces.
        let (butt, end) = (0.45 * wall_m, 0.9 * wall_m);
        let [foot, head] = [min.y - butt, max.y + butt];
        let out = dvec3(0.95, 0.0, 0.95) * wall_m;
        let across = |z: [f64; 2]| solid(dvec3(min.x - end, foot, z[0]), dvec3(max.x + end, head, z[1]));
        let (low, high) = (min.y - 0.3 * wall_m, max.y + 0.3 * wall_m);
        let along = |x: [f64; 2]| solid(dvec3(x[0], low, min.z - butt), dvec3(x[1], high, max.z + butt));
        let right = match window {
            None => along([max.x, max.x + wall_m]),
            Some(Window { z_m, y_m }) => {
                // The wall's own x is the room's z, and it faces -x.
                let outer = [dvec2(min.z - butt, low), dvec2(max.z + butt, high)];
                let hole = [dvec2(z_m[0], y_m[0]), dvec2(z_m[1], y_m[1])];
                let place = DAffine3::from_translation(dvec3(max.x, 0.0, 0.0)) * around_y(-0.25);
                placed(pierced(outer, hole, wall_m, TILE_M), place).collect()
            }
        };
        for (name, material, patches) in [
            (
                "floor",
                walls.floor,
                cuboid((min - out).with_y(min.y - wall_m), (max + out).with_y(min.y), FLOOR_TILE_M, Detail::COARSE),
            ),
            ("ceiling", walls.ceiling, solid((min - out).with_y(max.y), (max + out).with_y(max.y + wall_m))),
            ("far_wall", walls.far, across([min.z - wall_m, min.z])),
            ("near_wall", walls.near, across([max.z, max.z + wall_m])),
            ("left_wall", walls.left, along([min.x - wall_m, min.x])),
            ("right_wall", walls.right, right),
        ] {
            assembly.fixed(name, material, &patches);
        }
    }

    /// A lamp below the ceiling: a flat case of `frame`, and 2 mm below it a rectangle of `size_m` (x and z) that
    /// shines downward with `radiance`. Nothing stands out beside the rectangle: a rim would shade the walls from
    /// what is near it.
    pub fn ceiling_panel(&self, assembly: &mut Assembly, name: &str, at: [f64; 2], lamp: Panel) {
        const CASE_M: f64 = 0.05;
        const RIM_M: f64 = 0.03;
        let Panel { size_m: [width, depth], radiance, frame } = lamp;
        let [x, z] = at;
        let middle = dvec3(x, self.max.y, z);
        let (w, d) = (0.5 * width, 0.5 * depth);
        let [low, high] = [dvec3(-w - RIM_M, -CASE_M, -d - RIM_M), dvec3(w + RIM_M, 0.01, d + RIM_M)];
        assembly.fixed(&format!("{name}_case"), frame, &chamfered(middle + low, middle + high, 0.006, 1.0));
        let material = Material { emissive: radiance, ..Material::diffuse(name, Vec3::ZERO) };
        let material = assembly.material(material);
        let shining_m = -CASE_M - 0.002;
        let corners = [[-w, -d], [w, -d], [w, d], [-w, d]].map(|[i, j]| middle + dvec3(i, shining_m, j));
        assembly.fixed(name, material, &[face(corners, Mapping::Fit, Detail::COARSE)]);
    }

    /// A skirting of `height_m` along the four walls, but for these stretches (from, to) of the far wall's x.
    pub fn skirting(&self, height_m: f64, gaps: &[[f64; 2]]) -> Vec<Patch> {
        const DEPTH_M: f64 = 0.014;
        let Self { min, max, .. } = *self;
        let [foot, head] = [min.y - 3.0 * SUNK_M, min.y + height_m];
        // Lowered a hair where its end is inside another's.
        let solid = |low: [f64; 2], high: [f64; 2], down: f64| {
            let [low, high] = [dvec3(low[0], foot - down, low[1]), dvec3(high[0], head - down, high[1])];
            cuboid(low, high, 1.0, Detail::COARSE)
        };
        let mut patches = Vec::new();
        let mut from = min.x - SUNK_M;
        for gap in gaps.iter().copied().chain([[max.x + SUNK_M, f64::INFINITY]]) {
            patches.extend(solid([from, min.z - SUNK_M], [gap[0], min.z + DEPTH_M], 0.0));
            from = gap[1];
        }
        patches.extend(solid([min.x - SUNK_M, max.z - DEPTH_M], [max.x + SUNK_M, max.z + SUNK_M], 0.0));
        let z = [min.z + 0.5 * DEPTH_M, max.z - 0.5 * DEPTH_M];
        patches.extend(solid([min.x - 2.0 * SUNK_M, z[0]], [min.x + DEPTH_M, z[1]], SUNK_M));
        patches.extend(solid([max.x - DEPTH_M, z[0]], [max.x + 2.0 * SUNK_M, z[1]], SUNK_M));
        patches
    }
}

/// A rectangle that shines.
#[derive(Clone, Copy)]
pub struct Panel {
    /// Along x and z.
    pub size_m: [f64; 2],
    pub radiance: Vec3,
    /// Material of its case.
    pub frame: usize,
}

/// Where what is made on y = 0 stands: turned about y (from +z toward +x), sunk a little into what is at `at`.
pub fn standing(turns: f64, at: DVec3) -> Mat4 {
    let (sine, cosine) = sin_cos_turns(turns);
    place([sine, cosine], 1.0, at - DVec3::Y * SUNK_M)
}

/// The same for patches that are to be part of a larger mesh.
pub fn stood(patches: Vec<Patch>, turns: f64, at: DVec3) -> impl Iterator<Item = Patch> {
    placed(patches, DAffine3::from_translation(at - DVec3::Y * SUNK_M) * around_y(turns))
}
