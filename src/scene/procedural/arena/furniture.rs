//! What stands, hangs and moves in the arena: the armillary sphere on its stage, statues, banners, crowns of candles,
//! lanterns that rise and sink, gates.

use glam::{DAffine3, DMat3, DVec3, Mat4, dvec2, dvec3};

use super::materials::Materials;
use crate::scene::procedural::arena::layout::{
    Details, GALLERY_M, NICHE_M, RADIUS_M, SPHERE, STAGE_M, bays, corners, round,
};
use crate::scene::procedural::assembly::shifted;
use crate::scene::procedural::patch::{Patch, Point, around_y, moved, placed, sin_cos_turns};
use crate::scene::procedural::pieces::Piece;
use crate::scene::procedural::shapes::{Curve, Turning, bar, cuboid, prism, sphere, torus, turned, turned_with};

/// Height of the flames on the piers.
const SCONCE_M: f64 = 3.9;
/// Where the gates stand: which bays, and the seconds in which each opens and closes.
const GATES: [(&str, u32, u32); 4] =
    [("south_gate", 0, 10), ("east_gate", 6, 6), ("north_gate", 12, 12), ("west_gate", 18, 5)];

/// The seconds in which the gate of this name opens and closes.
pub fn gate_period_s(name: &str) -> u32 {
    GATES.iter().find(|gate| gate.0 == name).expect("a gate of the list").2
}

/// The middles of the crowns of candles.
pub fn crown_places() -> Vec<Mat4> {
    round(8, 1.0 / 48.0, 7.4, 7.6)
}

/// Everything that could be carried out.
pub fn pieces(materials: &Materials, details: Details) -> Vec<Piece> {
    let mut pieces = stage(materials, details);
    pieces.extend(on_the_piers(materials, details));
    pieces.extend(hanging(materials, details));
    pieces.extend(on_the_floor(materials, details));
    pieces.extend(gates(materials));
    pieces
}

fn stage(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, middle, .. } = details;
    let steps = [[4.6, 0.0], [4.6, 0.25], [4.1, 0.25], [4.1, 0.5], [3.6, 0.5], [3.6, STAGE_M], [0.0, STAGE_M]];
    let around = Turning { segments: middle.along(26.0, 32), repeats: 16, tile_m: 1.6, detail: middle };
    let pedestal = [
        Curve::line([1.0, 0.0], [1.0, 0.18]),
        Curve::bent([1.0, 0.18], [0.5, 0.22], [0.34, 0.5]),
        Curve::bent([0.34, 0.5], [0.62, 0.7], [0.3, 0.86]),
        Curve::bent([0.3, 0.86], [0.16, 0.95], [0.12, 1.2]),
        Curve::line([0.12, 1.2], [0.0, 1.2]),
    ];
    let lobes = fine.along(6.0, 24).next_multiple_of(12);
    let turning = Turning { segments: lobes, repeats: 3, tile_m: 0.8, detail: fine };
    let pedestal = turned_with(&pedestal, turning, |turns, piece, t| {
        if piece == 2 { 1.0 + 0.08 * sin_cos_turns(12.0 * turns).1 * (4.0 * t * (1.0 - t)).max(0.0) } else { 1.0 }
    });
    // A ring with knobs and two pivots, so that one sees it turn.
    let ring = |radius_m: f64, tube_m: f64, knobs: u32| {
        let mut patches = torus(radius_m, tube_m, fine.along(6.3 * radius_m, 24), fine.along(6.3 * tube_m, 8));
        for knob in 0..knobs {
            let (sine, cosine) = sin_cos_turns(f64::from(knob) / f64::from(knobs));
            let at = dvec3(radius_m * cosine, 0.0, -radius_m * sine);
            patches.extend(moved(sphere(1.9 * tube_m, fine.along(8.0 * tube_m, 8)), at));
        }
        patches
    };
    let upright = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y));
    let globe = |radius_m: f64| sphere(radius_m, fine.along(6.3 * radius_m, 16));
    let once = |name, material, patches, at| Piece { name, material, patches, places: vec![shifted(at)] };
    vec![
        once("stage", materials.stage, turned(&Curve::lines(&steps), around), DVec3::ZERO),
        once("pedestal", materials.bronze, pedestal, DVec3::Y * STAGE_M),
        once("globe", materials.gold, globe(0.42), SPHERE),
        once("outer_ring", materials.bronze, ring(1.7, 0.075, 12), SPHERE),
        once("middle_ring", materials.gold, placed(ring(1.35, 0.06, 8), upright).collect(), SPHERE),
        once("inner_ring", materials.silver, ring(1.0, 0.05, 6), SPHERE),
    ]
}

fn on_the_piers(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, middle, .. } = details;
    let turning = |around_m: f64| Turning { segments: fine.along(around_m, 8), repeats: 1, tile_m: 0.7, detail: fine };
    let bracket_m = 0.78;
    let out = |y: f64, z: f64| dvec3(0.0, y, z);
    // A hooded figure in a long robe on a corbel.
    let corbel = [
        Curve::bent([0.0, -0.5], [0.1, -0.48], [0.14, -0.36]),
        Curve::bent([0.14, -0.36], [0.2, -0.12], [0.36, -0.08]),
        Curve::line([0.36, -0.08], [0.36, 0.0]),
        Curve::line([0.36, 0.0], [0.0, 0.0]),
    ];
    let robe = [
        Curve::line([0.3, 0.0], [0.27, 0.1]),
        Curve::bent([0.27, 0.1], [0.17, 0.6], [0.2, 1.05]),
        Curve::bent([0.2, 1.05], [0.25, 1.3], [0.13, 1.38]),
        Curve::bent([0.13, 1.38], [0.06, 1.4], [0.085, 1.46]),
        Curve::bent([0.085, 1.46], [0.15, 1.6], [0.09, 1.7]),
        Curve::bent([0.09, 1.7], [0.05, 1.76], [0.0, 1.78]),
    ];
    let folds = fine.along(2.0, 20).next_multiple_of(10);
    let robe = turned_with(&robe, Turning { segments: folds, ..turning(2.0) }, |turns, piece, t| {
        // Folds that end at the belt.
        let deep = [1.0, 1.0 - t, 0.0, 0.0, 0.0, 0.0][piece];
        1.0 + 0.09 * deep * sin_cos_turns(10.0 * turns).0
    });
    let mut statue: Vec<Patch> = moved(turned(&corbel, turning(1.6)), out(GALLERY_M + 0.3, bracket_m)).collect();
    statue.extend(moved(robe, out(GALLERY_M + 0.3, bracket_m)));
    for side in [-1.0, 1.0] {
        // Arms that meet on the hilt of a sword.
        let shoulder = dvec3(side * 0.19, GALLERY_M + 1.58, bracket_m);
        let hands = dvec3(side * 0.03, GALLERY_M + 1.2, bracket_m + 0.3);
        statue.extend(bar(shoulder, hands, 0.055));
    }
    statue.extend(bar(out(GALLERY_M + 0.32, bracket_m + 0.31), out(GALLERY_M + 1.38, bracket_m + 0.31), 0.022));
    statue.extend(bar(
        dvec3(-0.16, GALLERY_M + 1.14, bracket_m + 0.31),
        dvec3(0.16, GALLERY_M + 1.14, bracket_m + 0.31),
        0.022,
    ));
    // A canopy over its head: a gabled spire with a knob.
    let mut canopy: Vec<Patch> = moved(prism(8, [0.4, 0.42], 0.16, 0.6), out(GALLERY_M + 2.4, bracket_m)).collect();
    canopy.extend(moved(prism(8, [0.3, 0.02], 0.95, 0.6), out(GALLERY_M + 2.56, bracket_m)));
    canopy.extend(moved(sphere(0.07, fine.along(0.5, 8)), out(GALLERY_M + 3.54, bracket_m)));
    for corner in 0..8 {
        let (sine, cosine) = sin_cos_turns((f64::from(corner) + 0.5) / 8.0);
        let foot = out(GALLERY_M + 2.5, bracket_m) + dvec3(0.38 * cosine, 0.0, 0.38 * sine);
        canopy.extend(moved(prism(4, [0.05, 0.005], 0.4, 0.4), foot));
    }
    // A bowl on a bracket, with a flame.
    let bowl = [
        Curve::bent([0.0, -0.16], [0.12, -0.16], [0.18, 0.0]),
        Curve::line([0.18, 0.0], [0.16, 0.0]),
        Curve::bent([0.16, 0.0], [0.1, -0.1], [0.0, -0.1]),
    ];
    let mut sconce: Vec<Patch> = moved(turned(&bowl, turning(1.1)), out(SCONCE_M, 0.95)).collect();
    sconce.extend(bar(out(SCONCE_M - 0.5, 0.4), out(SCONCE_M - 0.12, 0.95), 0.03));
    sconce.extend(bar(out(SCONCE_M - 0.14, 0.4), out(SCONCE_M - 0.14, 0.95), 0.025));
    let flame =
        [Curve::bent([0.0, -0.08], [0.12, -0.06], [0.09, 0.06]), Curve::bent([0.09, 0.06], [0.06, 0.16], [0.0, 0.3])];
    // Cloth that hangs in folds, deeper toward the hem.
    let banner = || {
        let patch = Patch::new(middle.along(2.4, 12), middle.along(2.6, 8), |s, t| {
            let deep = 0.02 + 0.07 * (1.0 - t);
            let fold = sin_cos_turns(2.5 * s + 0.1 * t).0;
            let position = dvec3((s - 0.5) * 0.9, 1.9 + 1.9 * t, 0.62 + deep * fold);
            Point { position, uv: dvec2(s, 1.0 - t) }
        });
        vec![patch]
    };
    let banners = |parity: usize| corners().into_iter().skip(parity).step_by(2).collect::<Vec<_>>();
    let beside = |shift: DVec3| -> Vec<Mat4> {
        let shift = Mat4::from_translation(shift.as_vec3());
        bays().into_iter().map(|bay| bay * shift).collect()
    };
    // Shields under the gallery's rail.
    let shield = Patch::new(fine.along(1.6, 10), fine.along(1.6, 8), |s, t| {
        // Narrower toward its point; bulging.
        let half = 0.34 * (1.0 - (1.0 - t) * (1.0 - t) * (1.0 - t));
        let x = (2.0 * s - 1.0) * half;
        let bulge = 0.12 - 0.6 * x * x - 0.1 * (t - 0.6) * (t - 0.6);
        Point { position: dvec3(x, 4.42 + 0.78 * t, 0.02 + bulge), uv: dvec2(0.5 + x / 0.68, 1.0 - t) }
    });
    vec![
        Piece { name: "statue", material: materials.statue, patches: statue, places: corners() },
        Piece { name: "canopy", material: materials.dressed, patches: canopy, places: corners() },
        Piece { name: "sconce", material: materials.iron, patches: sconce, places: corners() },
        Piece {
            name: "flame",
            material: materials.glow,
            patches: moved(turned(&flame, turning(0.6)), out(SCONCE_M, 0.95)).collect(),
            places: corners(),
        },
        Piece { name: "red_banner", material: materials.cloth[0], patches: banner(), places: banners(0) },
        Piece { name: "blue_banner", material: materials.cloth[1], patches: banner(), places: banners(1) },
        Piece {
            name: "shield",
            material: materials.bronze,
            patches: vec![shield.collapsed(true, false)],
            places: beside(DVec3::Y * 0.0),
        },
    ]
}

fn hanging(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, .. } = details;
    const CANDLES: u32 = 12;
    const CROWN_M: f64 = 0.95;
    let on_crown = |index: u32| {
        let (sine, cosine) = sin_cos_turns(f64::from(index) / f64::from(CANDLES));
        dvec3(CROWN_M * cosine, 0.0, -CROWN_M * sine)
    };
    let turning = |around_m: f64| Turning { segments: fine.along(around_m, 6), repeats: 1, tile_m: 0.4, detail: fine };
    let mut crown = torus(CROWN_M, 0.045, fine.along(6.0, 24), fine.along(0.35, 6));
    let cup = [Curve::bent([0.02, 0.02], [0.08, 0.06], [0.075, 0.12]), Curve::line([0.075, 0.12], [0.0, 0.12])];
    let candle = [Curve::line([0.022, 0.1], [0.022, 0.26]), Curve::line([0.022, 0.26], [0.0, 0.26])];
    let flame =
        [Curve::bent([0.0, 0.25], [0.045, 0.28], [0.03, 0.33]), Curve::bent([0.03, 0.33], [0.015, 0.38], [0.0, 0.42])];
    let mut candles = Vec::new();
    for index in 0..CANDLES {
        crown.extend(moved(turned(&cup, turning(0.5)), on_crown(index)));
        crown.extend(moved(turned(&candle, turning(0.2)), on_crown(index)));
        candles.extend(moved(turned(&flame, turning(0.3)), on_crown(index)));
        if index.is_multiple_of(3) {
            crown.extend(bar(on_crown(index), DVec3::Y * 1.1, 0.014));
        }
    }
    crown.extend(moved(sphere(0.1, fine.along(0.7, 8)), DVec3::Y * 1.1));
    let crowns = crown_places;
    let middles = || crowns().into_iter().map(|place| shifted(place.w_axis.truncate().as_dvec3())).collect::<Vec<_>>();
    let rod = bar(DVec3::Y * 1.15, DVec3::Y * 8.0, 0.015);

    // A cage of eight bars with a pointed roof.
    let cage = {
        let mut patches: Vec<Patch> = moved(prism(8, [0.3, 0.04], 0.4, 0.4), DVec3::Y * 0.36).collect();
        patches.extend(moved(prism(8, [0.16, 0.28], 0.12, 0.4), DVec3::Y * -0.44));
        for corner in 0..8 {
            let (sine, cosine) = sin_cos_turns(f64::from(corner) / 8.0);
            let side = dvec3(0.26 * cosine, 0.0, 0.26 * sine);
            patches.extend(bar(side - DVec3::Y * 0.34, side + DVec3::Y * 0.37, 0.016));
        }
        patches.extend(bar(DVec3::Y * 0.74, DVec3::Y * 10.5, 0.012));
        patches.extend(moved(torus(0.2, 0.02, fine.along(1.3, 12), fine.along(0.2, 5)), DVec3::Y * 0.76));
        patches
    };
    let lanterns = || round(6, 0.04, 4.6, 3.4).into_iter().map(|place| shifted(place.w_axis.truncate().as_dvec3()));
    vec![
        Piece { name: "crown", material: materials.iron, patches: crown, places: middles() },
        Piece { name: "crown_candles", material: materials.glow, patches: candles, places: middles() },
        Piece { name: "crown_rod", material: materials.iron, patches: rod, places: middles() },
        Piece { name: "lantern_cage", material: materials.iron, patches: cage, places: lanterns().collect() },
        Piece {
            name: "lantern_glass",
            material: materials.glow,
            patches: sphere(0.15, fine.along(1.0, 10)),
            places: lanterns().collect(),
        },
    ]
}

fn on_the_floor(materials: &Materials, details: Details) -> Vec<Piece> {
    let Details { fine, middle, broad } = details;
    let turning = |around_m: f64| Turning { segments: fine.along(around_m, 8), repeats: 1, tile_m: 0.7, detail: fine };
    // A parapet between the ring and the seats, open before the gates.
    let half_m = 1.05;
    let mut parapet = cuboid(dvec3(-half_m, 0.0, -0.14), dvec3(half_m, 0.22, 0.14), 0.9, middle);
    parapet.extend(cuboid(dvec3(-half_m, 0.86, -0.13), dvec3(half_m, 1.0, 0.13), 0.9, middle));
    let post = [
        Curve::line([0.09, 0.22], [0.09, 0.28]),
        Curve::bent([0.09, 0.28], [0.05, 0.32], [0.055, 0.45]),
        Curve::bent([0.055, 0.45], [0.12, 0.55], [0.055, 0.7]),
        Curve::bent([0.055, 0.7], [0.05, 0.78], [0.1, 0.86]),
    ];
    for index in 0..6 {
        parapet.extend(moved(turned(&post, turning(0.6)), DVec3::X * ((f64::from(index) - 2.5) * 0.36)));
    }
    let closed: Vec<Mat4> = round(24, 0.0, 9.3, 0.0)
        .into_iter()
        .enumerate()
        .filter(|(index, _)| GATES.iter().all(|gate| gate.1 as usize != *index))
        .map(|(_, place)| place)
        .collect();
    let bench = || {
        let mut patches = cuboid(dvec3(-0.85, 0.4, -0.24), dvec3(0.85, 0.48, 0.24), 0.9, middle);
        for x in [-0.7, 0.58] {
            patches.extend(cuboid(dvec3(x, 0.0, -0.2), dvec3(x + 0.12, 0.41, 0.2), 0.9, broad));
        }
        patches
    };
    let mut brazier = Vec::new();
    for leg in 0..3 {
        let (sine, cosine) = sin_cos_turns(f64::from(leg) / 3.0);
        brazier.extend(bar(dvec3(0.34 * cosine, 0.0, 0.34 * sine), dvec3(0.16 * cosine, 1.1, 0.16 * sine), 0.024));
    }
    let bowl = [
        Curve::bent([0.0, 0.95], [0.26, 0.96], [0.36, 1.2]),
        Curve::line([0.36, 1.2], [0.33, 1.2]),
        Curve::bent([0.33, 1.2], [0.2, 1.05], [0.0, 1.05]),
    ];
    brazier.extend(turned(&bowl, turning(2.2)));
    let fire =
        [Curve::bent([0.3, 1.12], [0.26, 1.3], [0.15, 1.38]), Curve::bent([0.15, 1.38], [0.08, 1.5], [0.0, 1.66])];
    let tongues = fine.along(1.8, 15).next_multiple_of(5);
    let fire = turned_with(&fire, Turning { segments: tongues, ..turning(1.8) }, |turns, piece, t| {
        let grown = if piece == 0 { t } else { 1.0 - t };
        1.0 + 0.22 * grown * sin_cos_turns(5.0 * turns).0
    });
    let stand = [
        Curve::line([0.16, 0.0], [0.16, 0.04]),
        Curve::bent([0.16, 0.04], [0.03, 0.08], [0.025, 0.4]),
        Curve::bent([0.025, 0.4], [0.09, 0.46], [0.025, 0.54]),
        Curve::line([0.025, 0.54], [0.02, 1.1]),
        Curve::bent([0.02, 1.1], [0.09, 1.12], [0.1, 1.2]),
        Curve::line([0.1, 1.2], [0.03, 1.18]),
        Curve::line([0.03, 1.18], [0.03, 1.5]),
        Curve::line([0.03, 1.5], [0.0, 1.5]),
    ];
    let braziers = || round(8, 1.0 / 16.0, 6.4, 0.0);
    // Chests and urns in the niches, a bench along each of their sides.
    let urn = [
        Curve::line([0.2, 0.0], [0.2, 0.05]),
        Curve::bent([0.2, 0.05], [0.06, 0.08], [0.08, 0.18]),
        Curve::bent([0.08, 0.18], [0.4, 0.34], [0.3, 0.7]),
        Curve::bent([0.3, 0.7], [0.22, 0.88], [0.12, 0.92]),
        Curve::bent([0.12, 0.92], [0.11, 1.0], [0.2, 1.06]),
        Curve::bent([0.2, 1.06], [0.09, 1.02], [0.0, 0.8]),
    ];
    let in_niches = |place: DAffine3| -> Vec<Mat4> {
        let place = place.as_affine3a();
        bays().into_iter().map(|bay| bay * Mat4::from(place)).collect()
    };
    let against = |side: f64| DAffine3::from_translation(dvec3(side * 0.92, 0.0, -1.7)) * around_y(0.25);
    vec![
        Piece { name: "parapet", material: materials.dressed, patches: parapet, places: closed },
        Piece { name: "bench", material: materials.wood, patches: bench(), places: in_niches(against(-1.0)) },
        Piece { name: "brazier", material: materials.iron, patches: brazier, places: braziers() },
        Piece { name: "fire", material: materials.glow, patches: fire, places: braziers() },
        Piece {
            name: "candlestick",
            material: materials.gold,
            patches: turned(&stand, turning(0.9)),
            places: round(CANDLESTICK_COUNT, 0.01, 5.2, 0.0),
        },
        Piece {
            name: "urn",
            material: materials.bronze,
            patches: turned(&urn, turning(1.8)),
            places: in_niches(DAffine3::from_translation(dvec3(0.0, 0.0, 0.35 - NICHE_M))),
        },
    ]
}

/// As many as bring the draws to those of the paper's table 1.
const CANDLESTICK_COUNT: u32 = 26;

/// Lattices of iron before four of the niches, which slide up behind the wall.
fn gates(materials: &Materials) -> Vec<Piece> {
    const HALF_M: f64 = 1.1;
    const HEIGHT_M: f64 = 3.1;
    let lattice = || {
        let mut patches = Vec::new();
        for index in 0..9 {
            let x = (f64::from(index) / 4.0 - 1.0) * HALF_M;
            patches.extend(bar(dvec3(x, 0.12, -0.3), dvec3(x, HEIGHT_M, -0.3), 0.028));
            let point = prism(4, [0.045, 0.004], 0.14, 0.4);
            let down = DAffine3::from_mat3_translation(
                DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z),
                dvec3(x, 0.14, -0.3),
            );
            patches.extend(placed(point, down));
        }
        for index in 0..10 {
            let y = 0.25 + f64::from(index) * 0.3;
            patches.extend(bar(dvec3(-HALF_M, y, -0.27), dvec3(HALF_M, y, -0.27), 0.022));
        }
        patches
    };
    let gate = |(name, bay, _): (&'static str, u32, u32)| {
        let turns = f64::from(bay) / 24.0;
        let (sine, cosine) = sin_cos_turns(turns);
        // Toward the middle, as its bay.
        let patches = placed(lattice(), around_y(turns + 0.5)).collect();
        let at = dvec3(RADIUS_M * sine, 0.0, RADIUS_M * cosine);
        Piece { name, material: materials.iron, patches, places: vec![shifted(at)] }
    };
    GATES.into_iter().map(gate).collect()
}
