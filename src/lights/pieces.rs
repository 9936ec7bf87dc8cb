//! Pieces of a draw: runs of its triangles, in their order, that lie together.
//!
//! BLEND draws are drawn whole and in the order of their mesh, which is part of the picture. A map has one mesh a material,
//! so that its panes and beams lie far apart in one draw, and a list of lights for the box around all of them is a list of
//! nearly all lights. Runs keep the order, and their boxes are small: 9 BLEND draws of a map under 1,663 lights (oa_thor of
//! OpenArena) are 181 pieces under 121 lights each, on average.

use crate::scene::{Bounds, Draw, Mesh};
use std::ops::Range;

/// A run of a draw's triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Their places in the mesh's list.
    pub triangles: Range<u32>,
    /// World space.
    pub bounds: Bounds,
}

/// What a box may grow by, beyond the larger of a run's and a triangle's, and still be one piece: the halves of a square
/// that is not quite parallel to the axes.
const GROWTH: f32 = 1.25;

/// The pieces of `draw`, which is of `mesh`: a triangle joins the run before it where the box around both has no side longer
/// than `side_m` metres, or hardly longer than one of them has by itself.
pub fn pieces(draw: &Draw, mesh: &Mesh, side_m: f32) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    for index in 0..mesh.triangle_count() as u32 {
        let mut own = Bounds::EMPTY;
        let corners = mesh.triangle(index as usize).map(|corner| draw.world_from_object.transform_point3(corner));
        corners.into_iter().for_each(|corner| own.include(corner));
        if let Some(last) = pieces.last_mut() {
            let mut joined = last.bounds;
            joined.include(own.min);
            joined.include(own.max);
            if longest(&joined) <= side_m.max(GROWTH * longest(&last.bounds).max(longest(&own))) {
                *last = Piece { triangles: last.triangles.start..index + 1, bounds: joined };
                continue;
            }
        }
        pieces.push(Piece { triangles: index..index + 1, bounds: own });
    }
    pieces
}

/// The longest side of a box that is not empty, in metres.
fn longest(bounds: &Bounds) -> f32 {
    (bounds.max - bounds.min).max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat4, Vec3};
    use proptest::prelude::*;

    /// Squares of two triangles each, side 1, with their lower corners there.
    fn squares(corners: &[Vec3]) -> Mesh {
        let mut mesh = Mesh::default();
        for corner in corners {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend([Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y].map(|at| *corner + at));
            mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|vertex| first + vertex));
        }
        mesh
    }

    #[test]
    fn what_lies_together_is_one_piece_and_what_lies_apart_is_not() {
        let mesh = squares(&[Vec3::ZERO, Vec3::X, Vec3::X * 50.0, Vec3::ZERO]);
        let draw = Draw { mesh: 0, world_from_object: Mat4::from_scale(Vec3::splat(2.0)) };
        let ranges = |side_m| pieces(&draw, &mesh, side_m).into_iter().map(|piece| piece.triangles).collect::<Vec<_>>();
        assert_eq!(ranges(4.0), [0..4, 4..6, 6..8]);
        // However small pieces are to be, a square stays one.
        assert_eq!(ranges(0.0), [0..2, 2..4, 4..6, 6..8]);
        assert_eq!(ranges(1e3).first(), Some(&(0..8)));
        let bounds = pieces(&draw, &mesh, 4.0)[1].bounds;
        assert_eq!((bounds.min, bounds.max), (Vec3::X * 100.0, Vec3::new(102.0, 2.0, 0.0)));
    }

    proptest! {
        #[test]
        fn pieces_hold_every_triangle_once_and_in_order(seed in 0u32..1000, side_m in 0.0f32..20.0) {
            let number = |index: u32, axis: u32| 10.0 * sobol_burley::sample(index, axis, seed);
            let corners: Vec<Vec3> = (0..20).map(|i| Vec3::new(number(i, 0), number(i, 1), number(i, 2))).collect();
            let mesh = squares(&corners);
            let draw = Draw { mesh: 0, world_from_object: Mat4::from_rotation_y(number(0, 3)) };
            let mut next = 0;
            for piece in pieces(&draw, &mesh, side_m) {
                prop_assert!(piece.triangles.start == next && !piece.triangles.is_empty());
                next = piece.triangles.end;
                for triangle in piece.triangles {
                    for corner in mesh.triangle(triangle as usize) {
                        let at = draw.world_from_object.transform_point3(corner);
                        prop_assert!(at.cmpge(piece.bounds.min).all() && at.cmple(piece.bounds.max).all());
                    }
                }
            }
            prop_assert_eq!(next, mesh.triangle_count() as u32);
        }
    }
}
