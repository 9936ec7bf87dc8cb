//! Normals of triangles, made or made one long.

use crate::scene::Mesh;
use crate::scene::gltf::topology;
use glam::Vec3;
use gltf::Semantic;
use std::collections::BTreeSet;

/// How many indices a primitive has, or vertices where it has none, by what the file says.
pub fn corners(primitive: &gltf::Primitive<'_>) -> usize {
    let corners = primitive.indices().or_else(|| primitive.get(&Semantic::Positions));
    corners.map_or(0, |accessor| accessor.count())
}

/// Unit normal of a triangle; +y where it has no area.
pub fn triangle_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    // In 64 bits: fourth powers of edges of any 32-bit length neither vanish nor overflow there.
    let [a, b, c] = [a, b, c].map(|corner| corner.as_dvec3());
    (b - a).cross(c - a).try_normalize().map_or(Vec3::Y, |normal| normal.as_vec3())
}

/// glTF 2.0, section 3.7.2.1: without normals a mesh is flat, so its triangles share no vertices.
pub fn flat_normals(mesh: &mut Mesh) {
    topology::unshare_vertices(mesh);
    flatten_normals(mesh);
}

/// Gives the vertices of each triangle its normal; triangles share none.
pub fn flatten_normals(mesh: &mut Mesh) {
    mesh.normals = (0..mesh.triangle_count()).flat_map(|index| [triangle_normal(mesh.triangle(index)); 3]).collect();
}

/// Makes normals unit length; those without a length take that of the last triangle at their vertex. Returns how many.
pub fn normalize_normals(mesh: &mut Mesh) -> usize {
    let mut broken = BTreeSet::new();
    for (vertex, normal) in mesh.normals.iter_mut().enumerate() {
        match normal.try_normalize() {
            Some(unit) => *normal = unit,
            None => {
                broken.insert(vertex as u32);
            }
        }
    }
    if !broken.is_empty() {
        for corner in 0..mesh.indices.len() {
            if broken.contains(&mesh.indices[corner]) {
                mesh.normals[mesh.indices[corner] as usize] = triangle_normal(mesh.triangle(corner / 3));
            }
        }
    }
    broken.len()
}
