//! The vocabulary of the procedural scenes: faces, boxes, turned and moulded pieces, spheres, arches.
//!
//! Every shape is a list of patches that face outward, in metres, y up. Shapes said to be closed are watertight: each
//! edge belongs to exactly two triangles, with the same bits on both sides.

use glam::{DAffine3, DVec2, DVec3, dvec2, dvec3};

use super::patch::{Detail, Patch, Point, placed, sin_cos_turns};

/// How a face takes its texture.
#[derive(Clone, Copy, Debug)]
pub enum Mapping {
    /// The whole picture once.
    Fit,
    /// One repeat every so many metres, from the origin, upright on walls.
    Repeat { tile_m: f64 },
}

/// A flat face between four corners, counter-clockwise as seen from outside, from the lower left one.
pub fn face(corners: [DVec3; 4], mapping: Mapping, detail: Detail) -> Patch {
    let [a, b, c, d] = corners;
    let columns = detail.along((b - a).length().max((c - d).length()), 1);
    let rows = detail.along((d - a).length().max((c - b).length()), 1);
    face_of(corners, mapping, columns, rows)
}

/// A flat face like `face`, divided into exactly `columns` x `rows`.
pub fn face_of([a, b, c, d]: [DVec3; 4], mapping: Mapping, columns: u32, rows: u32) -> Patch {
    let normal = (c - a).cross(d - b).normalize();
    let right = if normal.y.abs() > 0.5 { DVec3::X } else { DVec3::Y.cross(normal).normalize() };
    let up = normal.cross(right);
    Patch::new(columns, rows, move |s, t| {
        let position = (a * (1.0 - s) + b * s) * (1.0 - t) + (d * (1.0 - s) + c * s) * t;
        let uv = match mapping {
            Mapping::Fit => dvec2(s, 1.0 - t),
            Mapping::Repeat { tile_m } => dvec2(position.dot(right), -position.dot(up)) / tile_m,
        };
        Point { position, uv }
    })
}

/// A closed box from corner to corner.
pub fn cuboid(min: DVec3, max: DVec3, tile_m: f64, detail: Detail) -> Vec<Patch> {
    cuboid_of(min, max, tile_m, (max - min).to_array().map(|side_m| detail.along(side_m, 1)))
}

/// A closed box like `cuboid`, divided into exactly so many parts along x, y and z.
pub fn cuboid_of(min: DVec3, max: DVec3, tile_m: f64, [along_x, along_y, along_z]: [u32; 3]) -> Vec<Patch> {
    let corner = |x: usize, y: usize, z: usize| dvec3([min, max][x].x, [min, max][y].y, [min, max][z].z);
    let face = |corners, columns, rows| face_of(corners, Mapping::Repeat { tile_m }, columns, rows);
    vec![
        face([corner(1, 0, 1), corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1)], along_z, along_y),
        face([corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0)], along_z, along_y),
        face([corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0), corner(0, 1, 0)], along_x, along_z),
        face([corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)], along_x, along_z),
        face([corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)], along_x, along_y),
        face([corner(1, 0, 0), corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0)], along_x, along_y),
    ]
}

/// A piece of a profile: a parabola from `start` to `end` that leaves and arrives in the direction of `middle`.
///
/// In a turned shape x is the radius; outside is on the right of the way from start to end.
#[derive(Clone, Copy, Debug)]
pub struct Curve {
    pub start: DVec2,
    pub middle: DVec2,
    pub end: DVec2,
}

impl Curve {
    /// A straight piece.
    pub fn line(start: [f64; 2], end: [f64; 2]) -> Self {
        Self::bent(start, [(start[0] + end[0]) * 0.5, (start[1] + end[1]) * 0.5], end)
    }

    /// A bent piece.
    pub fn bent(start: [f64; 2], middle: [f64; 2], end: [f64; 2]) -> Self {
        Self { start: start.into(), middle: middle.into(), end: end.into() }
    }

    /// Straight pieces through all points.
    pub fn lines(points: &[[f64; 2]]) -> Vec<Self> {
        points.windows(2).map(|pair| Self::line(pair[0], pair[1])).collect()
    }

    /// The place at `t`, 0 to 1.
    pub fn at(&self, t: f64) -> DVec2 {
        let first = self.start * (1.0 - t) + self.middle * t;
        let second = self.middle * (1.0 - t) + self.end * t;
        first * (1.0 - t) + second * t
    }

    /// Between its chord and its control polygon: close enough to divide by and to lay textures along.
    pub fn length(&self) -> f64 {
        let polygon = (self.middle - self.start).length() + (self.end - self.middle).length();
        ((self.end - self.start).length() + polygon) * 0.5
    }

    fn is_straight(&self) -> bool {
        (self.start + self.end).abs_diff_eq(self.middle * 2.0, 1e-12)
    }

    /// A bend needs two segments to show, unless the piece is smaller than an edge.
    pub fn segments(&self, detail: Detail) -> u32 {
        let least = if self.is_straight() || self.length() < 0.5 * detail.edge_m { 1 } else { 2 };
        detail.along(self.length(), least)
    }
}

/// How a turned shape is divided and textured.
#[derive(Clone, Copy, Debug)]
pub struct Turning {
    /// Segments around the axis, at least 3.
    pub segments: u32,
    /// How often the texture goes around.
    pub repeats: u32,
    /// Metres along the profile for one repeat.
    pub tile_m: f64,
    /// How finely the profile is divided.
    pub detail: Detail,
}

/// A profile turned around the y axis. Closed where the profile begins and ends at radius 0.
pub fn turned(profile: &[Curve], turning: Turning) -> Vec<Patch> {
    turned_with(profile, turning, |_, _, _| 1.0)
}

/// A turned shape whose radius is scaled by `swell`: a function of the angle in turns, the curve's index in the
/// profile, and the place along that curve, 0 to 1.
pub fn turned_with(
    profile: &[Curve],
    turning: Turning,
    swell: impl Fn(f64, usize, f64) -> f64 + Copy + 'static,
) -> Vec<Patch> {
    let mut before_m = 0.0;
    profile
        .iter()
        .enumerate()
        .map(|(index, &curve)| {
            let start_m = before_m;
            before_m += curve.length();
            Patch::new(turning.segments, curve.segments(turning.detail), move |s, t| {
                let (sine, cosine) = sin_cos_turns(s);
                let at = curve.at(t);
                let radius = at.x * swell(s, index, t);
                Point {
                    position: dvec3(radius * cosine, at.y, -radius * sine),
                    uv: dvec2(s * f64::from(turning.repeats), -(start_m + t * curve.length()) / turning.tile_m),
                }
            })
            .collapsed(curve.start.x == 0.0, curve.end.x == 0.0)
        })
        .collect()
}

/// A closed prism or pyramid stump: `sides` flat sides, at least 3, standing on y = 0.
pub fn prism(sides: u32, radii_m: [f64; 2], height_m: f64, tile_m: f64) -> Vec<Patch> {
    let corner = |index: u32, top: usize| {
        let (sine, cosine) = sin_cos_turns(f64::from(index % sides) / f64::from(sides));
        dvec3(radii_m[top] * cosine, height_m * top as f64, -radii_m[top] * sine)
    };
    let mapping = Mapping::Repeat { tile_m };
    let mut patches = Vec::new();
    for side in 0..sides {
        let (left, right) = (side, side + 1);
        let corners = [corner(left, 0), corner(right, 0), corner(right, 1), corner(left, 1)];
        patches.push(face_of(corners, mapping, 1, 1));
        for (top, edge) in [(1, [left, right]), (0, [right, left])] {
            let center = DVec3::Y * (height_m * top as f64);
            let [from, to] = edge.map(|index| corner(index, top));
            let cap = Patch::new(1, 1, move |s, t| {
                let position = (from * (1.0 - s) + to * s) * (1.0 - t) + center * t;
                // Seen from above z runs down the picture, from below it runs up.
                let v = if top == 1 { position.z } else { -position.z };
                Point { position, uv: dvec2(position.x, v) / tile_m }
            });
            patches.push(cap.collapsed(false, true));
        }
    }
    patches
}

/// A closed sphere around the origin; the texture goes around it twice and up once.
pub fn sphere(radius_m: f64, segments: u32) -> Vec<Patch> {
    let rows = (segments / 2).max(2);
    let patch = Patch::new(segments.max(3), rows, move |s, t| {
        let (sine, cosine) = sin_cos_turns(s);
        let (height, width) = sin_cos_turns(t * 0.5 - 0.25);
        Point { position: dvec3(width * cosine, height, -width * sine) * radius_m, uv: dvec2(2.0 * s, 1.0 - t) }
    });
    vec![patch.collapsed(true, true)]
}

/// A closed ring around the y axis, at y = 0.
pub fn torus(radius_m: f64, tube_m: f64, segments: u32, tube_segments: u32) -> Vec<Patch> {
    vec![Patch::new(segments.max(3), tube_segments.max(3), move |s, t| {
        let (sine, cosine) = sin_cos_turns(s);
        let (height, outward) = sin_cos_turns(t);
        let radius = radius_m + tube_m * outward;
        Point { position: dvec3(radius * cosine, tube_m * height, -radius * sine), uv: dvec2(8.0 * s, -t) }
    })]
}

/// A place at `from` whose own y axis points to `to`.
pub fn toward(from: DVec3, to: DVec3) -> DAffine3 {
    let along = (to - from).normalize();
    let beside = if along.y.abs() > 0.5 { DVec3::X } else { DVec3::Y };
    let z = along.cross(beside).normalize();
    DAffine3::from_cols(along.cross(z), along, z, from)
}

/// A closed bar with four sides from one place to the other, `half_m` wide to each side.
pub fn bar(from: DVec3, to: DVec3, half_m: f64) -> Vec<Patch> {
    let [low, high] = [dvec3(-half_m, 0.0, -half_m), dvec3(half_m, from.distance(to), half_m)];
    placed(cuboid(low, high, 0.5, Detail::COARSE), toward(from, to)).collect()
}

/// A closed tube from one place to the other, of `segments` sides, at least 3.
pub fn tube(from: DVec3, to: DVec3, radius_m: f64, segments: u32) -> Vec<Patch> {
    let length_m = from.distance(to);
    let turning = Turning { segments, repeats: 1, tile_m: 0.5, detail: Detail::COARSE };
    let profile = Curve::lines(&[[0.0, 0.0], [radius_m, 0.0], [radius_m, length_m], [0.0, length_m]]);
    placed(turned(&profile, turning), toward(from, to)).collect()
}

/// A moulding: a profile in x and y, drawn out along z from -length/2 to +length/2, open at both ends.
pub fn moulding(profile: &[Curve], length_m: f64, tile_m: f64, detail: Detail) -> Vec<Patch> {
    let mut before_m = 0.0;
    profile
        .iter()
        .map(|&curve| {
            let start_m = before_m;
            before_m += curve.length();
            Patch::new(detail.along(length_m, 1), curve.segments(detail), move |s, t| {
                let at = curve.at(t);
                let z = (0.5 - s) * length_m;
                Point { position: dvec3(at.x, at.y, z), uv: dvec2(-z, -(start_m + t * curve.length())) / tile_m }
            })
        })
        .collect()
}

/// A round arch of stones over the x axis: half a ring between two radii, from y = 0, from z = `back_m` to `front_m`.
/// Closed.
pub fn arch(radii_m: [f64; 2], back_m: f64, front_m: f64, stones: u32, detail: Detail) -> Vec<Patch> {
    let [inner_m, outer_m] = radii_m;
    let columns = detail.along(std::f64::consts::PI * outer_m, 4);
    let across = detail.along(outer_m - inner_m, 1);
    let depth = detail.along(front_m - back_m, 1);
    // `turn` runs over the arch from the left, 0 to 1.
    let at = |turn: f64, radius: f64, z: f64| {
        let (sine, cosine) = sin_cos_turns(turn * 0.5);
        dvec3(-radius * cosine, radius * sine, z)
    };
    let stones = f64::from(stones);
    let point = move |position: DVec3, along: f64, up: f64| Point { position, uv: dvec2(along * stones, 1.0 - up) };
    let radius = move |t: f64| inner_m * (1.0 - t) + outer_m * t;
    let z = move |t: f64| back_m * (1.0 - t) + front_m * t;
    let foot = |x: [f64; 2]| {
        face_of(
            [dvec3(x[0], 0.0, back_m), dvec3(x[1], 0.0, back_m), dvec3(x[1], 0.0, front_m), dvec3(x[0], 0.0, front_m)],
            Mapping::Fit,
            across,
            depth,
        )
    };
    vec![
        Patch::new(columns, across, move |s, t| point(at(s, radius(t), front_m), s, t)),
        Patch::new(columns, across, move |s, t| point(at(1.0 - s, radius(t), back_m), s, t)),
        Patch::new(columns, depth, move |s, t| point(at(s, inner_m, z(t)), s, t)),
        Patch::new(columns, depth, move |s, t| point(at(s, outer_m, z(1.0 - t)), s, t)),
        foot([-outer_m, -inner_m]),
        foot([inner_m, outer_m]),
    ]
}

/// An opening with a round head in a wall, centred on x = 0.
#[derive(Clone, Copy, Debug)]
pub struct Opening {
    /// Half the width, and the radius of the head.
    pub radius_m: f64,
    pub sill_m: f64,
    /// Where the head begins.
    pub springing_m: f64,
}

/// Where a wall stands: x from -half_width to +half_width, y from bottom to top.
#[derive(Clone, Copy, Debug)]
pub struct WallExtent {
    pub half_width_m: f64,
    pub bottom_m: f64,
    pub top_m: f64,
}

/// The face of a wall with an opening, at z = 0, seen from +z.
pub fn pierced_face(wall: WallExtent, opening: Opening, tile_m: f64, detail: Detail) -> Vec<Patch> {
    let Opening { radius_m: r, sill_m, springing_m } = opening;
    let WallExtent { half_width_m: w, bottom_m, top_m } = wall;
    let rectangle = |x: [f64; 2], y: [f64; 2]| {
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| dvec3(x[i], y[j], 0.0));
        face(corners, Mapping::Repeat { tile_m }, detail)
    };
    let mut patches = Vec::new();
    for x in [[-w, -r], [r, w]] {
        if springing_m > bottom_m {
            patches.push(rectangle(x, [bottom_m, springing_m]));
        }
        patches.push(rectangle(x, [springing_m, top_m]));
    }
    if sill_m > bottom_m {
        patches.push(rectangle([-r, r], [bottom_m, sill_m]));
    }
    let columns = detail.along(std::f64::consts::PI * r, 4);
    patches.push(Patch::new(columns, detail.along(top_m - springing_m, 1), move |s, t| {
        let (sine, cosine) = sin_cos_turns(s * 0.5);
        let position = dvec3(-r * cosine, (springing_m + r * sine) * (1.0 - t) + top_m * t, 0.0);
        Point { position, uv: dvec2(position.x, -position.y) / tile_m }
    }));
    patches
}

/// The inside of an opening: jambs, head and sill, from z = 0 back to -`depth_m`.
pub fn reveal(opening: Opening, depth_m: f64, tile_m: f64, detail: Detail) -> Vec<Patch> {
    let Opening { radius_m: r, sill_m, springing_m } = opening;
    let side = |from: DVec2, to: DVec2| {
        let back = dvec3(0.0, 0.0, -depth_m);
        let corners = [from.extend(0.0), to.extend(0.0), to.extend(0.0) + back, from.extend(0.0) + back];
        face(corners, Mapping::Repeat { tile_m }, detail)
    };
    let columns = detail.along(std::f64::consts::PI * r, 4);
    let head = Patch::new(columns, detail.along(depth_m, 1), move |s, t| {
        let (sine, cosine) = sin_cos_turns(s * 0.5);
        let uv = dvec2(s * std::f64::consts::PI * r, -t * depth_m) / tile_m;
        Point { position: dvec3(r * cosine, springing_m + r * sine, -depth_m * t), uv }
    });
    vec![
        side(dvec2(r, sill_m), dvec2(r, springing_m)),
        head,
        side(dvec2(-r, springing_m), dvec2(-r, sill_m)),
        side(dvec2(-r, sill_m), dvec2(r, sill_m)),
    ]
}

/// A pane that fills an opening at z = 0, the picture once over its bounding rectangle, seen from +z.
pub fn pane(opening: Opening, detail: Detail) -> Vec<Patch> {
    let Opening { radius_m: r, sill_m, springing_m } = opening;
    let columns = detail.along(std::f64::consts::PI * r, 4);
    let height_m = springing_m + r - sill_m;
    vec![Patch::new(columns, detail.along(height_m, 1), move |s, t| {
        let (sine, cosine) = sin_cos_turns(s * 0.5);
        let position = dvec3(-r * cosine, sill_m * (1.0 - t) + (springing_m + r * sine) * t, 0.0);
        let uv = dvec2(0.5 + position.x / (2.0 * r), 1.0 - (position.y - sill_m) / height_m);
        Point { position, uv }
    })]
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::super::patch::mesh;
    use super::*;
    use crate::scene::Mesh;
    use crate::scene::procedural::checks;

    const FINE: Detail = Detail { edge_m: 0.11 };

    fn turning(segments: u32) -> Turning {
        Turning { segments, repeats: 2, tile_m: 1.0, detail: FINE }
    }

    /// Each edge, as two exact positions, must be walked once in each direction.
    fn assert_watertight(mesh: &Mesh) {
        let mut edges = BTreeMap::<_, i32>::new();
        for triangle in 0..mesh.triangle_count() {
            let corners = mesh.triangle(triangle).map(|corner| corner.to_array().map(f32::to_bits));
            for edge in 0..3 {
                *edges.entry((corners[edge], corners[(edge + 1) % 3])).or_default() += 1;
            }
        }
        for ((from, to), count) in &edges {
            assert_eq!(*count, 1, "{}: an edge is walked {count} times", mesh.name);
            assert_eq!(edges.get(&(*to, *from)), Some(&1), "{}: an edge has one side only", mesh.name);
        }
    }

    #[test]
    fn closed_shapes_are_watertight_and_face_outward() {
        let vase = [
            Curve::line([0.0, 0.0], [0.2, 0.0]),
            Curve::bent([0.2, 0.0], [0.6, 0.3], [0.1, 0.8]),
            Curve::line([0.1, 0.8], [0.0, 0.8]),
        ];
        let lobes = |turns: f64, _: usize, t: f64| 1.0 + 0.1 * sin_cos_turns(6.0 * turns).0 * t * (1.0 - t);
        let shapes = [
            ("cuboid", cuboid(dvec3(-0.5, -0.2, -0.3), dvec3(0.4, 0.5, 0.6), 1.0, FINE)),
            ("divided cuboid", cuboid_of(dvec3(-0.5, -0.2, -0.3), dvec3(0.4, 0.5, 0.6), 1.0, [3, 1, 2])),
            ("vase", turned(&vase, turning(16))),
            ("lobed vase", turned_with(&vase, turning(24), lobes)),
            ("prism", prism(7, [0.5, 0.3], 0.9, 1.0)),
            ("sphere", sphere(0.7, 20)),
            ("torus", torus(0.6, 0.2, 20, 9)),
            ("arch", arch([0.6, 0.9], -0.2, 0.3, 9, FINE)),
            ("bar", bar(dvec3(0.1, 0.2, -0.3), dvec3(0.9, -0.4, 0.5), 0.1)),
            ("tube", tube(dvec3(0.1, 0.2, -0.3), dvec3(0.2, 1.4, 0.1), 0.15, 9)),
        ];
        for (name, patches) in shapes {
            let mesh = mesh(name, 0, &patches, true);
            checks::assert_mesh_is_sound(&mesh);
            assert_watertight(&mesh);
            // The volume that the faces enclose is positive where they face outward.
            let volume: f32 = (0..mesh.triangle_count())
                .map(|triangle| {
                    let [a, b, c] = mesh.triangle(triangle);
                    a.dot(b.cross(c)) / 6.0
                })
                .sum();
            assert!(volume > 0.0, "{name}: volume {volume}");
        }
    }

    #[test]
    fn open_shapes_are_sound() {
        let opening = Opening { radius_m: 0.5, sill_m: 0.8, springing_m: 1.5 };
        let wall = WallExtent { half_width_m: 1.0, bottom_m: 0.0, top_m: 3.0 };
        let cornice = [Curve::line([0.0, 0.0], [0.2, 0.0]), Curve::bent([0.2, 0.0], [0.2, 0.2], [0.4, 0.2])];
        for (name, patches, toward) in [
            ("wall", pierced_face(wall, opening, 1.0, FINE), DVec3::Z),
            ("pane", pane(opening, FINE), DVec3::Z),
            ("moulding", moulding(&cornice, 2.0, 1.0, FINE), dvec3(1.0, -1.0, 0.0)),
        ] {
            let mesh = mesh(name, 0, &patches, true);
            checks::assert_mesh_is_sound(&mesh);
            assert!(mesh.normals.iter().all(|normal| normal.as_dvec3().dot(toward) > 0.0), "{name}");
        }
        let inside = mesh("reveal", 0, &reveal(opening, 0.4, 1.0, FINE), true);
        checks::assert_mesh_is_sound(&inside);
        let center = dvec3(0.0, 1.4, -0.2);
        for (position, normal) in inside.positions.iter().zip(&inside.normals) {
            assert!((center - position.as_dvec3()).dot(normal.as_dvec3()) > 0.0, "{position}");
        }
    }
}
