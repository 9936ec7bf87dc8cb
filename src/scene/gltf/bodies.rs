//! The nodes that show meshes: which stand still, which bend, and the draws that they are at a moment.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{Mat3, Mat4, Quat, Vec3};
use gltf::Document;
use rayon::prelude::*;

use super::buffers::Buffers;
use super::deform::{self, Deform};
use super::limits::Allowance;
use super::nodes::{Hierarchy, PlacedNode};
use super::primitives::{MeshUse, Piece};
use super::skins::Skin;
use super::{label, morph};
use crate::error::{Error, Result};
use crate::scene::gltf::motion::{Channel, Motion};
use crate::scene::{Draw, Mesh};

/// A short file can have many nodes that all draw one mesh of many primitives; this many draws take 320 MiB.
const MAX_DRAWS: usize = 1 << 22;

/// How many triangles all draws together may have, beside sixteen for each byte of the file: a tree over these takes
/// 500 MiB.
const FREE_TRIANGLES: usize = 1 << 21;

/// To which part of a metre a metre shrinks where the transform of a moving draw has no inverse: no pixel is that small,
/// and the normal matrix, the lengths of whose columns are squared twice, still is one.
const SHRUNK: f32 = 1e-8;

/// Every node that shows a mesh, and what bends those that bend.
#[derive(Debug)]
pub struct Bodies {
    bodies: Vec<Body>,
    /// Meshes that bend, at rest.
    bent: Vec<(Mesh, Deform)>,
    skins: BTreeMap<usize, Skin>,
    /// How many meshes stand still: those that bend come after them.
    still_count: usize,
}

/// A node that shows a mesh.
#[derive(Debug)]
struct Body {
    node_index: usize,
    /// An animation moves the node.
    is_moving: bool,
    form: Form,
}

#[derive(Debug)]
enum Form {
    /// These of the meshes that stand still.
    Still(Range<usize>),
    Bent(Bent),
}

/// Meshes of a node's own.
#[derive(Debug)]
struct Bent {
    /// Range of `Bodies::bent` from which they are made.
    sources: Range<usize>,
    /// Index in the file.
    skin: Option<usize>,
    rest_weights: Vec<f32>,
    /// Place of the channel that drives the weights.
    weights_channel: Option<usize>,
}

/// What is drawn at a moment.
#[derive(Debug)]
pub struct Shapes {
    /// Meshes that stand still, and after them those that bend.
    pub meshes: Vec<Mesh>,
    pub draws: Vec<Draw>,
    /// The node of each draw.
    pub draw_nodes: Vec<u32>,
    /// Nodes whose draws are left out: their transform has no inverse, at any time.
    pub flat: Vec<usize>,
}

/// How the nodes that are shown need each glTF mesh.
///
/// Errors: see `morph::target_count`.
pub fn shown(document: &Document, hierarchy: &Hierarchy) -> Result<BTreeMap<usize, MeshUse>> {
    let mut all: BTreeMap<usize, MeshUse> = BTreeMap::new();
    for node in document.nodes().filter(|node| hierarchy.shows(node.index())) {
        let Some(mesh) = node.mesh() else { continue };
        let shown = all.entry(mesh.index()).or_default();
        shown.is_skinned |= document.as_json().nodes[node.index()].skin.is_some();
        shown.is_bent |= deform::bends(document, node.index())?;
    }
    Ok(all)
}

impl Bodies {
    /// Sorts `pieces`, those of each glTF mesh, into the meshes that stand still, which it returns, and those that bend.
    ///
    /// Errors: too many draws; weights, joints or skins that do not fit (exit code 2).
    pub fn new(
        document: &Document,
        hierarchy: &Hierarchy,
        channels: &[Channel],
        buffers: &Buffers<'_>,
        pieces: BTreeMap<usize, Vec<Piece>>,
    ) -> Result<(Vec<Mesh>, Self)> {
        let moving = hierarchy.moving(channels);
        let of_channel = |(place, channel): (usize, &Channel)| {
            (channel.motion == Motion::Weights).then_some((channel.node_index, place))
        };
        let weights_channels: BTreeMap<usize, usize> = channels.iter().enumerate().filter_map(of_channel).collect();
        let mut shown = Vec::new();
        let mut is_still = vec![false; document.meshes().len()];
        let mut draw_count = 0;
        let mut triangles = Allowance::new("triangles over all nodes", FREE_TRIANGLES, 16, buffers.file_bytes());
        for node in document.nodes().filter(|node| hierarchy.shows(node.index())) {
            let Some(mesh) = node.mesh().map(|mesh| mesh.index()) else { continue };
            draw_count += pieces.get(&mesh).map_or(0, Vec::len);
            if draw_count > MAX_DRAWS {
                let node = label::node(document, node.index());
                return Err(Error::request(format!(
                    "{node} brings the scene to more than {MAX_DRAWS} draws, the limit"
                )));
            }
            let of_mesh = pieces.get(&mesh).into_iter().flatten().map(|piece| piece.mesh.triangle_count());
            triangles.spend(of_mesh.sum()).map_err(|error| error.within(label::node(document, node.index())))?;
            let bends = deform::bends(document, node.index())?;
            is_still[mesh] |= !bends;
            shown.push((node.index(), mesh, bends));
        }

        let (mut still, mut bent) = (Vec::new(), Vec::new());
        let mut ranges: BTreeMap<usize, [Range<usize>; 2]> = BTreeMap::new();
        for (mesh, pieces) in pieces {
            let (first_still, first_bent) = (still.len(), bent.len());
            for Piece { mesh: piece, deform } in pieces {
                match deform {
                    Some(deform) => {
                        still.extend(is_still[mesh].then(|| piece.clone()));
                        bent.push((piece, deform));
                    }
                    None => still.push(piece),
                }
            }
            ranges.insert(mesh, [first_still..still.len(), first_bent..bent.len()]);
        }

        let mut all = Self { bodies: Vec::new(), bent, skins: BTreeMap::new(), still_count: still.len() };
        for (node_index, mesh, bends) in shown {
            let [of_still, sources] = ranges.get(&mesh).cloned().unwrap_or_default();
            let form = if bends {
                let skin = document.as_json().nodes[node_index].skin.map(|skin| skin.value());
                if let Some(index) = skin.filter(|index| !all.skins.contains_key(index)) {
                    all.skins.insert(index, Skin::read(document, hierarchy, buffers, index)?);
                }
                let rest_weights = morph::rest_weights(document, node_index)?;
                let bent =
                    Bent { sources, skin, rest_weights, weights_channel: weights_channels.get(&node_index).copied() };
                all.require_joints(&bent).map_err(|error| error.within(label::node(document, node_index)))?;
                Form::Bent(bent)
            } else {
                Form::Still(of_still)
            };
            all.bodies.push(Body { node_index, is_moving: moving[node_index], form });
        }
        Ok((still, all))
    }

    /// Errors: a vertex names a joint beyond its skin (exit code 2).
    fn require_joints(&self, bent: &Bent) -> Result<()> {
        let Some(index) = bent.skin else { return Ok(()) };
        for (mesh, deform) in &self.bent[bent.sources.clone()] {
            if let Some(influences) = deform.influences() {
                let required = influences.require_joints(self.skins[&index].joint_count());
                required.map_err(|error| error.within(format!("skin {index} of mesh {:?}", mesh.name)))?;
            }
        }
        Ok(())
    }

    /// One draw for every primitive of every node, in the order of the nodes, where `placed` has them at `time_s`.
    ///
    /// Errors: a vertex leaves the range of 32-bit floats (exit code 2).
    pub fn shapes(
        &self,
        document: &Document,
        channels: &[Channel],
        placed: &[PlacedNode],
        time_s: f64,
    ) -> Result<Shapes> {
        let matrices: BTreeMap<usize, Vec<Mat4>> =
            self.skins.iter().map(|(index, skin)| (*index, skin.world_from_mesh(placed))).collect();
        let bend = |body: &Body| -> Result<Vec<Mesh>> {
            let Form::Bent(bent) = &body.form else { return Ok(Vec::new()) };
            let weights = bent.weights_channel.map(|channel| channels[channel].curve.at(time_s));
            let weights = weights.as_ref().unwrap_or(&bent.rest_weights);
            let matrices = bent.skin.map(|skin| matrices[&skin].as_slice());
            let sources = self.bent[bent.sources.clone()].par_iter();
            let meshes: Vec<Mesh> = sources.map(|(rest, deform)| deform.bend(rest, weights, matrices)).collect();
            match meshes.iter().all(|mesh| mesh.positions.iter().all(|position| position.is_finite())) {
                true => Ok(meshes),
                false => Err(Error::request(format!(
                    "{}: at {time_s} s its mesh bends beyond the range of 32-bit floats",
                    label::node(document, body.node_index)
                ))),
            }
        };
        let bent: Vec<Vec<Mesh>> = self.bodies.par_iter().map(bend).collect::<Result<_>>()?;

        let mut shapes = Shapes { meshes: Vec::new(), draws: Vec::new(), draw_nodes: Vec::new(), flat: Vec::new() };
        for (body, own) in self.bodies.iter().zip(bent) {
            let place = placed.binary_search_by_key(&body.node_index, |placed| placed.node_index);
            let world_from_node = placed[place.expect("a body's node is shown")].world_from_node;
            let (meshes, world_from_object) = match &body.form {
                Form::Still(meshes) => (meshes.clone(), drawable(world_from_node, body.is_moving)),
                Form::Bent(bent) => {
                    let next = self.still_count + shapes.meshes.len();
                    let meshes = next..next + own.len();
                    shapes.meshes.extend(own);
                    // glTF 2.0, section 3.7.3.3: a skin's joints are in the world, whatever its node's transform.
                    let in_world = bent.skin.map(|_| Mat4::IDENTITY);
                    (meshes, in_world.or_else(|| drawable(world_from_node, body.is_moving)))
                }
            };
            match world_from_object {
                Some(world_from_object) => {
                    shapes.draw_nodes.extend(meshes.clone().map(|_| body.node_index as u32));
                    shapes.draws.extend(meshes.map(|mesh| Draw { mesh, world_from_object }));
                }
                None => shapes.flat.push(body.node_index),
            }
        }
        Ok(shapes)
    }
}

/// The transform of a draw; None where it has no inverse and never will have one. Where it is moving and may have one
/// again, a transform that shrinks the draw to nothing at its place, so that it stays in the scene.
fn drawable(world_from_node: Mat4, is_moving: bool) -> Option<Mat4> {
    // Below the normal floats the inverse, and with it every normal, is lost.
    if Mat3::from_mat4(world_from_node).determinant().is_normal() {
        return Some(world_from_node);
    }
    let position = world_from_node.w_axis.truncate();
    is_moving.then(|| Mat4::from_scale_rotation_translation(Vec3::splat(SHRUNK), Quat::IDENTITY, position))
}
