//! A gothic arena: ARENA of Clarberg & Munkberg 2014, table 1 (528,000 triangles, 855 draws, 64 lights with shadows,
//! defocus and motion), made anew. A round of 24 bays in two storeys under a ribbed vault; in its middle an armillary
//! sphere on a stage; crowns of candles, lanterns and gates that move; a camera that flies through it (figure 6).
//!
//! y is up, the floor is y = 0, the middle of the round is the origin; metres. A bay is built in its own space: its wall
//! in the plane z = 0, x along the wall, z toward the middle. What repeats is one mesh drawn many times.

mod building;
mod furniture;
mod gothic;
mod layout;
mod materials;

use glam::{DVec3, Mat4, Vec3, dvec3, vec3};

use self::materials::Materials;
use super::assembly::Assembly;
use super::curves;
use super::patch::sin_cos_turns;
use super::pieces::{Piece, count, divided, grid};
use super::shapes::{Mapping, face_of};
use crate::scene::procedural::arena::layout::{
    Details, LANTERN_M, LANTERN_RADIUS_M, NICHE_M, RADIUS_M, SPHERE, bays, corners, round,
};
use crate::scene::procedural::values::Values;

/// With fewer the arches would not be round.
pub const LEAST_TRIANGLES: u64 = 60_000;

/// All pieces, with `wanted` triangles within 1 %.
fn plan(materials: &Materials, wanted: u64) -> Vec<Piece> {
    let all_but_floor = |edge_m: f64| {
        let details = Details::new(edge_m);
        let mut pieces = building::pieces(materials, details);
        pieces.extend(furniture::pieces(materials, details));
        pieces
    };
    let mut pieces = divided(wanted - wanted / 25, [0.01, 4.0], all_but_floor);
    let half = RADIUS_M + NICHE_M + 0.4;
    let [columns, rows] = grid([half; 2], wanted.saturating_sub(count(&pieces)));
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| dvec3(x * half, 0.0, z * half));
    let patches = vec![face_of(corners, Mapping::Repeat { tile_m: 3.4 }, columns, rows)];
    pieces.push(Piece { name: "pavement", material: materials.pavement, patches, places: vec![Mat4::IDENTITY] });
    pieces
}

/// The scene for `triangles`; the seed chooses the grain of its stones.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let materials = Materials::add(&mut assembly, seed as u32);
    for Piece { name, material, patches, places } in plan(&materials, values.get("triangles")) {
        let mesh = assembly.mesh(name, material, &patches);
        for (index, place) in places.into_iter().enumerate() {
            let (at, order) = (place.w_axis.truncate().as_dvec3(), index as u32);
            let label = format!("{name}_{index}");
            match name {
                "outer_ring" => assembly.turning(name, mesh, at, Vec3::X, 6),
                "middle_ring" => assembly.turning(name, mesh, at, Vec3::Y, 4),
                "inner_ring" => assembly.turning(name, mesh, at, Vec3::Z, 3),
                "crown" | "crown_candles" => assembly.turning(&label, mesh, at, Vec3::Y, 20),
                "lantern_cage" | "lantern_glass" => {
                    // The three on one side rise while the others sink.
                    let reach = [at, at + DVec3::Y * 2.6];
                    let reach = if order.is_multiple_of(2) { reach } else { [reach[1], reach[0]] };
                    assembly.moving(&label, mesh, curves::to_and_fro(reach, 6), None, 6);
                }
                _ if name.ends_with("_gate") => {
                    let period_s = furniture::gate_period_s(name);
                    assembly.moving(
                        name,
                        mesh,
                        curves::to_and_fro([at, at + DVec3::Y * 3.0], period_s),
                        None,
                        period_s,
                    );
                }
                _ => assembly.draw(mesh, place),
            }
        }
    }
    lights(&mut assembly);
    cameras(&mut assembly);
    assembly
}

const WARM: Vec3 = vec3(1.0, 0.68, 0.36);
const MOON: Vec3 = vec3(0.55, 0.70, 1.0);

/// 24 before the piers, 24 in the niches, 8 at the crowns of candles, 8 in the lantern of the vault.
fn lights(assembly: &mut Assembly) {
    let mut spot = |name: String, frame: Mat4, [from, to]: [DVec3; 2], color: Vec3, angles: [f32; 2]| {
        let ends = [from, to].map(|point| frame.as_dmat4().transform_point3(point));
        assembly.spot_light(name, ends, color, angles);
    };
    for (index, frame) in corners().into_iter().enumerate() {
        // From the parapet up along pier, statue and gallery.
        let ends = [dvec3(0.0, 1.25, 3.3), dvec3(0.0, 5.0, 0.3)];
        spot(format!("pier_{index}"), frame, ends, WARM * 34.0, [0.55, 1.0]);
    }
    for (index, frame) in bays().into_iter().enumerate() {
        let color = [vec3(1.0, 0.55, 0.25), MOON][index % 2] * 16.0;
        spot(format!("niche_{index}"), frame, [dvec3(0.0, 4.2, -0.7), dvec3(0.0, 1.2, -2.6)], color, [0.45, 0.95]);
    }
    for (index, frame) in furniture::crown_places().into_iter().enumerate() {
        // Up into the vault.
        spot(format!("crown_{index}"), frame, [dvec3(0.0, 0.5, 0.0), dvec3(0.0, 8.0, -1.0)], WARM * 60.0, [0.6, 1.1]);
    }
    for (index, frame) in round(8, 1.0 / 16.0, LANTERN_RADIUS_M - 0.5, LANTERN_M - 0.6).into_iter().enumerate() {
        let ends = [DVec3::ZERO, dvec3(0.0, SPHERE.y - LANTERN_M, LANTERN_RADIUS_M + 1.5)];
        spot(format!("lantern_{index}"), frame, ends, vec3(1.0, 0.86, 0.70) * 230.0, [0.25, 0.6]);
    }
}

fn cameras(assembly: &mut Assembly) {
    for (name, eye, target, y_fov) in [
        ("floor", dvec3(2.2, 1.7, 10.6), dvec3(-0.6, 4.3, 0.0), 1.0),
        ("gallery", dvec3(-10.2, 7.4, 5.4), dvec3(1.5, 3.4, -1.0), 0.85),
        ("sphere", dvec3(2.6, 2.9, 3.3), dvec3(0.0, 3.6, 0.0), 0.8),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    // Twice around in 24 stretches: low and near the middle, then high along the galleries; between the crowns of candles
    // and the wall, below them farther in.
    let stop = |index: u32, ahead: f64, radius_m: f64, height_m: f64| {
        let (sine, cosine) = sin_cos_turns(f64::from(index) / 12.0 + ahead);
        dvec3(radius_m * sine, height_m, radius_m * cosine)
    };
    let wave = |index: u32| sin_cos_turns(f64::from(index) / 8.0).1;
    let eyes: Vec<DVec3> =
        (0..24).map(|index| stop(index, 0.0, 7.8 + 2.5 * wave(index), 4.3 + 2.7 * wave(index))).collect();
    let targets: Vec<DVec3> = (0..24).map(|index| stop(index, 0.36, 5.0, 3.4 - 1.3 * wave(index))).collect();
    assembly.flying_camera("flight", &eyes, &targets, 0.95);
}
