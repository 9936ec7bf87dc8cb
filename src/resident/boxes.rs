//! Boxes in world space around the clusters of what is solid, for views that are many and small: made once, and asked by planes.

use super::swept::{Sweep, SweptView};
use super::{Coverage, DrawCall, DrawList, Raster, SceneGpu, Sides};
use crate::frame::View;
use crate::scene::{AlphaMode, Bounds, Scene};

/// A cluster that casts shadows.
struct Boxed {
    /// Its own range of indices, from both sides.
    part: DrawCall,
    bounds: Bounds,
}

pub struct ClusterBoxes {
    all: Vec<Boxed>,
    /// Boxes of those that a view may see.
    seen: Vec<Bounds>,
}

impl ClusterBoxes {
    /// `scene`: as its draws stand; `view`: from where it is seen.
    pub fn new(scene: &Scene, resident: &SceneGpu, view: &View) -> Self {
        let raster = Raster { extent: view.extent, coverage: Coverage::Middle };
        let (mut all, mut seen) = (Vec::new(), Vec::new());
        for call in resident.calls.iter().filter(|call| call.alpha != AlphaMode::Blend) {
            let swept = SweptView::new(scene, call, view, raster, Sweep::default());
            let world_from_object = scene.draws[call.draw as usize].world_from_object;
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
        }
        Self { all, seen }
    }

    /// Boxes of the clusters that the view may see.
    pub fn seen(&self) -> &[Bounds] {
        &self.seen
    }

    /// What is drawn of all clusters, in the order of the draws: those whose box `is_kept`.
    pub fn list(&self, is_kept: impl Fn(&Bounds) -> bool) -> DrawList {
        let mut list = DrawList::default();
        for Boxed { part, bounds } in &self.all {
            if is_kept(bounds) {
                list.push(*part);
                list.clusters_drawn += 1;
            } else {
                list.clusters_culled += 1;
            }
        }
        list
    }
}
