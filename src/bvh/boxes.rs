//! Boxes around boxes: the tree itself, without what its triangles are.
//!
//! A crate builds it (PLOC with reinsertion).

use crate::gpu::shader::structs::BvhNodeBlock;
use crate::scene::Bounds;
use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::{build_bvh2, build_bvh2_from_tris};
use obvhs::triangle::Triangle;
use std::time::Duration;

/// Room of the host's stack.
const STACK: usize = 64;

/// Nodes of a tree over at least one triangle, and the triangles in the order of its leaves. `closing`: the same triangles
/// where they move to, or none; boxes hold both, and so all between.
pub fn over(corners: &[Triangle], closing: &[Triangle]) -> (Vec<BvhNodeBlock>, Vec<u32>) {
    let (settings, time) = (BvhBuildParams::medium_build(), &mut Duration::default());
    let tree = if closing.is_empty() {
        build_bvh2_from_tris(corners, settings, time)
    } else {
        let boxes = corners.iter().zip(closing).map(|(from, to)| from.aabb().union(&to.aabb()));
        build_bvh2(&boxes.collect::<Vec<Aabb>>(), settings, time)
    };
    // A walk holds at most one waiting node a level, and one more.
    if tree.depth(0) >= STACK {
        return halved(corners, closing);
    }
    let blocks = tree.nodes.iter().map(|node| {
        let bounds = Bounds { min: node.aabb.min.into(), max: node.aabb.max.into() };
        block(&bounds, node.prim_count, node.first_index)
    });
    (blocks.collect(), tree.primitive_indices)
}

/// Calls `visit` for each triangle whose leaf the ray enters; what it returns becomes the new limit.
pub fn walk(
    nodes: &[BvhNodeBlock],
    origin: Vec3,
    direction: Vec3,
    mut limit: f32,
    mut visit: impl FnMut(usize, f32) -> Option<f32>,
) {
    let inverse = inverse_of(direction);
    let mut stack = [0u32; STACK];
    let mut depth = 1;
    while depth > 0 {
        depth -= 1;
        let node = &nodes[stack[depth] as usize];
        if !enters(node, origin, inverse, limit) {
            continue;
        }
        let (count, first) = (node.min_count[3].to_bits(), node.max_first[3].to_bits());
        if count == 0 {
            stack[depth] = first;
            stack[depth + 1] = first + 1;
            depth += 2;
            continue;
        }
        for triangle in first..first + count {
            if let Some(nearer) = visit(triangle as usize, limit) {
                limit = nearer;
            }
        }
    }
}

fn block(bounds: &Bounds, count: u32, first: u32) -> BvhNodeBlock {
    let (Vec3 { x, y, z }, far) = (bounds.min, bounds.max);
    BvhNodeBlock {
        min_count: [x, y, z, f32::from_bits(count)],
        max_first: [far.x, far.y, far.z, f32::from_bits(first)],
    }
}

/// Nodes and triangles in leaf order of a tree whose every node halves its triangles, whatever lies where. `closing`: the
/// same triangles where they move to, or none.
///
/// Why this way: PLOC joins what lies in one place one after the other, so that coincident triangles make a tree as deep
/// as they are many. This one is never deeper than the logarithm of their number.
pub(super) fn halved(corners: &[Triangle], closing: &[Triangle]) -> (Vec<BvhNodeBlock>, Vec<u32>) {
    const LEAF: usize = 4;
    let sides = |triangle: &Triangle| [triangle.v0, triangle.v1, triangle.v2];
    let swept = |index: u32| {
        let closing = closing.get(index as usize).unwrap_or(&corners[index as usize]);
        sides(&corners[index as usize]).into_iter().chain(sides(closing))
    };
    let middle = |index: u32| sides(&corners[index as usize]).into_iter().sum::<Vec3A>();
    let mut order: Vec<u32> = (0..corners.len() as u32).collect();
    let mut nodes = vec![BvhNodeBlock { min_count: [0.0; 4], max_first: [0.0; 4] }];
    let mut waiting = vec![(0, 0..corners.len())];
    while let Some((node, range)) = waiting.pop() {
        let mut bounds = Bounds::EMPTY;
        order[range.clone()].iter().flat_map(|index| swept(*index)).for_each(|corner| bounds.include(corner.into()));
        if range.len() <= LEAF {
            nodes[node] = block(&bounds, range.len() as u32, range.start as u32);
            continue;
        }
        let axis = (bounds.max - bounds.min).max_position();
        let half = range.len() / 2;
        order[range.clone()]
            .select_nth_unstable_by(half, |a, b| middle(*a)[axis].total_cmp(&middle(*b)[axis]).then(a.cmp(b)));
        let first = nodes.len();
        nodes[node] = block(&bounds, 0, first as u32);
        nodes.extend([nodes[node]; 2]);
        waiting.push((first, range.start..range.start + half));
        waiting.push((first + 1, range.start + half..range.end));
    }
    (nodes, order)
}

/// One by each side of a direction, as the shader has it.
pub(super) fn inverse_of(direction: Vec3) -> Vec3 {
    Vec3::from_array(direction.to_array().map(|side| 1.0 / if side == 0.0 { 1e-20 } else { side }))
}

/// Whether a ray enters a node's box before `limit`, in the shader's order of operations.
pub(super) fn enters(node: &BvhNodeBlock, origin: Vec3, inverse: Vec3, limit: f32) -> bool {
    let [x, y, z, _] = node.min_count;
    let near = (Vec3::new(x, y, z) - origin) * inverse;
    let [x, y, z, _] = node.max_first;
    let far = (Vec3::new(x, y, z) - origin) * inverse;
    let entry = near.min(far).max_element().max(0.0);
    let leave = near.max(far).min_element().min(limit);
    entry <= leave
}
