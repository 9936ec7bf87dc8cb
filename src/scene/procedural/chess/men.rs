//! The six men of a game of chess: turned, but for the head of the knight, the cross of the king and the rook's battlements.

use glam::{DVec3, dvec2, dvec3};

use crate::scene::procedural::patch::{Detail, Patch, Point, around_y, moved, placed, sin_cos_turns};
use crate::scene::procedural::shapes::{Curve, Turning, cuboid, sphere, turned, turned_with};

/// Metres of a surface for one repeat of its stone.
const TILE_M: f64 = 0.06;

/// A kind of man.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Man {
    Pawn,
    Rook,
    Knight,
    Bishop,
    Queen,
    King,
}

impl Man {
    /// What the meshes of white and black are called.
    pub fn names(self) -> [&'static str; 2] {
        match self {
            Self::Pawn => ["white_pawns", "black_pawns"],
            Self::Rook => ["white_rooks", "black_rooks"],
            Self::Knight => ["white_knights", "black_knights"],
            Self::Bishop => ["white_bishops", "black_bishops"],
            Self::Queen => ["white_queen", "black_queen"],
            Self::King => ["white_king", "black_king"],
        }
    }

    /// Standing on the origin, looking along +x. Closed, of parts that stand in each other.
    pub fn patches(self, detail: Detail) -> Vec<Patch> {
        match self {
            Self::Pawn => pawn(detail),
            Self::Rook => rook(detail),
            Self::Knight => knight(detail),
            Self::Bishop => bishop(detail),
            Self::Queen => queen(detail),
            Self::King => king(detail),
        }
    }
}

fn turning(detail: Detail) -> Turning {
    Turning { segments: detail.along(0.09, 12), repeats: 2, tile_m: TILE_M, detail }
}

/// From below: a foot of `radius_m` in two steps, and a stem that narrows to `waist_m` at `height_m`.
fn foot(radius_m: f64, waist_m: f64, height_m: f64) -> Vec<Curve> {
    let r = radius_m;
    vec![
        Curve::line([0.0, 0.0], [r, 0.0]),
        Curve::bent([r, 0.0], [1.06 * r, 0.0035], [r, 0.0065]),
        Curve::line([r, 0.0065], [0.88 * r, 0.0075]),
        Curve::bent([0.88 * r, 0.0075], [0.94 * r, 0.011], [0.8 * r, 0.0135]),
        Curve::bent([0.8 * r, 0.0135], [1.05 * waist_m, 0.017], [waist_m, height_m]),
    ]
}

/// A ring around a stem of `stem_m` at `height_m`, 0.003 m high.
fn collar(stem_m: f64, ring_m: f64, height_m: f64) -> [Curve; 2] {
    let middle = height_m + 0.0015;
    [
        Curve::bent([stem_m, height_m], [ring_m, height_m], [ring_m, middle]),
        Curve::bent([ring_m, middle], [ring_m, height_m + 0.003], [stem_m, height_m + 0.003]),
    ]
}

fn ball(radius_m: f64, detail: Detail) -> Vec<Patch> {
    sphere(radius_m, detail.along(6.3 * radius_m, 10))
}

fn pawn(detail: Detail) -> Vec<Patch> {
    let mut profile = foot(0.0145, 0.0058, 0.028);
    profile.extend(collar(0.0058, 0.0115, 0.028));
    profile.push(Curve::line([0.0058, 0.031], [0.0045, 0.033]));
    profile.push(Curve::bent([0.0045, 0.033], [0.0105, 0.034], [0.009, 0.041]));
    profile.push(Curve::bent([0.009, 0.041], [0.008, 0.0485], [0.0, 0.0485]));
    turned(&profile, turning(detail))
}

fn rook(detail: Detail) -> Vec<Patch> {
    let mut profile = foot(0.0165, 0.0095, 0.035);
    profile.extend(collar(0.0095, 0.0125, 0.035));
    profile.extend([
        Curve::bent([0.0095, 0.038], [0.010, 0.042], [0.0135, 0.043]),
        Curve::line([0.0135, 0.043], [0.0138, 0.0505]),
        Curve::line([0.0138, 0.0505], [0.0098, 0.0505]),
        Curve::line([0.0098, 0.0505], [0.0098, 0.047]),
        Curve::line([0.0098, 0.047], [0.0, 0.047]),
    ]);
    let mut patches = turned(&profile, turning(detail));
    for tooth in 0..6 {
        let block = cuboid(dvec3(0.0098, 0.05, -0.004), dvec3(0.0132, 0.0555, 0.004), TILE_M, Detail::COARSE);
        patches.extend(placed(block, around_y(f64::from(tooth) / 6.0)));
    }
    patches
}

fn bishop(detail: Detail) -> Vec<Patch> {
    let mut profile = foot(0.0155, 0.0062, 0.042);
    profile.extend(collar(0.0062, 0.0115, 0.042));
    profile.extend([
        Curve::line([0.0062, 0.045], [0.005, 0.048]),
        Curve::bent([0.005, 0.048], [0.0118, 0.0505], [0.0092, 0.058]),
        Curve::bent([0.0092, 0.058], [0.0075, 0.066], [0.0018, 0.069]),
        Curve::line([0.0018, 0.069], [0.0, 0.0692]),
    ]);
    // The cut in the mitre: a notch on one side of the head.
    let mut patches = turned_with(&profile, turning(detail), |turns, piece, t| {
        if piece != 9 {
            return 1.0;
        }
        let across = (1.0 - ((turns - 0.18) * 9.0) * ((turns - 0.18) * 9.0)).max(0.0);
        let along = (1.0 - ((t - 0.3) * 6.0) * ((t - 0.3) * 6.0)).max(0.0);
        1.0 - 0.3 * across * along
    });
    patches.extend(moved(ball(0.0028, detail), DVec3::Y * 0.0712));
    patches
}

fn queen(detail: Detail) -> Vec<Patch> {
    let mut profile = foot(0.0185, 0.0072, 0.054);
    profile.extend(collar(0.0072, 0.0135, 0.054));
    profile.extend([
        Curve::line([0.0072, 0.057], [0.0068, 0.060]),
        Curve::bent([0.0068, 0.060], [0.008, 0.071], [0.0138, 0.0775]),
        Curve::bent([0.0138, 0.0775], [0.0120, 0.0785], [0.0105, 0.0755]),
        Curve::bent([0.0105, 0.0755], [0.0090, 0.0805], [0.0, 0.0815]),
    ]);
    let crown = profile.len() - 3;
    let segments = turning(detail).segments.max(27).next_multiple_of(9);
    let mut patches = turned_with(&profile, Turning { segments, ..turning(detail) }, move |turns, piece, t| {
        // Nine points that grow toward the rim, on its outside and on its inside.
        let grown = if piece == crown { t * t } else { 1.0 - t };
        if piece == crown || piece == crown + 1 { 1.0 + 0.07 * grown * sin_cos_turns(9.0 * turns).1 } else { 1.0 }
    });
    patches.extend(moved(ball(0.0036, detail), DVec3::Y * 0.0840));
    patches
}

fn king(detail: Detail) -> Vec<Patch> {
    let mut profile = foot(0.0195, 0.0078, 0.060);
    profile.extend(collar(0.0078, 0.0145, 0.060));
    profile.extend([
        Curve::line([0.0078, 0.063], [0.0074, 0.066]),
        Curve::bent([0.0074, 0.066], [0.0085, 0.076], [0.0135, 0.0825]),
        Curve::bent([0.0135, 0.0825], [0.0125, 0.0885], [0.0035, 0.0895]),
        Curve::line([0.0035, 0.0895], [0.0, 0.0897]),
    ]);
    let mut patches = turned(&profile, turning(detail));
    // Knights and kings show their side: the cross lies across x.
    patches.extend(cuboid(dvec3(-0.0014, 0.0885, -0.0016), dvec3(0.0014, 0.1020, 0.0016), TILE_M, Detail::COARSE));
    patches.extend(cuboid(dvec3(-0.0013, 0.0940, -0.0050), dvec3(0.0013, 0.0970, 0.0050), TILE_M, Detail::COARSE));
    patches
}

/// How far the outline of a knight's head is from its middle, in metres, every sixteenth of a turn from its nose upward.
const HEAD_M: [f64; 16] = [
    0.0150, 0.0205, 0.0172, 0.0178, 0.0228, 0.0172, 0.0160, 0.0155, 0.0150, 0.0150, 0.0160, 0.0180, 0.0195, 0.0185,
    0.0140, 0.0098,
];

/// The outline at any angle: Catmull and Rom's spline through the sixteen.
fn outline_m(turns: f64) -> f64 {
    let at = (turns - turns.floor()) * 16.0;
    let (index, u) = (at.floor() as usize, at - at.floor());
    let [a, b, c, d] = [15, 0, 1, 2].map(|step| HEAD_M[(index + step) % 16]);
    b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)))
}

fn knight(detail: Detail) -> Vec<Patch> {
    const MIDDLE_M: f64 = 0.0365;
    let mut profile = foot(0.0165, 0.0125, 0.0215);
    profile.push(Curve::bent([0.0125, 0.0215], [0.0115, 0.0245], [0.0, 0.0250]));
    let mut patches = turned(&profile, turning(detail));
    // Round about the outline, from one cheek (t = 0) to the other; half a turn of t from pole to pole.
    let columns = detail.along(0.12, 32).next_multiple_of(16);
    let head = Patch::new(columns, detail.along(0.035, 10), |s, t| {
        let (sine, cosine) = sin_cos_turns(s);
        let (side, out) = sin_cos_turns(0.5 * t - 0.25);
        let radius = outline_m(s) * out;
        // Thinner toward the ears, thicker in the cheeks.
        let thick = 0.0078 - 0.0016 * sine * out;
        Point { position: dvec3(radius * cosine, MIDDLE_M + radius * sine, thick * side), uv: dvec2(2.0 * s, -0.6 * t) }
    });
    patches.push(head.collapsed(true, true));
    patches
}
