//! The node hierarchy to world transforms.
//!
//! Walked with a stack of its own: a file may nest deeper than the program's stack, and may lie about being a tree.

use glam::{Mat4, Quat, Vec3, Vec4};
use gltf::Document;
use gltf::scene::Transform;

use super::label;
use crate::error::{Error, Result};

/// A node that the scene shows.
#[derive(Clone, Copy, Debug)]
pub struct PlacedNode {
    pub node_index: usize,
    /// Affine and finite.
    pub world_from_node: Mat4,
}

impl PlacedNode {
    /// Index of the glTF mesh at this node.
    pub fn mesh(&self, document: &Document) -> Option<usize> {
        document.as_json().nodes[self.node_index].mesh.map(|mesh| mesh.value())
    }
}

/// The nodes of the default scene, else of the first, else of the whole file, ordered by index.
pub fn place(document: &Document) -> Result<Vec<PlacedNode>> {
    let node_count = document.nodes().len();
    let roots = check_tree(document)?;
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let shown = match scene {
        Some(scene) => scene.nodes().map(|node| node.index()).collect(),
        None => roots,
    };

    let mut placed = Vec::new();
    let mut visited = vec![false; node_count];
    let mut stack: Vec<(usize, Mat4)> = shown.into_iter().map(|root| (root, Mat4::IDENTITY)).collect();
    while let Some((node_index, world_from_parent)) = stack.pop() {
        let name = || label::node(document, node_index);
        if std::mem::replace(&mut visited[node_index], true) {
            return Err(Error::request(format!(
                "{} stands in the scene twice; list it once, as a root or as a child",
                name()
            )));
        }
        let Some(node) = document.nodes().nth(node_index) else { continue };
        let parent_from_node = local_transform(&node).map_err(|error| error.within(name()))?;
        let world_from_node = world_from_parent * parent_from_node;
        if !world_from_node.is_finite() {
            return Err(Error::request(format!("{}: its world transform leaves the range of 32-bit floats", name())));
        }
        placed.push(PlacedNode { node_index, world_from_node });
        stack.extend(node.children().map(|child| (child.index(), world_from_node)));
    }
    placed.sort_unstable_by_key(|placed| placed.node_index);
    Ok(placed)
}

/// Checks that no node has two parents or is its own ancestor; returns the nodes without a parent.
fn check_tree(document: &Document) -> Result<Vec<usize>> {
    let node_count = document.nodes().len();
    let mut parents: Vec<Option<usize>> = vec![None; node_count];
    for node in document.nodes() {
        for child in node.children() {
            if let Some(other) = parents[child.index()].replace(node.index()) {
                return Err(Error::request(format!(
                    "{} is a child of nodes {other} and {}; a node may have one parent",
                    label::node(document, child.index()),
                    node.index()
                )));
            }
        }
    }
    let roots: Vec<usize> = (0..node_count).filter(|node| parents[*node].is_none()).collect();
    // With one parent at most each, what no root reaches goes round in a circle.
    let mut reached = vec![false; node_count];
    let mut stack = roots.clone();
    while let Some(node_index) = stack.pop() {
        reached[node_index] = true;
        stack.extend(
            document.nodes().nth(node_index).iter().flat_map(|node| node.children()).map(|child| child.index()),
        );
    }
    match reached.iter().position(|reached| !reached) {
        Some(lost) => Err(Error::request(format!(
            "{} is its own ancestor: the nodes above it form a cycle",
            label::node(document, lost)
        ))),
        None => Ok(roots),
    }
}

/// How far a matrix's last row may be from 0 0 0 1: what exporters round away.
const AFFINE_TOLERANCE: f32 = 1e-3;

fn local_transform(node: &gltf::Node<'_>) -> Result<Mat4> {
    match node.transform() {
        Transform::Matrix { matrix } => {
            let matrix = Mat4::from_cols_array_2d(&matrix);
            let last_row = matrix.row(3);
            if !matrix.is_finite() || !last_row.abs_diff_eq(Vec4::W, AFFINE_TOLERANCE) {
                return Err(Error::request(format!(
                    "its matrix is not affine: all numbers must be finite and the last row 0 0 0 1, \
                     but it is {last_row}"
                )));
            }
            let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|column| column.truncate().extend(0.0));
            Ok(Mat4::from_cols(columns[0], columns[1], columns[2], matrix.w_axis.truncate().extend(1.0)))
        }
        Transform::Decomposed { translation, rotation, scale } => {
            let (translation, scale) = (Vec3::from_array(translation), Vec3::from_array(scale));
            // Length first in the largest component: the square of a tiny quaternion vanishes.
            let rotation = Vec4::from_array(rotation);
            let unit = (rotation / rotation.abs().max_element()).try_normalize();
            match unit.filter(|unit| unit.is_finite() && translation.is_finite() && scale.is_finite()) {
                Some(unit) => Ok(Mat4::from_scale_rotation_translation(scale, Quat::from_vec4(unit), translation)),
                None => Err(Error::request(format!(
                    "its translation {translation}, rotation {rotation} and scale {scale} must be finite, \
                     and the rotation not zero"
                ))),
            }
        }
    }
}
