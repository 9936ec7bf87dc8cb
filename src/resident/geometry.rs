//! The scene's triangles as device memory holds them: all meshes one after the other, in clusters, and the draw calls
//! over them.

use super::clusters::{Cluster, grouped};
use super::{DrawCall, ExtendedAttributes, Sides, VertexAttributes};
use crate::scene::{AlphaMode, Bounds, Mesh, Scene};
use glam::{Vec3, Vec4};
use std::ops::Range;

/// All meshes one after the other.
pub struct Geometry {
    pub positions: Vec<[f32; 3]>,
    pub attributes: Vec<VertexAttributes>,
    /// In the order of the clusters; of each mesh's own vertices.
    pub indices: Vec<u32>,
    pub clusters: Vec<Cluster>,
    starts: Vec<Start>,
}

/// Where a mesh lies.
struct Start {
    vertex: usize,
    index: usize,
    clusters: Range<u32>,
}

impl Geometry {
    pub fn of(scene: &Scene) -> Self {
        let mut all = Self {
            positions: Vec::new(),
            attributes: Vec::new(),
            indices: Vec::new(),
            clusters: Vec::new(),
            starts: Vec::new(),
        };
        for mesh in &scene.meshes {
            let (vertex, index, cluster) = (all.positions.len(), all.indices.len(), all.clusters.len() as u32);
            all.positions.extend(mesh.positions.iter().map(Vec3::to_array));
            all.attributes.extend(attributes_of(mesh));
            groups_of(scene, mesh).iter().for_each(|group| all.push(mesh, group));
            all.starts.push(Start { vertex, index, clusters: cluster..all.clusters.len() as u32 });
        }
        all
    }

    fn push(&mut self, mesh: &Mesh, triangles: &[u32]) {
        let first_index = self.indices.len() as u32;
        let mut bounds = Bounds::EMPTY;
        for triangle in triangles {
            let at = 3 * *triangle as usize;
            self.indices.extend_from_slice(&mesh.indices[at..at + 3]);
            mesh.triangle(*triangle as usize).into_iter().for_each(|position| bounds.include(position));
        }
        self.clusters.push(Cluster { first_index, index_count: 3 * triangles.len() as u32, bounds });
    }

    /// One for each of the scene's draws, in its order.
    pub fn calls(&self, scene: &Scene) -> Vec<DrawCall> {
        let boxes: Vec<_> = scene
            .meshes
            .iter()
            .map(|mesh| {
                let mut bounds = Bounds::EMPTY;
                mesh.positions.iter().for_each(|position| bounds.include(*position));
                bounds
            })
            .collect();
        let call = |(index, draw): (usize, &crate::scene::Draw)| {
            let mesh = &scene.meshes[draw.mesh];
            let material = &scene.materials[mesh.material];
            let start = &self.starts[draw.mesh];
            DrawCall {
                draw: index as u32,
                material: mesh.material as u32,
                first_index: start.index as u32,
                index_count: mesh.indices.len() as u32,
                first_cluster: start.clusters.start,
                cluster_count: start.clusters.len() as u32,
                vertex_offset: start.vertex as i32,
                alpha: material.alpha,
                sides: Sides::of(material),
                mirrored: draw.world_from_object.determinant() < 0.0,
                center_ws: draw.world_from_object.transform_point3(boxes[draw.mesh].center()),
            }
        };
        scene.draws.iter().enumerate().map(call).collect()
    }
}

/// Places of all vertices, mesh by mesh, as `Geometry` has them.
pub fn positions(scene: &Scene) -> Vec<[f32; 3]> {
    scene.meshes.iter().flat_map(|mesh| mesh.positions.iter().map(Vec3::to_array)).collect()
}

/// The same of the second stream.
pub fn attributes(scene: &Scene) -> Vec<VertexAttributes> {
    scene.meshes.iter().flat_map(attributes_of).collect()
}

fn attributes_of(mesh: &Mesh) -> impl Iterator<Item = VertexAttributes> {
    (0..mesh.positions.len()).map(|vertex| VertexAttributes {
        normal: mesh.normals[vertex].to_array(),
        tangent: tangent(mesh, vertex),
        uv: mesh.uvs.get(vertex).map_or([0.0; 2], |uv| uv.to_array()),
    })
}

/// The triangles of a mesh in the order in which they are resident, as their places in its list, cluster by cluster.
pub fn groups_of(scene: &Scene, mesh: &Mesh) -> Vec<Vec<u32>> {
    if scene.materials[mesh.material].alpha == AlphaMode::Blend {
        vec![(0..mesh.triangle_count() as u32).collect()]
    } else {
        grouped(mesh)
    }
}

/// A tangent as the second stream has it: w is the handedness, +1 or -1, times 1 + the id of the normal group, where the
/// paper has it too (Kircher & Lawrance 2009, section 3.1).
fn tangent(mesh: &Mesh, vertex: usize) -> [f32; 4] {
    let tangent = mesh.tangents.get(vertex).copied().unwrap_or(Vec4::ZERO);
    let group = mesh.normal_groups.get(vertex).copied().unwrap_or_default();
    let handedness = if tangent.w < 0.0 { -1.0 } else { 1.0 };
    tangent.truncate().extend(handedness * (1.0 + f32::from(group))).to_array()
}

/// The third stream, vertex by vertex as `Geometry` has them.
pub fn extended(scene: &Scene) -> Vec<ExtendedAttributes> {
    let of = |mesh: &Mesh, vertex: usize| ExtendedAttributes {
        color: mesh.colors.get(vertex).map_or([1.0; 4], |color| color.to_array()),
        uv_1: mesh.uvs_1.get(vertex).map_or([0.0; 2], |uv| uv.to_array()),
    };
    scene.meshes.iter().flat_map(|mesh| (0..mesh.positions.len()).map(move |vertex| of(mesh, vertex))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural;

    #[test]
    fn a_tangents_fourth_number_holds_handedness_and_normal_group() {
        let tangents = vec![Vec4::ZERO, Vec4::new(1.0, 0.0, 0.0, -1.0), Vec4::new(0.0, 1.0, 0.0, 1.0)];
        let mesh = Mesh { tangents, normal_groups: vec![3, 255, 0], ..Mesh::default() };
        assert_eq!(tangent(&mesh, 0), [0.0, 0.0, 0.0, 4.0]);
        assert_eq!(tangent(&mesh, 1), [1.0, 0.0, 0.0, -256.0]);
        assert_eq!(tangent(&mesh, 2), [0.0, 1.0, 0.0, 1.0]);
        assert_eq!(tangent(&Mesh::default(), 0), [0.0, 0.0, 0.0, 1.0], "neither has been made");
    }

    #[test]
    fn clusters_hold_their_meshes_triangles_inside_their_boxes() {
        for spec in ["hall:triangles=8000", "cornell", "lamps"] {
            let scene = procedural::build(spec, 1).unwrap().unwrap();
            let geometry = Geometry::of(&scene);
            assert_eq!(geometry.indices.len(), scene.meshes.iter().map(|mesh| mesh.indices.len()).sum::<usize>());
            for call in geometry.calls(&scene) {
                let mesh = &scene.meshes[scene.draws[call.draw as usize].mesh];
                let mut next = call.first_index;
                for cluster in &geometry.clusters[call.clusters()] {
                    assert_eq!(cluster.first_index, next, "{spec}: one after the other");
                    next += cluster.index_count;
                    for index in &geometry.indices[cluster.indices()] {
                        let position = mesh.positions[*index as usize];
                        assert!(position.cmpge(cluster.bounds.min).all() && position.cmple(cluster.bounds.max).all());
                    }
                }
                assert_eq!(next, call.first_index + call.index_count, "{spec}: the whole mesh");
                let indices = &geometry.indices[call.first_index as usize..next as usize];
                if call.alpha == AlphaMode::Blend {
                    assert_eq!(indices, mesh.indices, "{spec}: BLEND keeps its order");
                }
                let sorted = |indices: &[u32]| {
                    let mut triangles: Vec<[u32; 3]> =
                        indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect();
                    triangles.sort_unstable();
                    triangles
                };
                assert_eq!(sorted(indices), sorted(&mesh.indices), "{spec}: every triangle once");
            }
        }
    }
}
