//! A power station's hall: POWER of Clarberg & Munkberg 2014, table 1 (111,000 triangles, 286 draws, one light with
//! shadows, defocus), made anew. Valves and pipes at arm's length, turbines and tanks behind, forty metres to the far
//! wall: everything that a lens throws out of focus. Surfaces have a texture of colour and no other, as the paper's.
//!
//! The light is a floodlight in the yard that shines in through the open front, along the hall. z runs from the far wall (-28 m) to the
//! front (+12 m), x across, the floor is y = 0; metres.

mod building;
mod layout;
mod machines;

use glam::{Mat4, dvec3, vec3};

use super::assembly::Assembly;
use super::patch::Detail;
use super::pieces::{Piece, count, divided, grid};
use super::shapes::{Mapping, face_of};
use crate::scene::procedural::power::layout::{BACK_M, Details, FRONT_M, HALF_WIDTH_M, Materials, materials};
use crate::scene::procedural::values::Values;

/// With fewer the pipes would not be round.
pub const LEAST_TRIANGLES: u64 = 30_000;

/// All pieces, with `wanted` triangles within 1 %.
fn plan(materials: &Materials, wanted: u64) -> Vec<Piece> {
    let all_but_floor = |edge_m: f64| {
        let details = Details { fine: Detail { edge_m }, broad: Detail { edge_m: 8.0 * edge_m } };
        let mut pieces = building::pieces(materials, details);
        pieces.extend(machines::pieces(materials, details));
        pieces
    };
    let mut pieces = divided(wanted - wanted / 30, [0.005, 4.0], all_but_floor);
    let length_m = FRONT_M - BACK_M + 6.0;
    let [columns, rows] = grid([2.0 * HALF_WIDTH_M, length_m], wanted.saturating_sub(count(&pieces)));
    let corner = |x: f64, z: f64| dvec3(x * HALF_WIDTH_M, 0.0, z);
    let (near, far) = (BACK_M + length_m, BACK_M);
    let corners = [corner(-1.0, near), corner(1.0, near), corner(1.0, far), corner(-1.0, far)];
    let patches = vec![face_of(corners, Mapping::Repeat { tile_m: 4.0 }, columns, rows)];
    pieces.push(Piece { name: "floor", material: materials.floor, patches, places: vec![Mat4::IDENTITY] });
    pieces
}

/// The scene for `triangles`; the seed chooses grain and stains.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let materials = materials(&mut assembly, seed as u32);
    for Piece { name, material, patches, places } in plan(&materials, values.get("triangles")) {
        let mesh = assembly.mesh(name, material, &patches);
        for place in places {
            assembly.draw(mesh, place);
        }
    }
    // A tower in the yard, so far that near and far are not too unlike, and so low that it reaches under the roof.
    let ends = [dvec3(-2.6, 5.4, 38.0), dvec3(0.4, 4.2, 0.0)];
    assembly.spot_light("floodlight".to_owned(), ends, vec3(1.0, 0.88, 0.70) * FLOODLIGHT_CD, [0.36, 0.48]);
    for (name, eye, target, y_fov) in [
        ("valves", dvec3(0.9, 1.72, 11.4), dvec3(-0.5, 1.95, -6.0), 0.95),
        ("catwalk", dvec3(7.0, 5.0, 7.5), dvec3(-1.5, 1.6, -10.0), 0.9),
        ("crane", dvec3(-5.2, 8.6, 10.5), dvec3(1.0, 2.0, -9.0), 0.85),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    assembly
}

/// White paint at the front that faces it is about white in the picture.
const FLOODLIGHT_CD: f32 = 6500.0;
