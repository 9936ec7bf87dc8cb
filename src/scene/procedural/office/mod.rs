//! An office in the evening: two panels below the ceiling are all its light. Desks face each other in fours, blinds
//! hang before the window, shelves stand at a wall whose colour the others take up. After the Office of Dubla,
//! Debattista and Chalmers 2009, figure 6, made anew: soft shadows narrow and wide, and corners that only other
//! surfaces light.
//!
//! x runs from the left wall to the window, z from the wall with door and shelves to the one behind the camera, the
//! middle of the floor is the origin; metres.

mod furniture;
mod materials;
mod walls;

use glam::{DVec3, Vec3, dvec2, dvec3, vec3};

use self::furniture::{DESK_M, Loose, Meshes, shelves};
use self::materials::Materials;
use super::assembly::Assembly;
use super::patch::moved;
use super::room::{Panel, Room, SUNK_M, Window};
use super::wares::between;
use crate::sampling::pcg::Pcg32;
use crate::scene::Medium;
use crate::scene::procedural::values::Values;

/// Desks of a group: two by the window, two beside them.
const GROUP: u32 = 4;
/// Length of the room that a group takes, and what is left for door, shelves and the way around.
const GROUP_M: f64 = 3.2;
const WAYS_M: f64 = 2.2;
const WIDTH_M: f64 = 5.4;
const HEIGHT_M: f64 = 2.7;

/// White that reflects the light of a neutral lamp, so that a desk is bright and no wall is burnt out at exposure 0.
const PANEL_RADIANCE: Vec3 = vec3(30.0, 28.5, 26.0);

/// Light that crosses the room loses a third: lamps have halos and shadows show in the air, and the far wall is seen.
/// As small drops do, it scatters forward.
const SMOKE: Medium = Medium { scattering: 0.08, absorption: 0.005, asymmetry: 0.3 };

/// The scene for `desks`, blinds of `slats`, with smoke or without; the seed chooses what lies on desks and stands in
/// shelves.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let (desks, slats) = (values.get("desks") as u32, values.get("slats") as u32);
    let mut random = Pcg32::new(seed, 7);
    let mut assembly = Assembly::default();
    let materials = Materials::add(&mut assembly, seed as u32);
    assembly.scene.medium = (values.get("smoke") == 1).then_some(SMOKE);
    let groups = desks.div_ceil(GROUP);
    let room = Room::new(dvec3(WIDTH_M, HEIGHT_M, WAYS_M + GROUP_M * f64::from(groups)), 0.22);
    let window = Window { z_m: [room.min.z + 1.1, room.max.z - 1.7], y_m: [0.92, 2.28] };
    room.build(&mut assembly, materials.walls, Some(window));
    for (name, part) in [("far_panel", -0.25), ("near_panel", 0.25)] {
        let panel =
            Panel { size_m: [0.4, 1.2 * f64::from(groups)], radiance: PANEL_RADIANCE, frame: materials.lacquer };
        room.ceiling_panel(&mut assembly, name, [0.35, part * (room.max.z - room.min.z)], panel);
    }
    walls::window(&mut assembly, &materials, &room, window, slats);
    let door = walls::door(&mut assembly, &materials, &room);
    assembly.fixed("skirting", materials.lacquer, &room.skirting(0.09, &[door]));
    walls::left_wall(&mut assembly, &materials, &room, &mut random);

    let mut loose = Loose::default();
    fill_shelves(&mut assembly, &materials, &mut loose, &room, &mut random);
    let meshes = Meshes::add(&mut assembly, &materials);
    for desk in 0..desks {
        let middle = room.min.z + 0.77 * GROUP_M + GROUP_M * f64::from(desk / GROUP);
        let (is_near, is_left) = (desk % 2 == 0, desk % GROUP >= 2);
        let [side, turns] = if is_near { [1.0, 0.0] } else { [-1.0, 0.5] };
        let x = room.max.x - 0.95 - if is_left { DESK_M.x + 0.015 } else { 0.0 };
        let at = dvec3(x, 0.0, middle + side * (0.5 * DESK_M.z + 0.01));
        meshes.desk(&mut assembly, &mut loose, turns, at, &mut random);
        let away = between(&mut random, 0.38, 0.56);
        let aside = between(&mut random, -0.12, 0.12);
        meshes.chair(&mut assembly, turns + between(&mut random, -0.07, 0.07), at + dvec3(aside, 0.0, side * away));
    }
    loose.add(&mut assembly, &materials);
    let tub = dvec3(room.max.x - 0.42, 0.0, room.min.z + 0.4);
    let bin = dvec3(-0.78, 0.0, room.min.z + 0.77 * GROUP_M + 0.45);
    walls::on_the_floor(&mut assembly, &materials, [tub, bin], &mut random);

    let back = room.max.z;
    for (name, eye, target, y_fov) in [
        ("room", dvec3(-2.2, 1.62, back - 0.3), dvec3(0.75, 0.9, back - 3.7), 0.8),
        ("window", dvec3(0.55, 1.42, back - 1.0), dvec3(2.3, 1.02, back - 2.9), 0.8),
        ("door", dvec3(2.2, 1.7, back - 0.35), dvec3(-1.3, 0.95, room.min.z + 0.9), 0.9),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    assembly
}

/// The shelves at the far wall, what is in them, and a picture beside them.
fn fill_shelves(assembly: &mut Assembly, materials: &Materials, loose: &mut Loose, room: &Room, random: &mut Pcg32) {
    let corner = dvec3(-0.85, -SUNK_M, room.min.z);
    let (case, rows) = shelves(dvec3(1.7, 1.6, 0.3), 2, 4);
    assembly.fixed("shelves", materials.oak, &moved(case, corner).collect::<Vec<_>>());
    for row in rows {
        loose.row(&row.moved(corner), random);
    }
    let beside = DVec3::new(room.max.x - 0.72, 1.62, room.min.z);
    walls::picture(assembly, materials, beside, dvec2(0.62, 0.8));
}
