//! One random place in each of equal parts of a cell; times and lenses likewise, in an order of their own.

use super::over::{Over, PixelGrid, Points};
use crate::sampling::pattern::grid::squarest;
use crate::sampling::pcg::Pcg32;

/// Each cell with parts of its own: `squarest` of the place, and as many stretches as samples of each further dimension.
pub fn points(over: &Over, grid: &PixelGrid) -> Points {
    let mut random = Pcg32::new(u64::from(over.seed), 2);
    let count = grid.samples;
    let [columns, rows] = squarest(count);
    let mut orders: Vec<Vec<u32>> = Vec::new();
    grid.points(|_, sample| {
        if sample == 0 {
            orders = (2..over.dimensions).map(|_| shuffled(count, &mut random)).collect();
        }
        let mut within = |index: u32, count: u32| (f64::from(index) + f64::from(random.unit())) / f64::from(count);
        let place = [within(sample % columns, columns), within(sample / columns, rows)];
        let further: Vec<f64> = orders.iter().map(|order| within(order[sample as usize], count)).collect();
        place.into_iter().chain(further).collect()
    })
}

/// 0..count in a random order.
pub fn shuffled(count: u32, random: &mut Pcg32) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count).collect();
    random.shuffle(&mut order);
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::sampler::over::Points;

    #[test]
    fn each_part_of_a_cell_has_one_place() {
        assert_eq!([1, 2, 6, 7, 16].map(squarest), [[1, 1], [2, 1], [3, 2], [7, 1], [4, 4]]);
        let over = Over { sides_px: [2.0, 1.0], count: 12, dimensions: 4, seed: 3 };
        let grid = PixelGrid { sides: [2, 1], samples: 6 };
        let points: Points = super::points(&over, &grid);
        for cell in points.chunks(6) {
            let distinct = |index: &dyn Fn(&Vec<f64>) -> u32| {
                let mut seen: Vec<u32> = cell.iter().map(index).collect();
                seen.sort_unstable();
                seen.dedup();
                seen.len()
            };
            assert_eq!(distinct(&|point| (point[0] * 6.0) as u32 * 2 + (point[1] * 2.0) as u32), 6);
            assert_eq!(distinct(&|point| (point[2] * 6.0) as u32), 6);
            assert_eq!(distinct(&|point| (point[3] * 6.0) as u32), 6);
        }
    }
}
