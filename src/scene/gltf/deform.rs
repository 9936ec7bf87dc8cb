//! What bends one primitive: its morph targets and the joints that take its vertices along.

use crate::scene::gltf::normals;
use glam::Mat4;
use gltf::{Document, Semantic};

use super::buffers::Buffers;
use super::limits::Allowance;
use super::morph::{self, Target};
use super::nodes::Hierarchy;
use super::skins::Influences;
use super::{label, tangents};
use crate::error::Result;
use crate::scene::Mesh;

/// How many indices the meshes that bend may have together, counted for each node that shows one, beside sixteen for each
/// byte of the file: 700,000 triangles.
///
/// Each such node has vertices of its own at each moment, so a short file in which many share a mesh asks for much.
const FREE_BENT_INDICES: usize = 1 << 21;

/// How many vectors of morph targets a file may have, and how many all nodes may add up at a moment, beside those that its
/// bytes back.
const FREE_TARGET_VECTORS: usize = 1 << 24;
const FREE_MORPHED_VECTORS: usize = 1 << 25;

/// Targets and influences of one mesh, a value for each of its vertices.
#[derive(Debug)]
pub struct Deform {
    targets: Vec<Target>,
    /// Joints and weights, if a skin bends the mesh somewhere.
    influences: Option<Influences>,
    /// The file gives no normals: they are those of the triangles, whatever their shape.
    flat: bool,
}

impl Deform {
    /// What bends `primitive`, which became `mesh`; `corners`: its triangles as indices of vertices in the file.
    ///
    /// Errors: see `morph::read` and `Influences::read`.
    pub fn read(
        document: &Document,
        buffers: &Buffers<'_>,
        primitive: &gltf::Primitive<'_>,
        mesh_index: usize,
        is_skinned: bool,
        mesh: &Mesh,
        corners: &[u32],
    ) -> Result<Self> {
        let vertex_count = primitive.get(&Semantic::Positions).map_or(0, |accessor| accessor.count());
        let origins = origins(mesh, corners);
        let targets = document.as_json().meshes[mesh_index].primitives[primitive.index()].targets.as_deref();
        let influences = is_skinned.then(|| Influences::read(buffers, primitive, vertex_count, &origins));
        Ok(Self {
            targets: morph::read(document, buffers, targets.unwrap_or_default(), vertex_count, &origins)?,
            influences: influences.transpose()?,
            flat: primitive.get(&Semantic::Normals).is_none(),
        })
    }

    pub fn influences(&self) -> Option<&Influences> {
        self.influences.as_ref()
    }

    /// `rest` morphed by `weights` and then taken along by `world_from_mesh`, the matrices of a skin's joints, where
    /// there are some.
    pub fn bend(&self, rest: &Mesh, weights: &[f32], world_from_mesh: Option<&[Mat4]>) -> Mesh {
        let mut mesh = rest.clone();
        morph::apply(&mut mesh, &self.targets, weights);
        for (normal, rest) in mesh.normals.iter_mut().zip(&rest.normals) {
            *normal = normal.try_normalize().unwrap_or(*rest);
        }
        if let (Some(influences), Some(matrices)) = (&self.influences, world_from_mesh) {
            influences.apply(&mut mesh, matrices);
        }
        if self.flat {
            normals::flatten_normals(&mut mesh);
        }
        if mesh.tangents.iter().any(|tangent| tangent.w != 0.0) {
            tangents::normalize(&mut mesh);
        }
        mesh
    }
}

/// For each vertex of `mesh`, which vertex of the file it was: reading a primitive drops, parts and splits vertices, but
/// keeps the order of its corners.
fn origins(mesh: &Mesh, corners: &[u32]) -> Vec<u32> {
    let mut origins = vec![0; mesh.positions.len()];
    for (vertex, corner) in mesh.indices.iter().zip(corners) {
        origins[*vertex as usize] = *corner;
    }
    origins
}

/// Whether a node shows vertices of its own: its mesh has morph targets or a skin bends it.
pub fn bends(document: &Document, node_index: usize) -> Result<bool> {
    let node = &document.as_json().nodes[node_index];
    Ok(node.mesh.is_some() && (node.skin.is_some() || morph::target_count(document, node_index)? > 0))
}

/// Refuses what would take more memory or time than any scene here is worth, before anything is read.
pub fn check_total(document: &Document, hierarchy: &Hierarchy, buffers: &Buffers<'_>) -> Result<()> {
    let file_bytes = buffers.file_bytes();
    let mut indices = Allowance::new("indices of meshes that bend", FREE_BENT_INDICES, 16, file_bytes);
    let mut read = Allowance::new("vectors of morph targets", FREE_TARGET_VECTORS, 1, file_bytes);
    let what = "vectors of morph targets over all nodes";
    let mut morphed = Allowance::new(what, FREE_MORPHED_VECTORS, 16, file_bytes);
    let mut seen = vec![false; document.meshes().len()];
    for node in document.nodes() {
        let Some(mesh) = node.mesh().filter(|_| hierarchy.shows(node.index())) else { continue };
        if !bends(document, node.index())? {
            continue;
        }
        let targets = morph::target_count(document, node.index())?;
        // Targets and influences are read for all vertices, whatever triangles use of them.
        let longest = |primitive: gltf::Primitive<'_>| {
            let vertices = primitive.get(&Semantic::Positions).map_or(0, |accessor| accessor.count());
            normals::corners(&primitive).max(vertices)
        };
        let corners = mesh.primitives().fold(0usize, |sum, primitive| sum.saturating_add(longest(primitive)));
        // Positions, normals and tangents.
        let vectors = corners.saturating_mul(3).saturating_mul(targets);
        let is_new = !std::mem::replace(&mut seen[mesh.index()], true);
        let spent = indices
            .spend(corners)
            .and_then(|()| read.spend(if is_new { vectors } else { 0 }))
            .and_then(|()| morphed.spend(vectors));
        spent.map_err(|error| error.within(label::node(document, node.index())))?;
    }
    Ok(())
}
