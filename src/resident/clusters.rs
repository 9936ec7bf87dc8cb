//! Clusters: a mesh's triangles in groups that lie together, so that a view can leave a group out without testing each
//! of its triangles (`visible.rs`).
//!
//! Triangles are halved by the median of their middles along the longest side of the box around them, until a group holds
//! at most 128. The same mesh always gives the same clusters. Inside a cluster triangles keep the mesh's order, which the
//! file's author may have chosen so that neighbours share vertices. BLEND meshes stay one cluster in their own order:
//! they are drawn whole, sorted by mesh.

use crate::scene::{Bounds, Mesh};
use glam::Vec3;
use std::ops::Range;

/// Triangles of a cluster at most. All but the last of a mesh hold as many.
pub const MOST_TRIANGLES: usize = 128;

/// A range of the scene's index list whose triangles lie together.
#[derive(Clone, Copy, Debug)]
pub struct Cluster {
    pub first_index: u32,
    pub index_count: u32,
    /// Box around its triangles, object space.
    pub bounds: Bounds,
}

impl Cluster {
    /// Its range of the index list.
    pub fn indices(&self) -> Range<usize> {
        self.first_index as usize..(self.first_index + self.index_count) as usize
    }
}

/// The triangles of each cluster of `mesh`, as their places in its list, at most `MOST_TRIANGLES` each.
pub fn grouped(mesh: &Mesh) -> Vec<Vec<u32>> {
    // Three times the middle orders as the middle does.
    let middles: Vec<Vec3> = (0..mesh.triangle_count()).map(|index| mesh.triangle(index).into_iter().sum()).collect();
    let mut order: Vec<u32> = (0..middles.len() as u32).collect();
    let mut groups = Vec::with_capacity(order.len().div_ceil(MOST_TRIANGLES));
    halve(&middles, &mut order, &mut groups);
    groups
}

fn halve(middles: &[Vec3], triangles: &mut [u32], groups: &mut Vec<Vec<u32>>) {
    if triangles.len() <= MOST_TRIANGLES {
        if !triangles.is_empty() {
            triangles.sort_unstable();
            groups.push(triangles.to_vec());
        }
        return;
    }
    let mut bounds = Bounds::EMPTY;
    triangles.iter().for_each(|index| bounds.include(middles[*index as usize]));
    let axis = (bounds.max - bounds.min).max_position();
    // Whole clusters on the left, so that all but the last are full.
    let left = triangles.len().div_ceil(MOST_TRIANGLES).div_ceil(2) * MOST_TRIANGLES;
    // The index breaks ties: which triangles are the left ones does not depend on how they are found.
    triangles.select_nth_unstable_by(left, |a, b| {
        middles[*a as usize][axis].total_cmp(&middles[*b as usize][axis]).then(a.cmp(b))
    });
    let (left, right) = triangles.split_at_mut(left);
    halve(middles, left, groups);
    halve(middles, right, groups);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural;
    use proptest::prelude::*;

    fn soup(seed: u32, count: u32) -> Mesh {
        let number = |index: u32, axis: u32| sobol_burley::sample(index, axis, seed);
        let mut mesh = Mesh::default();
        for corner in 0..3 * count {
            mesh.indices.push(corner);
            let middle = Vec3::new(number(corner / 3, 0), number(corner / 3, 1), 0.1 * number(corner / 3, 2));
            mesh.positions.push(middle + 0.05 * Vec3::new(number(corner, 3), number(corner, 4), number(corner, 5)));
        }
        mesh
    }

    fn require_partition(mesh: &Mesh) {
        let groups = grouped(mesh);
        assert!(groups.iter().all(|group| (1..=MOST_TRIANGLES).contains(&group.len())));
        assert_eq!(groups.len(), mesh.triangle_count().div_ceil(MOST_TRIANGLES), "no more than needed");
        assert!(groups.iter().rev().skip(1).all(|group| group.len() == MOST_TRIANGLES), "all but the last are full");
        let mut every: Vec<u32> = groups.concat();
        every.sort_unstable();
        assert!(every.iter().copied().eq(0..mesh.triangle_count() as u32), "every triangle once");
        assert_eq!(groups, grouped(mesh), "the same again");
    }

    proptest! {
        #[test]
        fn every_triangle_is_in_one_cluster(seed in 0u32..100, count in 0u32..1500) {
            require_partition(&soup(seed, count));
        }
    }

    #[test]
    fn triangles_in_one_place_are_still_parted() {
        let mesh =
            Mesh { indices: [0, 1, 2].repeat(1000), positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], ..Mesh::default() };
        require_partition(&mesh);
    }

    #[test]
    fn clusters_are_small_beside_their_mesh() {
        let mesh = soup(7, 128 * 64);
        let whole = 1.1 * 1.1;
        let areas = grouped(&mesh).into_iter().map(|group| {
            let mut bounds = Bounds::EMPTY;
            group.iter().for_each(|index| mesh.triangle(*index as usize).into_iter().for_each(|p| bounds.include(p)));
            let side = bounds.max - bounds.min;
            side.x * side.y
        });
        // 64 tiles cover the square once; the triangles' own size makes them overlap.
        let sum: f32 = areas.sum();
        assert!(sum < 2.5 * whole, "{sum}");
    }

    #[test]
    fn the_hall_is_parted() {
        let scene = procedural::build("hall:triangles=8000", 1).unwrap().unwrap();
        scene.meshes.iter().for_each(require_partition);
    }
}
