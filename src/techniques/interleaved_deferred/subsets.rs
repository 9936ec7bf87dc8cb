//! Lights split over the n * m subsets: sizes differ by at most one, each as well spread as the whole.
//!
//! Virtual point lights come in the order of a low-discrepancy walk, so a stretch of them is as well spread as all; a
//! comb would not be (every 16th point of a base-2 sequence lies in one sixteenth of its range). Punctual lights have no
//! such order: they are sorted along a curve through the scene and dealt out like cards.

use crate::gpu::shader::structs::{LightBlock, SubsetBlock};
use crate::scene::Bounds;
use glam::{Vec3, Vec4};

/// Each subset's stretches. Virtual lights give their odd ones to the first subsets, punctual lights to the last, so
/// that the sums differ by at most one too.
pub fn subsets(subset_count: u32, vpl_count: u32, light_count: u32) -> Vec<SubsetBlock> {
    let (vpl_share, vpl_odd) = (vpl_count / subset_count, vpl_count % subset_count);
    let (light_share, light_odd) = (light_count / subset_count, light_count % subset_count);
    let (mut vpl_first, mut light_first) = (0, 0);
    (0..subset_count)
        .map(|subset| {
            let block = SubsetBlock {
                vpl_first,
                vpl_count: vpl_share + u32::from(subset < vpl_odd),
                light_first,
                light_count: light_share + u32::from(subset >= subset_count - light_odd),
            };
            vpl_first += block.vpl_count;
            light_first += block.light_count;
            block
        })
        .collect()
}

/// Punctual lights in the order in which `subsets` cuts them: neighbours in space go to different subsets.
pub fn dealt(lights: &[LightBlock], bounds: &Bounds, subset_count: u32) -> Vec<LightBlock> {
    let mut sorted: Vec<&LightBlock> = lights.iter().collect();
    sorted.sort_by_key(|light| morton(Vec4::from_array(light.position_ws).truncate(), bounds));
    let blocks = subsets(subset_count, 0, lights.len() as u32);
    let mut hands: Vec<Vec<LightBlock>> = vec![Vec::new(); subset_count as usize];
    // Subsets with an odd light take part in the last round; a hand that is full is passed over.
    let mut turn = 0;
    for light in sorted {
        while hands[turn % hands.len()].len() as u32 >= blocks[turn % hands.len()].light_count {
            turn += 1;
        }
        let hand = turn % hands.len();
        hands[hand].push(*light);
        turn += 1;
    }
    hands.concat()
}

/// Place along a Z-order curve through the box, 10 bits an axis.
fn morton(position: Vec3, bounds: &Bounds) -> u32 {
    let size = (bounds.max - bounds.min).max(Vec3::splat(1e-6));
    let cell = ((position - bounds.min) / size * 1024.0).clamp(Vec3::ZERO, Vec3::splat(1023.0)).as_uvec3();
    let spread = |value: u32| (0..10).fold(0, |code, bit| code | (value >> bit & 1) << (3 * bit));
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn subsets_hold_every_light_once_and_differ_by_at_most_one(count in 1u32..65, vpls in 0u32..500, lights in 0u32..200) {
            let blocks = subsets(count, vpls, lights);
            let sizes: Vec<u32> = blocks.iter().map(|block| block.vpl_count + block.light_count).collect();
            prop_assert_eq!(sizes.iter().sum::<u32>(), vpls + lights);
            prop_assert!(sizes.iter().max().unwrap() - sizes.iter().min().unwrap() <= 1);
            let mut next = (0, 0);
            for block in &blocks {
                prop_assert_eq!((block.vpl_first, block.light_first), next);
                next = (block.vpl_first + block.vpl_count, block.light_first + block.light_count);
            }
            prop_assert_eq!(next, (vpls, lights));
        }

        #[test]
        fn dealing_keeps_every_light(count in 1u32..50, lights in 0u32..200) {
            let blocks: Vec<LightBlock> = (0..lights)
                .map(|index| LightBlock { position_ws: [index as f32, 0.0, 0.0, 0.0], ..LightBlock::zeroed() })
                .collect();
            let bounds = Bounds { min: Vec3::ZERO, max: Vec3::new(lights as f32, 1.0, 1.0) };
            let mut places: Vec<u32> = dealt(&blocks, &bounds, count).iter().map(|l| l.position_ws[0] as u32).collect();
            places.sort_unstable();
            prop_assert_eq!(places, (0..lights).collect::<Vec<_>>());
        }
    }

    #[test]
    fn neighbours_go_to_different_subsets() {
        let blocks: Vec<LightBlock> = (0..16)
            .map(|index| LightBlock { position_ws: [index as f32, 0.0, 0.0, 0.0], ..LightBlock::zeroed() })
            .collect();
        let bounds = Bounds { min: Vec3::ZERO, max: Vec3::new(16.0, 1.0, 1.0) };
        let order: Vec<f32> = dealt(&blocks, &bounds, 4).iter().map(|light| light.position_ws[0]).collect();
        assert_eq!(order[..4], [0.0, 4.0, 8.0, 12.0]);
    }
}
