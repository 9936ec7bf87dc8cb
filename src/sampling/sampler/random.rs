//! Independent points: what a ray tracer takes for each pixel (Keller and Heidrich 2001, figure 4, right).

use super::over::{Over, Points};
use crate::sampling::pcg::Pcg32;

/// Independent in all dimensions.
pub fn points(over: &Over) -> Points {
    let mut random = Pcg32::new(u64::from(over.seed), 0);
    (0..over.count).map(|_| (0..over.dimensions).map(|_| f64::from(random.unit())).collect()).collect()
}
