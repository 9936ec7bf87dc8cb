//! What runs in the hall: turbines and generators, tanks, pipes with flanges and valves, and what stands about.

use glam::{DAffine3, DMat3, DVec3, dvec2, dvec3};

use crate::scene::procedural::patch::{Detail, Patch, Point, around_y, moved, placed, sin_cos_turns};
use crate::scene::procedural::pieces::Piece;
use crate::scene::procedural::power::layout::{BAY_COUNT, BAY_M, Details, FRONT_M, HALF_WIDTH_M, Materials, at, bays};
use crate::scene::procedural::shapes::{Curve, Turning, bar, cuboid, sphere, torus, tube, turned};

/// From y upward to z toward the front.
const LYING: DMat3 = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
/// Height of the turbines' axes, and where they stand across.
const SHAFT_M: f64 = 1.9;
const SETS_X_M: f64 = -4.0;
const TANKS_X_M: f64 = 4.6;
const TANK_M: f64 = 1.5;

/// Everything that is not a part of the building.
pub fn pieces(materials: &Materials, details: Details) -> Vec<Piece> {
    let mut pieces = sets(materials, details);
    pieces.extend(tanks(materials, details));
    pieces.extend(pipes(materials, details));
    pieces.extend(valves(materials, details));
    pieces.extend(about(materials, details));
    pieces
}

fn turning(details: Details, around_m: f64) -> Turning {
    let detail = details.fine;
    Turning { segments: detail.along(around_m, 8), repeats: 2, tile_m: 1.0, detail }
}

/// Knobs around the y axis: bolts of a flange.
fn bolts(count: u32, radius_m: f64, height_m: f64, size_m: f64) -> impl Iterator<Item = Patch> {
    (0..count).flat_map(move |index| {
        let (sine, cosine) = sin_cos_turns((f64::from(index) + 0.5) / f64::from(count));
        let (x, z) = (radius_m * cosine, radius_m * sine);
        let (low, high) = (DVec3::splat(-size_m), DVec3::splat(size_m));
        moved(cuboid(low, high, 1.0, Detail::COARSE), dvec3(x, height_m, z))
    })
}

/// Two plates that are bolted together, around the origin, across the y axis.
fn flange(details: Details, pipe_m: f64) -> Vec<Patch> {
    let wide = 1.45 * pipe_m;
    let profile = Curve::lines(&[
        [0.9 * pipe_m, -0.07],
        [wide, -0.07],
        [wide, -0.008],
        [1.2 * pipe_m, -0.008],
        [1.2 * pipe_m, 0.008],
        [wide, 0.008],
        [wide, 0.07],
        [0.9 * pipe_m, 0.07],
    ]);
    let mut patches = turned(&profile, turning(details, 9.0 * pipe_m));
    patches.extend(bolts(8, 1.3 * pipe_m, 0.08, 0.018));
    patches.extend(bolts(8, 1.3 * pipe_m, -0.08, 0.018));
    patches
}

/// Steam turbine, generator and exciter on one shaft, four times.
fn sets(materials: &Materials, details: Details) -> Vec<Piece> {
    let lying =
        |patches: Vec<Patch>, z: f64| placed(patches, DAffine3::from_mat3_translation(LYING, dvec3(0.0, SHAFT_M, z)));
    let casing = [
        Curve::line([0.0, -1.5], [0.35, -1.5]),
        Curve::bent([0.35, -1.5], [0.55, -1.45], [0.6, -1.2]),
        Curve::bent([0.6, -1.2], [0.7, -0.6], [1.15, -0.4]),
        Curve::bent([1.15, -0.4], [1.35, 0.0], [1.15, 0.4]),
        Curve::bent([1.15, 0.4], [0.7, 0.6], [0.6, 1.2]),
        Curve::bent([0.6, 1.2], [0.55, 1.45], [0.35, 1.5]),
        Curve::line([0.35, 1.5], [0.0, 1.5]),
    ];
    let mut turbine: Vec<Patch> = lying(turned(&casing, turning(details, 7.5)), 0.0).collect();
    // The joint of both halves, with its bolts.
    turbine.extend(cuboid(dvec3(-1.45, SHAFT_M - 0.07, -1.25), dvec3(1.45, SHAFT_M + 0.07, 1.25), 1.0, details.broad));
    for index in 0..7 {
        for side in [-1.32, 1.32] {
            let bolt = sphere(0.05, details.fine.along(0.3, 6));
            turbine.extend(moved(bolt, dvec3(side, SHAFT_M + 0.07, (f64::from(index) - 3.0) * 0.36)));
        }
    }
    let stator = [
        Curve::line([0.0, -1.15], [0.62, -1.15]),
        Curve::line([0.62, -1.15], [0.66, -1.05]),
        Curve::line([0.66, -1.05], [0.98, -1.0]),
        Curve::bent([0.98, -1.0], [1.05, 0.0], [0.98, 1.0]),
        Curve::line([0.98, 1.0], [0.66, 1.05]),
        Curve::line([0.66, 1.05], [0.62, 1.15]),
        Curve::line([0.62, 1.15], [0.0, 1.15]),
    ];
    let mut generator: Vec<Patch> = lying(turned(&stator, turning(details, 6.5)), -3.0).collect();
    for index in 0..7 {
        let band = torus(1.02, 0.035, details.fine.along(6.4, 16), 5);
        generator.extend(lying(band, -3.0 + (f64::from(index) - 3.0) * 0.29));
    }
    let mut block = cuboid(dvec3(-1.3, 0.0, -4.4), dvec3(1.3, 0.95, 1.7), 1.6, details.broad);
    for z in [-1.3, 1.2, -4.0, -2.0] {
        block.extend(cuboid(dvec3(-0.75, 0.9, z - 0.25), dvec3(0.75, 1.75, z + 0.25), 1.6, details.broad));
    }
    let exciter = Curve::lines(&[[0.0, -0.45], [0.42, -0.45], [0.46, -0.4], [0.46, 0.4], [0.42, 0.45], [0.0, 0.45]]);
    let mut exciter: Vec<Patch> = lying(turned(&exciter, turning(details, 2.9)), -5.0).collect();
    exciter.extend(lying(
        turned(&Curve::lines(&[[0.0, -3.0], [0.16, -3.0], [0.16, 0.0], [0.0, 0.0]]), turning(details, 1.0)),
        -1.7,
    ));
    exciter.extend(cuboid(dvec3(-0.5, 0.0, -5.5), dvec3(0.5, 1.55, -4.5), 1.0, details.broad));
    let places = || at([3.0, -5.5, -14.0, -22.5].map(|z| dvec3(SETS_X_M, 0.0, z)));
    vec![
        Piece { name: "turbine", material: materials.green, patches: turbine, places: places() },
        Piece { name: "generator", material: materials.grey, patches: generator, places: places() },
        Piece { name: "machine_block", material: materials.concrete, patches: block, places: places() },
        Piece { name: "exciter", material: materials.copper, patches: exciter, places: places() },
    ]
}

fn tanks(materials: &Materials, details: Details) -> Vec<Piece> {
    let r = TANK_M;
    let shell = [
        Curve::line([0.0, 0.55], [0.6 * r, 0.6]),
        Curve::bent([0.6 * r, 0.6], [r, 0.64], [r, 1.0]),
        Curve::line([r, 1.0], [r, 4.6]),
        Curve::bent([r, 4.6], [r, 5.1], [0.5 * r, 5.25]),
        Curve::bent([0.5 * r, 5.25], [0.2 * r, 5.33], [0.0, 5.33]),
    ];
    let mut tank = turned(&shell, turning(details, 9.4));
    tank.extend(moved(
        turned(
            &Curve::lines(&[[0.0, 0.0], [0.25, 0.0], [0.25, 0.3], [0.32, 0.3], [0.32, 0.36], [0.0, 0.36]]),
            turning(details, 2.0),
        ),
        DVec3::Y * 5.2,
    ));
    let mut bands = Vec::new();
    for y in [1.0, 1.9, 2.8, 3.7, 4.6] {
        bands.extend(moved(torus(r, 0.03, details.fine.along(9.4, 20), 5), DVec3::Y * y));
    }
    for leg in 0..4 {
        let (sine, cosine) = sin_cos_turns((f64::from(leg) + 0.5) / 4.0);
        let foot = dvec3(0.8 * r * cosine, 0.0, 0.8 * r * sine);
        bands.extend(bar(foot, foot + DVec3::Y * 0.85, 0.09));
    }
    let mut climb = Vec::new();
    for x in [-0.22, 0.22] {
        climb.extend(tube(dvec3(x, 0.0, r + 0.16), dvec3(x, 5.9, r + 0.16), 0.022, details.fine.along(0.14, 5)));
    }
    for rung in 0..19 {
        let y = 0.3 + 0.28 * f64::from(rung);
        climb.extend(tube(dvec3(-0.22, y, r + 0.16), dvec3(0.22, y, r + 0.16), 0.014, 5));
    }
    // A rail around the top.
    for y in [5.3, 5.7] {
        climb.extend(moved(torus(0.8 * r, 0.024, details.fine.along(7.5, 16), 5), DVec3::Y * y));
    }
    for post in 0..8 {
        let (sine, cosine) = sin_cos_turns(f64::from(post) / 8.0);
        let foot = dvec3(0.8 * r * cosine, 4.95, 0.8 * r * sine);
        climb.extend(tube(foot, foot.with_y(5.7), 0.022, 5));
    }
    let places = || at([-1.5, -6.5, -11.5, -16.5, -21.5].map(|z| dvec3(TANKS_X_M, 0.0, z)));
    vec![
        Piece { name: "tank", material: materials.grey, patches: tank, places: places() },
        Piece { name: "tank_bands", material: materials.rust, patches: bands, places: places() },
        Piece { name: "tank_ladder", material: materials.yellow, patches: climb, places: places() },
    ]
}

/// Mains along the walls, flanged at each bay, and feeders that rise from the machines.
fn pipes(materials: &Materials, details: Details) -> Vec<Piece> {
    let half_m = 0.5 * BAY_M;
    let main =
        |radius_m: f64| tube(DVec3::Z * -half_m, DVec3::Z * half_m, radius_m, details.fine.along(6.3 * radius_m, 8));
    let joint = |radius_m: f64| placed(flange(details, radius_m), DAffine3::from_mat3(LYING)).collect::<Vec<_>>();
    let run = |x: f64, y: f64| at(bays().map(move |z| dvec3(x, y, z)));
    let joints = |x: f64, y: f64| at(bays().map(move |z| dvec3(x, y, z - half_m)));
    let left_m = 0.7 - HALF_WIDTH_M;
    // From a main down to a machine: out, round a bend, down.
    let mut feeder = tube(DVec3::ZERO, dvec3(2.6, 0.0, 0.0), 0.2, details.fine.along(1.3, 8));
    feeder.extend(placed(elbow(details, 0.5, 0.2), DAffine3::from_translation(dvec3(2.6, -0.5, 0.0))));
    feeder.extend(tube(dvec3(3.1, -2.6, 0.0), dvec3(3.1, -0.5, 0.0), 0.2, details.fine.along(1.3, 8)));
    feeder.extend(moved(flange(details, 0.2), dvec3(3.1, -1.4, 0.0)));
    feeder.extend(placed(
        flange(details, 0.2),
        DAffine3::from_mat3_translation(DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z), dvec3(1.0, 0.0, 0.0)),
    ));
    let hung = {
        let mut patches = bar(dvec3(-0.75, 0.0, 0.0), dvec3(0.75, 0.0, 0.0), 0.05);
        patches.extend(bar(dvec3(-0.7, 0.0, 0.0), dvec3(-0.7, 1.6, 0.0), 0.03));
        patches
    };
    vec![
        Piece { name: "steam_main", material: materials.grey, patches: main(0.34), places: run(left_m, 5.4) },
        Piece { name: "steam_flange", material: materials.steel, patches: joint(0.34), places: joints(left_m, 5.4) },
        Piece { name: "water_main", material: materials.green, patches: main(0.2), places: run(left_m + 0.9, 5.2) },
        Piece {
            name: "water_flange",
            material: materials.steel,
            patches: joint(0.2),
            places: joints(left_m + 0.9, 5.2),
        },
        Piece { name: "oil_line", material: materials.copper, patches: main(0.07), places: run(left_m + 1.35, 5.1) },
        Piece {
            name: "pipe_hanger",
            material: materials.rust,
            patches: hung,
            places: at(bays().step_by(2).map(|z| dvec3(left_m + 0.5, 4.95, z))),
        },
        Piece {
            name: "feeder",
            material: materials.grey,
            patches: feeder,
            places: at([3.0, -5.5, -14.0, -22.5].map(|z| dvec3(SETS_X_M - 3.1, 5.4, z))),
        },
    ]
}

/// A quarter of a bend from +y to -x: it leaves upward where x is `bend_m` and arrives over the origin.
fn elbow(details: Details, bend_m: f64, pipe_m: f64) -> Vec<Patch> {
    let (around, along) = (details.fine.along(6.3 * pipe_m, 8), details.fine.along(1.6 * bend_m, 5));
    vec![Patch::new(around, along, move |s, t| {
        let ((sine, cosine), (up, out)) = (sin_cos_turns(s), sin_cos_turns(0.25 * t));
        let radius_m = bend_m + pipe_m * cosine;
        Point { position: dvec3(radius_m * out, radius_m * up, -pipe_m * sine), uv: dvec2(2.0 * s, -1.6 * bend_m * t) }
    })]
}

/// Close to the camera: risers with flanges and valves, their wheels turned to the front.
fn valves(materials: &Materials, details: Details) -> Vec<Piece> {
    // Finer than the rest, because seen from an arm's length.
    let near = Details { fine: Detail { edge_m: 0.35 * details.fine.edge_m }, ..details };
    let mut riser = tube(DVec3::ZERO, DVec3::Y * 3.6, 0.13, near.fine.along(0.9, 12));
    for y in [0.5, 1.35, 2.05, 2.9] {
        riser.extend(moved(flange(near, 0.13), DVec3::Y * y));
    }
    riser.extend(placed(elbow(near, 0.3, 0.13), DAffine3::from_translation(dvec3(-0.3, 3.6, 0.0))));
    riser.extend(tube(dvec3(-1.6, 3.9, 0.0), dvec3(-0.3, 3.9, 0.0), 0.13, near.fine.along(0.9, 12)));
    let body =
        [Curve::bent([0.0, 1.42], [0.22, 1.42], [0.22, 1.7]), Curve::bent([0.22, 1.7], [0.22, 1.98], [0.0, 1.98])];
    let mut valve = turned(&body, turning(near, 1.4));
    let stem = Curve::lines(&[
        [0.0, 0.0],
        [0.11, 0.0],
        [0.11, 0.26],
        [0.15, 0.26],
        [0.15, 0.3],
        [0.03, 0.3],
        [0.03, 0.52],
        [0.0, 0.52],
    ]);
    let forward = DAffine3::from_mat3_translation(LYING, DVec3::Y * 1.7);
    valve.extend(placed(turned(&stem, turning(near, 0.7)), forward));
    let mut wheel = torus(0.21, 0.02, near.fine.along(1.3, 16), near.fine.along(0.13, 6));
    for spoke in 0..5 {
        let (sine, cosine) = sin_cos_turns(f64::from(spoke) / 5.0);
        wheel.extend(tube(DVec3::ZERO, dvec3(0.21 * cosine, 0.0, 0.21 * sine), 0.011, near.fine.along(0.07, 5)));
    }
    wheel.extend(moved(sphere(0.04, near.fine.along(0.25, 8)), DVec3::ZERO));
    let wheel = placed(wheel, forward * DAffine3::from_translation(DVec3::Y * 0.48)).collect();
    // A gauge on a bent pipe.
    let case = Curve::lines(&[
        [0.0, -0.05],
        [0.1, -0.05],
        [0.105, -0.03],
        [0.105, 0.03],
        [0.09, 0.035],
        [0.085, 0.02],
        [0.0, 0.02],
    ]);
    let mut gauge: Vec<Patch> =
        placed(turned(&case, turning(near, 0.66)), DAffine3::from_mat3_translation(LYING, dvec3(0.34, 2.52, 0.1)))
            .collect();
    gauge.extend(tube(dvec3(0.0, 2.4, 0.0), dvec3(0.34, 2.42, 0.08), 0.014, near.fine.along(0.09, 6)));
    let stands = [dvec3(-0.55, 0.0, 9.6), dvec3(1.95, 0.0, 8.9), dvec3(-2.0, 0.0, 7.2), dvec3(3.1, 0.0, 6.4)];
    vec![
        Piece { name: "riser", material: materials.steel, patches: riser, places: at(stands) },
        Piece { name: "valve", material: materials.green, patches: valve, places: at(stands) },
        Piece { name: "valve_wheel", material: materials.red, patches: wheel, places: at(stands) },
        Piece { name: "gauge", material: materials.grey, patches: gauge, places: at(stands) },
    ]
}

fn about(materials: &Materials, details: Details) -> Vec<Piece> {
    let barrel = [
        Curve::line([0.0, 0.0], [0.28, 0.0]),
        Curve::bent([0.28, 0.0], [0.3, 0.15], [0.29, 0.3]),
        Curve::bent([0.29, 0.3], [0.32, 0.315], [0.29, 0.33]),
        Curve::line([0.29, 0.33], [0.29, 0.56]),
        Curve::bent([0.29, 0.56], [0.32, 0.575], [0.29, 0.59]),
        Curve::bent([0.29, 0.59], [0.3, 0.74], [0.28, 0.88]),
        Curve::line([0.28, 0.88], [0.26, 0.88]),
        Curve::line([0.26, 0.88], [0.26, 0.86]),
        Curve::line([0.26, 0.86], [0.0, 0.86]),
    ];
    let barrels = |count: u32, x: f64, z: f64| {
        // In pairs along the way.
        at((0..count).map(move |index| {
            let (row, side) = (f64::from(index / 2), f64::from(index % 2));
            dvec3(x + 0.68 * side + 0.1 * (row % 2.0), 0.0, z - 2.1 * row)
        }))
    };
    let mut crate_ = cuboid(dvec3(-0.5, 0.06, -0.4), dvec3(0.5, 0.8, 0.4), 1.0, details.broad);
    for x in [-0.46, 0.4] {
        crate_.extend(cuboid(dvec3(x, 0.0, -0.43), dvec3(x + 0.08, 0.86, 0.43), 1.0, Detail::COARSE));
    }
    let mut cabinet = cuboid(dvec3(-0.45, 0.0, -0.3), dvec3(0.45, 2.0, 0.3), 1.0, details.broad);
    cabinet.extend(cuboid(dvec3(-0.38, 0.9, 0.28), dvec3(0.38, 1.85, 0.34), 1.0, Detail::COARSE));
    cabinet.extend(cuboid(dvec3(0.3, 0.5, 0.28), dvec3(0.36, 0.8, 0.38), 1.0, Detail::COARSE));
    let shade = [Curve::line([0.04, 0.5], [0.05, 0.3]), Curve::bent([0.05, 0.3], [0.3, 0.26], [0.42, 0.0])];
    // Both sides are seen: down the outside, up the inside.
    let outside = [Curve::bent([0.44, 0.0], [0.32, 0.28], [0.05, 0.32]), Curve::line([0.05, 0.32], [0.0, 0.5])];
    let mut lamp = turned(&outside, turning(details, 2.4));
    lamp.extend(turned(&shade[1..], turning(details, 2.4)));
    lamp.extend(bar(DVec3::Y * 0.45, DVec3::Y * 2.4, 0.015));
    let turned_crate: Vec<Patch> = placed(crate_, around_y(0.04)).collect();
    let far_m = FRONT_M - BAY_M * f64::from(BAY_COUNT);
    vec![
        Piece {
            name: "barrel",
            material: materials.red,
            patches: turned(&barrel, turning(details, 1.8)),
            places: barrels(BARREL_COUNT, 0.6, 5.0),
        },
        Piece {
            name: "oil_drum",
            material: materials.rust,
            patches: turned(&barrel, turning(details, 1.8)),
            places: barrels(4, 7.0, 1.0),
        },
        Piece {
            name: "crate",
            material: materials.wood,
            patches: turned_crate,
            places: at([[-7.4, 8.0], [-7.2, 6.7], [-7.5, -0.8], [1.4, -19.0], [1.9, -20.4], [6.9, 4.2]]
                .map(|[x, z]| dvec3(x, 0.0, z))),
        },
        Piece {
            name: "cabinet",
            material: materials.grey,
            patches: cabinet,
            places: at((0..4).map(|index| dvec3(-6.0 + f64::from(index), 0.0, far_m + 0.5))),
        },
        Piece {
            name: "lamp",
            material: materials.steel,
            patches: lamp,
            places: at(bays().step_by(2).map(|z| dvec3(0.4, 7.0, z - 0.5 * BAY_M))),
        },
    ]
}

/// As many as bring the draws to those of the paper's table 1.
const BARREL_COUNT: u32 = 9;
