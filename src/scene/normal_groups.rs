//! Normal groups (Kircher & Lawrance 2009, section 3.1): the parts of a mesh over which its normals are continuous, with
//! an id of eight bits each, by which a filter sees creases without comparing normals.
//!
//! The triangles of a mesh are the nodes of its dual graph; two are joined where they share an edge, found by position,
//! and have the same normals at both of its ends. The connected parts are the groups. An edge with more than two triangles
//! joins those that agree. Triangles two of whose corners are in one place cover no pixel: they join nothing and are in
//! no group.
//!
//! **Which normals are the same.** Programs that write files round each normal for itself, to as little as a signed byte a
//! component, so the same one may come back one step further. Normals that differ by at most `TOLERANCE` are the same, and
//! so are those that a chain of such steps joins in one place. A crease shallower than that (0.9 degrees) is none.
//!
//! **Which ids.** The paper's are random. Here groups are numbered in the order of their first triangles, and each takes
//! its number modulo 256, or the next id that no group has that touches it, at a corner or along an edge: up to 256
//! groups all have different ids. Where more than 256 meet, that which the fewest of the places around have, so that
//! neighbours along an edge, which share two, still differ.
//!
//! Time is n log n in the triangles, memory linear, whatever the mesh: what a flat one of as many groups as triangles
//! costs is what a smooth one costs.

use std::collections::HashMap;

use glam::Vec3;
use rayon::prelude::*;

use super::Mesh;
use super::joined::Joined;
use super::palette::{self, Ids};
use super::places::Places;

/// How far apart the tips of two unit normals may be that are the same: rounding three components to steps of 1/127
/// moves a tip by at most 0.0068, so two roundings of one normal are 0.0136 apart.
pub const TOLERANCE: f32 = 1.0 / 64.0;

/// With how many others of its place a normal is compared at most, those nearest along x: a bound on what files made to
/// cost time can cost, which no mesh made to be looked at comes near.
const MOST_COMPARED: usize = 64;

/// Group of a triangle that is in none.
const NONE: u32 = u32::MAX;

/// Finds the groups of `mesh` and writes the id of its own into each vertex (`Mesh::normal_groups`). A vertex that
/// groups of different ids share is repeated; triangles, corners and their order stay.
pub fn assign(mesh: &mut Mesh) {
    let places = Places::of(&mesh.positions);
    let groups = Groups::of(mesh, &places);
    let ids = groups.ids(mesh, &places);
    mesh.normal_groups = vec![0; mesh.positions.len()];
    let mut is_known = vec![false; mesh.positions.len()];
    let mut further: HashMap<(u32, u8), u32> = HashMap::new();
    for triangle in 0..mesh.triangle_count() {
        let group = groups.of_triangle[triangle];
        if group == NONE {
            continue;
        }
        let id = ids[group as usize];
        for corner in 3 * triangle..3 * triangle + 3 {
            let vertex = mesh.indices[corner];
            if !std::mem::replace(&mut is_known[vertex as usize], true) {
                mesh.normal_groups[vertex as usize] = id;
            } else if mesh.normal_groups[vertex as usize] != id {
                mesh.indices[corner] = *further.entry((vertex, id)).or_insert_with(|| {
                    let repeated = mesh.repeat_vertex(vertex as usize);
                    mesh.normal_groups[repeated as usize] = id;
                    repeated
                });
            }
        }
    }
}

/// How many groups `mesh` has.
pub fn count(mesh: &Mesh) -> usize {
    Groups::of(mesh, &Places::of(&mesh.positions)).count
}

/// The connected parts of the dual graph.
struct Groups {
    /// The number of its group, or `NONE`.
    of_triangle: Vec<u32>,
    count: usize,
}

impl Groups {
    fn of(mesh: &Mesh, places: &Places) -> Self {
        let welded = welded(&mesh.normals, places);
        let triangles = || 0..mesh.triangle_count();
        let mut edges: Vec<([u32; 2], u32)> = triangles()
            .into_par_iter()
            .filter(|triangle| has_three_places(mesh, places, *triangle))
            .flat_map_iter(|triangle| {
                let [a, b, c] = mesh.corners(triangle).map(|vertex| welded[vertex]);
                [[a, b], [b, c], [c, a]].map(|[from, to]| ([from.min(to), from.max(to)], triangle as u32))
            })
            .collect();
        // Triangles that agree at both ends of an edge stand side by side then.
        edges.par_sort_unstable();
        let mut joined = Joined::new(mesh.triangle_count());
        for pair in edges.windows(2) {
            if pair[0].0 == pair[1].0 {
                joined.join(pair[0].1, pair[1].1);
            }
        }
        drop(edges);
        let mut groups = Self { of_triangle: vec![NONE; mesh.triangle_count()], count: 0 };
        for triangle in triangles() {
            if has_three_places(mesh, places, triangle) {
                // The first of a group stands for it: it has its number before the others ask for it.
                let first = joined.first(triangle as u32) as usize;
                if first == triangle {
                    groups.of_triangle[triangle] = groups.count as u32;
                    groups.count += 1;
                } else {
                    groups.of_triangle[triangle] = groups.of_triangle[first];
                }
            }
        }
        groups
    }

    /// The id of each.
    fn ids(&self, mesh: &Mesh, places: &Places) -> Vec<u8> {
        if self.count <= 256 {
            return (0..self.count).map(|group| group as u8).collect();
        }
        let mut members: Vec<(u32, u32)> = (0..mesh.triangle_count() as u32)
            .map(|triangle| (self.of_triangle[triangle as usize], triangle))
            .filter(|(group, _)| *group != NONE)
            .collect();
        members.par_sort_unstable();
        let mut at_place = vec![Ids::default(); places.count()];
        let mut ids = Vec::with_capacity(self.count);
        for of_group in members.chunk_by(|a, b| a.0 == b.0) {
            let corners = of_group.iter().flat_map(|(_, triangle)| mesh.corners(*triangle as usize));
            let mut around: Vec<u32> = corners.map(|vertex| places.of_vertex[vertex]).collect();
            around.sort_unstable();
            around.dedup();
            let taken: Vec<Ids> = around.iter().map(|place| at_place[*place as usize]).collect();
            let id = palette::pick(ids.len(), &taken);
            around.iter().for_each(|place| at_place[*place as usize].insert(id));
            ids.push(id);
        }
        ids
    }
}

fn has_three_places(mesh: &Mesh, places: &Places, triangle: usize) -> bool {
    let [a, b, c] = mesh.corners(triangle).map(|vertex| places.of_vertex[vertex]);
    a != b && b != c && c != a
}

/// For each vertex the first that has its place and its normal.
fn welded(normals: &[Vec3], places: &Places) -> Vec<u32> {
    let mut joined = Joined::new(normals.len());
    let mut here: Vec<(Vec3, u32)> = Vec::new();
    for vertices in places.iter().filter(|vertices| vertices.len() > 1) {
        here.clear();
        here.extend(vertices.iter().map(|vertex| (normals[*vertex as usize], *vertex)));
        let order = |a: Vec3, b: Vec3| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z));
        here.sort_unstable_by(|a, b| order(a.0, b.0).then(a.1.cmp(&b.1)));
        here.dedup_by(|later, kept| {
            let is_same = later.0 == kept.0;
            if is_same {
                joined.join(later.1, kept.1);
            }
            is_same
        });
        for (index, (normal, vertex)) in here.iter().enumerate() {
            for (before, other) in here[..index].iter().rev().take(MOST_COMPARED) {
                if normal.x - before.x > TOLERANCE {
                    break;
                }
                if normal.distance_squared(*before) <= TOLERANCE * TOLERANCE {
                    joined.join(*vertex, *other);
                }
            }
        }
    }
    (0..normals.len() as u32).map(|vertex| joined.first(vertex)).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use proptest::prelude::*;

    use super::*;
    use crate::scene::procedural;

    /// Triangles that share no vertices: each corner's position and normal.
    fn soup(corners: &[(Vec3, Vec3)]) -> Mesh {
        let (positions, normals): (Vec<Vec3>, Vec<Vec3>) = corners.iter().copied().unzip();
        Mesh { indices: (0..positions.len() as u32).collect(), positions, normals, ..Mesh::default() }
    }

    /// The same mesh with a vertex for each corner.
    fn parted(mesh: &Mesh) -> Mesh {
        let corner = |vertex: &u32| (mesh.positions[*vertex as usize], mesh.normals[*vertex as usize]);
        soup(&mesh.indices.iter().map(corner).collect::<Vec<_>>())
    }

    fn flat(mesh: &Mesh) -> Mesh {
        let mut flat = parted(mesh);
        for triangle in 0..flat.triangle_count() {
            let [a, b, c] = flat.triangle(triangle);
            let normal = (b - a).cross(c - a).normalize();
            flat.corners(triangle).into_iter().for_each(|vertex| flat.normals[vertex] = normal);
        }
        flat
    }

    fn lamps_mesh(shape: &str) -> Mesh {
        let scene = procedural::build("lamps", 1).unwrap().unwrap();
        scene.meshes.into_iter().find(|mesh| mesh.name.starts_with(&format!("{shape}_"))).expect("the scene has one")
    }

    /// The group of each triangle, numbered by first triangles: the rule of the module's header, every pair tried.
    fn slow(mesh: &Mesh) -> Vec<Option<usize>> {
        let corners =
            |triangle: usize| mesh.corners(triangle).map(|vertex| (mesh.positions[vertex], mesh.normals[vertex]));
        let covers = |triangle: usize| {
            let [a, b, c] = mesh.triangle(triangle);
            a != b && b != c && c != a
        };
        let is_same = |a: (Vec3, Vec3), b: (Vec3, Vec3)| a.0 == b.0 && a.1.distance(b.1) <= TOLERANCE;
        let is_joined = |one: usize, other: usize| {
            (0..9).any(|pair| {
                let edge = |triangle: usize, side: usize| [corners(triangle)[side], corners(triangle)[(side + 1) % 3]];
                let ([a, b], [c, d]) = (edge(one, pair / 3), edge(other, pair % 3));
                is_same(a, c) && is_same(b, d) || is_same(a, d) && is_same(b, c)
            })
        };
        let count = mesh.triangle_count();
        let mut of_triangle: Vec<Option<usize>> = vec![None; count];
        let mut groups = 0;
        for first in (0..count).filter(|triangle| covers(*triangle)) {
            if of_triangle[first].is_some() {
                continue;
            }
            let mut waiting = vec![first];
            while let Some(one) = waiting.pop() {
                if of_triangle[one].replace(groups).is_none() {
                    let near = (0..count).filter(|other| covers(*other) && is_joined(one, *other));
                    waiting.extend(near.filter(|other| of_triangle[*other].is_none()));
                }
            }
            groups += 1;
        }
        of_triangle
    }

    fn found(mesh: &Mesh) -> Vec<Option<usize>> {
        let groups = Groups::of(mesh, &Places::of(&mesh.positions));
        groups.of_triangle.iter().map(|group| (*group != NONE).then_some(*group as usize)).collect()
    }

    /// Every triangle that is in a group has its id at all corners, and groups that meet have different ones. Returns the
    /// ids of the groups.
    fn require_ids(mesh: &Mesh) -> BTreeMap<usize, u8> {
        let mut assigned = mesh.clone();
        assign(&mut assigned);
        assert_eq!(assigned.normal_groups.len(), assigned.positions.len());
        assert_eq!(assigned.indices.len(), mesh.indices.len());
        let (mut ids, mut at_place) = (BTreeMap::new(), BTreeMap::<_, BTreeSet<(usize, u8)>>::new());
        for (triangle, group) in found(mesh).into_iter().enumerate() {
            assert_eq!(assigned.triangle(triangle), mesh.triangle(triangle), "corners stay in place and order");
            let Some(group) = group else { continue };
            for vertex in assigned.corners(triangle) {
                let id = assigned.normal_groups[vertex];
                assert_eq!(*ids.entry(group).or_insert(id), id, "one id a group");
                let place = (assigned.positions[vertex] + Vec3::ZERO).to_array().map(f32::to_bits);
                at_place.entry(place).or_default().insert((group, id));
            }
        }
        for here in at_place.values().filter(|here| here.len() <= 100) {
            let different: BTreeSet<u8> = here.iter().map(|(_, id)| *id).collect();
            assert_eq!(different.len(), here.len(), "{here:?}");
        }
        ids
    }

    #[test]
    fn shapes_have_the_groups_that_one_sees() {
        for (shape, expected) in
            [("block", 6), ("ball", 1), ("can", 3), ("ring", 1), ("prism", 8), ("cone", 2), ("arch", 6)]
        {
            let mesh = lamps_mesh(shape);
            assert_eq!(count(&mesh), expected, "{shape}");
            assert_eq!(count(&parted(&mesh)), expected, "{shape} without shared vertices");
            let ids: BTreeSet<u8> = require_ids(&mesh).into_values().collect();
            assert_eq!(ids.len(), expected, "{shape}: so few groups all have different ids");
        }
    }

    /// A sheet of 4 x 4 quads in z = 0 whose normals lean over the line x = 2 to either side, from y = 0 to `end`.
    fn folded(end: usize) -> Mesh {
        let mut corners = Vec::new();
        for quad in 0..16 {
            let (x, y) = (quad % 4, quad / 4);
            let corner = |dx: usize, dy: usize| {
                let is_on_fold = x + dx == 2 && y + dy <= end;
                let lean = if x < 2 { -1.0 } else { 1.0 };
                let normal = if is_on_fold { Vec3::new(lean, 0.0, 1.0).normalize() } else { Vec3::Z };
                (Vec3::new((x + dx) as f32, (y + dy) as f32, 0.0), normal)
            };
            corners.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 0), corner(1, 1), corner(0, 1)]);
        }
        soup(&corners)
    }

    #[test]
    fn a_crease_cuts_where_it_goes_all_the_way() {
        // From y = 0 to 2 both sides are still one surface around its end.
        assert_eq!(count(&folded(2)), 1);
        assert_eq!(count(&folded(3)), 2, "the last edge's normals agree at one end only");
        assert_eq!(count(&folded(4)), 2);
    }

    #[test]
    fn an_edge_whose_normals_agree_at_one_end_only_is_cut() {
        let lean = Vec3::new(0.6, 0.0, 0.8);
        let pair = |at_end: Vec3| {
            let (a, b, c, d) = (Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::NEG_X);
            soup(&[(a, Vec3::Z), (c, Vec3::Z), (b, Vec3::Z), (b, at_end), (d, Vec3::Z), (a, Vec3::Z)])
        };
        assert_eq!(count(&pair(Vec3::Z)), 1);
        assert_eq!(count(&pair(lean)), 2);
        assert_eq!(count(&pair(Vec3::new(0.01, 0.0, 1.0).normalize())), 1, "rounding is no crease");
        assert_eq!(count(&pair(Vec3::new(0.02, 0.0, 1.0).normalize())), 2, "more than that is one");
    }

    #[test]
    fn normals_rounded_to_bytes_stay_the_same() {
        let mut mesh = parted(&lamps_mesh("vase"));
        let whole = count(&mesh);
        for (corner, normal) in mesh.normals.iter_mut().enumerate() {
            // Every second one is rounded up or down as it comes, the others to the nearest.
            let rounded = |component: f32| match corner % 3 {
                0 => (component * 127.0).floor() / 127.0,
                1 => (component * 127.0).ceil() / 127.0,
                _ => (component * 127.0).round() / 127.0,
            };
            *normal = Vec3::from_array(normal.to_array().map(rounded)).normalize();
        }
        assert_eq!(count(&mesh), whole);
    }

    #[test]
    fn a_vertex_that_two_groups_share_is_repeated() {
        // Two triangles that meet in a point.
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y];
        let normals = vec![Vec3::Z; 5];
        let mut mesh = Mesh { positions, normals, indices: vec![0, 1, 2, 0, 3, 4], ..Mesh::default() };
        assign(&mut mesh);
        assert_eq!(mesh.indices, [0, 1, 2, 5, 3, 4]);
        assert_eq!(mesh.normal_groups, [0, 0, 0, 1, 1, 1]);
        assert_eq!((mesh.positions.len(), mesh.positions[5]), (6, Vec3::ZERO));
        assert!(mesh.uvs.is_empty() && mesh.tangents.is_empty());
    }

    #[test]
    fn triangles_without_area_join_nothing() {
        // The middle one has a corner on either side of a crease.
        let (a, b, c, d) = (Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::NEG_X);
        let left = [(a, Vec3::X), (b, Vec3::X), (d, Vec3::X)];
        let between = [(a, Vec3::X), (b, Vec3::X), (b, Vec3::Z)];
        let right = [(a, Vec3::Z), (c, Vec3::Z), (b, Vec3::Z)];
        assert_eq!(count(&soup(&[left, between, right].concat())), 2);
        let nothing = soup(&between);
        assert_eq!(count(&nothing), 0);
        assert!(require_ids(&nothing).is_empty());
        assert_eq!(count(&Mesh::default()), 0);
    }

    #[test]
    fn more_groups_than_ids_differ_where_they_meet() {
        let mesh = flat(&lamps_mesh("ring"));
        let ids = require_ids(&mesh);
        assert!(ids.len() > 500, "{}", ids.len());
        assert_eq!(ids.values().collect::<BTreeSet<_>>().len(), 256, "all ids are used");
    }

    #[test]
    fn where_more_than_256_groups_meet_those_along_an_edge_still_differ() {
        const SIDES: usize = 1001;
        let rim = |side: usize| {
            let angle = (side % SIDES) as f32 / SIDES as f32 * std::f32::consts::TAU;
            Vec3::new(angle.cos(), angle.sin(), 0.0)
        };
        let triangle = |side: usize| [Vec3::Z * 0.1, rim(side), rim(side + 1)];
        // Normals that lean to and fro, by more than the tolerance, are as many groups as triangles.
        let normal = |side: usize| Vec3::new(0.3 * (side % 2) as f32, (side % 7) as f32, 9.0).normalize();
        let corners: Vec<_> =
            (0..SIDES).flat_map(|side| triangle(side).map(|position| (position, normal(side)))).collect();
        let ids: Vec<u8> = require_ids(&soup(&corners)).into_values().collect();
        assert_eq!(ids.len(), SIDES);
        assert!((0..SIDES).all(|side| ids[side] != ids[(side + 1) % SIDES]), "{ids:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Few places and few normals, so that triangles meet in every way, a little beside each other as rounding leaves
        /// them; edges with many triangles, repeated triangles, triangles without area.
        #[test]
        fn groups_are_those_that_trying_every_pair_finds(
            corners in prop::collection::vec((0usize..7, 0usize..3, -1i8..=1), 3..90)
        ) {
            let places = [
                Vec3::ZERO, Vec3::new(-0.0, 0.0, 1.0), Vec3::X, Vec3::Y, Vec3::ONE, Vec3::NEG_X, Vec3::new(0.0, -0.0, 1.0),
            ];
            let normals = [Vec3::Z, Vec3::X, Vec3::new(0.1, 0.0, 1.0).normalize()];
            let corner = |(place, normal, shift): &(usize, usize, i8)| {
                (places[*place], normals[*normal] + Vec3::Y * (f32::from(*shift) * 0.004))
            };
            let whole = corners.len() / 3 * 3;
            let mesh = soup(&corners[..whole].iter().map(corner).collect::<Vec<_>>());
            prop_assert_eq!(found(&mesh), slow(&mesh));
            require_ids(&mesh);
        }
    }
}
