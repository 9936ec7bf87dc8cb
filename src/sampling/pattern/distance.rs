//! How close samples come to each other over the repeated period.

use super::{Pattern, Sample};

impl Pattern {
    /// The least distance between two samples of the repeated pattern, px: copies of one sample in two periods count
    /// too. None without samples.
    pub fn least_distance_px(&self) -> Option<f64> {
        self.least_distance_of(|_| true)
    }

    /// The same between samples of one subset, where they are closest. None without samples.
    pub fn least_subset_distance_px(&self) -> Option<f64> {
        if self.subset_count as usize == self.samples.len() {
            // Copies of one sample in two periods are all that is there.
            return self.period_distance_px();
        }
        let subsets = 0..self.subset_count;
        let distances = subsets.filter_map(|subset| self.least_distance_of(|sample| sample.subset == subset));
        distances.reduce(f64::min)
    }

    /// Between copies of a sample in neighbouring periods.
    fn period_distance_px(&self) -> Option<f64> {
        (!self.samples.is_empty()).then(|| f64::from(self.period_px[0].min(self.period_px[1])))
    }

    fn least_distance_of(&self, is_meant: impl Fn(&Sample) -> bool) -> Option<f64> {
        let place = |([x, y], sample): ([u32; 2], &Sample)| {
            let [u, v] = sample.place_px.map(f64::from);
            [f64::from(x) + u, f64::from(y) + v]
        };
        let mut places: Vec<[f64; 2]> = self.placed().filter(|(_, sample)| is_meant(sample)).map(place).collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let [width, height] = self.period_px.map(f64::from);
        let mut least = if places.is_empty() { return None } else { self.period_distance_px()? };
        // Sorted by x, and again behind the period's end: those farther than the least so far need not be looked at.
        for (index, a) in places.iter().enumerate() {
            let behind = places[index + 1..].iter().map(|b| b[0] - a[0]).zip(&places[index + 1..]);
            let wrapped = places[..index].iter().map(|b| b[0] + width - a[0]).zip(&places[..index]);
            for (across, b) in behind.chain(wrapped) {
                if across >= least {
                    break;
                }
                let down = (b[1] - a[1]).abs();
                least = least.min(across.hypot(down.min(height - down)));
            }
        }
        Some(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_grid_s_pixels_are_one_apart_and_its_subsets_a_period() {
        for (sides, of_subset) in [([1, 1], 1.0), ([4, 4], 4.0), ([8, 6], 6.0), ([1, 5], 1.0)] {
            let grid = Pattern::grid(sides);
            assert_eq!((grid.least_distance_px(), grid.least_subset_distance_px()), (Some(1.0), Some(of_subset)));
        }
        assert_eq!(Pattern::new([2, 2], &[], Vec::new()).least_distance_px(), None);
    }

    /// Across the right edge, and across the lower one.
    #[test]
    fn the_period_s_edges_are_none() {
        let at = |x: f32, y: f32, subset| {
            ([x as u32, y as u32], Sample { place_px: [x.fract(), y.fract()], ..Sample::middle(subset) })
        };
        for (a, b) in [((0.25, 1.5), (3.75, 1.5)), ((2.5, 0.125), (2.5, 2.625))] {
            let pattern = Pattern::new([4, 3], &[], vec![at(a.0, a.1, 0), at(b.0, b.1, 1)]);
            assert_eq!((pattern.least_distance_px(), pattern.least_subset_distance_px()), (Some(0.5), Some(3.0)));
            let one = Pattern::new([4, 3], &[], vec![at(a.0, a.1, 0), at(b.0, b.1, 0)]);
            assert_eq!(one.least_subset_distance_px(), Some(0.5));
        }
    }

    proptest! {
        /// All pairs, with each copy of the second beside and below.
        #[test]
        fn it_is_what_all_pairs_say(places in prop::collection::vec((0f32..1.0, 0f32..1.0, 0u32..3, 0u32..2), 1..12)) {
            let sample = |(index, (u, v, x, y)): (usize, (f32, f32, u32, u32))| {
                ([x, y], Sample { place_px: [u, v], ..Sample::middle(index as u32) })
            };
            let samples: Vec<_> = places.into_iter().enumerate().map(sample).collect();
            let pattern = Pattern::new([3, 2], &[], samples.clone());
            let place = |([x, y], sample): &([u32; 2], Sample)| {
                [f64::from(*x) + f64::from(sample.place_px[0]), f64::from(*y) + f64::from(sample.place_px[1])]
            };
            let mut least = f64::INFINITY;
            for (i, a) in samples.iter().enumerate() {
                for (j, b) in samples.iter().enumerate() {
                    for shift in (-1..=1).flat_map(|right| (-1..=1).map(move |down| [right, down])) {
                        if i != j || shift != [0, 0] {
                            let (a, b) = (place(a), place(b));
                            let shift = [f64::from(shift[0]) * 3.0, f64::from(shift[1]) * 2.0];
                            least = least.min((b[0] + shift[0] - a[0]).hypot(b[1] + shift[1] - a[1]));
                        }
                    }
                }
            }
            let found = pattern.least_distance_px().unwrap();
            prop_assert!((found - least).abs() < 1e-9, "{found} {least}");
        }
    }
}
