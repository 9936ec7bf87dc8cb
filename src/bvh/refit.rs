//! A tree over the same triangles at another moment: its shape stays, its boxes are made anew from the leaves up (Wald,
//! Boulos and Shirley, Ray Tracing Deformable Scenes Using Dynamic Bounding Volume Hierarchies, ACM Transactions on
//! Graphics 26, 2007, section 4; the tree of Dubla 2009, section 4). That takes a part of what building takes, and as
//! triangles that were neighbours part, boxes overlap and rays take more steps: how many more is told by `cost`.
//!
//! A ray meets the same, to the bit, as in a tree that is built anew: each triangle is tried with the same numbers in both.
//! Only where two triangles are met at the same distance to the last bit, as on an edge that they share, the one that is
//! tried first is met, and which that is may differ, as it may between any two trees.

use super::nodes::{half_area, is_leaf};
use super::{Bvh, Source, block_of, triangle_in_world};
use crate::gpu::shader::structs::BvhNodeBlock;
use crate::scene::{Bounds, Scene};
use obvhs::triangle::Triangle;

impl Bvh {
    /// The tree over `scene`, which has the triangles over which it was built, wherever they have moved
    /// (`Scene::has_same_triangles`, and the same BLEND surfaces).
    pub fn refit(&mut self, scene: &Scene) {
        if self.sources.is_empty() {
            return;
        }
        let closing = scene.closing.as_deref();
        self.closing.clear();
        let mut bounds = Vec::with_capacity(self.sources.len());
        for (index, source) in self.sources.iter().enumerate() {
            let Source { draw, triangle } = *source;
            let corners = |at: &Scene| triangle_in_world(at, &at.draws[draw as usize], triangle as usize);
            let (opening, shut) = (corners(scene), closing.map(corners));
            let mut around = Bounds::EMPTY;
            for Triangle { v0, v1, v2 } in std::iter::once(opening).chain(shut) {
                [v0, v1, v2].into_iter().for_each(|corner| around.include(corner.into()));
            }
            self.triangles[index] = block_of(scene, source, &opening);
            self.closing.extend(shut.map(|corners| block_of(scene, source, &corners)));
            bounds.push(around);
        }
        for index in top_down(&self.nodes).into_iter().rev() {
            let node = self.nodes[index];
            let first = node.max_first[3].to_bits() as usize;
            let mut around = Bounds::EMPTY;
            let mut include = |part: &Bounds| {
                around.include(part.min);
                around.include(part.max);
            };
            if is_leaf(&node) {
                bounds[first..first + node.min_count[3].to_bits() as usize].iter().for_each(include);
            } else {
                self.nodes[first..first + 2].iter().map(box_of).for_each(|child| include(&child));
            }
            let node = &mut self.nodes[index];
            node.min_count[..3].copy_from_slice(&around.min.to_array());
            node.max_first[..3].copy_from_slice(&around.max.to_array());
        }
    }

    /// Boxes that a ray through the outermost box enters and triangles that it tries, in the mean over all rays, none of which
    /// is stopped: the surface area heuristic of Goldsmith and Salmon (Automatic Creation of Object Hierarchies for Ray
    /// Tracing, IEEE Computer Graphics and Applications 7, 1987), with a triangle as dear as a box. 0 where all lies on one
    /// line.
    pub fn cost(&self) -> f64 {
        let steps = |node: &BvhNodeBlock| f64::from(half_area(node)) * f64::from(node.min_count[3].to_bits().max(1));
        let outermost = f64::from(half_area(&self.nodes[0]));
        if outermost == 0.0 { 0.0 } else { self.nodes.iter().map(steps).sum::<f64>() / outermost }
    }
}

/// Indices of all nodes, each before those below it.
fn top_down(nodes: &[BvhNodeBlock]) -> Vec<usize> {
    let mut order = Vec::with_capacity(nodes.len());
    order.push(0);
    let mut at = 0;
    while at < order.len() {
        let node = &nodes[order[at]];
        if !is_leaf(node) {
            let first = node.max_first[3].to_bits() as usize;
            order.extend([first, first + 1]);
        }
        at += 1;
    }
    order
}

fn box_of(node: &BvhNodeBlock) -> Bounds {
    let [min, max] = [node.min_count, node.max_first].map(|[x, y, z, _]| glam::Vec3::new(x, y, z));
    Bounds { min, max }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::tests::field;
    use crate::scene::{AlphaMode, Material};
    use glam::{Mat4, Vec3};
    use proptest::prelude::*;

    /// `scene` with every triangle moved by up to `far` along each axis, and every draw turned.
    fn moved(scene: &Scene, seed: u32, far: f32) -> Scene {
        let mut moved = scene.clone();
        for (index, position) in moved.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions).enumerate() {
            let number = |axis: u32| sobol_burley::sample(index as u32 / 3, axis, seed + 77) * 2.0 - 1.0;
            *position += far * Vec3::new(number(0), number(1), number(2));
        }
        let turn = Mat4::from_rotation_y(seed as f32);
        moved.draws.iter_mut().for_each(|draw| draw.world_from_object = turn * draw.world_from_object);
        moved
    }

    /// Two draws of one field, one of them mirrored; every third triangle is of glass.
    fn scene(seed: u32, count: u32) -> Scene {
        let mut scene = field(seed, count);
        let mut glass = scene.meshes[0].clone();
        (glass.indices, scene.meshes[0].indices) = {
            let (glass, solid): (Vec<_>, Vec<_>) =
                scene.meshes[0].indices.chunks(3).enumerate().partition(|(index, _)| index % 3 == 0);
            let flat = |of: Vec<(usize, &[u32])>| of.into_iter().flat_map(|(_, corners)| corners.to_vec()).collect();
            (flat(glass), flat(solid))
        };
        glass.material = 1;
        scene.meshes.push(glass);
        scene.materials.push(Material { alpha: AlphaMode::Blend, ..Material::default() });
        let mut other = scene.draws[0];
        other.world_from_object = Mat4::from_scale(Vec3::new(-1.0, 0.5, 1.0));
        scene.draws.push(other);
        scene.draws.push(crate::scene::Draw { mesh: 1, ..other });
        scene
    }

    proptest! {
        #[test]
        fn a_refitted_tree_meets_what_a_new_one_meets(
            seed in 0u32..50, count in 1u32..80, far in 0.0f32..2.0, is_whole in any::<bool>(), shutter in 0usize..4,
        ) {
            let build = |scene: &Scene| if is_whole { Bvh::whole(scene) } else { Bvh::build(scene) }.unwrap();
            // A shutter may be open before, then, at both moments and at none.
            let with_shutter = |mut scene: Scene, is_open: bool| {
                scene.closing = is_open.then(|| Box::new(moved(&scene, seed + 5, 0.5)));
                scene
            };
            let before = with_shutter(scene(seed, count), shutter & 1 != 0);
            let then = with_shutter(moved(&Scene { closing: None, ..before.clone() }, seed, far), shutter & 2 != 0);
            let (mut refitted, built) = (build(&before), build(&then));
            refitted.refit(&then);
            prop_assert_eq!(refitted.closing.len(), built.closing.len());
            // The same triangles in another order, bit by bit, at both ends of the shutter.
            let sorted = |bvh: &Bvh| {
                let bits = |index: usize| {
                    let blocks = [bvh.triangles.get(index), bvh.closing.get(index)];
                    blocks.map(|block| block.map(|block| bytemuck::bytes_of(block).to_vec()))
                };
                let key = |source: &Source| (source.draw, source.triangle);
                let mut all: Vec<_> = bvh.sources.iter().enumerate().map(|(at, one)| (key(one), bits(at))).collect();
                all.sort();
                all
            };
            prop_assert!(sorted(&refitted) == sorted(&built));
            // Boxes hold what is below them, at both ends of the shutter, and touch it: the root's is the same.
            prop_assert_eq!(&refitted.nodes[0].min_count[..3], &built.nodes[0].min_count[..3]);
            prop_assert_eq!(&refitted.nodes[0].max_first[..3], &built.nodes[0].max_first[..3]);
            for ray in 0..40 {
                let number = |axis: u32| sobol_burley::sample(ray, axis, seed + 1000) * 2.0 - 1.0;
                let origin = 4.0 * Vec3::new(number(0), number(1), number(2));
                let direction = (Vec3::new(number(3), number(4), number(5)) - origin).normalize();
                let hit = |bvh: &Bvh| bvh.closest_hit(origin, direction, 100.0, |_| true).map(|hit| hit.distance);
                prop_assert_eq!(hit(&refitted), hit(&built));
                prop_assert_eq!(refitted.occluded(origin, direction, 100.0), built.occluded(origin, direction, 100.0));
                // Where the shutter closes: a tree of those triangles alone, in the same boxes.
                let at_close = |bvh: &Bvh| Bvh {
                    nodes: bvh.nodes.clone(),
                    triangles: bvh.closing.clone(),
                    closing: Vec::new(),
                    sources: bvh.sources.clone(),
                };
                if !built.closing.is_empty() {
                    prop_assert_eq!(hit(&at_close(&refitted)), hit(&at_close(&built)));
                }
            }
        }
    }

    #[test]
    fn a_tree_that_stands_stays_and_one_whose_triangles_part_costs_more() {
        let scene = field(4, 300);
        let built = Bvh::build(&scene).unwrap();
        let mut tree = Bvh::build(&scene).unwrap();
        tree.refit(&scene);
        assert_eq!(bytemuck::cast_slice::<_, u8>(&tree.nodes), bytemuck::cast_slice::<_, u8>(&built.nodes));
        let mut last = built.cost();
        for far in [0.2, 0.5, 1.0] {
            tree.refit(&moved(&scene, 0, far));
            assert!(tree.cost() > 1.05 * last, "{far}: {} after {last}", tree.cost());
            last = tree.cost();
        }
        // One size of all is as good as another.
        let mut larger = scene.clone();
        larger.draws[0].world_from_object = Mat4::from_scale(Vec3::splat(8.0)) * larger.draws[0].world_from_object;
        tree.refit(&larger);
        assert!((tree.cost() / built.cost() - 1.0).abs() < 1e-4, "{} for {}", tree.cost(), built.cost());
        let mut empty = Bvh::build(&Scene::default()).unwrap();
        empty.refit(&Scene::default());
        assert_eq!(empty.cost(), 0.0);
    }

    /// An inner node with two leaves: it, and both triangles where they are.
    #[test]
    fn the_cost_counts_boxes_and_triangles_by_their_areas() {
        let node = |side: f32, count: u32, first: u32| BvhNodeBlock {
            min_count: [0.0, 0.0, 0.0, f32::from_bits(count)],
            max_first: [side, side, side, f32::from_bits(first)],
        };
        let bvh = Bvh { nodes: vec![node(2.0, 0, 1), node(1.0, 1, 0), node(1.0, 3, 1)], ..Bvh::empty() };
        assert_eq!(bvh.cost(), 1.0 + 1.0 / 4.0 + 3.0 / 4.0);
    }
}
