//! Closed solids of furnished rooms, beside those of `shapes`: chamfered and open boxes, walls with a hole, the
//! covers of books, bent wire. In metres, y up; watertight, each edge with the same bits on both sides.

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::patch::{Patch, Point, sin_cos_turns};
use super::shapes::{Mapping, face_of};

fn flat(corners: [DVec3; 4], tile_m: f64) -> Patch {
    face_of(corners, Mapping::Repeat { tile_m }, 1, 1)
}

/// A box whose edges are cut off over `bevel_m`, less than half of each side.
pub fn chamfered(min: DVec3, max: DVec3, bevel_m: f64, tile_m: f64) -> Vec<Patch> {
    // A corner of the box on its face across `axis`: drawn in along the other two.
    let at = |axis: usize, corner: [usize; 3]| {
        let mut place = DVec3::ZERO;
        for along in 0..3 {
            let inward = if along == axis { 0.0 } else { bevel_m };
            place[along] = [min[along] + inward, max[along] - inward][corner[along]];
        }
        place
    };
    let outward = |corner: [usize; 3], axes: &[usize]| {
        let mut direction = DVec3::ZERO;
        axes.iter().for_each(|axis| direction[*axis] = [-1.0, 1.0][corner[*axis]]);
        direction
    };
    let facing = |[a, b, c, d]: [DVec3; 4], direction: DVec3| {
        let is_outside = (c - a).cross(d - b).dot(direction) > 0.0;
        flat(if is_outside { [a, b, c, d] } else { [b, a, d, c] }, tile_m)
    };
    let mut patches = Vec::new();
    for axis in 0..3 {
        let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
        for end in 0..2 {
            let corner = |i: usize, j: usize| {
                let mut corner = [end; 3];
                (corner[second], corner[third]) = (i, j);
                corner
            };
            let face = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| at(axis, corner(i, j)));
            patches.push(facing(face, outward(corner(0, 0), &[axis])));
            // The edge to each face across the next axis, along the third.
            for side in 0..2 {
                let [near, far] = [corner(side, 0), corner(side, 1)];
                let edge = [at(axis, near), at(axis, far), at(second, far), at(second, near)];
                patches.push(facing(edge, outward(near, &[axis, second])));
            }
        }
    }
    for index in 0..8_usize {
        let corner = [index & 1, index >> 1 & 1, index >> 2];
        let [a, b, c] = [0, 1, 2].map(|axis| at(axis, corner));
        let [a, b] = if (b - a).cross(c - a).dot(outward(corner, &[0, 1, 2])) > 0.0 { [a, b] } else { [b, a] };
        let right = (b - a).normalize();
        let up = (c - a - right * right.dot(c - a)).normalize();
        let triangle = Patch::new(1, 1, move |s, t| {
            let position = (a * (1.0 - s) + b * s) * (1.0 - t) + c * t;
            Point { position, uv: dvec2(position.dot(right), -position.dot(up)) / tile_m }
        });
        patches.push(triangle.collapsed(false, true));
    }
    patches
}

/// The four corners of a rectangle, counter-clockwise from the lower left one.
fn ring([min, max]: [DVec2; 2]) -> [DVec2; 4] {
    [min, dvec2(max.x, min.y), max, dvec2(min.x, max.y)]
}

/// The sides of a slab that stands from `z[0]` to `z[1]` over a closed line, counter-clockwise as seen from +z.
fn sides(line: [DVec2; 4], [back, front]: [f64; 2], tile_m: f64) -> impl Iterator<Item = Patch> {
    (0..4).map(move |index| {
        let (from, to) = (line[index], line[(index + 1) % 4]);
        flat([from.extend(back), to.extend(back), to.extend(front), from.extend(front)], tile_m)
    })
}

/// What is left of a rectangle around a hole in it, at `z`, seen from +z.
fn around_hole(outer: [DVec2; 4], hole: [DVec2; 4], z: f64, tile_m: f64) -> impl Iterator<Item = Patch> {
    (0..4).map(move |index| {
        let next = (index + 1) % 4;
        flat([outer[index], outer[next], hole[next], hole[index]].map(|at| at.extend(z)), tile_m)
    })
}

fn reversed([a, b, c, d]: [DVec2; 4]) -> [DVec2; 4] {
    [d, c, b, a]
}

/// A wall with a rectangular hole: lower and upper corners of both, its front at z = 0, `depth_m` deep.
pub fn pierced(outer: [DVec2; 2], hole: [DVec2; 2], depth_m: f64, tile_m: f64) -> Vec<Patch> {
    let (outer, hole, depth) = (ring(outer), ring(hole), [-depth_m, 0.0]);
    let mut patches: Vec<Patch> = around_hole(outer, hole, 0.0, tile_m).collect();
    // From behind everything runs the other way.
    patches.extend(around_hole(reversed(outer), reversed(hole), -depth_m, tile_m));
    patches.extend(sides(outer, depth, tile_m));
    patches.extend(sides(reversed(hole), depth, tile_m));
    patches
}

/// A box of `size_m` without a lid that opens toward +z, from z = 0, centred on x = y = 0; its walls are `wall_m`
/// thick.
pub fn open_box(size_m: DVec3, wall_m: f64, tile_m: f64) -> Vec<Patch> {
    let half = size_m.truncate() * 0.5;
    let (outer, inner) = (ring([-half, half]), ring([DVec2::splat(wall_m) - half, half - DVec2::splat(wall_m)]));
    let mut patches: Vec<Patch> = around_hole(outer, inner, size_m.z, tile_m).collect();
    patches.extend(sides(outer, [0.0, size_m.z], tile_m));
    patches.extend(sides(reversed(inner), [wall_m, size_m.z], tile_m));
    patches.push(flat(inner.map(|at| at.extend(wall_m)), tile_m));
    patches.push(flat(reversed(outer).map(|at| at.extend(0.0)), tile_m));
    patches
}

/// Three sides of an upright box of `size_m` from the origin, `thickness_m` thick, open toward -z, above and below: the
/// cover of a book.
pub fn channel(size_m: DVec3, thickness_m: f64, tile_m: f64) -> Vec<Patch> {
    let (DVec3 { x: w, y: height, z: d }, t) = (size_m, thickness_m);
    // x and z, counter-clockwise as seen from above: outside along the three sides, inside back.
    let outer = [[0.0, 0.0], [0.0, d], [w, d], [w, 0.0]];
    let inner = [[t, 0.0], [t, d - t], [w - t, d - t], [w - t, 0.0]];
    let at = |[x, z]: [f64; 2], y: f64| dvec3(x, y, z);
    let line: Vec<[f64; 2]> = outer.into_iter().chain(inner.into_iter().rev()).collect();
    let mut patches = Vec::new();
    for (index, from) in line.iter().enumerate() {
        let to = line[(index + 1) % line.len()];
        patches.push(flat([at(*from, 0.0), at(to, 0.0), at(to, height), at(*from, height)], tile_m));
    }
    for side in 0..3 {
        let corners = [outer[side], outer[side + 1], inner[side + 1], inner[side]];
        patches.push(flat(corners.map(|corner| at(corner, height)), tile_m));
        let [a, b, c, d] = corners.map(|corner| at(corner, 0.0));
        patches.push(flat([d, c, b, a], tile_m));
    }
    patches
}

/// Wire along `path`, which lies in a plane across the unit vector `normal` and is read a little outside of 0 to 1
/// too, in `segments` pieces of `around` sides. Its ends are flat.
pub fn wire(
    path: impl Fn(f64) -> DVec3 + 'static,
    normal: DVec3,
    radius_m: f64,
    [around, segments]: [u32; 2],
) -> Vec<Patch> {
    const STEP: f64 = 1e-5;
    let rows = segments + 2;
    let patch = Patch::new(around, rows, move |s, t| {
        // The first row and the last are the ends: there the wire grows from nothing and shrinks to it.
        let row = t * f64::from(rows);
        let along = ((row - 1.0) / f64::from(segments)).clamp(0.0, 1.0);
        let radius = radius_m * row.min(f64::from(rows) - row).min(1.0);
        let forward = (path(along + STEP) - path(along - STEP)).normalize();
        let (sine, cosine) = sin_cos_turns(s);
        let across = normal * cosine - normal.cross(forward) * sine;
        Point { position: path(along) + across * radius, uv: dvec2(s, -t) }
    });
    vec![patch.collapsed(true, true)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural::{checks, patch};
    use crate::scene::shell::Shell;

    /// Enclosed volumes in closed form: wound outward they are positive.
    #[test]
    fn solids_are_closed_and_have_their_volume() {
        let (min, max) = (dvec3(-0.2, 0.1, -0.3), dvec3(0.4, 0.5, 0.5));
        let bevel = 0.05_f64;
        // An edge lacks half a square of the bevel along its middle, and a corner all but a sixth of a cube.
        let edges = 0.5 * bevel * bevel * 4.0 * (0.6 + 0.4 + 0.8 - 6.0 * bevel);
        let corners = 8.0 * bevel.powi(3) * 5.0 / 6.0;
        let quarter = |t: f64| {
            let (sine, cosine) = sin_cos_turns(0.25 * t);
            dvec3(0.3 * cosine, 0.0, 0.3 * sine)
        };
        // A regular polygon of 64 sides for a circle, and a polyline of 64 pieces for its arc, are within half a
        // percent.
        let arc_m = 0.3 * std::f64::consts::FRAC_PI_2;
        for (name, patches, volume, bound) in [
            ("chamfered", chamfered(min, max, bevel, 1.0), 0.6 * 0.4 * 0.8 - edges - corners, 1e-6),
            (
                "pierced",
                pierced([dvec2(-1.0, 0.0), dvec2(2.0, 1.5)], [dvec2(0.2, 0.3), dvec2(1.0, 1.1)], 0.2, 1.0),
                (3.0 * 1.5 - 0.8 * 0.8) * 0.2,
                1e-6,
            ),
            ("open box", open_box(dvec3(0.4, 0.3, 0.2), 0.02, 1.0), 0.4 * 0.3 * 0.2 - 0.36 * 0.26 * 0.18, 1e-6),
            ("channel", channel(dvec3(0.04, 0.2, 0.15), 0.01, 1.0), (0.04 * 0.15 - 0.02 * 0.14) * 0.2, 1e-6),
            ("wire", wire(quarter, DVec3::Y, 0.05, [64, 64]), 0.05 * 0.05 * std::f64::consts::PI * arc_m, 5e-3),
        ] {
            let mesh = patch::mesh(name, 0, &patches, true);
            checks::assert_mesh_is_sound(&mesh);
            assert!(Shell::of(&mesh).is_closed(), "{name}: {} open edges", Shell::of(&mesh).open_edge_count);
            let found: f64 = (0..mesh.triangle_count())
                .map(|triangle| {
                    let [a, b, c] = mesh.triangle(triangle).map(|corner| corner.as_dvec3());
                    a.dot(b.cross(c)) / 6.0
                })
                .sum();
            assert!((found / volume - 1.0).abs() < bound, "{name}: {found} m3 for {volume}");
        }
    }
}
