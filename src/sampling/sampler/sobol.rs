//! One scrambled Sobol sequence over the cells of a basis: aligned stretches of it are nets (`Pattern::nets` has the same for
//! tuples, with a pair to each of its purposes).

use super::over::{Over, PixelGrid, Points};
use crate::sampling::sobol;

/// Point `index` of sequence `number`: two dimensions at a time, each pair shuffled and scrambled by itself.
pub fn point(over: &Over, number: [u32; 2], index: u32) -> Vec<f64> {
    let pixel_seed = sobol::pixel_seed(number, over.seed);
    let pairs = (0..over.dimensions.div_ceil(2) as u32)
        .flat_map(|pair| sobol::pair(index, sobol::pair_seed(pixel_seed, pair)).map(f64::from));
    pairs.take(over.dimensions).collect()
}

/// The sequence's points, cell by cell.
pub fn points(over: &Over, grid: &PixelGrid) -> Points {
    let mut index = 0;
    grid.points(|_, _| {
        index += 1;
        point(over, [0, 0], index - 1)
    })
}
