//! Small things of rooms and desks: books, cups, pots, pencils, paper, plants. Each stands on y = 0 around the y axis
//! unless it says otherwise, is closed, and is in metres.

use glam::{DAffine3, DVec3, dvec3};

use super::patch::{Detail, Patch, around_y, bent, moved, placed, sin_cos_turns};
use super::shapes::{Curve, Turning, cuboid_of, prism, sphere, turned};
use super::solids::{channel, wire};
use crate::sampling::pcg::Pcg32;

/// `turning` for profiles of straight pieces, which need no division.
const STRAIGHT: f64 = f64::INFINITY;

/// A number between two.
pub fn between(random: &mut Pcg32, low: f64, high: f64) -> f64 {
    low + (high - low) * f64::from(random.unit())
}

/// How a turned thing of this many sides is divided, with edges along its profile of about `edge_m` where it is bent.
pub fn turning(segments: u32, edge_m: f64) -> Turning {
    Turning { segments, repeats: 1, tile_m: 0.1, detail: Detail { edge_m } }
}

/// A book of thickness, height and depth `size_m` that stands from the origin, its spine toward +z: cover and pages.
pub fn book(size_m: DVec3) -> [Vec<Patch>; 2] {
    const COVER_M: f64 = 0.0025;
    const MARGIN_M: f64 = 0.004;
    let inside = COVER_M - 0.0004;
    let low = dvec3(inside, MARGIN_M, MARGIN_M);
    let high = size_m - dvec3(inside, MARGIN_M, inside);
    [channel(size_m, COVER_M, 0.1), cuboid_of(low, high, 0.1, [1; 3])]
}

/// A book that lies around the y axis with its spine toward +z: width, thickness and depth in `size_m`.
pub fn lying_book(size_m: DVec3) -> [Vec<Patch>; 2] {
    // Its thickness, the upright book's x, becomes y; its height lies along -x.
    let lie = DAffine3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z, dvec3(0.5 * size_m.x, 0.0, -0.5 * size_m.z));
    book(dvec3(size_m.y, size_m.x, size_m.z)).map(|patches| placed(patches, lie).collect())
}

/// Straight pieces up the outside and down the inside of a vessel: outer radii and heights, and how thick it is.
fn vessel(outside: &[[f64; 2]], wall_m: f64) -> Vec<Curve> {
    let inside = outside.iter().rev().map(|[radius, height]| [radius - wall_m, height.max(wall_m)]);
    let axis = [[0.0, wall_m]];
    let points: Vec<[f64; 2]> =
        [[0.0, 0.0]].into_iter().chain(outside.iter().copied()).chain(inside).chain(axis).collect();
    Curve::lines(&points)
}

/// A mug with its handle toward +x.
pub fn mug(segments: u32) -> Vec<Patch> {
    const RADIUS_M: f64 = 0.04;
    let mut patches =
        turned(&vessel(&[[0.034, 0.0], [RADIUS_M, 0.012], [RADIUS_M, 0.095]], 0.004), turning(segments, STRAIGHT));
    // Its ends are inside the wall.
    let handle = |t: f64| {
        let (sine, cosine) = sin_cos_turns(0.52 * (t - 0.5));
        dvec3(RADIUS_M - 0.002 + 0.026 * cosine, 0.052 + 0.029 * sine, 0.0)
    };
    patches.extend(wire(handle, DVec3::Z, 0.005, [(segments / 3).max(5), (segments / 2).max(6)]));
    patches
}

/// An open cylinder or cone stump: radii at foot and rim.
pub fn pot(radii_m: [f64; 2], height_m: f64, wall_m: f64, segments: u32) -> Vec<Patch> {
    turned(&vessel(&[[radii_m[0], 0.0], [radii_m[1], height_m]], wall_m), turning(segments, STRAIGHT))
}

/// A bowl on a low foot.
pub fn bowl(radius_m: f64, segments: u32) -> Vec<Patch> {
    let r = radius_m;
    let profile = [
        Curve::line([0.0, 0.0], [0.42 * r, 0.0]),
        Curve::line([0.42 * r, 0.0], [0.4 * r, 0.05 * r]),
        Curve::bent([0.4 * r, 0.05 * r], [0.95 * r, 0.1 * r], [r, 0.55 * r]),
        Curve::line([r, 0.55 * r], [0.95 * r, 0.56 * r]),
        Curve::bent([0.95 * r, 0.56 * r], [0.86 * r, 0.14 * r], [0.0, 0.1 * r]),
    ];
    turned(&profile, turning(segments, 0.2 * r))
}

/// A vase of a height and of half that height across.
pub fn vase(height_m: f64, segments: u32) -> Vec<Patch> {
    let h = height_m;
    let profile = [
        Curve::line([0.0, 0.0], [0.13 * h, 0.0]),
        Curve::bent([0.13 * h, 0.0], [0.36 * h, 0.34 * h], [0.17 * h, 0.66 * h]),
        Curve::bent([0.17 * h, 0.66 * h], [0.08 * h, 0.86 * h], [0.15 * h, h]),
        Curve::line([0.15 * h, h], [0.13 * h, h]),
        Curve::bent([0.13 * h, h], [0.05 * h, 0.84 * h], [0.0, 0.6 * h]),
    ];
    turned(&profile, turning(segments, 0.16 * h))
}

/// An apple without its stalk.
pub fn apple(radius_m: f64, segments: u32) -> Vec<Patch> {
    let bend = move |at: DVec3| {
        let height = at.y / radius_m;
        let width = 1.0 + 0.14 * height;
        // Hollow above, flat below.
        let dent = 0.3 * (1.0 - (at.x * at.x + at.z * at.z) / (radius_m * radius_m)).max(0.0) * height.max(0.0);
        dvec3(at.x * width, at.y * (0.92 - dent) + 0.92 * radius_m, at.z * width)
    };
    bent(sphere(radius_m, segments), bend).collect()
}

/// A pencil that stands on its blunt end: its painted body, its wood, its lead.
pub fn pencil(length_m: f64) -> [Vec<Patch>; 3] {
    const RADIUS_M: f64 = 0.0037;
    let raised = |patches, height_m: f64| moved(patches, DVec3::Y * height_m).collect::<Vec<_>>();
    [
        prism(6, [RADIUS_M; 2], length_m, 0.1),
        raised(prism(6, [0.98 * RADIUS_M, 0.24 * RADIUS_M], 0.019, 0.1), length_m - 0.001),
        raised(prism(3, [0.22 * RADIUS_M, 0.08 * RADIUS_M], 0.005, 0.1), length_m + 0.0165),
    ]
}

/// A sheet of paper of width and depth `size_m` whose far edge rises to `curl_m`.
pub fn sheet(size_m: [f64; 2], curl_m: f64) -> Vec<Patch> {
    let [w, d] = size_m.map(|side_m| 0.5 * side_m);
    let bend = move |at: DVec3| {
        let back = ((d - at.z) / (2.0 * d)).clamp(-0.1, 1.1);
        let rise = curl_m * back * back * back;
        at + DVec3::Y * rise
    };
    bent(cuboid_of(dvec3(-w, 0.0, -d), dvec3(w, 0.0006, d), 0.1, [1, 1, 8]), bend).collect()
}

/// A paper clip that lies along x.
pub fn clip(around: u32, segments: u32) -> Vec<Patch> {
    // Three straight runs and three half circles, ever smaller: lengths along the wire, and half the height of each
    // turn.
    const WIRE_M: f64 = 0.00045;
    let [outer, middle, inner] = [0.0042, 0.0035, 0.0028];
    let path = move |t: f64| {
        let pi = std::f64::consts::PI;
        let parts = [0.018, pi * outer, 0.022, pi * middle, 0.017, pi * inner, 0.012];
        let mut left = t * parts.iter().sum::<f64>();
        // Where the wire is, which way it runs along x, and how far each turn brings it across.
        let (mut at, mut forward) = (dvec3(-0.006, 0.0, outer), 1.0);
        let radii = [outer, -middle, inner];
        for (index, length) in parts.into_iter().enumerate() {
            let here = if index + 1 == parts.len() { left } else { left.min(length) };
            if index % 2 == 0 {
                at.x += forward * here;
            } else {
                // The turns wind the same way round: across by -2 r, then by +2 r, and back.
                let radius = radii[index / 2];
                let (sine, cosine) = sin_cos_turns(0.5 * here / length);
                at += dvec3(forward * radius.abs() * sine, 0.0, -radius * (1.0 - cosine));
                if here == length {
                    forward = -forward;
                }
            }
            left -= here;
            if left <= 0.0 {
                break;
            }
        }
        at + DVec3::Y * WIRE_M
    };
    wire(path, DVec3::Y, WIRE_M, [around, segments])
}

/// A leaf that rises from the y axis toward +z and bends over: half its width, its length, and how steep it begins.
fn leaf(half_m: f64, length_m: f64, rise: f64) -> Vec<Patch> {
    // Across, through and along, bent from a box of unit length, so that it has no poles.
    let blade = cuboid_of(dvec3(-1.0, 0.0, 0.0), dvec3(1.0, 1.0, 1.0), 1.0, [2, 1, 4]);
    let bend = move |DVec3 { x: across, y: through, z: along }: DVec3| {
        let width = half_m * (0.15 + 3.4 * along * (1.0 - along)) * (1.0 - 0.35 * along);
        let keel = 0.3 * width * across.abs();
        let y = length_m * (rise * along - 0.75 * along * along) + keel + 0.08 * half_m * through;
        dvec3(width * across, y, length_m * along * (1.0 - 0.25 * rise * (1.0 - along)))
    };
    bent(blade, bend).collect()
}

/// The leaves of a plant that grows from the origin, the longest `length_m`.
pub fn leaves(count: u32, length_m: f64, random: &mut Pcg32) -> Vec<Patch> {
    let mut patches = Vec::new();
    for index in 0..count {
        // The golden angle: each leaf goes where there is room.
        let turns = 0.381_966 * f64::from(index) + between(random, -0.03, 0.03);
        let age = (f64::from(index) + 0.5) / f64::from(count);
        let length = length_m * between(random, 0.75, 1.0) * (0.65 + 0.35 * age);
        let blade = leaf(between(random, 0.07, 0.1) * length, length, 1.7 - 1.2 * age);
        let stem = DAffine3::from_translation(dvec3(0.0, 0.02 * f64::from(index % 5), 0.0));
        patches.extend(placed(blade, stem * around_y(turns)));
    }
    patches
}
