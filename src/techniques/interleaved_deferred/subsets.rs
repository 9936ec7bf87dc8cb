//! Lights split over subsets whose sizes differ by at most one, each as well spread as the whole: virtual point lights over
//! the n * m of the pattern, punctual lights over the i * j of a pattern that divides it. Sub-buffers whose places are the
//! same modulo i and j are a cluster, and share one subset of the punctual lights (Segovia 2006, section 4.6).
//!
//! Virtual point lights come in the order of a low-discrepancy walk, so a stretch of them is as well spread as all; a
//! comb would not be (every 16th point of a base-2 sequence lies in one sixteenth of its range). Punctual lights have no
//! such order: they are sorted along a curve through the scene and dealt out like cards.

use crate::gpu::shader::structs::{LightBlock, SubsetBlock};
use crate::sampling::pattern::Pattern;
use crate::scene::Bounds;
use glam::{Vec3, Vec4};

/// Stretches of the two lists for each of the n * m sub-buffers, in the order of the subsets of `pattern`.
///
/// `direct_pattern` divides `pattern`: both are grids. Virtual lights give their odd ones to the first subsets, punctual
/// lights to the last, so that with one pattern for both the sums differ by at most one too.
pub fn subsets(pattern: &Pattern, direct_pattern: &Pattern, vpl_count: u32, light_count: u32) -> Vec<SubsetBlock> {
    let [[n, m], [i, j]] = [pattern, direct_pattern].map(Pattern::period_px);
    assert!(n.is_multiple_of(i) && m.is_multiple_of(j), "{i}x{j} does not divide {n}x{m}");
    let (count, lights) = (pattern.subset_count(), light_stretches(direct_pattern.subset_count(), light_count));
    let vpl_odd = vpl_count % count;
    let vpls = stretches(count, |subset| vpl_count / count + u32::from(subset < vpl_odd));
    let cluster = |pixel| direct_pattern.subset_of(pixel).expect("a pixel of a grid uses one subset");
    let clusters = pattern.placed().map(|(pixel, _)| lights[cluster(pixel) as usize]);
    vpls.into_iter()
        .zip(clusters)
        .map(|([vpl_first, vpl_count], [light_first, light_count])| SubsetBlock {
            vpl_first,
            vpl_count,
            light_first,
            light_count,
        })
        .collect()
}

/// The punctual lights of each subset.
fn light_stretches(subset_count: u32, light_count: u32) -> Vec<[u32; 2]> {
    let odd = light_count % subset_count;
    stretches(subset_count, |subset| light_count / subset_count + u32::from(subset >= subset_count - odd))
}

/// Stretches of these lengths, one behind the other: [first, count].
fn stretches(subset_count: u32, length: impl Fn(u32) -> u32) -> Vec<[u32; 2]> {
    let mut first = 0;
    (0..subset_count)
        .map(|subset| {
            let stretch = [first, length(subset)];
            first += stretch[1];
            stretch
        })
        .collect()
}

/// Punctual lights in the order in which `subsets` cuts them: neighbours in space go to different subsets.
pub fn dealt(lights: &[LightBlock], bounds: &Bounds, subset_count: u32) -> Vec<LightBlock> {
    let mut sorted: Vec<&LightBlock> = lights.iter().collect();
    sorted.sort_by_key(|light| morton(Vec4::from_array(light.position_ws).truncate(), bounds));
    let stretches = light_stretches(subset_count, lights.len() as u32);
    let mut hands: Vec<Vec<LightBlock>> = vec![Vec::new(); subset_count as usize];
    // Subsets with an odd light take part in the last round; a hand that is full is passed over.
    let mut turn = 0;
    for light in sorted {
        while hands[turn % hands.len()].len() as u32 >= stretches[turn % hands.len()][1] {
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

    prop_compose! {
        /// A direct pattern and a pattern that it divides.
        fn any_patterns()(i in 1u32..9, j in 1u32..9, wide in 1u32..5, high in 1u32..5) -> ([u32; 2], [u32; 2]) {
            ([i * wide, j * high], [i, j])
        }
    }

    /// Stretches that hold each of `count` lights once, in order, and whose sizes differ by at most one.
    fn require_whole(stretches: &[[u32; 2]], count: u32) -> Result<(), TestCaseError> {
        let mut next = 0;
        for [first, length] in stretches {
            prop_assert_eq!(*first, next);
            next += length;
        }
        prop_assert_eq!(next, count);
        let lengths = || stretches.iter().map(|[_, length]| length);
        prop_assert!(lengths().max().unwrap() - lengths().min().unwrap() <= 1);
        Ok(())
    }

    proptest! {
        #[test]
        fn every_light_is_in_one_subset((pattern, direct) in any_patterns(), vpls in 0u32..500, lights in 0u32..200) {
            let blocks = subsets(&Pattern::grid(pattern), &Pattern::grid(direct), vpls, lights);
            let of_vpls: Vec<_> = blocks.iter().map(|block| [block.vpl_first, block.vpl_count]).collect();
            require_whole(&of_vpls, vpls)?;
            // The first i * j places are one of each cluster.
            let of = |x: u32, y: u32| {
                let block = &blocks[(y * pattern[0] + x) as usize];
                [block.light_first, block.light_count]
            };
            let of_lights: Vec<_> = (0..direct[1]).flat_map(|y| (0..direct[0]).map(move |x| of(x, y))).collect();
            require_whole(&of_lights, lights)?;
            for y in 0..pattern[1] {
                for x in 0..pattern[0] {
                    prop_assert_eq!(of(x, y), of(x % direct[0], y % direct[1]));
                }
            }
        }

        #[test]
        fn with_one_pattern_the_sums_differ_by_at_most_one(n in 1u32..9, m in 1u32..9, vpls in 0u32..500, lights in 0u32..200) {
            let grid = Pattern::grid([n, m]);
            let blocks = subsets(&grid, &grid, vpls, lights);
            let sizes = || blocks.iter().map(|block| block.vpl_count + block.light_count);
            prop_assert!(sizes().max().unwrap() - sizes().min().unwrap() <= 1);
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
