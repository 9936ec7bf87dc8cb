//! Strips and fans to triangle lists, unused vertices dropped, shared vertices parted, some triangles taken out.

use gltf::mesh::Mode;

use crate::scene::Mesh;

/// A triangle list of vertex indices.
#[derive(Debug, PartialEq)]
pub struct TriangleList {
    pub indices: Vec<u32>,
    /// How many indices at the end made no whole triangle.
    pub left_over: usize,
}

/// Converts the indices of a primitive; None for points and lines.
///
/// Winding follows glTF 2.0, section 3.7.2.1. Triangles of a strip that use a vertex twice only join its parts and are
/// dropped.
pub fn triangle_list(mode: Mode, mut indices: Vec<u32>) -> Option<TriangleList> {
    match mode {
        Mode::Triangles => {
            let left_over = indices.len() % 3;
            indices.truncate(indices.len() - left_over);
            Some(TriangleList { indices, left_over })
        }
        Mode::TriangleStrip => {
            let triangles = indices.windows(3).enumerate().map(|(triangle, corners)| match triangle % 2 {
                0 => [corners[0], corners[1], corners[2]],
                _ => [corners[0], corners[2], corners[1]],
            });
            let whole = triangles.filter(|[a, b, c]| a != b && b != c && c != a);
            Some(TriangleList { indices: whole.flatten().collect(), left_over: incomplete(indices.len()) })
        }
        Mode::TriangleFan => {
            let center = indices.first().copied().unwrap_or_default();
            let rim = indices.get(1..).unwrap_or_default();
            let triangles = rim.windows(2).flat_map(|edge| [edge[0], edge[1], center]);
            Some(TriangleList { indices: triangles.collect(), left_over: incomplete(indices.len()) })
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
    }
}

/// A strip or fan is left over whole where it is shorter than a triangle.
fn incomplete(index_count: usize) -> usize {
    if index_count < 3 { index_count } else { 0 }
}

/// Drops vertices that no triangle uses: files share one vertex array among many primitives, and stray vertices would
/// widen the scene's bounds.
pub fn drop_unused_vertices(mesh: &mut Mesh) {
    const UNUSED: u32 = u32::MAX;
    let mut kept: Vec<u32> = vec![UNUSED; mesh.positions.len()];
    for index in &mesh.indices {
        kept[*index as usize] = 0;
    }
    if !kept.contains(&UNUSED) {
        return;
    }
    let used: Vec<u32> = (0..kept.len() as u32).filter(|vertex| kept[*vertex as usize] != UNUSED).collect();
    for (new, old) in used.iter().enumerate() {
        kept[*old as usize] = new as u32;
    }
    let indices = mesh.indices.iter().map(|index| kept[*index as usize]).collect();
    *mesh = Mesh { indices, ..of_vertices(mesh, &used) };
}

/// A mesh of some of the triangles, in that order, with the vertices that they use.
pub fn of_triangles(mesh: &Mesh, triangles: &[usize]) -> Mesh {
    let mut vertices: Vec<u32> =
        triangles.iter().flat_map(|triangle| mesh.corners(*triangle)).map(|vertex| vertex as u32).collect();
    let corners = vertices.clone();
    vertices.sort_unstable();
    vertices.dedup();
    let place = |vertex: u32| vertices.binary_search(&vertex).expect("a corner is a vertex") as u32;
    Mesh { indices: corners.into_iter().map(place).collect(), ..of_vertices(mesh, &vertices) }
}

/// Gives every corner of every triangle a vertex of its own.
pub fn unshare_vertices(mesh: &mut Mesh) {
    let indices = (0..mesh.indices.len() as u32).collect();
    *mesh = Mesh { indices, ..of_vertices(mesh, &mesh.indices) };
}

/// `vertices` of a mesh, in that order, without triangles; attributes that are empty stay so.
fn of_vertices(mesh: &Mesh, vertices: &[u32]) -> Mesh {
    fn gather<T: Copy>(attribute: &[T], vertices: &[u32]) -> Vec<T> {
        if attribute.is_empty() {
            return Vec::new();
        }
        vertices.iter().map(|vertex| attribute[*vertex as usize]).collect()
    }
    Mesh {
        name: mesh.name.clone(),
        positions: gather(&mesh.positions, vertices),
        normals: gather(&mesh.normals, vertices),
        tangents: gather(&mesh.tangents, vertices),
        uvs: gather(&mesh.uvs, vertices),
        uvs_1: gather(&mesh.uvs_1, vertices),
        atlas: gather(&mesh.atlas, vertices),
        colors: gather(&mesh.colors, vertices),
        normal_groups: gather(&mesh.normal_groups, vertices),
        indices: Vec::new(),
        material: mesh.material,
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;

    fn list(mode: Mode, indices: &[u32]) -> TriangleList {
        triangle_list(mode, indices.to_vec()).unwrap()
    }

    #[test]
    fn strips_keep_their_winding_and_lose_their_joints() {
        let strip = list(Mode::TriangleStrip, &[0, 1, 2, 3]);
        assert_eq!(strip, TriangleList { indices: vec![0, 1, 2, 1, 3, 2], left_over: 0 });
        assert_eq!(list(Mode::TriangleStrip, &[0, 1, 2, 2, 5, 5, 6, 7]).indices, [0, 1, 2, 5, 7, 6]);
        assert_eq!(list(Mode::TriangleStrip, &[0, 1]), TriangleList { indices: vec![], left_over: 2 });
    }

    #[test]
    fn fans_turn_around_their_first_vertex() {
        assert_eq!(list(Mode::TriangleFan, &[9, 1, 2, 3]).indices, [1, 2, 9, 2, 3, 9]);
        assert_eq!(list(Mode::TriangleFan, &[]), TriangleList { indices: vec![], left_over: 0 });
        assert_eq!(list(Mode::TriangleFan, &[1]).left_over, 1);
    }

    #[test]
    fn lists_lose_what_makes_no_triangle_and_lines_are_none() {
        assert_eq!(list(Mode::Triangles, &[0, 1, 2, 3, 4]), TriangleList { indices: vec![0, 1, 2], left_over: 2 });
        assert_eq!(triangle_list(Mode::LineLoop, vec![0, 1]), None);
    }

    #[test]
    fn vertices_are_dropped_and_parted_with_all_their_attributes() {
        let mut mesh = Mesh {
            positions: (0..5).map(|x| Vec3::splat(x as f32)).collect(),
            uvs: (0..5).map(|x| Vec2::splat(x as f32)).collect(),
            indices: vec![4, 1, 3, 1, 4, 3],
            ..Mesh::default()
        };
        drop_unused_vertices(&mut mesh);
        assert_eq!(mesh.positions, [1.0, 3.0, 4.0].map(Vec3::splat));
        assert_eq!(mesh.indices, [2, 0, 1, 0, 2, 1]);
        unshare_vertices(&mut mesh);
        assert_eq!(mesh.uvs, [4.0, 1.0, 3.0, 1.0, 4.0, 3.0].map(Vec2::splat));
        assert_eq!(mesh.indices, [0, 1, 2, 3, 4, 5]);
        assert!(mesh.normals.is_empty());
    }
}
