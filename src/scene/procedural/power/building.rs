//! The hall itself: walls with tall windows, columns, trusses, roof, the crane and its rails, the catwalk.

use glam::{DAffine3, DMat3, DVec3, Mat4, dvec2, dvec3};

use crate::scene::procedural::assembly::place;
use crate::scene::procedural::patch::{Detail, Patch, Point, moved, placed, sin_cos_turns};
use crate::scene::procedural::pieces::Piece;
use crate::scene::procedural::power::layout::{
    BACK_M, BAY_M, Details, EAVES_M, FRONT_M, HALF_WIDTH_M, Materials, at, bays,
};
use crate::scene::procedural::shapes::{
    Curve, Mapping, Opening, Turning, WallExtent, bar, cuboid, face, pane, pierced_face, reveal, sphere, tube, turned,
};

const WINDOW: Opening = Opening { radius_m: 1.0, sill_m: 2.2, springing_m: 6.6 };
const GREAT_WINDOW: Opening = Opening { radius_m: 3.6, sill_m: 3.0, springing_m: 6.2 };
const RECESS_M: f64 = 0.4;
/// Height of the catwalk along the right wall, and the middle of it.
const CATWALK_M: f64 = 3.3;
const CATWALK_X_M: f64 = HALF_WIDTH_M - 1.0;

/// Everything that is built in but the floor.
pub fn pieces(materials: &Materials, details: Details) -> Vec<Piece> {
    let mut pieces = walls(materials, details);
    pieces.extend(roof(materials, details));
    pieces.extend(crane(materials, details));
    pieces.extend(catwalk(materials, details));
    pieces
}

/// Both side walls, for pieces that face +z in their own space.
fn both_sides(x_m: f64) -> Vec<Mat4> {
    let one = |z: f64| [-1.0, 1.0].map(|side| place([-side, 0.0], 1.0, dvec3(side * x_m, 0.0, z)));
    bays().flat_map(one).collect()
}

fn walls(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, broad } = details;
    let bay = WallExtent { half_width_m: 0.5 * BAY_M, bottom_m: 0.0, top_m: EAVES_M };
    let mut wall = pierced_face(bay, WINDOW, 1.6, broad);
    wall.extend(reveal(WINDOW, RECESS_M, 1.6, broad));
    // Panes between bars: the bars are laid over one sheet.
    let mut bars = Vec::new();
    let top_m = WINDOW.springing_m + WINDOW.radius_m;
    for x in [-0.34, 0.34] {
        bars.extend(cuboid(dvec3(x - 0.03, WINDOW.sill_m, -0.36), dvec3(x + 0.03, top_m, -0.3), 0.5, Detail::COARSE));
    }
    for row in 0..6 {
        let y = WINDOW.sill_m + 0.9 * f64::from(row);
        bars.extend(cuboid(dvec3(-1.0, y - 0.03, -0.36), dvec3(1.0, y + 0.03, -0.3), 0.5, Detail::COARSE));
    }
    let end = WallExtent { half_width_m: HALF_WIDTH_M, bottom_m: 0.0, top_m: EAVES_M + 2.6 };
    let mut end_wall = pierced_face(end, GREAT_WINDOW, 1.6, broad);
    end_wall.extend(reveal(GREAT_WINDOW, RECESS_M, 1.6, broad));
    let mut end_bars = Vec::new();
    for index in 0..7 {
        let x = f64::from(index) - 3.0;
        end_bars.extend(bar(dvec3(x, GREAT_WINDOW.sill_m, -0.33), dvec3(x, 9.75 - 0.28 * x * x, -0.33), 0.045));
    }
    for row in 0..5 {
        let y = GREAT_WINDOW.sill_m + f64::from(row);
        end_bars.extend(bar(dvec3(-3.6, y, -0.33), dvec3(3.6, y, -0.33), 0.045));
    }
    let end_place = || vec![place([0.0, 1.0], 1.0, dvec3(0.0, 0.0, BACK_M))];
    // A rolled column: two flanges and a web, riveted.
    let mut column = cuboid(dvec3(-0.2, 0.0, 0.0), dvec3(0.2, EAVES_M, 0.04), 1.0, broad);
    column.extend(cuboid(dvec3(-0.02, 0.0, 0.04), dvec3(0.02, EAVES_M, 0.34), 1.0, broad));
    column.extend(cuboid(dvec3(-0.2, 0.0, 0.34), dvec3(0.2, EAVES_M, 0.38), 1.0, broad));
    column.extend(cuboid(dvec3(-0.32, 0.0, 0.0), dvec3(0.32, 0.3, 0.5), 1.0, broad));
    for row in 0..12 {
        for side in [-0.13, 0.13] {
            let rivet = sphere(0.028, fine.along(0.16, 4).min(8));
            column.extend(moved(rivet, dvec3(side, 0.6 + 0.72 * f64::from(row), 0.38)));
        }
    }
    let columns = || {
        let lines = bays().map(|z| z - 0.5 * BAY_M);
        lines
            .flat_map(|z| [-1.0, 1.0].map(|side| place([-side, 0.0], 1.0, dvec3(side * HALF_WIDTH_M, 0.0, z))))
            .collect()
    };
    let behind = |opening: Opening| moved(pane(opening, broad), DVec3::Z * (0.02 - RECESS_M)).collect::<Vec<_>>();
    vec![
        Piece { name: "wall", material: materials.brick, patches: wall, places: both_sides(HALF_WIDTH_M) },
        Piece { name: "window", material: materials.pane, patches: behind(WINDOW), places: both_sides(HALF_WIDTH_M) },
        Piece { name: "window_bars", material: materials.steel, patches: bars, places: both_sides(HALF_WIDTH_M) },
        Piece { name: "column", material: materials.green, patches: column, places: columns() },
        Piece { name: "end_wall", material: materials.brick, patches: end_wall, places: end_place() },
        Piece { name: "great_window", material: materials.pane, patches: behind(GREAT_WINDOW), places: end_place() },
        Piece { name: "great_bars", material: materials.steel, patches: end_bars, places: end_place() },
    ]
}

fn roof(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { broad, .. } = details;
    let ridge_m = EAVES_M + 2.4;
    let side = |x: f64, y: f64| dvec3(x, y, 0.0);
    let mut truss = Vec::new();
    truss.extend(bar(side(-HALF_WIDTH_M, EAVES_M), side(HALF_WIDTH_M, EAVES_M), 0.09));
    for half in [-1.0, 1.0] {
        truss.extend(bar(side(half * HALF_WIDTH_M, EAVES_M), side(0.0, ridge_m), 0.1));
        for step in 1..4 {
            let x = |index: f64| half * HALF_WIDTH_M * (1.0 - index / 4.0);
            let y = |index: f64| EAVES_M + (ridge_m - EAVES_M) * index / 4.0;
            let index = f64::from(step);
            truss.extend(bar(side(x(index), EAVES_M), side(x(index), y(index)), 0.05));
            truss.extend(bar(side(x(index), EAVES_M), side(x(index - 1.0), y(index - 1.0) + 0.01), 0.045));
        }
    }
    truss.extend(bar(side(0.0, EAVES_M), side(0.0, ridge_m), 0.05));
    // Seen from below. Corrugated: waves along z.
    let slope = |half: f64, from: f64, to: f64| {
        let waves = 8.0;
        let columns = broad.along(16.0, 32);
        Patch::new(columns, broad.along(4.0, 1), move |s, t| {
            // Facing down: s runs toward the front on the right side, toward the back on the left.
            let along = half * (s - 0.5) * BAY_M;
            let across = from + (to - from) * t;
            let (sine, _) = sin_cos_turns(waves * s);
            let y = EAVES_M + 0.2 + (ridge_m - EAVES_M) * (1.0 - across) + 0.05 * sine;
            Point {
                position: dvec3(half * across * HALF_WIDTH_M, y, along),
                uv: dvec2(4.0 * s, -9.0 * t * (from - to)) / 2.0,
            }
        })
    };
    // From the eaves up to the light strip, and from there to the ridge.
    let sheets: Vec<Patch> =
        [-1.0, 1.0].into_iter().flat_map(|half| [slope(half, 1.02, 0.5), slope(half, 0.28, 0.0)]).collect();
    let strip = |half: f64| {
        let corner = |across: f64, z: f64| {
            dvec3(half * across * HALF_WIDTH_M, EAVES_M + 0.28 + (ridge_m - EAVES_M) * (1.0 - across), z)
        };
        let (front, back) = (-0.5 * BAY_M * half, 0.5 * BAY_M * half);
        face(
            [corner(0.5, front), corner(0.5, back), corner(0.28, back), corner(0.28, front)],
            Mapping::Repeat { tile_m: 1.0 },
            broad,
        )
    };
    let strips = [-1.0, 1.0].map(strip).into();
    let over_bays = || at(bays().map(|z| DVec3::Z * z));
    vec![
        Piece {
            name: "truss",
            material: materials.steel,
            patches: truss,
            places: at(bays().map(|z| DVec3::Z * (z - 0.5 * BAY_M))),
        },
        Piece { name: "roof_sheet", material: materials.roof, patches: sheets, places: over_bays() },
        Piece { name: "light_strip", material: materials.pane, patches: strips, places: over_bays() },
    ]
}

fn crane(materials: &Materials, details: Details) -> Vec<Piece> {
    const RAIL_M: f64 = 8.3;
    let Details { fine, broad } = details;
    let reach_m = HALF_WIDTH_M - 0.7;
    let mut rail = cuboid(dvec3(-0.12, RAIL_M - 0.35, BACK_M), dvec3(0.12, RAIL_M - 0.1, FRONT_M), 1.0, broad);
    rail.extend(cuboid(dvec3(-0.05, RAIL_M - 0.1, BACK_M), dvec3(0.05, RAIL_M, FRONT_M), 1.0, broad));
    let mut bridge = Vec::new();
    for z in [-0.7, 0.7] {
        bridge.extend(cuboid(
            dvec3(-reach_m, RAIL_M + 0.15, z - 0.12),
            dvec3(reach_m, RAIL_M + 0.75, z + 0.12),
            1.0,
            broad,
        ));
    }
    for x in [-reach_m, reach_m] {
        bridge.extend(cuboid(dvec3(x - 0.25, RAIL_M, -1.1), dvec3(x + 0.25, RAIL_M + 0.3, 1.1), 1.0, broad));
    }
    let drum = Turning { segments: fine.along(1.5, 10), repeats: 2, tile_m: 0.5, detail: fine };
    let profile = Curve::lines(&[
        [0.0, -0.5],
        [0.3, -0.5],
        [0.3, -0.42],
        [0.22, -0.42],
        [0.22, 0.42],
        [0.3, 0.42],
        [0.3, 0.5],
        [0.0, 0.5],
    ]);
    let lying = DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z));
    let on_top = DAffine3::from_translation(DVec3::Y * (RAIL_M + 1.15)) * lying;
    let mut trolley: Vec<Patch> = placed(turned(&profile, drum), on_top).collect();
    trolley.extend(cuboid(dvec3(-0.8, RAIL_M + 0.78, -0.9), dvec3(0.8, RAIL_M + 0.9, 0.9), 1.0, broad));
    let mut hook = Vec::new();
    for x in [-0.12, 0.12] {
        hook.extend(bar(dvec3(x, 5.2, 0.0), dvec3(x, RAIL_M + 1.1, 0.0), 0.018));
    }
    hook.extend(cuboid(dvec3(-0.22, 4.75, -0.1), dvec3(0.22, 5.25, 0.1), 1.0, broad));
    hook.extend(bar(dvec3(0.0, 4.3, 0.0), dvec3(0.0, 4.8, 0.0), 0.05));
    hook.extend(bar(dvec3(0.03, 4.32, 0.0), dvec3(0.26, 4.42, 0.0), 0.05));
    hook.extend(bar(dvec3(0.24, 4.4, 0.0), dvec3(0.26, 4.6, 0.0), 0.04));
    let bridge_z = -9.0;
    vec![
        Piece {
            name: "crane_rail",
            material: materials.steel,
            patches: rail,
            places: at([-reach_m, reach_m].map(|x| DVec3::X * x)),
        },
        Piece { name: "crane_bridge", material: materials.yellow, patches: bridge, places: at([DVec3::Z * bridge_z]) },
        Piece {
            name: "crane_trolley",
            material: materials.red,
            patches: trolley,
            places: at([dvec3(2.4, 0.0, bridge_z)]),
        },
        Piece { name: "crane_hook", material: materials.steel, patches: hook, places: at([dvec3(2.4, 0.0, bridge_z)]) },
    ]
}

fn catwalk(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, broad } = details;
    let half_m = 0.5 * BAY_M;
    // Bars on edge across, two bearers along.
    let mut grating = Vec::new();
    for index in 0..24 {
        let z = (f64::from(index) + 0.5) / 24.0 * BAY_M - half_m;
        grating.extend(cuboid(dvec3(-0.6, -0.05, z - 0.012), dvec3(0.6, 0.0, z + 0.012), 1.0, Detail::COARSE));
    }
    for x in [-0.62, 0.0, 0.56] {
        grating.extend(cuboid(dvec3(x, -0.16, -half_m), dvec3(x + 0.06, -0.01, half_m), 1.0, broad));
    }
    let rail = |from: DVec3, to: DVec3| tube(from, to, 0.026, fine.along(0.16, 5));
    let mut railing = Vec::new();
    for y in [0.55, 1.1] {
        railing.extend(rail(dvec3(-0.58, y, -half_m), dvec3(-0.58, y, half_m)));
    }
    for index in 0..3 {
        let z = (f64::from(index) - 1.0) * 0.98 * half_m;
        railing.extend(rail(dvec3(-0.58, 0.0, z), dvec3(-0.58, 1.1, z)));
    }
    let mut bracket = bar(dvec3(-0.6, -0.2, 0.0), dvec3(0.95, -0.2, 0.0), 0.06);
    bracket.extend(bar(dvec3(-0.5, -0.25, 0.0), dvec3(0.9, -1.5, 0.0), 0.05));
    let mut ladder = Vec::new();
    for z in [-0.24, 0.24] {
        ladder.extend(rail(dvec3(0.0, 0.0, z), dvec3(0.0, CATWALK_M + 1.1, z)));
    }
    for rung in 0..13 {
        let y = 0.25 + 0.25 * f64::from(rung);
        ladder.extend(rail(dvec3(0.0, y, -0.24), dvec3(0.0, y, 0.24)));
    }
    let along = || at(bays().map(|z| dvec3(CATWALK_X_M, CATWALK_M, z)));
    vec![
        Piece { name: "grating", material: materials.steel, patches: grating, places: along() },
        Piece { name: "railing", material: materials.yellow, patches: railing, places: along() },
        Piece { name: "bracket", material: materials.steel, patches: bracket, places: along() },
        Piece {
            name: "ladder",
            material: materials.yellow,
            patches: ladder,
            places: at([7.4, -4.6, -16.6].map(|z| dvec3(CATWALK_X_M - 0.7, 0.0, z))),
        },
    ]
}
