//! BLEND surfaces in parts that hang together. What is sorted by its distance, or lit in a layer of its own, is a draw: panes of
//! a whole building that are one primitive would have one place in the order, and one layer (Kircher & Lawrance 2009,
//! section 4, gives layers by hand, a pane each). Time is n log n in the vertices, memory some 20 bytes a vertex meanwhile.

use crate::scene::gltf::topology;
use crate::scene::joined::Joined;
use crate::scene::places::Places;
use crate::scene::{Bounds, Mesh};
use glam::Vec3;

/// Parts of a primitive at most; where more hang together, neighbours are one.
const MOST_PARTS: usize = 256;

/// The parts of `mesh` whose triangles touch in a vertex's place, in the order of their first triangles.
pub fn split(mesh: Mesh) -> Vec<Mesh> {
    let mut parts = connected(&mesh);
    if parts.len() > MOST_PARTS {
        let mut near: Vec<Part> = parts.into_iter().map(|triangles| Part::new(&mesh, triangles)).collect();
        parts = joined(&mut near, MOST_PARTS);
        parts.sort_by_key(|triangles| triangles[0]);
    }
    if parts.len() <= 1 {
        return vec![mesh];
    }
    let part = |triangles: Vec<usize>| topology::of_triangles(&mesh, &triangles);
    parts.into_iter().map(part).collect()
}

/// Triangles that hang together, each part's ascending; parts by their first.
fn connected(mesh: &Mesh) -> Vec<Vec<usize>> {
    let places = Places::of(&mesh.positions);
    let places_of = |triangle: usize| mesh.corners(triangle).map(|vertex| places.of_vertex[vertex]);
    let mut joined = Joined::new(places.count());
    for triangle in 0..mesh.triangle_count() {
        let [a, b, c] = places_of(triangle);
        joined.join(a, b);
        joined.join(a, c);
    }
    let mut parts: Vec<Vec<usize>> = Vec::new();
    let mut part_at = vec![None; places.count()];
    for triangle in 0..mesh.triangle_count() {
        let first = joined.first(places_of(triangle)[0]) as usize;
        let part = *part_at[first].get_or_insert(parts.len());
        if part == parts.len() {
            parts.push(Vec::new());
        }
        parts[part].push(triangle);
    }
    parts
}

struct Part {
    triangles: Vec<usize>,
    middle: Vec3,
}

impl Part {
    fn new(mesh: &Mesh, triangles: Vec<usize>) -> Self {
        let mut bounds = Bounds::EMPTY;
        triangles.iter().flat_map(|triangle| mesh.triangle(*triangle)).for_each(|corner| bounds.include(corner));
        Self { triangles, middle: bounds.center() }
    }
}

/// The triangles of `parts` in at most `most` parts: halved where they reach farthest, until there are as many.
fn joined(parts: &mut [Part], most: usize) -> Vec<Vec<usize>> {
    if most <= 1 || parts.len() <= 1 {
        let mut all: Vec<usize> = parts.iter_mut().flat_map(|part| std::mem::take(&mut part.triangles)).collect();
        all.sort_unstable();
        return vec![all];
    }
    let mut bounds = Bounds::EMPTY;
    parts.iter().for_each(|part| bounds.include(part.middle));
    let reach = bounds.max - bounds.min;
    let axis = (0..3).max_by(|a, b| reach[*a].total_cmp(&reach[*b])).unwrap_or_default();
    parts.sort_by(|a, b| a.middle[axis].total_cmp(&b.middle[axis]));
    let (near, far) = parts.split_at_mut(parts.len() / 2);
    let mut all = joined(near, most / 2);
    all.extend(joined(far, most - most / 2));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares of two triangles at these places; vertices of a square are shared, or each triangle has its own.
    fn squares(places: &[Vec3], is_shared: bool) -> Mesh {
        let mut mesh = Mesh { name: "squares".to_owned(), material: 3, ..Mesh::default() };
        for place in places {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y].map(|corner| corner + *place);
            let first = mesh.positions.len() as u32;
            if is_shared {
                mesh.positions.extend(corners);
                mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|index| first + index));
            } else {
                mesh.positions.extend([0, 1, 2, 0, 2, 3].map(|index| corners[index]));
                mesh.indices.extend(first..first + 6);
            }
        }
        mesh.normals = vec![Vec3::Z; mesh.positions.len()];
        mesh
    }

    fn corners(mesh: &Mesh) -> Vec<[Vec3; 3]> {
        (0..mesh.triangle_count()).map(|triangle| mesh.triangle(triangle)).collect()
    }

    #[test]
    fn what_touches_is_one_part_whether_vertices_are_shared_or_not() {
        for is_shared in [true, false] {
            // The second and the fourth touch in a corner.
            let places = [0.0, 5.0, 10.0, 6.0].map(|x| Vec3::new(x, if x == 6.0 { 1.0 } else { -0.0 }, 0.0));
            let mesh = squares(&places, is_shared);
            let parts = split(mesh.clone());
            assert_eq!(parts.iter().map(Mesh::triangle_count).collect::<Vec<_>>(), [2, 4, 2]);
            let all = corners(&mesh);
            assert_eq!(corners(&parts[1]), [&all[2..4], &all[6..8]].concat());
            assert!(parts.iter().all(|part| part.material == 3 && part.name == "squares"));
            assert!(parts.iter().all(|part| part.normals.len() == part.positions.len()));
            assert_eq!(parts.iter().map(|part| part.positions.len()).sum::<usize>(), mesh.positions.len());
        }
    }

    #[test]
    fn many_parts_are_joined_with_their_neighbours_and_no_triangle_is_lost() {
        let places: Vec<Vec3> =
            (0..1000).map(|index| Vec3::new(2.0 * (index % 10) as f32, 2.0 * (index / 10) as f32, 0.0)).collect();
        let mesh = squares(&places, true);
        let parts = split(mesh.clone());
        assert_eq!(parts.len(), MOST_PARTS);
        let key = |corners: &[Vec3; 3]| corners.map(|corner| corner.to_array().map(f32::to_bits));
        let sorted = |mut all: Vec<_>| {
            all.sort_unstable();
            all
        };
        let found = sorted(parts.iter().flat_map(corners).map(|corners| key(&corners)).collect());
        assert_eq!(found, sorted(corners(&mesh).iter().map(key).collect()));
        for part in &parts {
            let mut bounds = Bounds::EMPTY;
            part.positions.iter().for_each(|position| bounds.include(*position));
            // 3 or 4 squares of a field that is 20 by 200.
            assert!(bounds.diagonal() < 15.0, "{bounds:?}");
        }
    }

    #[test]
    fn one_part_stays_as_it_is_and_so_does_none() {
        let mesh = squares(&[Vec3::ZERO], true);
        assert_eq!(split(mesh.clone())[0].indices, mesh.indices);
        assert_eq!(split(Mesh::default()).len(), 1);
    }
}
