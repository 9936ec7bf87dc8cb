//! The surface of a mesh as a shadow volume needs it (Heidmann 1991; Kircher & Lawrance 2009, section 4): triangles over
//! places instead of vertices, the two triangles at each edge, and whether the surface is closed.
//!
//! It is closed where each edge is walked as often one way as the other: a two-manifold of one winding, in which that is
//! once each, or several of them that touch. Triangles two of whose corners are in one place are left out.

use glam::Vec3;
use rayon::prelude::*;

use super::Mesh;
use super::places::Places;

/// A mesh's surface, in its object space.
#[derive(Debug)]
pub struct Shell {
    /// Metres, each once.
    pub positions: Vec<Vec3>,
    /// Indices into `positions`, counter-clockwise from outside as the mesh has them.
    pub triangles: Vec<[u32; 3]>,
    /// Edges that two triangles share.
    pub edges: Vec<Edge>,
    /// How many edges of triangles have no counterpart: where the surface ends, and where its winding turns.
    pub open_edge_count: usize,
}

/// Where two triangles meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Indices into `Shell::positions`.
    pub places: [u32; 2],
    /// Indices into `Shell::triangles`: of the one that walks the edge so, and of the one that walks it the other way.
    pub triangles: [u32; 2],
}

impl Shell {
    /// In n log n of the mesh's triangles, in memory linear in them.
    pub fn of(mesh: &Mesh) -> Self {
        let places = Places::of(&mesh.positions);
        let positions = places.iter().map(|vertices| mesh.positions[vertices[0] as usize]).collect();
        let triangles: Vec<[u32; 3]> = (0..mesh.triangle_count())
            .map(|triangle| mesh.corners(triangle).map(|vertex| places.of_vertex[vertex]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        // Sorted: the same edge side by side, one direction before the other.
        let mut sides: Vec<([u32; 2], bool, u32)> = triangles
            .par_iter()
            .enumerate()
            .flat_map_iter(|(triangle, [a, b, c])| {
                let side = move |from: u32, to: u32| ([from.min(to), from.max(to)], from > to, triangle as u32);
                [side(*a, *b), side(*b, *c), side(*c, *a)]
            })
            .collect();
        sides.par_sort_unstable();
        let mut shell = Self { positions, triangles, edges: Vec::new(), open_edge_count: 0 };
        for of_edge in sides.chunk_by(|a, b| a.0 == b.0) {
            let (forward, backward) = of_edge.split_at(of_edge.partition_point(|side| !side.1));
            shell.edges.extend(
                forward.iter().zip(backward).map(|(one, other)| Edge { places: one.0, triangles: [one.2, other.2] }),
            );
            shell.open_edge_count += forward.len().abs_diff(backward.len());
        }
        shell
    }

    /// Whether it has an inside and an outside.
    pub fn is_closed(&self) -> bool {
        self.open_edge_count == 0 && !self.triangles.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural;

    fn mesh(spec: &str, shape: &str) -> Mesh {
        let scene = procedural::build(spec, 1).unwrap().unwrap();
        scene.meshes.into_iter().find(|mesh| mesh.name.starts_with(shape)).expect("the scene has one")
    }

    #[test]
    fn closed_shapes_are_closed_and_have_eulers_number() {
        // Places - edges + triangles: 2 for what a sphere can be bent to, 0 for a ring.
        for (shape, expected) in [("block", 2), ("ball", 2), ("can", 2), ("prism", 2), ("arch", 2), ("ring", 0)] {
            let shell = Shell::of(&mesh("lamps", shape));
            assert!(shell.is_closed(), "{shape}: {} open edges", shell.open_edge_count);
            assert_eq!(2 * shell.edges.len(), 3 * shell.triangles.len(), "{shape}");
            let number = shell.positions.len() as i64 - shell.edges.len() as i64 + shell.triangles.len() as i64;
            assert_eq!(number, expected, "{shape}");
            for Edge { places: [from, to], triangles } in &shell.edges {
                for (triangle, [from, to]) in triangles.iter().zip([[*from, *to], [*to, *from]]) {
                    let corners = shell.triangles[*triangle as usize];
                    assert!((0..3).any(|side| corners[side] == from && corners[(side + 1) % 3] == to), "{shape}");
                }
            }
        }
    }

    #[test]
    fn a_lid_off_a_turned_face_and_a_sheet_are_open() {
        let whole = mesh("lamps", "block");
        let mut lidless = whole.clone();
        lidless.indices.truncate(3 * 10);
        assert_eq!(Shell::of(&lidless).open_edge_count, 4);
        let mut turned = whole.clone();
        turned.indices.swap(0, 1);
        // Its three edges are each walked twice the same way now.
        assert_eq!(Shell::of(&turned).open_edge_count, 6);
        assert!(!Shell::of(&mesh("lamps", "ground")).is_closed());
        assert!(!Shell::of(&Mesh::default()).is_closed());
    }

    #[test]
    fn triangles_without_area_and_shells_that_touch_leave_a_surface_closed() {
        let mut two = mesh("lamps", "block");
        let own = two.positions.len() as u32;
        let side_m = two.positions.iter().fold(f32::NEG_INFINITY, |most, position| most.max(position.x)) * 2.0;
        for vertex in 0..own as usize {
            two.positions.push(two.positions[vertex] + Vec3::new(side_m, 0.0, 0.0));
        }
        let further: Vec<u32> = two.indices.iter().map(|index| index + own).collect();
        two.indices.extend(further);
        two.indices.extend([0, 0, 1]);
        let shell = Shell::of(&two);
        assert!(shell.is_closed());
        assert_eq!((shell.positions.len(), shell.triangles.len(), shell.edges.len()), (12, 24, 36));
    }
}
