//! Which texels of the stipple each BLEND surface is lit at. Kircher 2009, sections 4 and 7.1.
//!
//! A stipple of side s has s * s layers; layer 0 is the solid surfaces' alone, the others are the BLEND surfaces'. Two that
//! share a layer and overlap on screen fight for its texels: the nearer one gets them, the farther one is filtered from
//! whatever is there. The paper assigns layers by hand or by depth and leaves the best assignment open; `overlap` is ours:
//! a greedy colouring, nearest first, of the graph of draws whose boxes overlap on screen.

use super::assignment::{Assignment, layer_count};
use super::choices::Choices;
use crate::frame::View;
use crate::resident::DrawCall;
use crate::scene::{Bounds, Scene};
use glam::{Mat4, Vec2, Vec3, Vec4};
use std::collections::BTreeSet;

/// A BLEND draw and its layer.
#[derive(Clone, Copy, Debug)]
pub struct StippledDraw {
    pub call: DrawCall,
    /// 1 to side * side - 1: which texel of each cell of the stipple is its, row-major.
    pub layer: u32,
    /// Its box reaches into the screen.
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
}

/// A rectangle of the screen, in parts of it from -1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Footprint {
    low: Vec2,
    high: Vec2,
}

impl Footprint {
    const WHOLE: Self = Self { low: Vec2::NEG_ONE, high: Vec2::ONE };

    /// Footprint of a box in object space; None where it lies outside of the screen.
    fn of(bounds: &Bounds, clip_from_object: Mat4) -> Option<Self> {
        let mut footprint = Self { low: Vec2::INFINITY, high: Vec2::NEG_INFINITY };
        let mut is_crossing = false;
        for at in corners(bounds, clip_from_object) {
            // What crosses the eye's plane may be anywhere.
            if at.w <= BEFORE_EYE {
                is_crossing = true;
                continue;
            }
            let place = Vec2::new(at.x, at.y) / at.w;
            footprint = Self { low: footprint.low.min(place), high: footprint.high.max(place) };
        }
        if is_crossing {
            return Some(Self::WHOLE);
        }
        let inside = Self { low: footprint.low.max(Vec2::NEG_ONE), high: footprint.high.min(Vec2::ONE) };
        inside.low.cmple(inside.high).all().then_some(inside)
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }
}

/// The least w of clip space at which something lies before the eye.
const BEFORE_EYE: f32 = 1e-6;

/// The corners of a box in object space.
fn corners(bounds: &Bounds, clip_from_object: Mat4) -> impl Iterator<Item = Vec4> {
    let [min, max] = [bounds.min, bounds.max];
    (0..8u32).map(move |corner| {
        let pick = |bit: u32, low: f32, high: f32| if corner & bit == 0 { low } else { high };
        let point = Vec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z));
        clip_from_object * point.extend(1.0)
    })
}

/// Layers for `calls`, which are sorted farthest first, as they are drawn.
pub fn assign(scene: &Scene, view: &View, calls: Vec<DrawCall>, choices: &Choices) -> (Vec<StippledDraw>, Shares) {
    let of_call = |call: &DrawCall| {
        let draw = &scene.draws[call.draw as usize];
        let mut bounds = Bounds::EMPTY;
        scene.meshes[draw.mesh].positions.iter().for_each(|position| bounds.include(*position));
        let clip_from_object = view.clip_from_world() * draw.world_from_object;
        let footprint = Footprint::of(&bounds, clip_from_object);
        // What lies behind the eye altogether has a footprint, as what crosses the eye's plane, but no texels.
        let is_before_eye = corners(&bounds, clip_from_object).any(|at| at.w > BEFORE_EYE);
        (footprint, footprint.is_some() && is_before_eye)
    };
    let (footprints, on_screen): (Vec<_>, Vec<_>) = calls.iter().map(of_call).unzip();
    let static_place = |call: &DrawCall| (call.draw, choices.named_layers.get(&call.draw).copied());
    let places: Vec<_> = match choices.assignment {
        Assignment::Static => calls.iter().map(static_place).collect(),
        _ => Vec::new(),
    };
    let layers = layers(&footprints, &places, layer_count(&choices.stipple), choices.assignment);
    let shares = shares(&footprints, &layers);
    let all = calls.into_iter().zip(layers).zip(on_screen);
    let stippled = |((call, layer), is_on_screen): ((DrawCall, u32), bool)| StippledDraw { call, layer, is_on_screen };
    (all.map(stippled).collect(), shares)
}

/// A layer, 1 to `count`, for each footprint, farthest first. `places`: of `Assignment::Static`, in the file, with the layer
/// that the user says.
pub(super) fn layers(
    footprints: &[Option<Footprint>],
    places: &[(u32, Option<u32>)],
    count: u32,
    assignment: Assignment,
) -> Vec<u32> {
    let mut layers = vec![0; footprints.len()];
    match assignment {
        Assignment::Static => {
            let mut free: Vec<u32> =
                (1..=count).filter(|layer| places.iter().all(|(_, said)| *said != Some(*layer))).collect();
            if free.is_empty() {
                free.extend(1..=count);
            }
            let mut order: Vec<usize> = (0..places.len()).collect();
            order.sort_by_key(|index| places[*index].0);
            let mut turns = free.iter().cycle();
            for index in order {
                let said = places[index].1;
                layers[index] = said.unwrap_or_else(|| *turns.next().expect("a stipple has a layer for alpha"));
            }
        }
        Assignment::Depth => {
            layers.iter_mut().rev().enumerate().for_each(|(turn, layer)| *layer = 1 + turn as u32 % count);
        }
        Assignment::Overlap => {
            for index in (0..footprints.len()).rev() {
                let mut neighbours = vec![0u32; count as usize];
                let nearer = index + 1..footprints.len();
                for other in nearer.filter(|other| overlap(footprints[index], footprints[*other])) {
                    neighbours[layers[other] as usize - 1] += 1;
                }
                let least = neighbours.iter().min().copied().unwrap_or_default();
                let first = neighbours.iter().position(|neighbours| *neighbours == least);
                layers[index] = 1 + first.expect("a stipple has a layer for alpha") as u32;
            }
        }
    }
    layers
}

pub(super) fn overlap(a: Option<Footprint>, b: Option<Footprint>) -> bool {
    matches!((a, b), (Some(a), Some(b)) if a.overlaps(&b))
}

fn shares(footprints: &[Option<Footprint>], layers: &[u32]) -> Shares {
    let distinct = |layers: Vec<u32>| layers.into_iter().collect::<BTreeSet<u32>>().len();
    let shares_layer = |index: &usize| {
        (0..layers.len()).any(|other| {
            other != *index && layers[other] == layers[*index] && overlap(footprints[*index], footprints[other])
        })
    };
    let sharing: Vec<u32> = (0..layers.len()).filter(shares_layer).map(|index| layers[index]).collect();
    Shares { layers_used: distinct(layers.to_vec()), draws_sharing: sharing.len(), layers_shared: distinct(sharing) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn footprint(x: f32, y: f32, side: f32) -> Option<Footprint> {
        Some(Footprint { low: Vec2::new(x, y), high: Vec2::new(x + side, y + side) })
    }

    #[test]
    fn turns_run_from_the_nearest_or_in_the_order_of_the_file() {
        let four = [footprint(0.0, 0.0, 0.5); 4];
        assert_eq!(layers(&four, &[], 3, Assignment::Depth), [1, 3, 2, 1]);
        assert_eq!(layers(&four, &[7, 2, 9, 4].map(|place| (place, None)), 3, Assignment::Static), [3, 1, 1, 2]);
        let said = [(7, None), (2, Some(3)), (9, None), (4, None)];
        assert_eq!(layers(&four, &said, 3, Assignment::Static), [2, 3, 1, 1], "3 is taken, 1 and 2 go by turns");
        let all = [(7, Some(1)), (2, Some(3)), (9, Some(2)), (4, None)];
        assert_eq!(layers(&four, &all, 3, Assignment::Static), [1, 3, 2, 1], "none is free");
    }

    /// Two piles side by side: turns by depth make neighbours share where colouring needs two layers.
    #[test]
    fn what_does_not_overlap_shares_a_layer_and_what_does_does_not() {
        let piles =
            [footprint(-0.9, 0.0, 0.2), footprint(0.5, 0.0, 0.2), footprint(0.6, 0.1, 0.2), footprint(-0.8, 0.1, 0.2)];
        let found = layers(&piles, &[], 3, Assignment::Overlap);
        assert_eq!(found, [2, 2, 1, 1]);
        assert_eq!(shares(&piles, &found), Shares { layers_used: 2, draws_sharing: 0, layers_shared: 0 });
        let five = [footprint(0.0, 0.0, 0.5); 5];
        let found = layers(&five, &[], 3, Assignment::Overlap);
        assert_eq!(shares(&five, &found), Shares { layers_used: 3, draws_sharing: 4, layers_shared: 2 });
    }

    #[test]
    fn what_lies_outside_of_the_screen_shares_with_nothing() {
        let all = [None, footprint(0.0, 0.0, 0.1), None];
        let found = layers(&all, &[], 3, Assignment::Overlap);
        assert_eq!(shares(&all, &found), Shares { layers_used: 1, draws_sharing: 0, layers_shared: 0 });
    }

    proptest! {
        /// A draw shares a layer with a nearer one only where it overlaps as many nearer ones as there are layers.
        #[test]
        fn colouring_shares_only_where_it_must(
            places in proptest::collection::vec((-1f32..0.8, -1f32..0.8, 0.01f32..0.4), 0..24),
            count in prop::sample::select(vec![3u32, 15]),
        ) {
            let all: Vec<_> = places.iter().map(|(x, y, side)| footprint(*x, *y, *side)).collect();
            let found = layers(&all, &[], count, Assignment::Overlap);
            for (index, layer) in found.iter().enumerate() {
                prop_assert!((1..=count).contains(layer));
                let nearer: Vec<usize> =
                    (index + 1..all.len()).filter(|other| overlap(all[index], all[*other])).collect();
                let is_sharing = nearer.iter().any(|other| found[*other] == *layer);
                prop_assert!(!is_sharing || nearer.len() >= count as usize);
            }
        }
    }
}
