//! Atlases: whether a set of a mesh's coordinates gives each triangle a place of a texture to itself, as shading into textures needs
//! it (Andersson et al. 2014, as Clarberg & Munkberg 2014 describe it in sections 2 and 6: "a unique mapping of each triangle").
//!
//! Overlaps are looked for at the middles of a texture's texels: one that lies well inside two triangles is one. That takes a row
//! of the texture a triangle at most, and a word a texel. What no middle shows is not seen: it is less than a texel wide.

use super::Mesh;
use glam::{DVec2, Vec2, Vec3};
use std::collections::HashMap;
use std::fmt;

/// Texels by which a middle must lie inside a triangle: of a texture of 8192 coordinates of 32 bits are rounded to a 2048th of
/// a texel, so that neighbours along an edge never both have it.
const INSIDE: f64 = 1.0 / 64.0;

/// How far outside the unit square coordinates may lie because of rounding in the program that wrote them.
const ROUNDING: f32 = 1e-5;

const NOBODY: u32 = u32::MAX;

/// Coordinates of a mesh at which no triangle lies over another.
#[derive(Debug)]
pub struct Atlas {
    /// One a vertex, in the unit square.
    pub coordinates: Vec<Vec2>,
    /// Chart of each triangle, a connected part of the atlas: an index into `sides`.
    pub charts: Vec<u32>,
    /// The shorter side of the box around each chart, a part of the texture's.
    pub sides: Vec<f32>,
}

/// Why coordinates are no atlas. Triangles by their place in the mesh's list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Flaw {
    Outside {
        triangle: usize,
        at: Vec2,
    },
    /// It has an area in space and none in the atlas.
    Flat {
        triangle: usize,
        at: Vec2,
    },
    Overlap {
        triangles: [usize; 2],
        at: Vec2,
    },
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Outside { triangle, at: Vec2 { x, y } } => {
                write!(f, "triangle {triangle} reaches ({x}, {y}): all do not fit into 0 to 1")
            }
            Self::Flat { triangle, at: Vec2 { x, y } } => {
                write!(f, "triangle {triangle} has no area there, at ({x}, {y})")
            }
            Self::Overlap { triangles: [a, b], at: Vec2 { x, y } } => {
                write!(f, "triangles {a} and {b} overlap at ({x}, {y})")
            }
        }
    }
}

impl Atlas {
    /// The first of the mesh's sets of coordinates that is one for textures of `side_px` texels: that which was laid out for it, the
    /// first, the second. Those of one unit square are brought into the first: textures repeat.
    ///
    /// Errors: what is wrong with each that the mesh has, and its name.
    pub fn of(mesh: &Mesh, side_px: u32) -> Result<Self, Vec<(&'static str, Flaw)>> {
        let sets = [("atlas", &mesh.atlas), ("first coordinates", &mesh.uvs), ("second coordinates", &mesh.uvs_1)];
        let mut flaws = Vec::new();
        for (name, coordinates) in sets.into_iter().filter(|(_, coordinates)| !coordinates.is_empty()) {
            let coordinates = in_first_square(coordinates);
            match find_flaw(mesh, &coordinates, side_px) {
                None => {
                    let (charts, sides) = charts(mesh, &coordinates);
                    return Ok(Self { coordinates, charts, sides });
                }
                Some(flaw) => flaws.push((name, flaw)),
            }
        }
        Err(flaws)
    }
}

/// Moved by whole numbers, so that the middle of all is in 0 to 1; what rounding has left outside is on the rim.
fn in_first_square(coordinates: &[Vec2]) -> Vec<Vec2> {
    let (least, greatest) = coordinates
        .iter()
        .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(least, greatest), at| (least.min(*at), greatest.max(*at)));
    let square = least.midpoint(greatest).floor();
    let moved = |at: &Vec2| {
        let (at, rim) = (*at - square, (*at - square).clamp(Vec2::ZERO, Vec2::ONE));
        if at.abs_diff_eq(rim, ROUNDING) { rim } else { at }
    };
    coordinates.iter().map(moved).collect()
}

fn corners(mesh: &Mesh, coordinates: &[Vec2], triangle: usize) -> [Vec2; 3] {
    mesh.corners(triangle).map(|vertex| coordinates[vertex])
}

fn find_flaw(mesh: &Mesh, coordinates: &[Vec2], side_px: u32) -> Option<Flaw> {
    let is_inside = |at: &Vec2| at.cmpge(Vec2::ZERO).all() && at.cmple(Vec2::ONE).all();
    for triangle in 0..mesh.triangle_count() {
        let corners = corners(mesh, coordinates, triangle);
        if let Some(at) = corners.into_iter().find(|at| !is_inside(at)) {
            return Some(Flaw::Outside { triangle, at });
        }
        let [a, b, c] = corners.map(|corner| corner.as_dvec2());
        if (b - a).perp_dot(c - a) == 0.0 && has_area(mesh.triangle(triangle)) {
            return Some(Flaw::Flat { triangle, at: corners[0] });
        }
    }
    let side = side_px as usize;
    let mut owners = vec![NOBODY; side * side];
    for triangle in 0..mesh.triangle_count() {
        let texels = corners(mesh, coordinates, triangle).map(|corner| corner.as_dvec2() * f64::from(side_px));
        let bounds = |axis: fn(DVec2) -> f64| {
            let values = texels.map(axis);
            [values[0].min(values[1]).min(values[2]), values[0].max(values[1]).max(values[2])]
        };
        let [top, bottom] = bounds(|at| at.y);
        for y in top.floor() as usize..(bottom.ceil() as usize).min(side) {
            let middle = y as f64 + 0.5;
            // The square around a middle is inside where both its upper and its lower side are: triangles are convex.
            let [upper, lower] = [middle - INSIDE, middle + INSIDE].map(|y| span(texels, y));
            let from = upper[0].max(lower[0]) + INSIDE;
            let to = upper[1].min(lower[1]) - INSIDE;
            for x in (from - 0.5).ceil().max(0.0) as usize..((to - 0.5).floor() + 1.0).clamp(0.0, side as f64) as usize
            {
                let owner = &mut owners[y * side + x];
                if *owner != NOBODY {
                    let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / side_px as f32;
                    return Some(Flaw::Overlap { triangles: [*owner as usize, triangle], at });
                }
                *owner = triangle as u32;
            }
        }
    }
    None
}

fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(|corner| corner.as_dvec3());
    (b - a).cross(c - a).length_squared() > 0.0
}

/// From where to where a triangle lies on a line across; from beyond where it ends, where it does not.
fn span(corners: [DVec2; 3], y: f64) -> [f64; 2] {
    let mut span = [f64::INFINITY, f64::NEG_INFINITY];
    for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(from, to)| (corners[from], corners[to])) {
        if (from.y <= y) != (to.y <= y) {
            let x = from.x + (y - from.y) / (to.y - from.y) * (to.x - from.x);
            span = [span[0].min(x), span[1].max(x)];
        }
    }
    span
}

/// One end of an edge: where it is in the atlas and in space, as bits.
type End = [u32; 5];

/// The chart of each triangle, and each chart's shorter side. Triangles that share an edge, in the atlas and in space, are of one.
fn charts(mesh: &Mesh, coordinates: &[Vec2]) -> (Vec<u32>, Vec<f32>) {
    let end = |vertex: usize| -> End {
        let (at, position) = (coordinates[vertex], mesh.positions[vertex]);
        // Adding +0 makes equal what is equal: -0 becomes +0.
        [at.x, at.y, position.x, position.y, position.z].map(|number| (number + 0.0).to_bits())
    };
    let count = mesh.triangle_count();
    let mut parents: Vec<u32> = (0..count as u32).collect();
    let mut edges: HashMap<[End; 2], u32> = HashMap::with_capacity(2 * count);
    for triangle in 0..count {
        let [a, b, c] = mesh.corners(triangle).map(end);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let neighbour = *edges.entry([from.min(to), from.max(to)]).or_insert(triangle as u32);
            let [kept, joined] = [root(&mut parents, neighbour), root(&mut parents, triangle as u32)];
            parents[joined.max(kept) as usize] = joined.min(kept);
        }
    }
    let mut boxes: Vec<[Vec2; 2]> = Vec::new();
    let mut charts = vec![0; count];
    for triangle in 0..count {
        let first = root(&mut parents, triangle as u32) as usize;
        if first == triangle {
            charts[triangle] = boxes.len() as u32;
            boxes.push([Vec2::INFINITY, Vec2::NEG_INFINITY]);
        }
        // A chart's first triangle is the least of it: it has been here.
        charts[triangle] = charts[first];
        let [least, greatest] = &mut boxes[charts[first] as usize];
        for at in corners(mesh, coordinates, triangle) {
            (*least, *greatest) = (least.min(at), greatest.max(at));
        }
    }
    (charts, boxes.into_iter().map(|[least, greatest]| (greatest - least).min_element()).collect())
}

/// The least triangle known of a chart.
fn root(parents: &mut [u32], mut triangle: u32) -> u32 {
    while parents[triangle as usize] != triangle {
        parents[triangle as usize] = parents[parents[triangle as usize] as usize];
        triangle = parents[triangle as usize];
    }
    triangle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural;

    const SIDE_PX: u32 = 64;

    /// Triangles of their own vertices; in space they lie where they do in the atlas.
    fn mesh(triangles: &[[[f32; 2]; 3]]) -> Mesh {
        let atlas: Vec<Vec2> = triangles.iter().flatten().map(|at| Vec2::from_array(*at)).collect();
        let positions = atlas.iter().map(|at| at.extend(0.0)).collect();
        Mesh { indices: (0..atlas.len() as u32).collect(), positions, uvs: atlas, ..Mesh::default() }
    }

    fn flaw(mesh: &Mesh) -> Flaw {
        Atlas::of(mesh, SIDE_PX).map(|_| ()).unwrap_err()[0].1
    }

    /// Halves of a square, one of a whole turn around a point, and what is next to it: every texel's middle of an edge at 45 degrees
    /// lies on it.
    #[test]
    fn edges_that_triangles_share_are_nobodys_overlap() {
        let lower = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        let halves = mesh(&[lower, [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]);
        let atlas = Atlas::of(&halves, SIDE_PX).unwrap();
        assert_eq!((atlas.charts, atlas.sides), (vec![0, 0], vec![1.0]));
        let fan: Vec<_> = (0..12)
            .map(|index| {
                let at = |index: u32| {
                    let angle = f64::from(index) / 12.0 * std::f64::consts::TAU;
                    [(0.5 + 0.5 * angle.cos()) as f32, (0.5 + 0.5 * angle.sin()) as f32]
                };
                [[0.5, 0.5], at(index), at((index + 1) % 12)]
            })
            .collect();
        assert_eq!(Atlas::of(&mesh(&fan), SIDE_PX).unwrap().charts, [0; 12]);
    }

    #[test]
    fn triangles_over_each_other_are_found_and_named() {
        let apart = [[0.6, 0.6], [0.9, 0.6], [0.9, 0.9]];
        let [over, under] = [[[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]], [[0.4, 0.0], [0.45, 0.4], [0.05, 0.3]]];
        let Flaw::Overlap { triangles, at } = flaw(&mesh(&[over, apart, under])) else { panic!("they overlap") };
        assert_eq!(triangles, [0, 2]);
        assert!(at.x + at.y < 0.5 && at.x > 0.05, "{at}");
        // A texel's width of it is enough, and the sense of either does not matter.
        let [a, b] = [[[0.0, 0.0], [0.5, 0.0], [0.5, 0.5]], [[0.0, 0.0], [0.0, 0.5], [0.52, 0.5]]];
        assert!(matches!(flaw(&mesh(&[a, b])), Flaw::Overlap { triangles: [0, 1], .. }));
    }

    #[test]
    fn what_leaves_the_texture_or_has_no_area_in_it_is_named() {
        let fine = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]];
        let outside = mesh(&[fine, [[0.6, 0.6], [0.9, 0.6], [1.5, 0.9]]]);
        assert_eq!(flaw(&outside), Flaw::Outside { triangle: 1, at: Vec2::new(1.5, 0.9) });
        let mut flat = mesh(&[fine, [[0.6, 0.6], [0.7, 0.7], [0.8, 0.8]]]);
        // Without an area in space it needs none: nobody sees it.
        assert!(Atlas::of(&flat, SIDE_PX).is_ok());
        flat.positions[4] = Vec3::Z;
        assert_eq!(flaw(&flat), Flaw::Flat { triangle: 1, at: Vec2::splat(0.6) });
        assert_eq!(flaw(&flat).to_string(), "triangle 1 has no area there, at (0.6, 0.6)");
        let moved = [[1.0, -3.0], [1.5, -3.0], [1.0, -2.0]];
        assert_eq!(Atlas::of(&mesh(&[moved]), SIDE_PX).unwrap().coordinates[2], Vec2::Y, "it is of one square");
        let rounded = [[-1e-6, 0.0], [1.000001, 0.0], [0.0, 1.0]];
        assert_eq!(Atlas::of(&mesh(&[rounded]), SIDE_PX).unwrap().coordinates[1], Vec2::X, "it is on the rim");
        let not_a_number = mesh(&[[[f32::NAN, 0.0], [0.5, 0.0], [0.0, 0.5]]]);
        assert!(matches!(flaw(&not_a_number), Flaw::Outside { triangle: 0, .. }));
    }

    #[test]
    fn the_second_coordinates_serve_where_the_first_do_not() {
        let mut mesh = mesh(&[[[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]]; 2]);
        assert!(Atlas::of(&mesh, SIDE_PX).is_err());
        mesh.uvs_1 = mesh.uvs.clone();
        mesh.uvs_1[3..].iter_mut().for_each(|at| *at += 0.5);
        let atlas = Atlas::of(&mesh, SIDE_PX).unwrap();
        assert_eq!((atlas.charts, atlas.sides), (vec![0, 1], vec![0.5; 2]));
        mesh.uvs_1[0] = Vec2::splat(2.0);
        let names: Vec<_> = Atlas::of(&mesh, SIDE_PX).unwrap_err().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["first coordinates", "second coordinates"]);
    }

    /// Where positions or coordinates are parted, so are charts; normals part none.
    #[test]
    fn charts_end_at_seams() {
        let square = [[[0.0, 0.0], [0.5, 0.0], [0.5, 0.5]], [[0.0, 0.0], [0.5, 0.5], [0.0, 0.5]]];
        let mut mesh = mesh(&square);
        mesh.normals = [Vec3::X, Vec3::Y].into_iter().flat_map(|normal| [normal; 3]).collect();
        assert_eq!(Atlas::of(&mesh, SIDE_PX).unwrap().sides, [0.5]);
        mesh.positions[3..].iter_mut().for_each(|position| position.z += 1.0);
        assert_eq!(Atlas::of(&mesh, SIDE_PX).unwrap().charts, [0, 1]);
    }

    /// One chart a patch, and nothing of one in another.
    #[test]
    fn built_in_scenes_have_atlases() {
        for spec in ["cornell", "lamps:objects=8", "fence"] {
            for mesh in procedural::build(spec, 1).unwrap().unwrap().meshes {
                let atlas = Atlas::of(&mesh, 512).unwrap_or_else(|flaws| panic!("{spec}: {}: {flaws:?}", mesh.name));
                assert_eq!(atlas.coordinates, mesh.atlas, "{spec}: {}", mesh.name);
                assert!(
                    atlas.sides.iter().all(|side| (0.0..=1.0).contains(side) && *side > 0.0),
                    "{spec}: {}",
                    mesh.name
                );
            }
        }
    }
}
