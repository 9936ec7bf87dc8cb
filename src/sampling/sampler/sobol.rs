//! One scrambled Sobol sequence over the cells of a basis, as `Pattern::nets` has it: aligned stretches of it are nets.

use super::over::{Over, PixelGrid, Points};
use crate::sampling::sobol;

/// The sequence's points, cell by cell; two dimensions at a time, each pair shuffled and scrambled by itself.
pub fn points(over: &Over, grid: &PixelGrid) -> Points {
    let mut index = 0;
    grid.points(|_, _| {
        let own = index;
        index += 1;
        let pairs = (0..over.dimensions.div_ceil(2) as u32).flat_map(|pair| {
            sobol::pair(own, sobol::pair_seed(sobol::pixel_seed([0, 0], over.seed), pair)).map(f64::from)
        });
        pairs.take(over.dimensions).collect()
    })
}
