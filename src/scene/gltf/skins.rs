//! Skins: the matrices of their joints at a moment, and which joints move a vertex by how much.

use glam::{Mat3, Mat4, Vec3};
use gltf::{Document, Semantic};

use super::buffers::Buffers;
use super::nodes::{self, Hierarchy, PlacedNode};
use super::{accessors, label};
use crate::error::{Error, Result};
use crate::scene::Mesh;

/// How many sets JOINTS_n, WEIGHTS_n are read: eight joints a vertex.
pub const SETS: u32 = 2;

/// A skin: joints, and the meshes' space in each of them.
#[derive(Debug)]
pub struct Skin {
    joints: Vec<Joint>,
}

#[derive(Debug)]
struct Joint {
    node_index: usize,
    joint_from_mesh: Mat4,
}

impl Skin {
    /// Reads a skin whose joints `hierarchy` shows.
    ///
    /// Errors: no joints, a joint outside the scene, too few or broken inverse bind matrices (exit code 2).
    pub fn read(document: &Document, hierarchy: &Hierarchy, buffers: &Buffers<'_>, skin_index: usize) -> Result<Self> {
        let skin = &document.as_json().skins[skin_index];
        let read = || {
            let accessor = skin.inverse_bind_matrices.and_then(|index| document.accessors().nth(index.value()));
            let matrices = accessor.map(|accessor| accessors::floats::<16>(buffers, &accessor)).transpose();
            let matrices = matrices.map_err(|error| error.within("inverseBindMatrices"))?;
            if skin.joints.is_empty() {
                return Err(Error::request("has no joints; at least one is needed"));
            }
            if let Some(matrices) = matrices.as_ref().filter(|matrices| matrices.len() < skin.joints.len()) {
                return Err(Error::request(format!(
                    "inverseBindMatrices: holds {} matrices for {} joints; each joint needs one",
                    matrices.len(),
                    skin.joints.len()
                )));
            }
            let joint = |(place, node): (usize, &gltf::json::Index<gltf::json::Node>)| {
                let node_index = node.value();
                if !hierarchy.shows(node_index) {
                    return Err(Error::request(format!(
                        "joint {place} is {}, which is not in the scene that is shown; put it there",
                        label::node(document, node_index)
                    )));
                }
                let matrix = matrices.as_ref().map_or(Ok(Mat4::IDENTITY), |matrices| {
                    nodes::affine(Mat4::from_cols_array(&matrices[place]))
                        .map_err(|error| error.within(format!("inverseBindMatrices: element {place}")))
                });
                Ok(Joint { node_index, joint_from_mesh: matrix? })
            };
            Ok(Self { joints: skin.joints.iter().enumerate().map(joint).collect::<Result<_>>()? })
        };
        read().map_err(|error| error.within(label::element("skin", skin_index, skin.name.as_deref())))
    }

    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// What takes a vertex of a mesh to the world, for each joint. `placed`: ordered by node.
    pub fn world_from_mesh(&self, placed: &[PlacedNode]) -> Vec<Mat4> {
        let matrix = |joint: &Joint| {
            let place = placed.binary_search_by_key(&joint.node_index, |placed| placed.node_index);
            placed[place.expect("`read` saw that the scene shows it")].world_from_node * joint.joint_from_mesh
        };
        self.joints.iter().map(matrix).collect()
    }
}

/// Which joints move each vertex of a mesh; weights are at least 0 and sum up to 1.
#[derive(Debug, Default)]
pub struct Influences {
    sets: Vec<Vec<[Influence; 4]>>,
    /// The greatest joint with a weight, and the vertex in the file that names it.
    greatest: Option<(u16, usize)>,
    /// How many vertices have no weight at all: the skin's first joint takes them along.
    pub weightless: usize,
}

#[derive(Clone, Copy, Debug, Default)]
struct Influence {
    joint: u16,
    weight: f32,
}

impl Influences {
    /// Those of a primitive of `vertex_count` vertices in the file, at the vertices that became `origins`.
    ///
    /// Errors: no JOINTS_0 or WEIGHTS_0, another number of elements, negative weights (exit code 2).
    pub fn read(
        buffers: &Buffers<'_>,
        primitive: &gltf::Primitive<'_>,
        vertex_count: usize,
        origins: &[u32],
    ) -> Result<Self> {
        let mut influences = Self::default();
        let mut of_file: Vec<Vec<[Influence; 4]>> = Vec::new();
        for set in 0..SETS {
            let of_set = (primitive.get(&Semantic::Joints(set)), primitive.get(&Semantic::Weights(set)));
            let (joints, weights) = match of_set {
                (Some(joints), Some(weights)) => (joints, weights),
                (None, None) if set > 0 => break,
                _ => {
                    return Err(Error::request(format!(
                        "a node gives it a skin, so it needs both JOINTS_{set} and WEIGHTS_{set}"
                    )));
                }
            };
            let in_joints = |error: Error| error.within(format!("JOINTS_{set}"));
            let in_weights = |error: Error| error.within(format!("WEIGHTS_{set}"));
            accessors::require_count(&joints, vertex_count).map_err(in_joints)?;
            accessors::require_count(&weights, vertex_count).map_err(in_weights)?;
            let joints = accessors::joints(buffers, &joints).map_err(in_joints)?;
            let weights = accessors::floats::<4>(buffers, &weights).map_err(in_weights)?;
            if let Some(vertex) = weights.iter().position(|weights| weights.iter().any(|weight| *weight < 0.0)) {
                return Err(in_weights(Error::request(format!(
                    "element {vertex} is {:?}; weights must be at least 0",
                    weights[vertex]
                ))));
            }
            let pair = |(joints, weights): (&[u16; 4], &[f32; 4])| {
                std::array::from_fn(|at| Influence { joint: joints[at], weight: weights[at] })
            };
            of_file.push(joints.iter().zip(&weights).map(pair).collect());
        }
        influences.normalize(&mut of_file);
        let at_origins = |set: Vec<[Influence; 4]>| origins.iter().map(|origin| set[*origin as usize]).collect();
        influences.sets = of_file.into_iter().map(at_origins).collect();
        Ok(influences)
    }

    /// Makes the weights of each vertex sum up to 1; joints without weight become the first, so that they name none.
    fn normalize(&mut self, sets: &mut [Vec<[Influence; 4]>]) {
        for vertex in 0..sets[0].len() {
            // In 64 bits: the sum of any 32-bit weights is finite there.
            let of_vertex = || sets.iter().flat_map(|set| &set[vertex]);
            let sum: f64 = of_vertex().map(|influence| f64::from(influence.weight)).sum();
            for influence in sets.iter_mut().flat_map(|set| &mut set[vertex]) {
                influence.weight = if sum > 0.0 { (f64::from(influence.weight) / sum) as f32 } else { 0.0 };
                if influence.weight == 0.0 {
                    influence.joint = 0;
                } else if self.greatest.is_none_or(|(joint, _)| influence.joint > joint) {
                    self.greatest = Some((influence.joint, vertex));
                }
            }
            if sum <= 0.0 {
                sets[0][vertex][0].weight = 1.0;
                self.weightless += 1;
            }
        }
    }

    /// Errors: a vertex names a joint that a skin of `joint_count` joints does not have (exit code 2).
    pub fn require_joints(&self, joint_count: usize) -> Result<()> {
        match self.greatest.filter(|(joint, _)| usize::from(*joint) >= joint_count) {
            Some((joint, vertex)) => Err(Error::request(format!(
                "vertex {vertex} names joint {joint}, but the skin has {joint_count} joints"
            ))),
            None => Ok(()),
        }
    }

    /// Takes the vertices of `mesh` along with the joints. Normals follow the inverse transpose of the blended matrix,
    /// tangents the matrix.
    ///
    /// A triangle that the joints mirror runs the other way round afterwards, so that its front stays its front. glTF 2.0
    /// has the determinant of a node's transform say which way fronts run (section 3.7.2.1), and has the node's transform
    /// ignored where a skin is (3.7.3.3): the joints, which replace it there, decide it here, for each triangle as most
    /// of its corners have it.
    pub fn apply(&self, mesh: &mut Mesh, world_from_mesh: &[Mat4]) {
        let mut is_mirrored = vec![false; mesh.positions.len()];
        for vertex in 0..mesh.positions.len() {
            let of_vertex = self.sets.iter().flat_map(|set| &set[vertex]).filter(|influence| influence.weight > 0.0);
            let blended = of_vertex.fold(Mat4::ZERO, |sum, influence| {
                sum + world_from_mesh[usize::from(influence.joint)] * influence.weight
            });
            // Weights round, so the last row is 1 only about; transform_point3 leaves it out.
            mesh.positions[vertex] = blended.transform_point3(mesh.positions[vertex]);
            let linear = Mat3::from_mat4(blended);
            is_mirrored[vertex] = linear.determinant() < 0.0;
            if let Some(normal) = mesh.normals.get_mut(vertex) {
                *normal = turned_normal(linear, *normal);
            }
            if let Some(tangent) = mesh.tangents.get_mut(vertex) {
                *tangent = (linear * tangent.truncate()).extend(tangent.w);
            }
        }
        for corners in mesh.indices.chunks_exact_mut(3) {
            if corners.iter().filter(|vertex| is_mirrored[**vertex as usize]).count() >= 2 {
                corners.swap(1, 2);
            }
        }
    }
}

/// A normal under a transform, of unit length; as it was where the transform leaves it no direction.
fn turned_normal(linear: Mat3, normal: Vec3) -> Vec3 {
    // Cofactors are the inverse transpose times the determinant, and are there where the inverse is not. The largest
    // number first made 1, so that products of three neither vanish nor overflow.
    let largest = [linear.x_axis, linear.y_axis, linear.z_axis].map(|axis| axis.abs().max_element());
    let linear = linear * (1.0 / largest.into_iter().fold(0.0, f32::max));
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let turned = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * normal;
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    (sign * turned).try_normalize().unwrap_or(normal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_normal_follows_the_inverse_transpose() {
        let shear = Mat3::from_cols(Vec3::new(2.0, 0.5, 0.0), Vec3::new(-1.0, 3.0, 0.2), Vec3::new(0.0, 0.7, -4.0));
        for scale in [1.0, 1e-20, 1e20] {
            let normal = Vec3::new(0.6, 0.0, 0.8);
            let expected = (shear.inverse().transpose() * normal).normalize();
            let found = turned_normal(shear * scale, normal);
            assert!(found.abs_diff_eq(expected, 1e-5), "{scale}: {found} {expected}");
        }
        assert_eq!(turned_normal(Mat3::ZERO, Vec3::Y), Vec3::Y);
        assert_eq!(turned_normal(Mat3::from_diagonal(Vec3::new(1.0, 0.0, 1.0)), Vec3::Y), Vec3::Y);
    }

    #[test]
    fn a_triangle_turns_round_where_joints_mirror_most_of_it() {
        let joints = [Mat4::IDENTITY, Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0))];
        for (of_vertices, expected) in
            [([0, 0, 0], [0, 1, 2]), ([1, 0, 0], [0, 1, 2]), ([1, 0, 1], [0, 2, 1]), ([1, 1, 1], [0, 2, 1])]
        {
            let set = of_vertices.map(|joint| {
                let mut influences = [Influence::default(); 4];
                influences[0] = Influence { joint, weight: 1.0 };
                influences
            });
            let influences = Influences { sets: vec![set.to_vec()], ..Influences::default() };
            let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
            let mut mesh = Mesh { positions, indices: vec![0, 1, 2], ..Mesh::default() };
            influences.apply(&mut mesh, &joints);
            assert_eq!(mesh.indices, expected, "{of_vertices:?}");
        }
    }

    #[test]
    fn weights_sum_up_to_one_over_all_sets() {
        let influence = |joint, weight| Influence { joint, weight };
        let none = [Influence::default(); 4];
        let mut sets = [
            vec![[influence(1, 1.0), influence(9, 0.0), influence(0, 0.0), influence(0, 0.0)], none],
            vec![[influence(2, 3.0), none[0], none[0], none[0]], none],
        ];
        let mut influences = Influences::default();
        influences.normalize(&mut sets);
        assert_eq!([sets[0][0][0].weight, sets[1][0][0].weight], [0.25, 0.75]);
        assert_eq!((sets[0][1][0].weight, influences.weightless), (1.0, 1));
        assert_eq!(sets[0][0][1].joint, 0);
        assert!(influences.require_joints(3).is_ok());
        let error = influences.require_joints(2).unwrap_err();
        assert!(error.message().contains("vertex 0 names joint 2"), "{error}");
    }
}
