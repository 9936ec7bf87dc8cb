//! Which texels of the stipple each BLEND surface is lit at. Kircher 2009, sections 4 and 7.1.
//!
//! A stipple of side s has s * s layers; layer 0 is the solid surfaces' alone, the others are the BLEND surfaces'. Two that
//! share a layer and overlap on screen fight for its texels: the nearer one gets them, the farther one is filtered from
//! whatever is there. The paper assigns layers by hand or by depth and leaves the best assignment open; `overlap` is ours: a
//! greedy colouring, nearest first, of the graph of draws that overlap on screen, each in the layer with whose draws it shares
//! the least area, and then moves of single draws while they help. Backs and fronts of what is double-sided are two draws to it,
//! because the walls of a closed shape overlap; by hand and by depth both get one layer. Memory meanwhile: a footprint for each
//! of them (528 bytes), and for each of 4096 cells 4 bytes a layer: 48 or 240 KiB.
//!
//! Decals (decals.rs) get no layer.

use super::assignment::Assignment;
use super::footprint::{Footprint, SCREEN_CELLS};
use crate::frame::View;
use crate::passes::blend;
use crate::resident::{DrawCall, Sides};
use crate::scene::{AlphaMode, Draw, Scene};
use glam::Vec3;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Times that all draws are looked at again for a better layer.
const MOST_ROUNDS: usize = 8;

/// A BLEND draw and its layer.
#[derive(Clone, Copy, Debug)]
pub struct StippledDraw {
    pub call: DrawCall,
    /// 1 to side * side - 1: which texel of each cell of the stipple is its, row-major. 0: it is a decal.
    pub layer: u32,
    /// It has a layer and reaches into the screen.
    pub is_on_screen: bool,
}

/// Result of an assignment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shares {
    /// Layers that some draw has.
    pub layers_used: usize,
    /// Layers that two draws have which overlap on screen.
    pub layers_shared: usize,
    /// Draws that overlap another of their layer on screen.
    pub draws_sharing: usize,
    /// Cells that two draws of a layer reach into, summed over all such pairs.
    pub cells_shared: u64,
}

impl Shares {
    /// Part of the screen on which two draws of a layer overlap, summed over all such pairs: it may be more than 1.
    pub fn part_of_screen(&self) -> f64 {
        self.cells_shared as f64 / SCREEN_CELLS as f64
    }
}

/// How layers are given to BLEND draws.
#[derive(Clone, Copy, Debug)]
pub struct Rules<'a> {
    pub assignment: Assignment,
    /// `Choices::named_layers`.
    pub named_layers: &'a BTreeMap<u32, u32>,
    /// Draws that get none: they are lit with what they lie on.
    pub decals: &'a BTreeSet<u32>,
    /// Layers that there are for them.
    pub layer_count: u32,
}

/// Sides of BLEND draws, farthest first: their layers, and where they are on the screen.
struct Given {
    footprints: Vec<Footprint>,
    layers: Vec<u32>,
    shares: Shares,
}

impl Given {
    fn new(scene: &Scene, view: &View, draws: &[(u32, Sides)], rules: Rules<'_>) -> Self {
        let clip_from_world = view.clip_from_world();
        let footprint = |(draw, sides): &(u32, Sides)| {
            let draw = &scene.draws[*draw as usize];
            Footprint::of(draw, &scene.meshes[draw.mesh], *sides, clip_from_world)
        };
        let footprints: Vec<Footprint> = draws.par_iter().map(footprint).collect();
        let draws: Vec<u32> = draws.iter().map(|(draw, _)| *draw).collect();
        let layers = layers(&footprints, &draws, rules);
        let shares = Shares::of(&footprints, &layers, rules.layer_count);
        Self { footprints, layers, shares }
    }
}

impl StippledDraw {
    pub fn is_decal(&self) -> bool {
        self.layer == 0
    }
}

/// Layers for `calls`, which are sorted farthest first, as they are drawn, the sides of a draw one after the other.
pub fn assign(scene: &Scene, view: &View, calls: Vec<DrawCall>, rules: Rules<'_>) -> (Vec<StippledDraw>, Shares) {
    let is_decal = |draw: u32| rules.decals.contains(&draw);
    let draws: Vec<(u32, Sides)> =
        calls.iter().map(|call| (call.draw, call.sides)).filter(|(draw, _)| !is_decal(*draw)).collect();
    let given = Given::new(scene, view, &draws, rules);
    let mut layers = given.layers.into_iter().zip(&given.footprints);
    let stippled = |call: DrawCall| {
        let given = if is_decal(call.draw) { None } else { layers.next() };
        let (layer, is_on_screen) = given.map_or((0, false), |(layer, footprint)| (layer, !footprint.is_empty()));
        StippledDraw { call, layer, is_on_screen }
    };
    (calls.into_iter().map(stippled).collect(), given.shares)
}

/// What BLEND draws would share by `rules`.
pub fn shared(scene: &Scene, view: &View, rules: Rules<'_>) -> Shares {
    let material = |draw: &Draw| &scene.materials[scene.meshes[draw.mesh].material];
    let blends = |(index, draw): &(usize, &Draw)| {
        material(draw).alpha == AlphaMode::Blend && !rules.decals.contains(&(*index as u32))
    };
    let place = |(index, draw): (usize, &Draw)| {
        (draw.bounds(&scene.meshes[draw.mesh]).center(), index as u32, Sides::of(material(draw)))
    };
    let mut draws: Vec<(Vec3, u32, Sides)> = scene.draws.iter().enumerate().filter(blends).map(place).collect();
    blend::sort_farthest_first(&mut draws, view, |(center_ws, ..)| *center_ws);
    let apart = |(_, draw, sides): &(Vec3, u32, Sides)| {
        let draw = *draw;
        sides.apart().iter().map(move |sides| (draw, *sides))
    };
    let sides: Vec<(u32, Sides)> = draws.iter().flat_map(apart).collect();
    Given::new(scene, view, &sides, rules).shares
}

/// How many draws of each layer reach into each cell of the screen.
struct Occupancy {
    layer_count: usize,
    /// Numbers of a cell stand together, a layer each.
    draws: Vec<u32>,
}

impl Occupancy {
    fn new(layer_count: u32) -> Self {
        let layer_count = layer_count as usize;
        Self { layer_count, draws: vec![0; SCREEN_CELLS * layer_count] }
    }

    fn of_cell(&self, cell: usize) -> &[u32] {
        &self.draws[cell * self.layer_count..][..self.layer_count]
    }

    fn add(&mut self, footprint: &Footprint, layer: u32) {
        footprint.cells().for_each(|cell| self.draws[cell * self.layer_count + layer as usize - 1] += 1);
    }

    fn remove(&mut self, footprint: &Footprint, layer: u32) {
        footprint.cells().for_each(|cell| self.draws[cell * self.layer_count + layer as usize - 1] -= 1);
    }

    /// Cells that a draw which is in none shares with those of each layer, summed over them.
    fn shared_with(&self, footprint: &Footprint) -> Vec<u64> {
        let mut shared = vec![0; self.layer_count];
        for cell in footprint.cells() {
            shared.iter_mut().zip(self.of_cell(cell)).for_each(|(sum, draws)| *sum += u64::from(*draws));
        }
        shared
    }

    /// The layer, from 1, that a draw which is in none shares least with: `layer` where no other is better.
    fn least_shared(&self, footprint: &Footprint, layer: u32) -> u32 {
        let shared = self.shared_with(footprint);
        let cells = |layer: u32| shared[layer as usize - 1];
        (1..=self.layer_count as u32).fold(layer, |best, other| if cells(other) < cells(best) { other } else { best })
    }
}

impl Shares {
    /// What draws share that have these layers.
    fn of(footprints: &[Footprint], layers: &[u32], layer_count: u32) -> Self {
        let mut all = Occupancy::new(layer_count);
        footprints.iter().zip(layers).for_each(|(footprint, layer)| all.add(footprint, *layer));
        let is_shared = |(footprint, layer): &(&Footprint, &u32)| {
            footprint.cells().any(|cell| all.of_cell(cell)[**layer as usize - 1] > 1)
        };
        let sharing: Vec<u32> = footprints.iter().zip(layers).filter(is_shared).map(|(_, layer)| *layer).collect();
        let distinct = |layers: &[u32]| layers.iter().collect::<BTreeSet<_>>().len();
        let pairs = |draws: &u32| u64::from(*draws) * u64::from(draws.saturating_sub(1)) / 2;
        Self {
            layers_used: distinct(layers),
            draws_sharing: sharing.len(),
            layers_shared: distinct(&sharing),
            cells_shared: all.draws.iter().map(pairs).sum(),
        }
    }
}

/// A layer, from 1, for each entry of `draws`, indices in the file, farthest first. A draw's sides are entries of their own, one
/// after the other.
fn layers(footprints: &[Footprint], draws: &[u32], rules: Rules<'_>) -> Vec<u32> {
    let count = rules.layer_count;
    let mut layers = vec![0; draws.len()];
    match rules.assignment {
        // The paper's layers are an object's, whichever of its sides is seen.
        Assignment::Static => {
            let said = |draw: &u32| rules.named_layers.get(draw).copied();
            let mut free: Vec<u32> =
                (1..=count).filter(|layer| draws.iter().all(|draw| said(draw) != Some(*layer))).collect();
            if free.is_empty() {
                free.extend(1..=count);
            }
            let in_file: BTreeSet<u32> = draws.iter().copied().collect();
            let (named, others): (Vec<u32>, Vec<u32>) = in_file.into_iter().partition(|draw| said(draw).is_some());
            let mut layer_of: BTreeMap<u32, u32> = others.into_iter().zip(free.iter().copied().cycle()).collect();
            layer_of.extend(named.iter().filter_map(|draw| said(draw).map(|layer| (*draw, layer))));
            layers.iter_mut().zip(draws).for_each(|(layer, draw)| *layer = layer_of[draw]);
        }
        Assignment::Depth => {
            let mut turn = 0;
            for index in (0..draws.len()).rev() {
                layers[index] = 1 + turn % count;
                turn += u32::from(index == 0 || draws[index - 1] != draws[index]);
            }
        }
        Assignment::Overlap => {
            let mut occupancy = Occupancy::new(count);
            for (footprint, layer) in footprints.iter().zip(&mut layers).rev() {
                *layer = occupancy.least_shared(footprint, 1);
                occupancy.add(footprint, *layer);
            }
            // The nearest were placed without those behind them: each moves while that takes something off the sum.
            for _ in 0..MOST_ROUNDS {
                let mut is_better = false;
                for (footprint, layer) in footprints.iter().zip(&mut layers).rev() {
                    occupancy.remove(footprint, *layer);
                    let best = occupancy.least_shared(footprint, *layer);
                    is_better |= best != *layer;
                    *layer = best;
                    occupancy.add(footprint, *layer);
                }
                if !is_better {
                    break;
                }
            }
        }
    }
    layers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques::inferred_lighting::footprint::tests::{rectangle, shared_cells};
    use proptest::prelude::*;

    /// Layers of these draws, some of which are said.
    fn given(
        footprints: &[Footprint],
        draws: &[u32],
        said: &[(u32, u32)],
        layer_count: u32,
        assignment: Assignment,
    ) -> Vec<u32> {
        let named_layers = &said.iter().copied().collect();
        layers(footprints, draws, Rules { assignment, named_layers, decals: &BTreeSet::new(), layer_count })
    }

    fn assigned(footprints: &[Footprint], count: u32, assignment: Assignment) -> (Vec<u32>, Shares) {
        let draws: Vec<u32> = (0..footprints.len() as u32).collect();
        let layers = given(footprints, &draws, &[], count, assignment);
        let shares = Shares::of(footprints, &layers, count);
        (layers, shares)
    }

    #[test]
    fn turns_run_from_the_nearest_or_in_the_order_of_the_file() {
        let four = [(); 4].map(|()| rectangle(0, 0, 32, 32));
        let file = [7, 2, 9, 4];
        assert_eq!(given(&four, &file, &[], 3, Assignment::Depth), [1, 3, 2, 1]);
        let sides = [7, 2, 2, 4];
        assert_eq!(given(&four, &sides, &[], 3, Assignment::Depth), [3, 2, 2, 1], "two sides have one turn");
        assert_eq!(given(&four, &file, &[], 3, Assignment::Static), [3, 1, 1, 2]);
        assert_eq!(given(&four, &sides, &[], 3, Assignment::Static), [3, 1, 1, 2]);
        let said = given(&four, &file, &[(2, 3)], 3, Assignment::Static);
        assert_eq!(said, [2, 3, 1, 1], "3 is taken, 1 and 2 go by turns");
        let said = given(&four, &file, &[(7, 1), (2, 3), (9, 2)], 3, Assignment::Static);
        assert_eq!(said, [1, 3, 2, 1], "none is free");
    }

    /// Two piles side by side: turns by depth make neighbours share where colouring needs two layers.
    #[test]
    fn what_does_not_overlap_shares_a_layer_and_what_does_does_not() {
        let piles = [rectangle(3, 0, 6, 6), rectangle(50, 0, 6, 6), rectangle(52, 3, 6, 6), rectangle(5, 3, 6, 6)];
        let (found, shares) = assigned(&piles, 3, Assignment::Overlap);
        assert_eq!(found, [2, 2, 1, 1]);
        let none = Shares { layers_used: 2, ..Shares::default() };
        assert_eq!(shares, none);
        let five = [(); 5].map(|()| rectangle(0, 0, 8, 8));
        let (_, shares) = assigned(&five, 3, Assignment::Overlap);
        let of_five = Shares { layers_used: 3, draws_sharing: 4, layers_shared: 2, cells_shared: 128 };
        assert_eq!(shares, of_five);
    }

    /// Four of which any two overlap, in two layers: a large one goes with a small one.
    #[test]
    fn of_layers_that_are_all_taken_the_least_shared_area_decides() {
        let small = || rectangle(18, 18, 10, 30);
        let four = [rectangle(0, 0, 20, 20), small(), rectangle(0, 0, 20, 19), small()];
        let (found, shares) = assigned(&four, 2, Assignment::Overlap);
        assert_eq!(found, [1, 2, 2, 1]);
        assert_eq!(shares.cells_shared, 2 * 2 + 2);
    }

    #[test]
    fn what_lies_outside_of_the_screen_shares_with_nothing() {
        let outside = || rectangle(70, 70, 5, 5);
        let (found, shares) = assigned(&[outside(), rectangle(32, 32, 3, 3), outside()], 3, Assignment::Overlap);
        assert_eq!(shares, Shares { layers_used: 1, ..Shares::default() }, "{found:?}");
    }

    proptest! {
        /// A draw shares a layer only where it overlaps as many others as there are layers; no single move helps; and the sum is
        /// that of a plain count.
        #[test]
        fn colouring_shares_only_where_it_must(
            places in proptest::collection::vec((0usize..60, 0usize..60, 1usize..16), 0..24),
            count in prop::sample::select(vec![3u32, 15]),
        ) {
            let all: Vec<_> = places.iter().map(|(x, y, side)| rectangle(*x, *y, *side, *side)).collect();
            let (found, shares) = assigned(&all, count, Assignment::Overlap);
            let shared = |index: usize, layer: u32| -> usize {
                let others = (0..all.len()).filter(|other| *other != index && found[*other] == layer);
                others.map(|other| shared_cells(&all[index], &all[other])).sum()
            };
            for (index, layer) in found.iter().enumerate() {
                prop_assert!((1..=count).contains(layer));
                let least = (1..=count).map(|layer| shared(index, layer)).min().unwrap();
                prop_assert_eq!(shared(index, *layer), least);
            }
            let sum: usize = (0..all.len()).map(|index| shared(index, found[index])).sum();
            prop_assert_eq!(shares.cells_shared, sum as u64 / 2);
        }
    }
}
