//! A desk at night, seen closely: the disc in the shade of its lamp is all the light there is. After the Deskar of
//! Dubla, Debattista and Chalmers 2009, figure 6, made anew: many small things, each with a shadow that is sharp
//! where it touches the desk and wide away from it, and a room that the desk lights.
//!
//! x runs along the desk to the right, z from the wall behind it to who sits there, y up; the desk's middle is over the
//! origin; metres.

mod lamp;
mod materials;
mod things;

use glam::{DVec3, dvec3};

use self::materials::{DESK_M, Materials};
use super::assembly::Assembly;
use super::patch::{Detail, Patch};
use super::room::Room;
use super::shapes::{bar, cuboid};
use super::solids::chamfered;
use crate::sampling::pcg::Pcg32;
use crate::scene::procedural::values::Values;

/// The scene with so many small `things` that lie about; the seed chooses which and where.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let mut random = Pcg32::new(seed, 13);
    let mut assembly = Assembly::default();
    let materials = Materials::add(&mut assembly, seed as u32);
    let room = Room { min: dvec3(-1.0, 0.0, -0.46), max: dvec3(1.0, 1.65, 1.15), wall_m: 0.05 };
    room.build(&mut assembly, materials.walls, None);
    assembly.fixed("skirting", materials.lacquer, &room.skirting(0.09, &[]));
    assembly.fixed("desk", materials.oak, &desk());
    lamp::add(&mut assembly, &materials, DESK_M.y);
    things::add(&mut assembly, &materials, values.get("things") as u32, &mut random);
    for (name, eye, target, y_fov) in [
        ("desk", dvec3(0.16, 1.30, 0.95), dvec3(0.03, 0.86, -0.08), 0.76),
        ("close", dvec3(0.30, 0.93, 0.44), dvec3(-0.02, 0.77, 0.0), 0.62),
        ("wide", dvec3(0.85, 1.5, 1.0), dvec3(-0.12, 0.8, -0.12), 0.95),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    assembly
}

/// A top on four legs with an apron, its boards across.
fn desk() -> Vec<Patch> {
    let [w, d] = [0.5 * DESK_M.x, 0.5 * DESK_M.z];
    let under = DESK_M.y - 0.03;
    let mut patches = chamfered(dvec3(-w, under, -d), dvec3(w, DESK_M.y, d), 0.004, 0.5);
    let (x, z) = (w - 0.06, d - 0.06);
    for [i, k] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
        patches.extend(bar(dvec3(i * x, -0.001, k * z), dvec3(i * x, under + 0.01, k * z), 0.028));
    }
    for side in [-1.0, 1.0] {
        let solid = |low: DVec3, high: DVec3| cuboid(low, high, 0.5, Detail::COARSE);
        patches.extend(solid(dvec3(-x, under - 0.09, side * z - 0.01), dvec3(x, under + 0.006, side * z + 0.01)));
        patches.extend(solid(dvec3(side * x - 0.01, under - 0.089, -z), dvec3(side * x + 0.01, under + 0.007, z)));
    }
    patches
}
