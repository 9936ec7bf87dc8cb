//! Independent points: what a ray tracer takes for each pixel (Keller and Heidrich 2001, figure 4, right).

use super::over::{Over, PixelGrid, Points};
use crate::sampling::pcg::Pcg32;

/// Independent in all dimensions; of places in the middles of pixels, in all others.
pub fn points(over: &Over, middles: Option<PixelGrid>) -> Points {
    let mut random = Pcg32::new(u64::from(over.seed), 0);
    let mut numbers = |count: usize| (0..count).map(|_| f64::from(random.unit())).collect::<Vec<f64>>();
    match middles {
        None => (0..over.count).map(|_| numbers(over.dimensions)).collect(),
        Some(grid) => grid.points(|_, _| [vec![0.5; 2], numbers(over.dimensions - 2)].concat()),
    }
}
