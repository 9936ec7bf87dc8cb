//! A scrambled Sobol sequence for each pixel, given to pixels so that neighbours err differently: Heitz, Belcour,
//! Ostromoukhov, Coeurjolly and Iehl 2019, "A low-discrepancy sampler that distributes Monte Carlo errors as a blue noise
//! in screen space".
//!
//! Errors are those of means of half-spaces (the paper's Heaviside functions), which stand for what a picture may hold. The
//! paper exchanges scrambling keys; exchanging whole sequences of pixels is the same. A basis larger than a tile has copies
//! of it.

use super::over::{Over, PixelGrid, Points};
use super::{mask, sobol};
use crate::sampling::pcg::Pcg32;

/// Half-spaces whose means are judged.
const TEST_COUNT: usize = 96;
/// Pixels on each side of one that are its neighbours; a Gaussian of 2.1 px, as Georgiev and Fajardo 2016 have, is below an
/// eighth beyond.
const REACH: i32 = 3;
/// exp(-1 / 2.1^2): weights are its powers, by the squared distance.
const FALL: f64 = 0.797_114_162_945_813;
const EXCHANGES_PER_PIXEL: usize = 40;

/// Each pixel's own sequence.
pub fn points(over: &Over, grid: &PixelGrid) -> Points {
    let tile = mask::tile(grid.sides);
    let order = order(over, tile, grid.samples);
    grid.points(|[x, y], sample| {
        let set = order[(y % tile[1] * tile[0] + x % tile[0]) as usize];
        point(over, set, sample)
    })
}

/// Point `sample` of the sequence of this number.
fn point(over: &Over, set: u32, sample: u32) -> Vec<f64> {
    sobol::point(over, [set, 1], sample)
}

/// A half-space: points whose product with `normal` is at least `least`.
struct HalfSpace {
    normal: Vec<f64>,
    least: f64,
}

impl HalfSpace {
    /// Any direction and any point of the unit cube, through which its plane goes, are as likely as others.
    fn new(dimensions: usize, random: &mut Pcg32) -> Self {
        let normal = loop {
            let normal: Vec<f64> = (0..dimensions).map(|_| 2.0 * f64::from(random.unit()) - 1.0).collect();
            let squared: f64 = normal.iter().map(|part| part * part).sum();
            if squared <= 1.0 && squared > 1e-4 {
                break normal;
            }
        };
        let least = normal.iter().map(|part| part * f64::from(random.unit())).sum();
        Self { normal, least }
    }

    fn has(&self, point: &[f64]) -> bool {
        self.normal.iter().zip(point).map(|(part, number)| part * number).sum::<f64>() >= self.least
    }
}

/// Which sequence each pixel of the tile has, row by row.
fn order(over: &Over, tile: [u32; 2], samples: u32) -> Vec<u32> {
    let count = tile[0] * tile[1];
    let mut random = Pcg32::new(u64::from(over.seed), 32);
    let tests: Vec<HalfSpace> = (0..TEST_COUNT).map(|_| HalfSpace::new(over.dimensions, &mut random)).collect();
    // The means themselves: what is true of a test is the same for all of them.
    let means: Vec<Vec<f32>> = (0..count)
        .map(|set| {
            let points: Vec<Vec<f64>> = (0..samples).map(|sample| point(over, set, sample)).collect();
            let mean = |test: &HalfSpace| points.iter().filter(|point| test.has(point)).count() as f32 / samples as f32;
            tests.iter().map(mean).collect()
        })
        .collect();
    let mut order: Vec<u32> = (0..count).collect();
    if count < 3 {
        return order;
    }
    let falls: Vec<f64> =
        std::iter::successors(Some(1.0), |fall| Some(fall * FALL)).take((2 * REACH * REACH + 1) as usize).collect();
    let [width, height] = tile.map(|side| side as i32);
    let around = |pixel: usize| {
        let (x, y) = (pixel as i32 % width, pixel as i32 / width);
        let steps = (-REACH..=REACH).flat_map(|down| (-REACH..=REACH).map(move |across| [across, down]));
        steps.map(move |[across, down]| {
            let at = (y + down).rem_euclid(height) * width + (x + across).rem_euclid(width);
            (at as usize, (across * across + down * down) as usize)
        })
    };
    // How like its neighbours the pixel `at` would be with the sequence of `with`, which would have its own.
    let likeness = |order: &[u32], at: usize, with: usize| -> f64 {
        let own = &means[order[with] as usize];
        let felt = around(at).filter(|(other, _)| *other != at).map(|(other, squared)| {
            let there = if other == with { at } else { other };
            let pairs = own.iter().zip(&means[order[there] as usize]);
            let apart: f32 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
            -falls[squared] * f64::from(apart.sqrt())
        });
        felt.sum()
    };
    for _ in 0..EXCHANGES_PER_PIXEL * count as usize {
        let [a, b] = [0, 1].map(|_| random.below(count) as usize);
        let before = likeness(&order, a, a) + likeness(&order, b, b);
        let after = likeness(&order, a, b) + likeness(&order, b, a);
        if after < before {
            order.swap(a, b);
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The errors of a mean over the pixels around one are less than those of sequences in any order: what one pixel has too
    /// much its neighbours have too little. A test that no exchange has seen.
    #[test]
    fn neighbours_err_differently() {
        let (side, samples) = (16, 4);
        let over = Over { sides_px: [16.0; 2], count: side * side * samples, dimensions: 2, seed: 9 };
        let found = order(&over, [side; 2], samples);
        let mut sorted = found.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..side * side).collect::<Vec<_>>());
        let mut random = Pcg32::new(99, 0);
        let spread = |order: &[u32], test: &HalfSpace| {
            let mean = |pixel: u32| {
                let own = order[pixel as usize];
                (0..samples).filter(|sample| test.has(&point(&over, own, *sample))).count() as f64 / f64::from(samples)
            };
            let means: Vec<f64> = (0..side * side).map(mean).collect();
            let block = |x: u32, y: u32| {
                let pixels = (0..3).flat_map(|down| (0..3).map(move |across| [(x + across) % side, (y + down) % side]));
                pixels.map(|[x, y]| means[(y * side + x) as usize]).sum::<f64>() / 9.0
            };
            let blocks: Vec<f64> =
                (0..side).flat_map(|y| (0..side).map(move |x| [x, y])).map(|[x, y]| block(x, y)).collect();
            let mean = blocks.iter().sum::<f64>() / blocks.len() as f64;
            blocks.iter().map(|block| (block - mean).powi(2)).sum::<f64>()
        };
        let any: Vec<u32> = (0..side * side).collect();
        let tests: Vec<HalfSpace> = (0..40).map(|_| HalfSpace::new(2, &mut random)).collect();
        let [with, without] = [&found, &any].map(|order| tests.iter().map(|test| spread(order, test)).sum::<f64>());
        assert!(with < 0.75 * without, "{with} and {without}");
    }
}
