//! What is at the office's walls: window and blinds, door, board, clock, pictures, sideboard.

use glam::{DAffine3, DVec2, DVec3, dvec2, dvec3};

use crate::sampling::pcg::Pcg32;
use crate::scene::procedural::assembly::Assembly;
use crate::scene::procedural::office::furniture::{basket, tray};
use crate::scene::procedural::office::materials::Materials;
use crate::scene::procedural::patch::{Detail, Patch, around_y, bent, moved, placed, sin_cos_turns};
use crate::scene::procedural::room::{Room, SUNK_M, Window, standing, stood};
use crate::scene::procedural::shapes::{Curve, Mapping, cuboid, cuboid_of, face, tube, turned};
use crate::scene::procedural::solids::{chamfered, pierced};
use crate::scene::procedural::wares::{between, leaves, pot, turning};

/// Where the door is in the far wall, from the left one.
const DOOR_M: [f64; 2] = [0.4, 1.26];
const DOOR_HEIGHT_M: f64 = 2.05;

fn solid(low: DVec3, high: DVec3) -> Vec<Patch> {
    cuboid(low, high, 0.6, Detail::COARSE)
}

/// The frame, the sill, the screen that closes the hole, and blinds of `slats` slats each before it, from the left
/// one (as seen from outside the room, along z) on.
pub fn window(assembly: &mut Assembly, materials: &Materials, room: &Room, window: Window, slats: u32) {
    let wall = room.max.x;
    let Window { z_m: [near, far], y_m: [sill, head] } = window;
    let pane =
        solid(dvec3(wall + 0.16, sill - 0.01, near - 0.01), dvec3(wall + room.wall_m - 0.01, head + 0.01, far + 0.01));
    assembly.fixed("dusk", materials.dusk, &pane);
    // Two casements, each a frame with a bar across.
    let middle = 0.5 * (near + far);
    let mut frame = Vec::new();
    for [from, to] in [[near - 0.005, middle + 0.002], [middle + 0.006, far + 0.005]] {
        // The frame's own x is the room's z.
        let outer = [dvec2(from, sill - 0.005), dvec2(to, head + 0.005)];
        let rim = DVec2::splat(0.055);
        let place = DAffine3::from_translation(dvec3(wall + 0.11, 0.0, 0.0)) * around_y(-0.25);
        frame.extend(placed(pierced(outer, [outer[0] + rim, outer[1] - rim], 0.04, 0.6), place));
        let y = sill + 0.62 * (head - sill);
        frame.extend(solid(dvec3(wall + 0.118, y, from + 0.05), dvec3(wall + 0.142, y + 0.03, to - 0.05)));
    }
    let [low, high] = [dvec3(wall - 0.035, sill - 0.03, near - 0.06), dvec3(wall + 0.112, sill + 0.004, far + 0.06)];
    frame.extend(chamfered(low, high, 0.003, 0.6));
    assembly.fixed("window_frame", materials.lacquer, &frame);

    let count = ((far - near) / 1.3).round().max(1.0) as u32;
    let width = (far - near + 0.12) / f64::from(count);
    for index in 0..count {
        let from = near - 0.06 + width * f64::from(index);
        let span = [from + 0.006, from + width - 0.006];
        // Every second one is half way up.
        let down = if index % 2 == 0 { 0.55 } else { 1.0 };
        let [slats, rails] = blind(span, [head + 0.05, sill - 0.1], slats, down);
        let shift = dvec3(wall - 0.055, 0.0, 0.0);
        let moved = |patches| moved(patches, shift).collect::<Vec<_>>();
        assembly.fixed("blind_slats", materials.slats, &moved(slats));
        assembly.fixed("blind_rails", materials.lacquer, &moved(rails));
    }
}

/// Slats and what holds them, at x = 0, seen from -x: where along z, from which height to which, and how far it is let
/// down, 0 to 1; the slats that are not lie on the lowest rail.
fn blind([from, to]: [f64; 2], [top, foot]: [f64; 2], count: u32, down: f64) -> [Vec<Patch>; 2] {
    const RAIL_M: f64 = 0.035;
    const STACKED_M: f64 = 0.0035;
    let pitch = (top - RAIL_M - foot) / f64::from(count);
    let half = 0.58 * pitch;
    let hung = (f64::from(count) * down).round() as u32;
    let stack = f64::from(count - hung) * STACKED_M;
    let lowest = top - RAIL_M - pitch * f64::from(hung) - stack;
    let slat = |y: f64, turns: f64| {
        let (sine, cosine) = sin_cos_turns(turns);
        let flat = cuboid_of(dvec3(-half, -0.0005, from), dvec3(half, 0.0005, to), 0.6, [2, 1, 1]);
        bent(flat, move |at| {
            let crowned = at.y + 0.1 * half * (1.0 - at.x * at.x / (half * half));
            dvec3(at.x * cosine - crowned * sine, y + at.x * sine + crowned * cosine, at.z)
        })
    };
    let mut slats = Vec::new();
    for index in 0..hung {
        // The edge toward the room is the higher one.
        slats.extend(slat(top - RAIL_M - pitch * (f64::from(index) + 0.5), -0.07));
    }
    for index in 0..count - hung {
        slats.extend(slat(lowest + 0.004 + STACKED_M * f64::from(index), 0.0));
    }
    let mut rails = solid(dvec3(-0.022, top - RAIL_M, from - 0.002), dvec3(0.022, top, to + 0.002));
    rails.extend(chamfered(dvec3(-half, lowest - 0.018, from), dvec3(half, lowest, to), 0.003, 0.6));
    for part in [0.14, 0.86] {
        let z = from + part * (to - from);
        let tape = |x: [f64; 2]| solid(dvec3(x[0], lowest - 0.01, z - 0.009), dvec3(x[1], top - 0.01, z + 0.009));
        rails.extend(tape([-half - 0.0015, -half - 0.0005]));
        rails.extend(tape([half + 0.0005, half + 0.0015]));
    }
    rails.extend(tube(dvec3(-0.03, top - 0.9, from + 0.06), dvec3(-0.03, top - 0.02, from + 0.06), 0.004, 6));
    [slats, rails]
}

/// The door in the far wall. Returns where no skirting goes.
pub fn door(assembly: &mut Assembly, materials: &Materials, room: &Room) -> [f64; 2] {
    let wall = room.min.z;
    let [left, right] = DOOR_M.map(|along| room.min.x + along);
    let head = DOOR_HEIGHT_M;
    let mut frame = Vec::new();
    for [from, to] in [[left - 0.07, left], [right, right + 0.07]] {
        frame.extend(chamfered(dvec3(from, -SUNK_M, wall - 0.01), dvec3(to, head + 0.004, wall + 0.03), 0.004, 0.6));
    }
    let [low, high] = [dvec3(left - 0.075, head, wall - 0.012), dvec3(right + 0.075, head + 0.075, wall + 0.034)];
    frame.extend(chamfered(low, high, 0.004, 0.6));
    frame.extend(solid(dvec3(left - 0.01, 0.004, wall - 0.008), dvec3(right + 0.01, head + 0.01, wall + 0.012)));
    for [from, to] in [[0.12, 0.92], [1.06, 1.92]] {
        for [x0, x1] in [[0.1, 0.4], [0.46, 0.76]] {
            let [low, high] = [dvec3(left + x0, from, wall + 0.01), dvec3(left + x1, to, wall + 0.02)];
            frame.extend(chamfered(low, high, 0.0045, 0.6));
        }
    }
    assembly.fixed("door", materials.lacquer, &frame);
    let at = dvec3(right - 0.06, 1.0, wall + 0.01);
    let mut handle = tube(at, at + DVec3::Z * 0.05, 0.009, 10);
    handle.extend(tube(at + dvec3(0.008, 0.0, 0.045), at + dvec3(-0.11, 0.0, 0.045), 0.008, 10));
    handle.extend(tube(at - DVec3::Z * 0.003, at + DVec3::Z * 0.008, 0.024, 16));
    assembly.fixed("door_handle", materials.steel, &handle);
    [left - 0.07 + SUNK_M, right + 0.07 - SUNK_M]
}

/// What the left wall has: a board with notes over a sideboard, and a clock; and plants and a basket.
pub fn left_wall(assembly: &mut Assembly, materials: &Materials, room: &Room, random: &mut Pcg32) {
    // Everything is made as before the far wall and turned to the left one: own x is -z, own z is x.
    let wall = DAffine3::from_translation(dvec3(room.min.x, 0.0, 0.4)) * around_y(0.25);
    let mut put = |name: &str, material: usize, patches: Vec<Patch>| {
        assembly.fixed(name, material, &placed(patches, wall).collect::<Vec<_>>());
    };
    let outer = [dvec2(-0.7, 1.2), dvec2(0.7, 2.05)];
    let rim = DVec2::splat(0.03);
    let board = pierced(outer, [outer[0] + rim, outer[1] - rim], 0.026, 0.6);
    put("board_frame", materials.oak, moved(board, DVec3::Z * 0.024).collect());
    put("board", materials.cork, solid(dvec3(-0.69, 1.21, -SUNK_M), dvec3(0.69, 2.04, 0.014)));
    let mut notes = [Vec::new(), Vec::new()];
    for index in 0..9_u32 {
        let (column, row) = (f64::from(index % 5), f64::from(index / 5));
        let size = dvec2(between(random, 0.12, 0.2), between(random, 0.14, 0.27)) * 0.5;
        let shift = dvec3(-0.54 + 0.265 * column + between(random, -0.03, 0.03), 1.83 - 0.37 * row, 0.0);
        let depth = 0.0155 + 0.0006 * f64::from(index);
        let note = solid(dvec3(-size.x, -size.y, 0.013), dvec3(size.x, size.y, depth));
        let (sine, cosine) = sin_cos_turns(between(random, -0.012, 0.012));
        let turn = DAffine3::from_cols(dvec3(cosine, sine, 0.0), dvec3(-sine, cosine, 0.0), DVec3::Z, shift);
        notes[usize::from(random.below(4) == 0)].extend(placed(note, turn));
    }
    let [white, colored] = notes;
    put("notes", materials.paper, white);
    if !colored.is_empty() {
        put("coloured_notes", materials.covers[3], colored);
    }

    let mut sideboard = chamfered(dvec3(-0.8, 0.08, SUNK_M), dvec3(0.8, 0.72, 0.4), 0.003, 0.8);
    for [from, to] in [[-0.79, -0.27], [-0.263, 0.263], [0.27, 0.79]] {
        sideboard.extend(chamfered(dvec3(from, 0.1, 0.39), dvec3(to, 0.7, 0.418), 0.003, 0.8));
    }
    sideboard.extend(chamfered(dvec3(-0.81, 0.718, -SUNK_M), dvec3(0.81, 0.745, 0.43), 0.003, 0.8));
    for x in [-0.72, 0.72] {
        for z in [0.06, 0.34] {
            sideboard.extend(tube(dvec3(x, -SUNK_M, z), dvec3(x, 0.09, z), 0.02, 10));
        }
    }
    put("sideboard", materials.oak, sideboard);
    let knobs = [-0.32, 0.2, 0.33].map(|x| tube(dvec3(x, 0.42, 0.41), dvec3(x, 0.42, 0.44), 0.012, 10));
    put("knobs", materials.charcoal, knobs.into_iter().flatten().collect());
    put("letter_tray", materials.charcoal, stood(tray(), 0.02, dvec3(-0.5, 0.745, 0.21)).collect());
    put(
        "flower_pot",
        materials.china,
        stood(pot([0.07, 0.095], 0.15, 0.006, 24), 0.0, dvec3(0.52, 0.745, 0.2)).collect(),
    );
    let earth = tube(dvec3(0.52, 0.855, 0.2), dvec3(0.52, 0.875, 0.2), 0.085, 16);
    put("flower_soil", materials.soil, earth);
    put("flower", materials.leaf, stood(leaves(10, 0.3, random), 0.0, dvec3(0.52, 0.87, 0.2)).collect());

    let forward = DAffine3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y, dvec3(1.25, 1.95, 0.0));
    let rim = Curve::lines(&[[0.0, -SUNK_M], [0.15, -SUNK_M], [0.15, 0.03], [0.138, 0.03], [0.138, 0.02], [0.0, 0.02]]);
    put("clock", materials.charcoal, placed(turned(&rim, turning(32, 1.0)), forward).collect());
    let dial = Curve::lines(&[[0.0, 0.019], [0.139, 0.019], [0.137, 0.0215], [0.0, 0.0215]]);
    put("dial", materials.paper, placed(turned(&dial, turning(32, 1.0)), forward).collect());
    let hands = [([0.0, 0.07], 0.02), ([0.05, -0.035], 0.024)].map(|([x, y], depth)| {
        let from = dvec3(1.25, 1.95, depth);
        tube(from, from + dvec3(x, y, 0.001), 0.004, 6)
    });
    put("hands", materials.charcoal, hands.into_iter().flatten().collect());
}

/// A picture at the far wall, over what stands there, around `at`.
pub fn picture(assembly: &mut Assembly, materials: &Materials, at: DVec3, size_m: DVec2) {
    let half = 0.5 * size_m;
    let rim = DVec2::splat(0.025);
    let frame = moved(pierced([-half, half], [rim - half, half - rim], 0.03, 0.6), at + DVec3::Z * 0.028);
    assembly.fixed("picture_frame", materials.oak, &frame.collect::<Vec<_>>());
    let canvas = half - 0.9 * rim;
    let mut sheet = solid(at - canvas.extend(SUNK_M), at + canvas.extend(0.01));
    // Its picture once over its front, in place of the box's own repeats.
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corners = corners.map(|[x, y]| at + dvec3(x * canvas.x, y * canvas.y, 0.01));
    sheet[4] = face(corners, Mapping::Fit, Detail::COARSE);
    assembly.fixed("painting", materials.painting, &sheet);
}

/// A plant in a tub, and a basket for paper.
pub fn on_the_floor(assembly: &mut Assembly, materials: &Materials, places: [DVec3; 2], random: &mut Pcg32) {
    let [tub, bin] = places;
    let patches: Vec<Patch> = stood(pot([0.15, 0.2], 0.34, 0.01, 28), 0.0, tub).collect();
    assembly.fixed("tub", materials.clay, &patches);
    assembly.fixed("soil", materials.soil, &tube(tub + DVec3::Y * 0.25, tub + DVec3::Y * 0.29, 0.183, 20));
    let plant: Vec<Patch> = stood(leaves(16, 0.75, random), 0.1, tub + DVec3::Y * 0.28).collect();
    assembly.fixed("plant", materials.leaf, &plant);
    let [basket, balls] = basket(random);
    let mesh = assembly.mesh("basket", materials.charcoal, &basket);
    assembly.draw(mesh, standing(0.0, bin));
    let mesh = assembly.mesh("waste", materials.paper, &balls);
    assembly.draw(mesh, standing(0.0, bin));
}
