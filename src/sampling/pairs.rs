//! Pairs of numbers for the pixels of a tile, in one iteration after another: what becomes places on lights and directions
//! (Dubla 2009, section 3: each pixel of a tile has samples of its own, and none of them twice).

use super::basis::Basis;
use super::pattern::{Dimension, Pattern, Sample};
use super::sampler::{Places, Sampler};
use super::side::Side;

/// A pattern in whose pixels sample `i` is that of iteration `i`, with a pair of numbers beside its place, the middle.
///
/// `tile_px`: width and height, each at least 1. `iterations`: at least 1. `Sampler::Sobol` is one sequence of which each iteration
/// has a stretch; others have no order, and spread all iterations' pairs over all pixels.
pub fn of_tile(sampler: Sampler, tile_px: [u32; 2], iterations: u32, seed: u32) -> Pattern {
    let further = [Dimension::LightU, Dimension::LightV];
    if sampler != Sampler::Sobol {
        let sides = tile_px.map(|side| Side::new(side, 1));
        let basis = Basis::new(sides, &further, f64::from(iterations), sampler, Places::Middles, seed);
        return basis.expect("every pixel has as many samples").pattern();
    }
    let [width, height] = tile_px;
    let samples = (0..iterations * width * height).map(|index| {
        let numbers = [0, 1].map(|dimension| sobol_burley::sample(index, dimension, seed));
        let slot = index % (width * height);
        ([slot % width, slot / width], Sample { further: Sample::further(numbers), ..Sample::middle(index) })
    });
    Pattern::new(tile_px, &further, samples.collect())
}

/// The pairs of `of_tile`, iteration by iteration and in each of them pixel by pixel, row-major.
pub fn in_order(sampler: Sampler, tile_px: [u32; 2], iterations: u32, seed: u32) -> Vec<[f32; 2]> {
    let pattern = of_tile(sampler, tile_px, iterations, seed);
    let [width, height] = tile_px;
    let of = |iteration: u32| {
        let pixels = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
        let pattern = &pattern;
        pixels.map(move |pixel| {
            let [u, v, ..] = pattern.samples_of(pixel)[iteration as usize].further;
            [u, v]
        })
    };
    (0..iterations).flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Choice;

    /// Every sampler: a pair for each pixel in each iteration, and of those but independent ones the mean of a function is nearer
    /// than theirs; of `void-and-cluster` hardly, whose masks spread neighbours alone.
    #[test]
    fn pairs_are_spread_over_a_tile() {
        let rms = |sampler: Sampler| {
            let error = |seed: u32| {
                let pairs = in_order(sampler, [3, 3], 9, seed);
                assert_eq!(pairs.len(), 81);
                pairs.iter().filter(|[u, v]| *u + *v < 0.8).count() as f64 / 81.0 - 0.32
            };
            ((0..24).map(|seed| error(seed).powi(2)).sum::<f64>() / 24.0).sqrt()
        };
        let independent = (0.32_f64 * 0.68 / 81.0).sqrt();
        for sampler in Sampler::ALL {
            let rms = rms(*sampler) / independent;
            let wanted = if *sampler == Sampler::Random { 0.6..1.5 } else { 0.0..0.95 };
            assert!(wanted.contains(&rms), "{}: {rms}", sampler.name());
        }
    }

    /// The sequence goes on from iteration to iteration, and a pixel has one pair of each.
    #[test]
    fn iterations_are_stretches_of_the_sequence() {
        let pairs = in_order(Sampler::Sobol, [3, 2], 4, 7);
        for (index, pair) in (0..).zip(&pairs) {
            assert_eq!(*pair, [0, 1].map(|dimension| sobol_burley::sample(index, dimension, 7)));
        }
        let pattern = of_tile(Sampler::Sobol, [3, 2], 4, 7);
        assert_eq!(pattern.samples_of([2, 1]).iter().map(|sample| sample.subset).collect::<Vec<_>>(), [5, 11, 17, 23]);
    }
}
