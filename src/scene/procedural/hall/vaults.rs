//! The hall's ceilings: the coffered barrel over the nave, the groin vaults over the aisles, and their ribs.

use glam::{DAffine3, DVec3, dvec2, dvec3};

use super::materials::Materials;
use crate::scene::procedural::assembly::shifted;
use crate::scene::procedural::hall::layout::{
    BAY_M, Details, NAVE_M, OUTER_M, SPRINGING_M, VAULT_M, bays, column_lines,
};
use crate::scene::procedural::patch::{Detail, Patch, Point, sin_cos_turns};
use crate::scene::procedural::pieces::Piece;
use crate::scene::procedural::shapes::{Curve, Turning, arch, sphere, turned_with};

/// Everything overhead.
pub fn pieces(materials: &Materials, details: Details) -> Vec<Piece> {
    let mut pieces = nave_vault(materials, details);
    pieces.extend(aisle_vaults(materials, details));
    pieces
}

/// A face of the barrel vault between four corners, each z, angle in turns and radius, seen from the axis.
fn vault_face(corners: [[f64; 3]; 4], columns: u32, rows: u32) -> Patch {
    let [a, b, c, d] = corners.map(DVec3::from_array);
    let point = |polar: DVec3| {
        let (sine, cosine) = sin_cos_turns(polar.y);
        dvec3(polar.z * cosine, polar.z * sine, polar.x)
    };
    let width_m = (point(b) - point(a)).length().max((point(c) - point(d)).length());
    let height_m = (point(d) - point(a)).length().max((point(c) - point(b)).length());
    Patch::new(columns, rows, move |s, t| {
        let polar = (a * (1.0 - s) + b * s) * (1.0 - t) + (d * (1.0 - s) + c * s) * t;
        Point { position: point(polar), uv: dvec2(s * width_m, -t * height_m) }
    })
}

/// One coffer between z and angle limits: rims and steps, then the panel.
fn coffer(z: [f64; 2], turns: [f64; 2], steps: u32, detail: Detail) -> Vec<Patch> {
    let turn_m = std::f64::consts::TAU * NAVE_M;
    let columns = detail.along(z[1] - z[0], 1);
    let rows = detail.along((turns[1] - turns[0]) * turn_m, 1);
    let corner = |inset_m: f64, radius_m: f64, [i, j]: [usize; 2]| {
        let inset = [inset_m, -inset_m];
        [z[i] + inset[i], turns[j] + inset[j] / turn_m, radius_m]
    };
    const CORNERS: [[usize; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let mut patches = Vec::new();
    let (mut inset_m, mut radius_m) = (0.0, NAVE_M);
    for step in 0..steps {
        for (wider_m, deeper_m) in [(if step == 0 { 0.13 } else { 0.1 }, 0.0), (0.0, 0.1)] {
            let (inner_m, inner_radius_m) = (inset_m + wider_m, radius_m + deeper_m);
            for side in 0..4 {
                let (from, to) = (CORNERS[side], CORNERS[(side + 1) % 4]);
                let corners = [
                    corner(inset_m, radius_m, from),
                    corner(inset_m, radius_m, to),
                    corner(inner_m, inner_radius_m, to),
                    corner(inner_m, inner_radius_m, from),
                ];
                patches.push(vault_face(corners, if side % 2 == 0 { columns } else { rows }, 1));
            }
            (inset_m, radius_m) = (inner_m, inner_radius_m);
        }
    }
    patches.push(vault_face(CORNERS.map(|at| corner(inset_m, radius_m, at)), columns, rows));
    patches
}

fn nave_vault(materials: &Materials, details: Details) -> Vec<Piece> {
    const RIB_M: f64 = 0.5;
    const ALONG: u32 = 3;
    const AROUND: u32 = 9;
    let Details { fine, middle, .. } = details;
    let length_m = BAY_M - RIB_M;
    let mut vault = Vec::new();
    let mut rosettes = Vec::new();
    // Coffers cost 4000 triangles a step at least: they come when that is a small part of the whole.
    let steps = if middle.edge_m < 0.35 {
        2
    } else if middle.edge_m < 0.65 {
        1
    } else {
        0
    };
    if steps == 0 {
        // From rib to rib and above them: coarse ribs sag and would leave gaps.
        let corners = [[-0.5, 0.0], [0.5, 0.0], [0.5, 0.5], [-0.5, 0.5]].map(|[z, turns]| [z * BAY_M, turns, NAVE_M]);
        vault.push(vault_face(corners, middle.along(BAY_M, 1), middle.along(11.6, 8)));
    }
    for index in 0..if steps > 0 { ALONG * AROUND } else { 0 } {
        let (i, j) = (f64::from(index % ALONG), f64::from(index / ALONG));
        let z = [i, i + 1.0].map(|edge| (edge / f64::from(ALONG) - 0.5) * length_m);
        let turns = [j, j + 1.0].map(|edge| 0.5 * edge / f64::from(AROUND));
        vault.extend(coffer(z, turns, steps, Detail { edge_m: middle.edge_m * 1.5 }));
        // A boss stands in the panel; it is turned around y, and y points to the axis here.
        let profile = [
            Curve::line([0.17, -0.02], [0.17, 0.02]),
            Curve::bent([0.17, 0.02], [0.12, 0.02], [0.08, 0.05]),
            Curve::bent([0.08, 0.05], [0.06, 0.12], [0.0, 0.12]),
        ];
        let segments = fine.along(1.0, 6).next_multiple_of(6);
        let turning = Turning { segments, repeats: 1, tile_m: 0.5, detail: fine };
        let petals = move |turns: f64, _: usize, _: f64| 1.0 + 0.12 * sin_cos_turns(6.0 * turns).1;
        let (sine, cosine) = sin_cos_turns(0.25 * (turns[0] + turns[1]) * 2.0);
        let toward_axis = dvec3(-cosine, -sine, 0.0);
        let place = DAffine3::from_cols(
            toward_axis.cross(DVec3::Z),
            toward_axis,
            DVec3::Z,
            toward_axis * -(NAVE_M + 0.1 * f64::from(steps)) + DVec3::Z * (0.5 * (z[0] + z[1])),
        );
        rosettes.extend(turned_with(&profile, turning, petals).into_iter().map(|patch| patch.moved(place)));
    }
    if rosettes.is_empty() {
        // Without coffers one boss sits on the crown of each bay, so that every hall has the same materials.
        let crown = DAffine3::from_translation(DVec3::Y * NAVE_M);
        rosettes.extend(sphere(0.2, 4).into_iter().map(|patch| patch.moved(crown)));
    }
    let bay_places: Vec<_> = bays().map(|z| shifted(dvec3(0.0, VAULT_M, z))).collect();
    let rib_places = column_lines().map(|z| shifted(dvec3(0.0, VAULT_M, z))).collect();
    let ribs = arch([3.52, 3.95], -0.5 * RIB_M, 0.5 * RIB_M, 14, middle);
    vec![
        Piece { name: "vault", material: materials.vault, patches: vault, places: bay_places.clone() },
        Piece { name: "rosettes", material: materials.rosette, patches: rosettes, places: bay_places },
        Piece { name: "nave_rib", material: materials.rib, patches: ribs, places: rib_places },
    ]
}

/// A groin vault over a square bay: two crossing barrels of radius `r`, seen from below.
fn groin_vault(r: f64, detail: Detail) -> Vec<Patch> {
    let columns = detail.along(std::f64::consts::PI * r, 4);
    let rows = detail.along(0.5 * std::f64::consts::PI * r, 1);
    [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]
        .map(|(sine, cosine): (f64, f64)| {
            Patch::new(columns, rows, move |s, t| {
                let half_m = r * sin_cos_turns(0.25 * t).1;
                let x = half_m * sin_cos_turns(0.5 * s).1;
                let position = dvec3(x, (r * r - x * x).max(0.0).sqrt(), half_m);
                Point { position, uv: dvec2(s * 3.0, -t * 1.5) }
            })
            .collapsed(false, true)
            .moved(DAffine3::from_cols(
                dvec3(cosine, 0.0, -sine),
                DVec3::Y,
                dvec3(sine, 0.0, cosine),
                DVec3::ZERO,
            ))
        })
        .into()
}

fn aisle_vaults(materials: &Materials, details: Details) -> Vec<Piece> {
    let half = 0.5 * BAY_M;
    let aisle_middle_m = OUTER_M - half;
    let overhead = |lines: Vec<f64>| -> Vec<_> {
        let sides = [-aisle_middle_m, aisle_middle_m];
        lines.iter().flat_map(|z| sides.map(|x| shifted(dvec3(x, SPRINGING_M, *z)))).collect()
    };
    let edges = |factor: f64| Detail { edge_m: details.middle.edge_m * factor };
    vec![
        Piece {
            name: "aisle_vault",
            material: materials.aisle_vault,
            patches: groin_vault(half, edges(1.8)),
            places: overhead(bays().collect()),
        },
        Piece {
            name: "aisle_rib",
            material: materials.rib,
            patches: arch([1.82, 2.1], -0.22, 0.22, 8, edges(1.0)),
            places: overhead(column_lines().collect()),
        },
    ]
}
