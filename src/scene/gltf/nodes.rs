//! The node hierarchy, and where its nodes are at a moment.
//!
//! Walked with a stack of its own: a file may nest deeper than the program's stack, and may lie about being a tree.

use glam::{Mat4, Quat, Vec3, Vec4};
use gltf::Document;
use gltf::scene::Transform;

use super::label;
use crate::error::{Error, Result};
use crate::scene::animation::unit_quaternion;
use crate::scene::gltf::motion::{Channel, Motion};

/// A node that the scene shows.
#[derive(Clone, Copy, Debug)]
pub struct PlacedNode {
    pub node_index: usize,
    /// Affine and finite.
    pub world_from_node: Mat4,
}

/// The nodes of the default scene, else of the first, else of the whole file, parents before their children.
#[derive(Debug)]
pub struct Hierarchy {
    links: Vec<Link>,
    /// Place in `links` of each node of the file.
    link_of: Vec<Option<usize>>,
}

#[derive(Debug)]
struct Link {
    node_index: usize,
    /// Place of the parent in `links`.
    parent: Option<usize>,
    rest: Local,
}

/// Where a node stands in its parent.
#[derive(Clone, Copy, Debug)]
enum Local {
    Matrix(Mat4),
    Parts { translation: Vec3, rotation: Quat, scale: Vec3 },
}

impl Local {
    fn matrix(&self) -> Mat4 {
        match *self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                Mat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

impl Hierarchy {
    /// Reads the nodes that are shown.
    pub fn read(document: &Document) -> Result<Self> {
        let roots = check_tree(document)?;
        let scene = document.default_scene().or_else(|| document.scenes().next());
        let shown = match scene {
            Some(scene) => scene.nodes().map(|node| node.index()).collect(),
            None => roots,
        };

        let mut links: Vec<Link> = Vec::new();
        let mut link_of = vec![None; document.nodes().len()];
        let mut stack: Vec<(usize, Option<usize>)> = shown.into_iter().map(|root| (root, None)).collect();
        while let Some((node_index, parent)) = stack.pop() {
            let name = || label::node(document, node_index);
            let place = links.len();
            if link_of[node_index].replace(place).is_some() {
                return Err(Error::request(format!(
                    "{} stands in the scene twice; list it once, as a root or as a child",
                    name()
                )));
            }
            let Some(node) = document.nodes().nth(node_index) else { continue };
            let rest = local_transform(&node).map_err(|error| error.within(name()))?;
            links.push(Link { node_index, parent, rest });
            stack.extend(node.children().map(|child| (child.index(), Some(place))));
        }
        Ok(Self { links, link_of })
    }

    /// Whether the scene shows a node of the file.
    pub fn shows(&self, node_index: usize) -> bool {
        self.link_of[node_index].is_some()
    }

    /// Whether a node has no translation, rotation and scale of its own that could be animated.
    pub fn has_matrix(&self, node_index: usize) -> bool {
        self.link_of[node_index].is_some_and(|place| matches!(self.links[place].rest, Local::Matrix(_)))
    }

    /// For each node of the file, whether `channels` move it, or one above it.
    pub fn moving(&self, channels: &[Channel]) -> Vec<bool> {
        let mut moving = vec![false; self.link_of.len()];
        for channel in channels.iter().filter(|channel| channel.motion != Motion::Weights) {
            moving[channel.node_index] = true;
        }
        for link in &self.links {
            let above = link.parent.is_some_and(|parent| moving[self.links[parent].node_index]);
            moving[link.node_index] |= above;
        }
        moving
    }

    /// The nodes that are shown, ordered by index, where `channels` have them at `time_s`.
    ///
    /// Errors: a transform leaves the range of 32-bit floats (exit code 2).
    pub fn place(&self, document: &Document, channels: &[Channel], time_s: f64) -> Result<Vec<PlacedNode>> {
        let mut locals: Vec<Local> = self.links.iter().map(|link| link.rest).collect();
        for channel in channels {
            let Some(place) = self.link_of[channel.node_index] else { continue };
            let Local::Parts { translation, rotation, scale } = &mut locals[place] else { continue };
            match channel.motion {
                Motion::Translation => *translation = channel.curve.vector_at(time_s),
                Motion::Rotation => *rotation = channel.curve.rotation_at(time_s),
                Motion::Scale => *scale = channel.curve.vector_at(time_s),
                Motion::Weights => {}
            }
        }
        let mut placed: Vec<PlacedNode> = Vec::with_capacity(self.links.len());
        for (link, local) in self.links.iter().zip(&locals) {
            let world_from_parent = link.parent.map_or(Mat4::IDENTITY, |parent| placed[parent].world_from_node);
            let world_from_node = world_from_parent * local.matrix();
            if !world_from_node.is_finite() {
                let name = label::node(document, link.node_index);
                return Err(Error::request(format!("{name}: its world transform leaves the range of 32-bit floats")));
            }
            placed.push(PlacedNode { node_index: link.node_index, world_from_node });
        }
        placed.sort_unstable_by_key(|placed| placed.node_index);
        Ok(placed)
    }
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

/// A matrix from a file with its last row made 0 0 0 1, from which it may differ by what exporters round away.
///
/// Errors: it is not affine (exit code 2).
pub fn affine(matrix: Mat4) -> Result<Mat4> {
    let last_row = matrix.row(3);
    if !matrix.is_finite() || !last_row.abs_diff_eq(Vec4::W, AFFINE_TOLERANCE) {
        return Err(Error::request(format!(
            "its matrix is not affine: all numbers must be finite and the last row 0 0 0 1, but it is {last_row}"
        )));
    }
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|column| column.truncate().extend(0.0));
    Ok(Mat4::from_cols(columns[0], columns[1], columns[2], matrix.w_axis.truncate().extend(1.0)))
}

fn local_transform(node: &gltf::Node<'_>) -> Result<Local> {
    match node.transform() {
        Transform::Matrix { matrix } => affine(Mat4::from_cols_array_2d(&matrix)).map(Local::Matrix),
        Transform::Decomposed { translation, rotation, scale } => {
            let (translation, scale) = (Vec3::from_array(translation), Vec3::from_array(scale));
            let rotation = Vec4::from_array(rotation);
            match unit_quaternion(rotation).filter(|_| translation.is_finite() && scale.is_finite()) {
                Some(rotation) => Ok(Local::Parts { translation, rotation, scale }),
                None => Err(Error::request(format!(
                    "its translation {translation}, rotation {rotation} and scale {scale} must be finite, \
                     and the rotation not zero"
                ))),
            }
        }
    }
}
