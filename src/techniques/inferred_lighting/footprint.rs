//! Where on the screen a BLEND draw may leave texels: the cells of a coarse grid that its triangles reach into. Kircher 2009,
//! section 7.1, leaves open what layers are to be given by; this is what they are given by here. 528 bytes a draw, and 16 a
//! vertex of a mesh meanwhile.

use crate::resident::Sides;
use crate::scene::{Draw, Mesh};
use glam::{Mat3, Mat4, Vec2, Vec4};
use std::ops::RangeInclusive;

/// Cells along a side of the screen: a row's are the bits of a word.
const SIDE_CELLS: usize = 64;
pub const SCREEN_CELLS: usize = SIDE_CELLS * SIDE_CELLS;

/// Cells that the visible sides of a draw's triangles reach into, whatever hides them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Footprint {
    /// From the top, each a bit a cell.
    rows: [u64; SIDE_CELLS],
    /// The rows that have any.
    spread: [usize; 2],
}

impl Footprint {
    const EMPTY: Self = Self { rows: [0; SIDE_CELLS], spread: [SIDE_CELLS, 0] };

    /// That of `mesh`, which is the one drawn.
    pub fn of(draw: &Draw, mesh: &Mesh, sides: Sides, clip_from_world: Mat4) -> Self {
        let clip_from_object = clip_from_world * draw.world_from_object;
        let is_mirrored = draw.world_from_object.determinant() < 0.0;
        let places: Vec<Vec4> = mesh.positions.iter().map(|position| clip_from_object * position.extend(1.0)).collect();
        let mut footprint = Self::EMPTY;
        for triangle in 0..mesh.triangle_count() {
            let corners = mesh.corners(triangle).map(|vertex| places[vertex]);
            // y runs down in clip space, so that what runs left seen from the front runs right there.
            let turn = Mat3::from_cols_array_2d(&corners.map(|at| [at.x, at.y, at.w])).determinant();
            let is_front = if is_mirrored { turn > 0.0 } else { turn < 0.0 };
            let is_drawn = match sides {
                Sides::Fronts => is_front,
                Sides::Backs => !is_front,
                Sides::Both => true,
            };
            if is_drawn {
                footprint.include(&beyond_near_plane(&corners));
            }
        }
        footprint
    }

    /// Includes the cells that a convex polygon reaches into.
    fn include(&mut self, polygon: &[Vec2]) {
        let edges = || polygon.iter().zip(polygon.iter().cycle().skip(1));
        let of = |coordinate: fn(&Vec2) -> f32| {
            polygon
                .iter()
                .map(coordinate)
                .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
        };
        let (Some(rows), Some(_)) = (cells(of(|at| at.y)), cells(of(|at| at.x))) else { return };
        for row in rows {
            // The polygon's part between the row's edges reaches as far as its edges' parts do.
            let band = [row as f32, row as f32 + 1.0];
            let mut reach = [f32::INFINITY, f32::NEG_INFINITY];
            for (a, b) in edges() {
                let [high, low] = if a.y > b.y { [a, b] } else { [b, a] };
                let (from, to) = (low.y.max(band[0]), high.y.min(band[1]));
                if from <= to {
                    // NaN along a level edge, which min and max leave out: the edges beside it have its ends.
                    let at = |y: f32| low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y));
                    let ends = [at(from), at(to)];
                    reach = [reach[0].min(ends[0]).min(ends[1]), reach[1].max(ends[0]).max(ends[1])];
                }
            }
            if let Some(columns) = cells(reach) {
                let [first, last] = [*columns.start(), *columns.end()];
                self.rows[row] |= (u64::MAX >> (SIDE_CELLS - 1 - (last - first))) << first;
                self.spread = [self.spread[0].min(row), self.spread[1].max(row + 1)];
            }
        }
    }

    /// It has no cell: the draw is not on the screen.
    pub fn is_empty(&self) -> bool {
        self.spread[0] >= self.spread[1]
    }

    /// Its cells, row-major from the upper left corner, below `SCREEN_CELLS`.
    pub fn cells(&self) -> impl Iterator<Item = usize> {
        let of_row = |row: usize| {
            let rest = std::iter::successors(Some(self.rows[row]), |left| Some(left & left.wrapping_sub(1)));
            rest.take_while(|left| *left > 0).map(move |left| row * SIDE_CELLS + left.trailing_zeros() as usize)
        };
        (self.spread[0]..self.spread[1]).flat_map(of_row)
    }
}

/// The cells along an axis between two places in cells; None where they lie outside of the screen.
fn cells([low, high]: [f32; 2]) -> Option<RangeInclusive<usize>> {
    let is_inside = low <= high && high > 0.0 && low < SIDE_CELLS as f32;
    // A conversion cuts off what is beyond.
    is_inside.then(|| low.max(0.0) as usize..=(high as usize).min(SIDE_CELLS - 1))
}

/// The part of a triangle in clip space that is beyond the near plane, in cells from the screen's upper left corner.
fn beyond_near_plane(corners: &[Vec4; 3]) -> Vec<Vec2> {
    // Depth is 1 on the near plane, and less beyond it.
    let beyond = |at: &Vec4| at.w - at.z;
    let mut part = Vec::with_capacity(4);
    for (index, a) in corners.iter().enumerate() {
        let b = &corners[(index + 1) % 3];
        if beyond(a) >= 0.0 {
            part.push(*a);
        }
        if (beyond(a) >= 0.0) != (beyond(b) >= 0.0) {
            part.push(*a + (*b - *a) * (beyond(a) / (beyond(a) - beyond(b))));
        }
    }
    part.iter().map(|at| (Vec2::new(at.x, at.y) / at.w + 1.0) * (0.5 * SIDE_CELLS as f32)).collect()
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::frame::View;
    use crate::scene::{Camera, Projection, Scene};
    use crate::units::Extent;
    use glam::{Vec3, vec3};
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn cell_count(footprint: &Footprint) -> usize {
        footprint.cells().count()
    }

    /// Cells that both have.
    pub fn shared_cells(a: &Footprint, b: &Footprint) -> usize {
        let of_b: BTreeSet<usize> = b.cells().collect();
        a.cells().filter(|cell| of_b.contains(cell)).count()
    }

    /// A rectangle of cells.
    pub fn rectangle(x: usize, y: usize, width: usize, height: usize) -> Footprint {
        let mut footprint = Footprint::EMPTY;
        let [low, high] = [[x, y], [x + width, y + height]].map(|at| Vec2::from_array(at.map(|at| at as f32)));
        let [low, high] = [low + 0.1, high - 0.1];
        footprint.include(&[low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)]);
        footprint
    }

    /// An eye at the origin that looks down -z.
    fn clip_from_world(projection: Projection) -> Mat4 {
        let camera = Camera { name: "eye".to_owned(), world_from_view: Mat4::IDENTITY, projection };
        let scene = Scene { cameras: vec![camera], ..Scene::default() };
        View::new(&scene, "0", Extent::new(64, 64)).unwrap().clip_from_world()
    }

    fn perspective() -> Mat4 {
        clip_from_world(Projection::Perspective { y_fov: 1.2, aspect: None, z_near: 0.1, z_far: None })
    }

    fn triangle(corners: [Vec3; 3]) -> Mesh {
        Mesh { positions: corners.to_vec(), indices: vec![0, 1, 2], ..Mesh::default() }
    }

    const STILL: Draw = Draw { mesh: 0, world_from_object: Mat4::IDENTITY };

    #[test]
    fn rectangles_have_their_cells_and_share_them() {
        let [a, b] = [rectangle(3, 5, 10, 4), rectangle(8, 7, 20, 50)];
        assert_eq!([cell_count(&a), cell_count(&b), shared_cells(&a, &b)], [40, 1000, 10]);
        assert_eq!(cell_count(&rectangle(0, 0, 64, 64)), 4096);
        assert_eq!(shared_cells(&rectangle(3, 5, 1, 1), &rectangle(4, 5, 1, 1)), 0);
        assert_eq!(rectangle(62, 1, 2, 2).cells().collect::<Vec<_>>(), [126, 127, 190, 191]);
    }

    /// Fronts that look at the eye, backs, both of them mirrored, and what lies behind the eye or beside the screen.
    #[test]
    fn only_what_is_seen_has_cells() {
        let front = triangle([vec3(-1.0, -1.0, -3.0), vec3(1.0, -1.0, -3.0), vec3(0.0, 1.0, -3.0)]);
        let back = Mesh { indices: vec![0, 2, 1], ..front.clone() };
        let at = |world_from_object: Mat4| Draw { mesh: 0, world_from_object };
        let mirror = Mat4::from_scale(vec3(-1.0, 1.0, 1.0));
        let orthographic =
            clip_from_world(Projection::Orthographic { x_mag: 2.0, y_mag: 2.0, z_near: 0.1, z_far: 9.0 });
        for clip in [perspective(), orthographic] {
            for (draw, mesh, sides, is_seen) in [
                (STILL, &front, Sides::Fronts, true),
                (STILL, &front, Sides::Backs, false),
                (STILL, &back, Sides::Fronts, false),
                (STILL, &back, Sides::Backs, true),
                (STILL, &back, Sides::Both, true),
                (at(mirror), &front, Sides::Fronts, true),
                (at(mirror), &front, Sides::Backs, false),
                (at(mirror), &back, Sides::Fronts, false),
                (at(Mat4::from_translation(Vec3::Z * 6.0)), &front, Sides::Both, false),
                (at(Mat4::from_translation(Vec3::X * 60.0)), &front, Sides::Both, false),
                (at(Mat4::from_translation(Vec3::Y * -60.0)), &front, Sides::Both, false),
            ] {
                let seen = !Footprint::of(&draw, mesh, sides, clip).is_empty();
                assert_eq!(seen, is_seen, "{draw:?}, {sides:?}");
            }
        }
    }

    proptest! {
        /// Every point of a triangle that the eye sees is in one of its cells, also where it reaches behind the eye; and no cell
        /// is farther from it than a cell where it does not.
        #[test]
        fn a_triangle_has_the_cells_of_its_points(
            numbers in prop::array::uniform9(-4f32..4.0), weights in prop::array::uniform3(0.01f32..1.0),
        ) {
            let corners = [0, 3, 6].map(|at| vec3(numbers[at], numbers[at + 1], numbers[at + 2] - 2.0));
            let clip = perspective();
            let found = Footprint::of(&STILL, &triangle(corners), Sides::Both, clip);
            let sum: f32 = weights.iter().sum();
            let point: Vec3 = corners.iter().zip(weights).map(|(corner, weight)| *corner * (weight / sum)).sum();
            let at = clip * point.extend(1.0);
            let cell = (Vec2::new(at.x, at.y) / at.w + 1.0) * 32.0;
            if at.w > at.z && cell.min_element() >= 0.0 && cell.max_element() < 64.0 {
                // A point on an edge may round to the cell beside it.
                let near = [-1e-3, 0.0, 1e-3].map(|off| cell + off).map(|cell| cell.clamp(Vec2::ZERO, Vec2::splat(63.0)));
                let has = |cell: Vec2| found.rows[cell.y as usize] >> cell.x as usize & 1 == 1;
                prop_assert!(near.into_iter().any(has), "{cell}");
            }
            if corners.iter().all(|corner| corner.z < -0.2) {
                let places = corners.map(|corner| clip.project_point3(corner).truncate() * 32.0 + 32.0);
                let area = (places[1] - places[0]).perp_dot(places[2] - places[0]).abs() * 0.5;
                let around: f32 = (0..3).map(|index| (places[index] - places[(index + 1) % 3]).length()).sum();
                prop_assert!(cell_count(&found) as f32 <= area + 2.0 * around + 4.0);
            }
        }
    }
}
