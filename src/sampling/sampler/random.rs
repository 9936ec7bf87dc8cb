//! Independent points: what a ray tracer takes for each pixel (Keller and Heidrich 2001, figure 4, right).

use super::over::{Over, PixelGrid, Places, Points};
use crate::sampling::pcg::Pcg32;

/// Independent in all dimensions; of places in the middles of pixels, in all others; of counted ones within pixels.
pub fn points(over: &Over, pixels: Option<PixelGrid>, places: Places) -> Points {
    let mut random = Pcg32::new(u64::from(over.seed), 0);
    let mut numbers = |count: usize| (0..count).map(|_| f64::from(random.unit())).collect::<Vec<f64>>();
    match (pixels, places) {
        (Some(grid), Places::Middles) => grid.points(|_, _| [vec![0.5; 2], numbers(over.dimensions - 2)].concat()),
        (Some(grid), Places::Counted) => grid.points(|_, _| numbers(over.dimensions)),
        _ => (0..over.count).map(|_| numbers(over.dimensions)).collect(),
    }
}
