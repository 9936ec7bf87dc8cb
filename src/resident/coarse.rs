//! Coarser triangles for what is solid, for views in which a texel is larger than what they leave out: neighbouring clusters in groups,
//! in each of which edges are collapsed by what the surface is moved (meshoptimizer's simplifier; Garland and Heckbert 1997). The rim
//! of a group stays, so that fine and coarse groups fit beside each other without gaps. Levels are made once, on the host: of 60,000
//! triangles in some tenths of a second.

use super::SceneGpu;
use super::clusters::Cluster;
use crate::scene::{AlphaMode, Mesh, Scene};
use glam::Vec3;
use meshopt::{SimplifyOptions, VertexDataAdapter};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::Range;

/// Clusters of a group at most. More leave less of its triangles to rims, and a view's nearest group is farther out.
const MOST_CLUSTERS: u32 = 8;
/// A level with fewer triangles saves nothing.
const LEAST_TRIANGLES: usize = 4;

/// Neighbouring clusters of a mesh, together.
pub struct Group {
    /// Clusters of the scene.
    pub clusters: Range<u32>,
    /// Finest first.
    pub levels: Vec<Level>,
}

/// A group's triangles, fewer than its clusters have.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// Into `CoarseMeshes::indices`.
    pub first_index: u32,
    pub index_count: u32,
    /// How far from it corners and middles of the triangles are that it stands for, at most; object space.
    pub error: f32,
}

/// Coarser triangles of a scene.
#[derive(Default)]
pub struct CoarseMeshes {
    /// Numbers of each mesh's own vertices; at most as many as the scene has, because a level has at most half of the one before.
    pub indices: Vec<u32>,
    /// Groups of each mesh, by its first cluster.
    of_meshes: HashMap<u32, Vec<Group>>,
}

/// Indices of `scene` that may have coarser ones: those of what is solid and has no holes.
pub fn most_indices(scene: &Scene) -> u64 {
    let is_solid = |mesh: &&Mesh| scene.materials[mesh.material].alpha == AlphaMode::Opaque;
    scene.meshes.iter().filter(is_solid).map(|mesh| mesh.indices.len() as u64).sum()
}

impl CoarseMeshes {
    /// Those of all that `scene` draws, whose clusters are `resident`'s.
    pub fn of(scene: &Scene, resident: &SceneGpu) -> Self {
        let solid = resident.calls.iter().filter(|call| call.alpha == AlphaMode::Opaque);
        let meshes: BTreeMap<u32, (&Mesh, Range<usize>)> = solid
            .map(|call| (call.first_cluster, (&scene.meshes[scene.draws[call.draw as usize].mesh], call.clusters())))
            .collect();
        let mut all = Self::default();
        for (first_cluster, (mesh, clusters)) in meshes {
            all.add(mesh, first_cluster, &resident.clusters[clusters], &resident.host_indices);
        }
        all
    }

    fn add(&mut self, mesh: &Mesh, first_cluster: u32, clusters: &[Cluster], indices: &[u32]) {
        let Some((first, last)) = clusters.first().zip(clusters.last()) else { return };
        let start = first.first_index as usize;
        let vertices = VertexDataAdapter::new(bytemuck::cast_slice(&mesh.positions), size_of::<Vec3>(), 0)
            .expect("a whole number of vertices");
        // Vertices in one place are one: normals do not count here.
        let joined = meshopt::generate_shadow_indices(&indices[start..last.indices().end], &vertices);
        let mut parts = Vec::new();
        halve(0..clusters.len() as u32, &mut parts);
        let made: Vec<Vec<(Vec<u32>, f32)>> = parts
            .par_iter()
            .map(|part| {
                let [first, last] = [part.start, part.end - 1].map(|index| clusters[index as usize].indices());
                levels(&joined[first.start - start..last.end - start], &vertices, &mesh.positions)
            })
            .collect();
        let groups = parts.into_iter().zip(made).map(|(part, made)| {
            let levels = made.into_iter().map(|(triangles, error)| {
                let first_index = self.indices.len() as u32;
                self.indices.extend_from_slice(&triangles);
                Level { first_index, index_count: triangles.len() as u32, error }
            });
            Group { clusters: first_cluster + part.start..first_cluster + part.end, levels: levels.collect() }
        });
        let groups = groups.collect();
        self.of_meshes.insert(first_cluster, groups);
    }

    /// Groups of the mesh whose clusters begin here; none if it has holes or is seen through.
    pub fn groups(&self, first_cluster: u32) -> &[Group] {
        self.of_meshes.get(&first_cluster).map_or(&[], Vec::as_slice)
    }
}

/// Parts of at most `MOST_CLUSTERS`, halved as a mesh's clusters were, so that each lies together.
fn halve(clusters: Range<u32>, parts: &mut Vec<Range<u32>>) {
    let count = clusters.end - clusters.start;
    if count <= MOST_CLUSTERS {
        parts.push(clusters);
        return;
    }
    let middle = clusters.start + count.div_ceil(2);
    halve(clusters.start..middle, parts);
    halve(middle..clusters.end, parts);
}

/// Each with at most half the triangles of the one before, and how far it is off, until the rim allows no fewer.
fn levels(triangles: &[u32], vertices: &VertexDataAdapter<'_>, positions: &[Vec3]) -> Vec<(Vec<u32>, f32)> {
    let options = SimplifyOptions::LockBorder | SimplifyOptions::Sparse | SimplifyOptions::ErrorAbsolute;
    let mut levels = Vec::new();
    let mut most = triangles.len() / 6 * 3;
    while most >= 3 * LEAST_TRIANGLES {
        // From the finest: what is off does not add up.
        let fewer = meshopt::simplify(triangles, vertices, most, f32::MAX, options, None);
        if fewer.len() > most || fewer.is_empty() {
            break;
        }
        // What the simplifier says of itself is a mean, and up to seventeen times less.
        let error = farthest(triangles, &fewer, positions);
        if !error.is_finite() {
            break;
        }
        most = fewer.len() / 6 * 3;
        levels.push((fewer, error));
    }
    levels
}

/// How far the corners and the middles of `fine` are from `coarse` at most.
fn farthest(fine: &[u32], coarse: &[u32], positions: &[Vec3]) -> f32 {
    let corners = |triangle: &[u32]| [0, 1, 2].map(|corner| positions[triangle[corner] as usize]);
    let mut seen = HashSet::new();
    let places = fine.iter().filter(|index| seen.insert(**index)).map(|index| positions[*index as usize]);
    let middles = fine.chunks_exact(3).map(|triangle| corners(triangle).into_iter().sum::<Vec3>() / 3.0);
    let nearest =
        |at: Vec3| coarse.chunks_exact(3).map(|triangle| distance(at, corners(triangle))).fold(f32::INFINITY, f32::min);
    places.chain(middles).map(nearest).fold(0.0, f32::max)
}

/// Distance to a triangle: to its plane where the point lies over it, to its edges else.
fn distance(at: Vec3, [a, b, c]: [Vec3; 3]) -> f32 {
    let normal = (b - a).cross(c - a);
    let is_over = [(a, b), (b, c), (c, a)].iter().all(|(from, to)| (to - from).cross(at - from).dot(normal) >= 0.0);
    if is_over && normal.length_squared() > 0.0 {
        return (at - a).dot(normal.normalize()).abs();
    }
    let to_edge = |from: Vec3, to: Vec3| {
        let along = to - from;
        let part = ((at - from).dot(along) / along.length_squared().max(1e-30)).clamp(0.0, 1.0);
        at.distance(from + part * along)
    };
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

#[cfg(test)]
mod tests {
    use super::super::geometry::Geometry;
    use super::*;
    use crate::scene::procedural;
    use std::collections::BTreeSet;

    struct Coarsened {
        mesh: Mesh,
        fine: Vec<u32>,
        coarse: CoarseMeshes,
        clusters: Vec<Cluster>,
    }

    const SCENES: [&str; 2] = ["hall:triangles=8000", "lamps:objects=10"];

    /// Each mesh of a scene.
    fn coarsened(spec: &str) -> Vec<Coarsened> {
        let scene = procedural::build(spec, 1).unwrap().unwrap();
        let geometry = Geometry::of(&scene);
        let mut calls = geometry.calls(&scene);
        calls.sort_by_key(|call| call.first_cluster);
        calls.dedup_by_key(|call| call.first_cluster);
        calls
            .iter()
            .map(|call| {
                let mesh = scene.meshes[scene.draws[call.draw as usize].mesh].clone();
                let mut coarse = CoarseMeshes::default();
                coarse.add(&mesh, call.first_cluster, &geometry.clusters[call.clusters()], &geometry.indices);
                Coarsened { mesh, fine: geometry.indices.clone(), coarse, clusters: geometry.clusters.clone() }
            })
            .collect()
    }

    impl Coarsened {
        /// For each level of each group: what it stands for, itself, and how far it is off.
        fn levels(&self) -> Vec<(&[u32], &[u32], f32)> {
            let all = self.coarse.of_meshes.values().flatten();
            all.flat_map(|group| {
                let [first, last] =
                    [group.clusters.start, group.clusters.end - 1].map(|index| &self.clusters[index as usize]);
                let fine = &self.fine[first.indices().start..last.indices().end];
                group.levels.iter().map(move |level| {
                    let range = level.first_index as usize..(level.first_index + level.index_count) as usize;
                    (fine, &self.coarse.indices[range], level.error)
                })
            })
            .collect()
        }

        fn corners(&self, triangle: &[u32]) -> [Vec3; 3] {
            [0, 1, 2].map(|corner| self.mesh.positions[triangle[corner] as usize])
        }

        /// Edges that one triangle alone has, by where they lie.
        fn rim(&self, triangles: &[u32]) -> BTreeSet<[[u32; 3]; 2]> {
            let mut uses: BTreeMap<[[u32; 3]; 2], u32> = BTreeMap::new();
            for triangle in triangles.chunks_exact(3) {
                // One zero is as good as the other.
                let at = self.corners(triangle).map(|at| (at + Vec3::ZERO).to_array().map(f32::to_bits));
                for corner in 0..3 {
                    let (a, b) = (at[corner], at[(corner + 1) % 3]);
                    *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
                }
            }
            uses.into_iter().filter(|(edge, count)| *count == 1 && edge[0] != edge[1]).map(|(edge, _)| edge).collect()
        }
    }

    #[test]
    fn levels_are_half_of_each_other_and_keep_their_rims() {
        for spec in SCENES {
            let scene = procedural::build(spec, 1).unwrap().unwrap();
            let meshes = coarsened(spec);
            let solid = meshes.iter().filter(|mesh| scene.materials[mesh.mesh.material].alpha == AlphaMode::Opaque);
            let all: usize = solid.map(|mesh| mesh.coarse.indices.len()).sum();
            assert!(all as u64 <= most_indices(&scene), "{spec}: they have room");
            println!(
                "{spec}: {} levels of {} meshes",
                meshes.iter().map(|mesh| mesh.levels().len()).sum::<usize>(),
                meshes.len()
            );
            assert!(all > 0, "{spec}");
            for mesh in &meshes {
                assert!(mesh.coarse.indices.len() <= mesh.mesh.indices.len());
                for group in mesh.coarse.of_meshes.values().flatten() {
                    let mut before: u32 =
                        group.clusters.clone().map(|index| mesh.clusters[index as usize].index_count).sum();
                    for level in &group.levels {
                        assert!(2 * level.index_count <= before, "{spec}: {} of {before}", level.index_count);
                        before = level.index_count;
                    }
                }
                for (fine, coarse, _) in mesh.levels() {
                    let (fine, coarse) = (mesh.rim(fine), mesh.rim(coarse));
                    assert!(
                        fine.is_subset(&coarse),
                        "{spec}: {} edges of a rim are lost",
                        fine.difference(&coarse).count()
                    );
                }
            }
        }
    }

    /// What a level says of itself against the distances between it and what it stands for, both ways, at many points.
    #[test]
    fn a_level_is_hardly_farther_off_than_it_says() {
        for spec in SCENES {
            let mut worst = 0f32;
            for mesh in &coarsened(spec) {
                for (fine, coarse, error) in mesh.levels() {
                    let points = |triangles: &[u32]| -> Vec<Vec3> {
                        let of = |triangle: &[u32]| {
                            let [a, b, c] = mesh.corners(triangle);
                            [a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0]
                        };
                        triangles.chunks_exact(3).flat_map(of).collect()
                    };
                    let farthest = |from: &[u32], to: &[u32]| {
                        points(from)
                            .into_iter()
                            .map(|at| {
                                to.chunks_exact(3)
                                    .map(|triangle| distance(at, mesh.corners(triangle)))
                                    .fold(f32::MAX, f32::min)
                            })
                            .fold(0.0, f32::max)
                    };
                    let size = mesh.mesh.positions.iter().fold(0f32, |most, at| most.max(at.abs().max_element()));
                    let off = farthest(fine, coarse).max(farthest(coarse, fine));
                    worst = worst.max(off / (error + 1e-5 * size));
                }
            }
            println!("{spec}: off by up to {worst} times what levels say");
            assert!(worst < 1.1, "{spec}: {worst}");
        }
    }
}
