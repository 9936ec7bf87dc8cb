//! A game of chess under a ring of spots: CHESS of Clarberg & Munkberg 2014, table 1 (46,000 triangles, 19 draws, 16
//! lights with shadows, motion), made anew.
//!
//! Men of one kind and colour are one mesh and one draw; four are meshes of their own and move, so that a shutter blurs
//! them. x runs along the ranks from a to h, z from black's side to white's, the board's top is y = 0, its middle the
//! origin; all in metres, as large as a board for tournaments.

mod men;

use glam::{DAffine3, DVec3, Mat4, Vec3, dvec2, dvec3, vec3};

use super::assembly::{Assembly, Maps};
use super::curves;
use super::patch::{Detail, Patch, Point, around_y, placed, sin_cos_turns};
use super::patterns;
use super::pieces::{Piece, count, divided, grid};
use super::shapes::{Curve, Mapping, Turning, face_of, turned};
use crate::scene::Material;
use crate::scene::procedural::values::Values;
use men::Man;

/// With fewer the men would not be round.
pub const LEAST_TRIANGLES: u64 = 12_000;

const SQUARE_M: f64 = 0.06;
const BOARD_M: f64 = 8.0 * SQUARE_M;
/// Thickness of the board, and height of the table that it lies on.
const BOARD_HEIGHT_M: f64 = 0.03;
const TABLE_HEIGHT_M: f64 = 0.7;

/// The men that stay, by kind: white's squares, black's squares, as in the notation of the game.
const STANDING: [(Man, &str, &str); 6] = [
    (Man::Pawn, "a2 b2 c2 d3 e4 f2 g2 h2", "a7 b7 c7 d6 e5 f7 g7"),
    (Man::Rook, "a1 f1", "a8 f8"),
    (Man::Knight, "c3 g5", "c6"),
    (Man::Bishop, "c1", "c8 e7"),
    (Man::Queen, "", "d8"),
    (Man::King, "g1", "g8"),
];

/// What only the number of triangles needs to be known for stays 0.
#[derive(Default)]
struct Materials {
    white: usize,
    black: usize,
    board: usize,
    frame: usize,
    table: usize,
    studio: usize,
}

fn materials(assembly: &mut Assembly, seed: u32) -> Materials {
    let named = |name: &str| Material { name: name.to_owned(), metallic: 0.0, ..Material::default() };
    let full = |size_px: u32, relief: f32| Maps { size_px, relief: Some(relief), metallic_roughness: true };
    let polished = Maps { size_px: 256, relief: None, metallic_roughness: true };
    let a = assembly;
    Materials {
        white: a.textured(named("ivory"), polished, |at| {
            patterns::marble(at, [0.90, 0.85, 0.74], [0.78, 0.68, 0.52], seed)
        }),
        black: a.textured(named("ebony"), polished, |at| {
            patterns::marble(at, [0.14, 0.10, 0.09], [0.32, 0.19, 0.13], seed ^ 1)
        }),
        board: a.textured(named("squares"), full(512, 0.0015), |at| {
            patterns::checker(at, 8, [[0.84, 0.76, 0.62], [0.36, 0.20, 0.13]], seed ^ 2)
        }),
        frame: a.textured(named("walnut"), full(256, 0.004), |at| {
            patterns::boards(at, [0.24, 0.13, 0.08], [0.42, 0.26, 0.16], seed ^ 3)
        }),
        table: a.textured(named("oak"), full(256, 0.003), |at| {
            patterns::boards(at, [0.44, 0.30, 0.19], [0.62, 0.46, 0.31], seed ^ 4)
        }),
        studio: a.textured(named("paper"), full(256, 0.001), |at| patterns::plaster(at, [0.46, 0.50, 0.56], seed ^ 5)),
    }
}

/// The middle of a square: `e4`.
fn square(name: &str) -> DVec3 {
    let [file, rank] = name.as_bytes() else { panic!("a square is a letter and a digit: {name}") };
    let at = |index: u8| (f64::from(index) - 3.5) * SQUARE_M;
    dvec3(at(file - b'a'), 0.0, -at(rank - b'1'))
}

/// Copies of a man that face the other side, on the squares of a list.
fn on_squares(man: Man, is_white: bool, squares: &str, detail: Detail) -> Vec<Patch> {
    // Knights look along their own +x; those of one colour look at the other, and more to the side.
    let turn = around_y(if is_white { 0.10 } else { -0.40 });
    let copies = squares
        .split_whitespace()
        .map(|name| placed(man.patches(detail), DAffine3::from_translation(square(name)) * turn).collect::<Vec<_>>());
    copies.flatten().collect()
}

/// Everything but the squares of the board.
fn around(materials: &Materials, edge_m: f64) -> Vec<Piece> {
    let detail = Detail { edge_m };
    let once = |name, material, patches| Piece { name, material, patches, places: vec![Mat4::IDENTITY] };
    let mut pieces = Vec::new();
    for (man, white, black) in STANDING {
        let [white_name, black_name] = man.names();
        for (name, material, squares) in [(white_name, materials.white, white), (black_name, materials.black, black)] {
            if !squares.is_empty() {
                pieces.push(once(name, material, on_squares(man, material == materials.white, squares, detail)));
            }
        }
    }
    for (name, man, material) in [
        ("queen_that_moves", Man::Queen, materials.white),
        ("bishop_that_moves", Man::Bishop, materials.white),
        ("knight_that_leaps", Man::Knight, materials.black),
        ("pawn_that_moves", Man::Pawn, materials.black),
    ] {
        pieces.push(once(name, material, man.patches(detail)));
    }
    pieces.push(once("frame", materials.frame, frame(detail)));
    pieces.push(once("table", materials.table, table(detail)));
    pieces.push(once("studio", materials.studio, studio(detail)));
    pieces
}

/// Four mouldings with mitred corners around the squares, and the block that they lie on.
fn frame(detail: Detail) -> Vec<Patch> {
    // From the squares outward: half of the width and height over them.
    let profile = [
        Curve::line([0.240, 0.0], [0.241, 0.002]),
        Curve::line([0.241, 0.002], [0.262, 0.002]),
        Curve::bent([0.262, 0.002], [0.272, 0.001], [0.272, -0.010]),
        Curve::line([0.272, -0.010], [0.276, -0.012]),
        Curve::line([0.276, -0.012], [0.276, -BOARD_HEIGHT_M]),
    ];
    let mut patches = Vec::new();
    for side in 0..4 {
        let turn = around_y(f64::from(side) * 0.25);
        let mut before_m = 0.0;
        for curve in profile {
            let (start_m, length_m) = (before_m, curve.length());
            before_m += length_m;
            let along = detail.along(BOARD_M * 0.2, 2);
            let across = detail.along(length_m * 0.5, 2);
            let patch = Patch::new(along, across, move |s, t| {
                let at = curve.at(1.0 - t);
                let x = (2.0 * s - 1.0) * at.x;
                Point { position: dvec3(x, at.y, at.x), uv: dvec2(start_m + (1.0 - t) * length_m, -x) / 0.3 }
            });
            patches.push(patch.moved(turn));
        }
    }
    patches
}

/// A round top on a turned leg.
fn table(detail: Detail) -> Vec<Patch> {
    let top = -BOARD_HEIGHT_M;
    let profile = [
        Curve::line([0.0, -TABLE_HEIGHT_M], [0.30, -TABLE_HEIGHT_M]),
        Curve::bent([0.30, -TABLE_HEIGHT_M], [0.31, 0.05 - TABLE_HEIGHT_M], [0.07, 0.07 - TABLE_HEIGHT_M]),
        Curve::bent([0.07, 0.07 - TABLE_HEIGHT_M], [0.03, -0.45], [0.08, top - 0.10]),
        Curve::line([0.08, top - 0.10], [0.50, top - 0.03]),
        Curve::bent([0.50, top - 0.03], [0.54, top - 0.03], [0.54, top - 0.014]),
        Curve::bent([0.54, top - 0.014], [0.54, top], [0.52, top]),
    ];
    let detail = Detail { edge_m: detail.edge_m * 6.0 };
    let turning = Turning { segments: detail.along(3.4, 24), repeats: 6, tile_m: 0.5, detail };
    let mut patches = turned(&profile, turning);
    // Boards run straight over the top, not around it.
    let disc = Patch::new(turning.segments, detail.along(0.52, 2), move |s, t| {
        let (sine, cosine) = sin_cos_turns(s);
        let radius = 0.52 * (1.0 - t);
        let position = dvec3(radius * cosine, top, -radius * sine);
        Point { position, uv: dvec2(position.x, position.z) / 0.5 }
    });
    patches.push(disc.collapsed(false, true));
    patches
}

/// Paper all round: a floor that runs up into a wall without an edge.
fn studio(detail: Detail) -> Vec<Patch> {
    const FLOOR_M: f64 = -TABLE_HEIGHT_M;
    // Downward and inward, so that the inside is what is seen.
    let profile = [
        Curve::line([2.2, 2.6], [2.2, 0.3]),
        Curve::bent([2.2, 0.3], [2.2, FLOOR_M], [1.2, FLOOR_M]),
        Curve::line([1.2, FLOOR_M], [0.0, FLOOR_M]),
    ];
    let detail = Detail { edge_m: detail.edge_m * 24.0 };
    turned(&profile, Turning { segments: detail.along(13.8, 24), repeats: 14, tile_m: 1.0, detail })
}

/// All pieces, with `wanted` triangles within 1 %.
fn plan(materials: &Materials, wanted: u64) -> Vec<Piece> {
    let mut pieces = divided(wanted - wanted / 40, [2e-4, 0.05], |edge_m| around(materials, edge_m));
    let [columns, rows] = grid([BOARD_M; 2], wanted.saturating_sub(count(&pieces)));
    let half = 0.5 * BOARD_M;
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| dvec3(x * half, 0.0, z * half));
    let patches = vec![face_of(corners, Mapping::Fit, columns, rows)];
    pieces.push(Piece { name: "squares", material: materials.board, patches, places: vec![Mat4::IDENTITY] });
    pieces
}

/// The scene for `triangles`; the seed chooses the grain of stone and wood.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let materials = materials(&mut assembly, seed as u32);
    for Piece { name, material, patches, .. } in plan(&materials, values.get("triangles")) {
        let mesh = assembly.mesh(name, material, &patches);
        let between = |from: &str, to: &str| [square(from), square(to)];
        match name {
            "queen_that_moves" => {
                assembly.moving("queen", mesh, curves::to_and_fro(between("d1", "h5"), 4), None, 4);
            }
            "bishop_that_moves" => {
                assembly.moving("bishop", mesh, curves::to_and_fro(between("c4", "b3"), 3), None, 3);
            }
            "pawn_that_moves" => {
                assembly.moving("pawn", mesh, curves::to_and_fro(between("h7", "h6"), 2), None, 2);
            }
            "knight_that_leaps" => {
                let [from, to] = between("f6", "d5");
                let above = from.lerp(to, 0.5) + DVec3::Y * 0.09;
                let leap = curves::circuit(&[from, above, to, above], 4);
                assembly.moving("knight", mesh, leap, Some(curves::turns(Vec3::Y, 4)), 4);
            }
            _ => assembly.draw(mesh, Mat4::IDENTITY),
        }
    }
    lights(&mut assembly);
    for (name, eye, target, y_fov) in [
        ("player", dvec3(0.30, 0.30, 0.52), dvec3(0.01, 0.0, 0.0), 0.62),
        ("close", dvec3(0.19, 0.075, 0.33), dvec3(0.0, 0.035, 0.02), 0.7),
        ("above", dvec3(0.0, 0.86, 0.05), DVec3::ZERO, 0.62),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    let ring = |part: u32, radius_m: f64, height_m: f64| {
        let (sine, cosine) = sin_cos_turns(f64::from(part) / 8.0);
        dvec3(radius_m * sine, height_m, radius_m * cosine)
    };
    // Higher and lower in turn, with a look a little before the middle.
    let eyes: Vec<DVec3> = (0..8).map(|part| ring(part, 0.62, 0.2 + 0.16 * f64::from(part % 2))).collect();
    let targets: Vec<DVec3> = (0..8).map(|part| ring(part, 0.06, 0.02)).collect();
    assembly.flying_camera("circling", &eyes, &targets, 0.62);
    assembly
}

/// Twelve spots in a ring, each on its own part of the board, and four for the paper all round.
fn lights(assembly: &mut Assembly) {
    const TONES: [Vec3; 4] =
        [vec3(1.0, 0.82, 0.60), vec3(1.0, 0.93, 0.82), vec3(0.72, 0.84, 1.0), vec3(1.0, 0.70, 0.5)];
    for index in 0..12_u32 {
        let (sine, cosine) = sin_cos_turns(f64::from(index) / 12.0 + 0.04);
        let position = dvec3(0.75 * cosine, 0.85 + 0.08 * f64::from(index % 3), -0.75 * sine);
        // Across the middle, so that shadows run inward and cross.
        let target = dvec3(-0.09 * cosine, 0.0, 0.09 * sine);
        let color = TONES[index as usize % TONES.len()] * 0.8;
        assembly.spot_light(format!("ring_{index}"), [position, target], color, [0.16, 0.34]);
    }
    for index in 0..4_u32 {
        let (sine, cosine) = sin_cos_turns(f64::from(index) * 0.25);
        // From behind the table over it, so that the board stays in the light of the ring.
        let ends = [dvec3(-cosine, 1.9, sine), dvec3(2.2 * cosine, 0.9, -2.2 * sine)];
        assembly.spot_light(format!("paper_{index}"), ends, vec3(0.62, 0.74, 1.0) * 9.0, [0.3, 0.66]);
    }
}
