//! A room of tables and boxes under one panel, in the spirit of Peter Shirley's test rooms, one of which Dubla,
//! Debattista and Chalmers 2009 light (figure 6, Shirley 6): plain solids of many sizes and turns, alone, stacked and
//! on tables, so that every kind of contact between shadow and surface is there.
//!
//! The middle of the floor is the origin, y up; metres.

use glam::{DAffine3, DVec3, Vec3, dvec3, vec3};

use super::assembly::Assembly;
use super::patch::{Detail, Patch, around_y, placed};
use super::room::{Panel, Room, SUNK_M, Walls, standing, stood};
use super::shapes::{bar, cuboid};
use super::solids::{chamfered, open_box};
use super::wares::between;
use crate::sampling::pcg::Pcg32;
use crate::scene::Material;
use crate::scene::procedural::values::Values;

const TABLE_M: DVec3 = dvec3(1.5, 0.72, 0.8);
/// Tables stand in two rows of two.
const TABLES_M: [[f64; 2]; 4] = [[-1.45, -1.1], [1.45, -1.25], [-1.3, 1.0], [1.55, 0.85]];
/// Cells in which a box can stand: along x and z on a table, and side of a cell of the floor.
const ON_TABLE: [u32; 2] = [4, 2];
const FLOOR_CELL_M: f64 = 0.62;

const PANEL_RADIANCE: Vec3 = vec3(38.0, 36.0, 32.0);

/// A place for a box, and for others on top of it.
struct Cell {
    at: DVec3,
    /// Greatest side of what stands there.
    side_m: f64,
}

/// The scene for `boxes`; the seed chooses their sizes, turns, colours and places.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let mut random = Pcg32::new(seed, 11);
    let mut assembly = Assembly::default();
    let mut plain = |name: &str, albedo: Vec3| assembly.material(Material::diffuse(name, albedo));
    let white = plain("white", vec3(0.74, 0.73, 0.70));
    let walls = Walls {
        floor: plain("floor", vec3(0.48, 0.44, 0.39)),
        ceiling: white,
        far: white,
        near: white,
        left: plain("ochre", vec3(0.66, 0.42, 0.14)),
        right: plain("blue", vec3(0.16, 0.30, 0.52)),
    };
    let wood = plain("table", vec3(0.50, 0.32, 0.18));
    let colors = [
        plain("chalk", vec3(0.72, 0.71, 0.68)),
        plain("card", vec3(0.52, 0.38, 0.23)),
        plain("brick", vec3(0.52, 0.16, 0.10)),
        plain("moss", vec3(0.22, 0.36, 0.13)),
        plain("slate", vec3(0.22, 0.26, 0.32)),
        plain("straw", vec3(0.70, 0.58, 0.24)),
    ];
    let room = Room::new(dvec3(6.4, 2.8, 5.6), 0.15);
    room.build(&mut assembly, walls, None);
    let panel = Panel { size_m: [0.9, 0.9], radiance: PANEL_RADIANCE, frame: white };
    room.ceiling_panel(&mut assembly, "panel", [0.0, -0.1], panel);
    assembly.fixed("skirting", white, &room.skirting(0.08, &[]));

    let table = assembly.mesh("table", wood, &table());
    let turns = TABLES_M.map(|_| between(&mut random, -0.03, 0.03));
    for ([x, z], turns) in TABLES_M.into_iter().zip(turns) {
        assembly.draw(table, standing(turns, dvec3(x, 0.0, z)));
    }
    let boxes = boxes(&room, turns, values.get("boxes") as u32, &mut random);
    let names = ["chalk", "card", "brick", "moss", "slate", "straw"];
    for ((name, material), patches) in names.into_iter().zip(colors).zip(boxes) {
        if !patches.is_empty() {
            assembly.fixed(&format!("{name}_boxes"), material, &patches);
        }
    }
    for (name, eye, target, y_fov) in [
        ("room", dvec3(-0.5, 2.05, 2.6), dvec3(0.1, 0.42, -0.6), 0.92),
        ("table", dvec3(0.2, 1.25, 2.2), dvec3(-1.2, 0.72, 0.8), 0.7),
        ("floor", dvec3(2.7, 0.5, 2.4), dvec3(-0.6, 0.35, -0.6), 0.85),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    assembly
}

/// A top on four legs with rails between them, around the y axis.
fn table() -> Vec<Patch> {
    let [w, d] = [0.5 * TABLE_M.x, 0.5 * TABLE_M.z];
    let under = TABLE_M.y - 0.035;
    let mut patches = chamfered(dvec3(-w, under, -d), dvec3(w, TABLE_M.y, d), 0.004, 1.0);
    let (x, z) = (w - 0.07, d - 0.07);
    for [i, k] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
        patches.extend(bar(dvec3(i * x, 0.0, k * z), dvec3(i * x, under + 0.01, k * z), 0.03));
    }
    for side in [-1.0, 1.0] {
        let solid = |low: DVec3, high: DVec3| cuboid(low, high, 1.0, Detail::COARSE);
        let (y, top) = (under - 0.08, under + 0.006);
        patches.extend(solid(dvec3(-x, y, side * z - 0.011), dvec3(x, top, side * z + 0.011)));
        patches.extend(solid(dvec3(side * x - 0.011, y + 0.001, -z), dvec3(side * x + 0.011, top + 0.001, z)));
    }
    patches
}

/// `count` boxes by colour: in cells of tables and floor, in a shuffled order, and where all are taken on top of
/// others.
fn boxes(room: &Room, turns: [f64; 4], count: u32, random: &mut Pcg32) -> [Vec<Patch>; 6] {
    let mut cells = cells(room, turns);
    let mut patches: [Vec<Patch>; 6] = Default::default();
    // Cells from here on have had no box in this round.
    let mut first = 0;
    for _ in 0..count {
        if first == cells.len() {
            first = 0;
        }
        // One in four goes on top of another that is large enough.
        let other = random.below(first.max(1) as u32) as usize;
        let index = if random.below(4) == 0 && first > 0 && cells[other].side_m > 0.12 {
            other
        } else {
            let pick = first + random.below((cells.len() - first) as u32) as usize;
            cells.swap(first, pick);
            first += 1;
            first - 1
        };
        let Cell { at, side_m } = cells[index];
        let color = random.below(6) as usize;
        let turns = f64::from(random.unit());
        // The diagonal fits whatever the turn.
        let [x, z] = [0.0; 2].map(|_| side_m * std::f64::consts::FRAC_1_SQRT_2 * between(random, 0.55, 1.0));
        let height = side_m * between(random, 0.35, 1.15);
        let is_open = random.below(5) == 0;
        let solid = if is_open {
            // It opens toward +z of its own: up.
            let lie = DAffine3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y, DVec3::ZERO);
            placed(open_box(dvec3(x, z, height), 0.03 * side_m, 1.0), lie).collect()
        } else {
            let half = dvec3(0.5 * x, 0.0, 0.5 * z);
            chamfered(-half, half.with_y(height), 0.02 * side_m, 1.0)
        };
        patches[color].extend(stood(solid, turns, at));
        // Into an open box goes what fits between its walls; on a closed one, what fits on its lid.
        let inner = x.min(z) - if is_open { 0.08 * side_m } else { 0.05 * side_m };
        cells[index] =
            Cell { at: at + DVec3::Y * (if is_open { 0.03 * side_m } else { height } - SUNK_M), side_m: 0.95 * inner };
    }
    patches
}

/// Cells on the four tables, turned with them, and of the floor where no table stands.
fn cells(room: &Room, turns: [f64; 4]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for ([x, z], turns) in TABLES_M.into_iter().zip(turns) {
        let [columns, rows] = ON_TABLE;
        let side_m = (TABLE_M.x / f64::from(columns)).min(TABLE_M.z / f64::from(rows));
        for index in 0..columns * rows {
            let along = (f64::from(index % columns) + 0.5) / f64::from(columns) - 0.5;
            let across = (f64::from(index / columns) + 0.5) / f64::from(rows) - 0.5;
            let on = dvec3(along * TABLE_M.x, TABLE_M.y - SUNK_M, across * TABLE_M.z);
            let turned = around_y(turns).transform_vector3(on);
            cells.push(Cell { at: turned + dvec3(x, 0.0, z), side_m: 0.88 * side_m });
        }
    }
    let size = room.max - room.min;
    let [columns, rows] = [size.x, size.z].map(|side_m| ((side_m - 0.3) / FLOOR_CELL_M) as u32);
    for index in 0..columns * rows {
        let x = (f64::from(index % columns) + 0.5 - 0.5 * f64::from(columns)) * FLOOR_CELL_M;
        let z = (f64::from(index / columns) + 0.5 - 0.5 * f64::from(rows)) * FLOOR_CELL_M;
        let is_free = TABLES_M.iter().all(|table| {
            let reach = [0.5 * TABLE_M.x + 0.35, 0.5 * TABLE_M.z + 0.35];
            (table[0] - x).abs() > reach[0] || (table[1] - z).abs() > reach[1]
        });
        // Where the cameras stand nothing does.
        if is_free && z < room.max.z - 1.2 {
            cells.push(Cell { at: dvec3(x, 0.0, z), side_m: 0.86 * FLOOR_CELL_M });
        }
    }
    cells
}
