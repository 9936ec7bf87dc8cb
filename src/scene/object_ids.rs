//! Object ids (Kircher & Lawrance 2009, section 3.1): eight bits for each draw, by which a filter sees where one object
//! ends and another begins.
//!
//! The paper gives objects their number and lets those beyond the 256th share one. So do up to 256 draws here. Of more,
//! each takes its number modulo 256, or the next id that no draw has whose box it touches; where 256 meet, that which the
//! fewest around have. Boxes that touch are those that share a cell of a grid as wide as the smaller of the two: some
//! that only come near count too, none that touch is missed. The largest are first, so that in linear time each finds all
//! that are as large as it or larger.

use std::collections::{BTreeSet, HashMap};

use glam::IVec3;
use rayon::prelude::*;

use super::palette::{self, Ids};
use super::{Bounds, Scene};

/// A box of a part of the scene's longest side smaller than 2 to the minus this is taken for one of that size.
const FINEST_LEVEL: u32 = 20;

/// The id of each of the scene's draws, in their order. The same scene always gives the same ids.
pub fn of(scene: &Scene) -> Vec<u8> {
    let boxes: Vec<Bounds> = scene.draws.par_iter().map(|draw| draw.bounds(&scene.meshes[draw.mesh])).collect();
    colored(&boxes)
}

fn colored(boxes: &[Bounds]) -> Vec<u8> {
    if boxes.len() <= 256 {
        return (0..boxes.len()).map(|draw| draw as u8).collect();
    }
    let grid = Grid::over(boxes);
    let mut order: Vec<(u32, usize)> = boxes.iter().enumerate().map(|(draw, one)| (grid.level(one), draw)).collect();
    order.sort_unstable();
    let levels: BTreeSet<u32> = order.iter().map(|(level, _)| *level).collect();
    let mut at_cell: HashMap<(u32, IVec3), Ids> = HashMap::new();
    let mut ids = vec![0; boxes.len()];
    let mut around = Vec::new();
    for (own, draw) in order {
        around.clear();
        for level in levels.range(..=own) {
            around.extend(grid.cells(&boxes[draw], *level).filter_map(|cell| at_cell.get(&(*level, cell)).copied()));
        }
        ids[draw] = palette::pick(draw, &around);
        for cell in grid.cells(&boxes[draw], own) {
            at_cell.entry((own, cell)).or_default().insert(ids[draw]);
        }
    }
    ids
}

/// Grids over the scene, each with cells half as wide as the one before.
struct Grid {
    all: Bounds,
    /// Width of a cell at level 0, metres.
    width_m: f32,
}

impl Grid {
    fn over(boxes: &[Bounds]) -> Self {
        let mut all = Bounds::EMPTY;
        for one in boxes.iter().filter(|one| !one.is_empty()) {
            all.include(one.min);
            all.include(one.max);
        }
        let width_m = if all.is_empty() { 0.0 } else { (all.max - all.min).max_element() };
        // Where all is in one point, so that nothing is divided by 0.
        Self { all, width_m: width_m.max(f32::MIN_POSITIVE) }
    }

    fn cell_m(&self, level: u32) -> f32 {
        self.width_m * 0.5f32.powi(level as i32)
    }

    /// The finest level at which a box is no wider than a cell: it lies in at most eight there.
    fn level(&self, one: &Bounds) -> u32 {
        let width_m = (one.max - one.min).max_element();
        (0..FINEST_LEVEL).find(|level| self.cell_m(level + 1) < width_m).unwrap_or(FINEST_LEVEL)
    }

    /// The cells in which a box lies.
    fn cells(&self, one: &Bounds, level: u32) -> impl Iterator<Item = IVec3> + use<> {
        // Rounding puts both of two boxes that touch to the same side of a cell's border: it keeps order.
        let cell_of = |point: glam::Vec3| ((point - self.all.min) / self.cell_m(level)).floor().as_ivec3();
        let (low, high) = if one.is_empty() { (IVec3::ONE, IVec3::ZERO) } else { (cell_of(one.min), cell_of(one.max)) };
        (low.x..=high.x)
            .flat_map(move |x| (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural;
    use glam::Vec3;
    use proptest::prelude::*;

    fn touch(a: &Bounds, b: &Bounds) -> bool {
        a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
    }

    /// How many pairs of boxes touch, and how many of them share an id.
    fn pairs(boxes: &[Bounds], ids: &[u8]) -> (usize, usize) {
        let all = (0..boxes.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let touching: Vec<(usize, usize)> = all.filter(|(a, b)| touch(&boxes[*a], &boxes[*b])).collect();
        (touching.len(), touching.iter().filter(|(a, b)| ids[*a] == ids[*b]).count())
    }

    fn boxes_of(scene: &Scene) -> Vec<Bounds> {
        scene.draws.iter().map(|draw| draw.bounds(&scene.meshes[draw.mesh])).collect()
    }

    #[test]
    fn up_to_256_draws_have_their_numbers() {
        let scene = procedural::build("lamps:objects=255,lights=1", 1).unwrap().unwrap();
        assert!(of(&scene).into_iter().eq(0..=255));
        assert!(of(&Scene::default()).is_empty());
    }

    #[test]
    fn more_share_ids_where_they_do_not_touch() {
        let scene = procedural::build("lamps:objects=3000,lights=1", 1).unwrap().unwrap();
        let (ids, boxes) = (of(&scene), boxes_of(&scene));
        let (touching, same) = pairs(&boxes, &ids);
        assert!(touching >= 3000, "each stands on the ground: {touching}");
        assert_eq!(same, 0);
        assert_eq!(ids, of(&scene));
        let by_number: Vec<u8> = (0..boxes.len()).map(|draw| draw as u8).collect();
        assert!(pairs(&boxes, &by_number).1 > 0, "the paper's ids would have met");
    }

    #[test]
    fn ids_are_given_where_boxes_are_points_empty_or_all_in_one_place() {
        for one in
            [Bounds { min: Vec3::ONE, max: Vec3::ONE }, Bounds::EMPTY, Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE }]
        {
            let ids = colored(&vec![one; 600]);
            let uses = |id: u8| ids.iter().filter(|other| **other == id).count();
            assert!((0..=255).all(|id| (1..=3).contains(&uses(id))), "{one:?}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 32, ..ProptestConfig::default() })]

        /// Boxes of all sizes on whole coordinates, so that many touch at a face, an edge or a corner only.
        #[test]
        fn boxes_that_touch_have_different_ids(
            corners in prop::collection::vec((prop::array::uniform3(-60i8..60), prop::array::uniform3(0u8..9)), 257..500)
        ) {
            let vector = |[x, y, z]: [f32; 3]| Vec3::new(x, y, z);
            let boxes: Vec<Bounds> = corners.iter().enumerate().map(|(index, (min, size))| {
                let min = vector(min.map(f32::from));
                let scale = if index % 50 == 0 { 12.0 } else { 1.0 };
                Bounds { min, max: min + vector(size.map(f32::from)) * scale }
            }).collect();
            prop_assert_eq!(pairs(&boxes, &colored(&boxes)).1, 0);
        }
    }
}
