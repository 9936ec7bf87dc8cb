//! Boxes in world space around the clusters of what is solid, for views that are many and small: made once, and asked by planes.

use super::coarse::{CoarseMeshes, Group};
use super::swept::{Sweep, SweptView};
use super::{Coverage, DrawCall, DrawList, Raster, SceneGpu, Sides};
use crate::frame::View;
use crate::scene::{AlphaMode, Bounds, Scene};
use glam::Mat4;
use std::ops::Range;

/// A cluster that casts shadows.
struct Boxed {
    /// Its own range of indices, from both sides.
    part: DrawCall,
    bounds: Bounds,
}

/// Clusters that coarser triangles stand for together.
struct BoxedGroup {
    /// Places in `ClusterBoxes::all`.
    clusters: Range<usize>,
    bounds: Bounds,
    levels: Vec<BoxedLevel>,
}

/// Coarser triangles, and how far they are off in world space.
struct BoxedLevel {
    part: DrawCall,
    error_m: f32,
}

/// What a view draws of clusters.
#[derive(Default)]
pub struct Casters {
    /// By the scene's own index list.
    pub fine: DrawList,
    /// By that of its coarser triangles.
    pub coarse: DrawList,
}

impl Casters {
    pub fn triangles_drawn(&self) -> u64 {
        self.fine.triangles_drawn() + self.coarse.triangles_drawn()
    }

    pub fn draw_count(&self) -> usize {
        self.fine.calls().count() + self.coarse.calls().count()
    }
}

pub struct ClusterBoxes {
    all: Vec<Boxed>,
    groups: Vec<BoxedGroup>,
    /// Boxes of those that a view may see.
    seen: Vec<Bounds>,
}

impl ClusterBoxes {
    /// `scene`: as its draws stand; `coarse`: what may be drawn in place of its triangles; `view`: from where it is seen.
    pub fn new(scene: &Scene, resident: &SceneGpu, coarse: &CoarseMeshes, view: &View) -> Self {
        let raster = Raster { extent: view.extent, coverage: Coverage::Middle };
        let (mut all, mut groups, mut seen) = (Vec::new(), Vec::new(), Vec::new());
        for call in resident.calls.iter().filter(|call| call.alpha != AlphaMode::Blend) {
            let swept = SweptView::new(scene, call, view, raster, Sweep::default());
            let world_from_object = scene.draws[call.draw as usize].world_from_object;
            let first = all.len();
            for cluster in &resident.clusters[call.clusters()] {
                let mut bounds = Bounds::EMPTY;
                cluster.bounds.corners().iter().for_each(|at| bounds.include(world_from_object.transform_point3(*at)));
                if !swept.sees_nothing_of(cluster, &resident.host_indices[cluster.indices()]) {
                    seen.push(bounds);
                }
                let (first_index, index_count) = (cluster.first_index, cluster.index_count);
                // Shadow rays meet both sides.
                all.push(Boxed { part: DrawCall { first_index, index_count, sides: Sides::Both, ..*call }, bounds });
            }
            let grown = growth(&world_from_object);
            let boxed = |group: &Group| {
                let [start, end] = [group.clusters.start, group.clusters.end]
                    .map(|cluster| first + (cluster - call.first_cluster) as usize);
                let levels = group.levels.iter().map(|level| BoxedLevel {
                    part: DrawCall {
                        first_index: level.first_index,
                        index_count: level.index_count,
                        ..all[start].part
                    },
                    error_m: grown * level.error,
                });
                let mut bounds = Bounds::EMPTY;
                all[start..end]
                    .iter()
                    .flat_map(|cluster| [cluster.bounds.min, cluster.bounds.max])
                    .for_each(|at| bounds.include(at));
                BoxedGroup { clusters: start..end, bounds, levels: levels.collect() }
            };
            match coarse.groups(call.first_cluster) {
                [] => groups.push(BoxedGroup { clusters: first..all.len(), bounds: Bounds::EMPTY, levels: Vec::new() }),
                found => groups.extend(found.iter().map(boxed)),
            }
        }
        Self { all, groups, seen }
    }

    /// Boxes of the clusters that the view may see.
    pub fn seen(&self) -> &[Bounds] {
        &self.seen
    }

    /// What is drawn of all clusters, in the order of the draws: those whose box `is_kept`, or the coarsest triangles that say they are
    /// off by no more than `may_be_off_m` of the box around what they stand for, where these are fewer.
    pub fn list(&self, is_kept: impl Fn(&Bounds) -> bool, may_be_off_m: impl Fn(&Bounds) -> f32) -> Casters {
        let mut casters = Casters::default();
        for group in &self.groups {
            let mut kept: Vec<&Boxed> = Vec::with_capacity(group.clusters.len());
            kept.extend(self.all[group.clusters.clone()].iter().filter(|cluster| is_kept(&cluster.bounds)));
            let index_count: u32 = kept.iter().map(|cluster| cluster.part.index_count).sum();
            let Casters { fine, coarse } = &mut casters;
            match group.coarsest(&may_be_off_m).filter(|level| level.part.index_count < index_count) {
                Some(level) => coarse.push(level.part),
                None => kept.iter().for_each(|cluster| fine.push(cluster.part)),
            }
        }
        casters
    }
}

impl BoxedGroup {
    fn coarsest(&self, may_be_off_m: impl Fn(&Bounds) -> f32) -> Option<&BoxedLevel> {
        let most_m = if self.levels.is_empty() { 0.0 } else { may_be_off_m(&self.bounds) };
        self.levels.iter().rev().find(|level| level.error_m <= most_m)
    }
}

/// The most by which a transform makes a length longer: its longest column where these are at right angles, else no more than the
/// root of the sum of its squares.
fn growth(world_from_object: &Mat4) -> f32 {
    let columns = [0, 1, 2].map(|axis| world_from_object.col(axis).truncate());
    let [x, y, z] = columns;
    let longest = columns.iter().map(|column| column.length()).fold(0.0, f32::max);
    let are_orthogonal = x.dot(y).abs().max(y.dot(z).abs()).max(z.dot(x).abs()) <= 1e-4 * longest * longest;
    if are_orthogonal { longest } else { columns.iter().map(|column| column.length_squared()).sum::<f32>().sqrt() }
}
