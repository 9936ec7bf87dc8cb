//! Charts: a rectangle of the unit square for each patch of a mesh, so that every triangle has a place of a texture to itself.
//!
//! Rectangles stand on shelves, the highest first, with a gutter between them, in the least square that a search finds. Only
//! + - * / and sqrt are used, in f64, as by patches themselves: the same charts on every system.

use glam::DVec2;

/// Gutters are this part of the atlas: four texels of 2048.
const GUTTER: f64 = 1.0 / 512.0;
/// Greatest gutter, as a part of the side of the square that each chart would have if all were equal squares.
const MOST_GUTTER: f64 = 1.0 / 16.0;
/// Sides are at least this part of the largest.
const LEAST_SIDE: f64 = 1e-4;
/// Halvings of what is known of the square's side.
const SEARCHES: u32 = 24;

/// A rectangle of the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Chart {
    corner: DVec2,
    size: DVec2,
}

impl Chart {
    /// The place at these parts of its width and height.
    pub fn at(&self, part: [f64; 2]) -> DVec2 {
        self.corner + self.size * DVec2::from_array(part)
    }
}

/// Charts of these sizes, all in one scale and none over another.
pub fn packed(sizes: &[DVec2]) -> Vec<Chart> {
    let largest = sizes.iter().fold(0.0, |largest: f64, size| largest.max(size.max_element()));
    let least = if largest > 0.0 { LEAST_SIDE * largest } else { 1.0 };
    let sizes: Vec<DVec2> = sizes.iter().map(|size| size.max(DVec2::splat(least))).collect();
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    // Stable: what is equally high stays in the order of the patches.
    order.sort_by(|a, b| sizes[*b].y.total_cmp(&sizes[*a].y));
    let area: f64 = sizes.iter().map(|size| size.x * size.y).sum();
    let mut too_small = largest.max(area.sqrt()).max(least) * (1.0 - f64::EPSILON);
    let mut side = 2.0 * too_small;
    let mut charts = loop {
        if let Some(charts) = shelved(&sizes, &order, side) {
            break charts;
        }
        (too_small, side) = (side, 2.0 * side);
    };
    for _ in 0..SEARCHES {
        let middle = 0.5 * (too_small + side);
        match shelved(&sizes, &order, middle) {
            Some(better) => (charts, side) = (better, middle),
            None => too_small = middle,
        }
    }
    charts
}

/// None: a square of `side` is too small.
fn shelved(sizes: &[DVec2], order: &[usize], side: f64) -> Option<Vec<Chart>> {
    let gutter = side * GUTTER.min(MOST_GUTTER / (sizes.len() as f64).sqrt());
    let mut charts = vec![Chart::default(); sizes.len()];
    let (mut corner, mut shelf_height) = (DVec2::ZERO, 0.0);
    for index in order {
        let size = sizes[*index];
        if corner.x + size.x > side {
            corner = DVec2::new(0.0, corner.y + shelf_height + gutter);
            shelf_height = 0.0;
        }
        if corner.x + size.x > side || corner.y + size.y > side {
            return None;
        }
        charts[*index] = Chart { corner: corner / side, size: size / side };
        corner.x += size.x + gutter;
        shelf_height = size.y.max(shelf_height);
    }
    Some(charts)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sides of many kinds, rows of points among them.
    fn sizes(count: u32) -> Vec<DVec2> {
        let side = |index: u32, axis: u32| f64::from(sobol_burley::sample(index, axis, 7)).powi(3);
        (0..count).map(|index| DVec2::new(if index % 9 == 0 { 0.0 } else { side(index, 0) }, side(index, 1))).collect()
    }

    #[test]
    fn charts_lie_in_the_square_with_gutters_and_in_one_scale() {
        for count in [1, 2, 7, 300] {
            let (sizes, charts) = (sizes(count), packed(&sizes(count)));
            let largest = |sizes: &[DVec2]| sizes.iter().fold(0.0, |most: f64, size| most.max(size.max_element()));
            let scale = largest(&charts.iter().map(|chart| chart.size).collect::<Vec<_>>()) / largest(&sizes);
            for (index, (chart, size)) in charts.iter().zip(&sizes).enumerate() {
                assert!(chart.corner.min_element() >= 0.0 && chart.at([1.0, 1.0]).max_element() <= 1.0, "{chart:?}");
                let expected = scale * size.max(DVec2::splat(LEAST_SIDE * largest(&sizes)));
                assert!(chart.size.abs_diff_eq(expected, 1e-9), "{count}: {chart:?} of {size}");
                let gutter = 0.99 * GUTTER.min(MOST_GUTTER / f64::from(count).sqrt());
                let is_apart = |other: &Chart| {
                    let beyond = |a: &Chart, b: &Chart| b.corner - a.at([1.0, 1.0]);
                    beyond(chart, other).max(beyond(other, chart)).max_element() >= gutter
                };
                assert!(charts[..index].iter().all(is_apart), "{count}: chart {index}");
            }
            let area: f64 = charts.iter().map(|chart| chart.size.x * chart.size.y).sum();
            println!("{count} charts fill {area}");
            assert!(count < 300 || area > 0.5, "{count} charts fill {area}");
        }
    }
}
