//! The nodes of a tree for a walk that keeps nothing but its place (glsl/bvh_walk.glsl): each node before all below it, and
//! with an inner node the place after these, where a ray continues that does not enter its box.
//!
//! A stack of a ray's own costs a GPU registers: as many words as the deepest tree makes wait, for every ray of a wave.

use super::nodes::{half_area, is_leaf};
use crate::gpu::shader::structs::BvhNodeBlock;

enum FlatStep {
    Node(u32),
    /// All below the node at this place are there.
    Close(usize),
}

/// As many nodes, in the order of such a walk: of two children the one with the larger box first, which stops more rays
/// (Nah and Manocha, SATO: Surface Area Traversal Order for Shadow Ray Tracing, Computer Graphics Forum 2014, have areas of
/// what is in the boxes). The last word of `max_first` is a leaf's first triangle, as it was, and of an inner node the place
/// after all below it.
pub fn flattened(nodes: &[BvhNodeBlock]) -> Vec<BvhNodeBlock> {
    let mut flat: Vec<BvhNodeBlock> = Vec::with_capacity(nodes.len());
    let mut turns = vec![FlatStep::Node(0)];
    while let Some(turn) = turns.pop() {
        match turn {
            FlatStep::Close(place) => flat[place].max_first[3] = f32::from_bits(flat.len() as u32),
            FlatStep::Node(index) => {
                let node = nodes[index as usize];
                if !is_leaf(&node) {
                    let first = node.max_first[3].to_bits();
                    let area = |child: u32| half_area(&nodes[child as usize]);
                    let is_first_larger = area(first) >= area(first + 1);
                    let [sooner, later] = if is_first_larger { [first, first + 1] } else { [first + 1, first] };
                    turns.extend([FlatStep::Close(flat.len()), FlatStep::Node(later), FlatStep::Node(sooner)]);
                }
                flat.push(node);
            }
        }
    }
    flat
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::tests::field;
    use crate::bvh::{Bvh, boxes, intersect};
    use glam::Vec3;
    use proptest::prelude::*;

    /// The shader's walk. Whether a ray meets anything, and the triangles that were tried.
    fn walked(bvh: &Bvh, flat: &[BvhNodeBlock], origin: Vec3, direction: Vec3, limit: f32) -> (bool, usize) {
        // A leaf's first triangle, or the place after all below.
        let last_word = |node: &BvhNodeBlock| node.max_first[3].to_bits() as usize;
        let inverse = boxes::inverse_of(direction);
        let end = if is_leaf(&flat[0]) { 1 } else { last_word(&flat[0]) };
        let (mut at, mut tried) = (0, 0);
        while at < end {
            let node = &flat[at];
            let is_entered = boxes::enters(node, origin, inverse, limit);
            if !is_leaf(node) {
                at = if is_entered { at + 1 } else { last_word(node) };
                continue;
            }
            at += 1;
            let first = last_word(node);
            for triangle in first..first + if is_entered { node.min_count[3].to_bits() as usize } else { 0 } {
                tried += 1;
                if intersect(&bvh.triangles[triangle], origin, direction, limit).is_some() {
                    return (true, tried);
                }
            }
        }
        (false, tried)
    }

    proptest! {
        /// The same answer as with a stack and, where there is nothing, the same triangles tried.
        #[test]
        fn a_walk_without_a_stack_meets_what_one_with_a_stack_meets(seed in 0u32..50, ray in 0u32..200, count in 1u32..200) {
            let bvh = Bvh::build(&field(seed, count)).unwrap();
            let flat = flattened(&bvh.nodes);
            prop_assert_eq!(flat.len(), bvh.nodes.len());
            let number = |axis: u32| sobol_burley::sample(ray, axis, seed + 1000) * 2.0 - 1.0;
            let origin = 3.0 * Vec3::new(number(0), number(1), number(2));
            let direction = (Vec3::new(number(3), number(4), number(5)) - origin).normalize();
            let (met, tried) = walked(&bvh, &flat, origin, direction, 100.0);
            prop_assert_eq!(met, bvh.occluded(origin, direction, 100.0));
            let mut tried_with_stack = 0;
            boxes::walk(&bvh.nodes, origin, direction, 100.0, |_, _| {
                tried_with_stack += 1;
                None
            });
            prop_assert!(tried <= tried_with_stack && (met || tried == tried_with_stack));
        }
    }

    #[test]
    fn the_tree_that_no_ray_meets_is_one_leaf() {
        let bvh = Bvh::empty();
        let flat = flattened(&bvh.nodes);
        assert_eq!(flat.len(), 1);
        assert_eq!(walked(&bvh, &flat, Vec3::ZERO, Vec3::X, 1e30), (false, 1));
    }
}
