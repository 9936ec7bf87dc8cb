//! Triangles of a tree while a shutter is open: between their places when it opens and when it closes, along straight lines. Twin:
//! glsl/bvh_moving.glsl. Boxes hold both ends, and so all between: none changes.

use super::Bvh;
use crate::gpu::shader::structs::BvhTriangleBlock;

impl Bvh {
    /// The triangles at a part of the time that the shutter is open, 0 to 1, in their order; None where nothing moves.
    pub fn triangles_at(&self, part: f32) -> Option<Vec<BvhTriangleBlock>> {
        let ends = self.triangles.iter().zip(&self.closing);
        (!self.closing.is_empty()).then(|| ends.map(|(open, close)| between(open, close, part)).collect())
    }
}

fn between(open: &BvhTriangleBlock, close: &BvhTriangleBlock, part: f32) -> BvhTriangleBlock {
    let mix = |from: [f32; 4], to: [f32; 4]| {
        let [x, y, z] = [0, 1, 2].map(|axis| from[axis] * (1.0 - part) + to[axis] * part);
        [x, y, z, from[3]]
    };
    BvhTriangleBlock {
        corner: mix(open.corner, close.corner),
        edge1: mix(open.edge1, close.edge1),
        edge2: mix(open.edge2, close.edge2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_at_both_ends_and_halfway() {
        let block = |corner: [f32; 4], edge1: [f32; 4]| BvhTriangleBlock { corner, edge1, edge2: [0.0, 1.0, 0.0, 7.0] };
        let open = block([0.0, 2.0, 4.0, 5.0], [1.0, 0.0, 0.0, 6.0]);
        let close = block([2.0, 2.0, 0.0, 5.0], [0.0, 0.0, 3.0, 6.0]);
        let still = Bvh { triangles: vec![open], ..Bvh::empty() };
        assert!(still.triangles_at(0.5).is_none());
        let moving = Bvh { closing: vec![close], ..still };
        for (part, expected) in [(0.0, open), (1.0, close), (0.5, block([1.0, 2.0, 2.0, 5.0], [0.5, 0.0, 1.5, 6.0]))] {
            let found = moving.triangles_at(part).unwrap()[0];
            assert_eq!((found.corner, found.edge1, found.edge2), (expected.corner, expected.edge1, expected.edge2));
        }
    }
}
