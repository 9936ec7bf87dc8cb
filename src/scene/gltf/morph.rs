//! Morph targets: how far each moves positions, normals and tangents, and the weights they have at rest.

use gltf::{Document, json};

use super::buffers::Buffers;
use super::{accessors, label};
use crate::error::{Error, Result};
use crate::scene::Mesh;
use glam::Vec3;

/// One morph target of a primitive: displacements at weight 1, one a vertex, or none at all.
#[derive(Debug)]
pub struct Target {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub tangents: Vec<Vec3>,
}

/// How many morph targets the mesh of a node has, 0 without a mesh.
///
/// Errors: its primitives do not agree (exit code 2).
pub fn target_count(document: &Document, node_index: usize) -> Result<usize> {
    let root = document.as_json();
    let Some(mesh_index) = root.nodes[node_index].mesh.map(|mesh| mesh.value()) else { return Ok(0) };
    let mesh = &root.meshes[mesh_index];
    let mut counts = mesh.primitives.iter().map(|primitive| primitive.targets.as_ref().map_or(0, Vec::len));
    let first = counts.next().unwrap_or_default();
    match counts.position(|count| count != first) {
        None => Ok(first),
        Some(other) => Err(Error::request(format!(
            "{}: primitive {} has another number of morph targets than primitive 0, which has {first}; \
             all must have the same",
            label::element("mesh", mesh_index, mesh.name.as_deref()),
            other + 1
        ))),
    }
}

/// The weights that the mesh of a node has where no animation drives them: the node's, else the mesh's, else 0.
///
/// Errors: another number of weights than of targets, or one that is not finite (exit code 2).
pub fn rest_weights(document: &Document, node_index: usize) -> Result<Vec<f32>> {
    let target_count = target_count(document, node_index)?;
    let root = document.as_json();
    let node = &root.nodes[node_index];
    let mesh = node.mesh.map(|mesh| &root.meshes[mesh.value()]);
    let Some(weights) = node.weights.as_ref().or_else(|| mesh.and_then(|mesh| mesh.weights.as_ref())) else {
        return Ok(vec![0.0; target_count]);
    };
    if weights.len() != target_count || !weights.iter().all(|weight| weight.is_finite()) {
        return Err(Error::request(format!(
            "{}: has {} morph weights for {target_count} morph targets; needed is a finite weight for each",
            label::node(document, node_index),
            weights.len()
        )));
    }
    Ok(weights.clone())
}

/// The targets of a primitive of `vertex_count` vertices in the file, at the vertices that became `origins`.
///
/// Errors: an attribute has another number of elements, or is broken (exit code 2).
pub fn read(
    document: &Document,
    buffers: &Buffers<'_>,
    targets: &[json::mesh::MorphTarget],
    vertex_count: usize,
    origins: &[u32],
) -> Result<Vec<Target>> {
    let read = |index: Option<json::Index<json::Accessor>>, semantic: &str| -> Result<Vec<Vec3>> {
        let Some(accessor) = index.and_then(|index| document.accessors().nth(index.value())) else {
            return Ok(Vec::new());
        };
        let within = |error: Error| error.within(semantic);
        accessors::require_count(&accessor, vertex_count).map_err(within)?;
        let moves = accessors::floats::<3>(buffers, &accessor).map_err(within)?;
        Ok(origins.iter().map(|origin| Vec3::from_array(moves[*origin as usize])).collect())
    };
    let read_target = |(index, target): (usize, &json::mesh::MorphTarget)| {
        let all = || {
            Ok(Target {
                positions: read(target.positions, "POSITION")?,
                normals: read(target.normals, "NORMAL")?,
                tangents: read(target.tangents, "TANGENT")?,
            })
        };
        all().map_err(|error: Error| error.within(format!("morph target {index}")))
    };
    targets.iter().enumerate().map(read_target).collect()
}

/// Moves the vertices of `mesh` by each target times its weight; normals and tangents then have any length.
pub fn apply(mesh: &mut Mesh, targets: &[Target], weights: &[f32]) {
    for (target, weight) in targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        for (position, by) in mesh.positions.iter_mut().zip(&target.positions) {
            *position += *by * *weight;
        }
        for (normal, by) in mesh.normals.iter_mut().zip(&target.normals) {
            *normal += *by * *weight;
        }
        for (tangent, by) in mesh.tangents.iter_mut().zip(&target.tangents) {
            *tangent += (*by * *weight).extend(0.0);
        }
    }
}
