//! A hall in the manner of a Roman basilica, seen from inside: a nave of eight bays under a coffered barrel vault, an
//! aisle with groin vaults on each side, lamps and no sun. Closed all round, so that light bounces.
//!
//! z runs along the nave from the stained-glass window (-16 m) to the door (+16 m), x across, the floor is y = 0. What
//! repeats is one mesh drawn many times; the right side is the left one turned by half a turn.
//!
//! A wanted number of triangles is met as `pieces` has it; what is missing goes into the floor of the nave.

mod furniture;
mod layout;
mod materials;
mod structure;
mod vaults;

use glam::{DVec3, Mat4, Vec3, dvec3, vec3};

use self::furniture::Lamps;
use self::materials::Materials;
use super::assembly::Assembly;
use super::pieces::{Piece, count, divided, grid, joined};
use super::shapes::{Mapping, face_of};
use crate::scene::procedural::hall::layout::{Details, LENGTH_M, NAVE_M};
use crate::scene::procedural::values::Values;

/// With fewer the arches would not be round.
pub const LEAST_TRIANGLES: u64 = 5000;

/// Lamps, each with its light.
pub const MOST_LAMPS: u64 = Lamps::MOST;
/// Draws of the whole hall; a sketch has fewer.
pub const MOST_DRAWS: u64 = 437;
/// Pieces that nothing joins: with fewer draws there would be fewer of them.
pub const LEAST_DRAWS: u64 = 60;

/// What a sketch leaves out. The lights of its lamps stay: brightness does not depend on the triangles.
const ORNAMENTS: [&str; 17] = [
    "cornice",
    "string_course",
    "rosettes",
    "aisle_rib",
    "pilaster",
    "wainscot",
    "nave_crown",
    "nave_rod",
    "aisle_crown",
    "aisle_rod",
    "candelabrum",
    "candelabrum_glass",
    "bench",
    "plinth",
    "copper_urn",
    "blue_urn",
    "veil_rail",
];

fn nave_floor(material: usize, triangles: u64) -> Piece {
    let width_m = 2.0 * (NAVE_M + 0.05);
    let [columns, rows] = grid([width_m, LENGTH_M], triangles);
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]
        .map(|[x, z]| dvec3(x * width_m * 0.5, 0.0, z * LENGTH_M * 0.5));
    let floor = face_of(corners, Mapping::Repeat { tile_m: 3.7 }, columns, rows);
    Piece { name: "nave_floor", material, patches: vec![floor], places: vec![Mat4::IDENTITY] }
}

/// All pieces, with `wanted` triangles within 5 %, in at most `most_draws`.
fn plan(materials: &Materials, wanted: u64, lamps: &Lamps, most_draws: u64) -> Vec<Piece> {
    let all_but_floor = |edge_m: f64| {
        let details = Details::new(edge_m);
        let mut pieces = structure::pieces(materials, details);
        pieces.extend(vaults::pieces(materials, details));
        pieces.extend(furniture::pieces(materials, details, lamps));
        pieces.retain(|piece| !(details.sketch && ORNAMENTS.contains(&piece.name)));
        pieces
    };
    // The floor should have its share: about a twentieth of what is seen.
    let mut pieces = divided(wanted - wanted / 20, [0.005, 100.0], all_but_floor);
    let rest = wanted.saturating_sub(count(&pieces));
    pieces.push(nave_floor(materials.floor, rest));
    joined(pieces, most_draws)
}

/// How many triangles the hall has when `wanted` are asked for.
#[cfg(test)]
pub fn planned_triangle_count(wanted: u64) -> u64 {
    count(&plan(&Materials::default(), wanted, &Lamps::new(17), MOST_DRAWS))
}

/// The hall for `triangles`; the seed chooses the grain of its stones.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let materials = materials::add(&mut assembly, seed as u32);
    let lamps = Lamps::new(values.get("lights") as usize);
    for piece in plan(&materials, values.get("triangles"), &lamps, values.get("draws")) {
        let mesh = assembly.mesh(piece.name, piece.material, &piece.patches);
        for place in piece.places {
            assembly.draw(mesh, place);
        }
    }
    lights(&mut assembly, lamps);
    for (name, eye, target, y_fov) in [
        ("nave", dvec3(-2.5, 1.75, 13.3), dvec3(0.75, 3.2, -3.0), 1.0),
        ("aisle", dvec3(-6.9, 1.7, 14.4), dvec3(-5.2, 2.2, 0.0), 0.95),
        ("dais", dvec3(2.7, 2.0, 2.6), dvec3(-0.4, 1.3, -3.4), 0.8),
        ("vault", dvec3(1.6, 1.2, 9.0), dvec3(-0.8, 8.6, -2.0), 1.05),
        ("column", dvec3(-1.7, 2.6, 5.9), dvec3(-4.6, 3.9, 3.2), 0.85),
        // A candelabrum at arm's length, the window thirteen metres behind it: for a lens out of focus.
        ("candelabrum", dvec3(-3.3, 1.74, 1.1), dvec3(0.1, 1.95, -6.0), 0.85),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    assembly
}

/// Every lamp has its light a little outside of its glass, which would else stand in the way of every shadow ray.
fn lights(assembly: &mut Assembly, lamps: Lamps) {
    const WARM: Vec3 = vec3(1.0, 0.74, 0.44);
    for (kind, places, below_m, candela) in [
        ("nave_lamp", lamps.nave, 0.4, 38.0),
        ("aisle_lamp", lamps.aisle, 0.4, 15.0),
        ("candelabrum", lamps.candelabra, -furniture::CANDELABRUM_M - 0.32, 5.0),
    ] {
        for (index, position) in places.into_iter().enumerate() {
            let position = position - DVec3::Y * below_m;
            assembly.point_light(format!("{kind}_{index}"), position.as_vec3(), WARM * candela, None);
        }
    }
}
