//! Blue noise that tiles, by relaxation: Keller and Heidrich 2001, section 2.2, after McCool and Fiume 1992, "Hierarchical
//! Poisson disk sampling distributions". Darts are thrown with a radius that shrinks until all have their place, and then
//! each place moves to the middle of what lies nearest to it, a few times: with many more it would become a lattice.
//!
//! Times and lenses are numbers that are well spread by themselves, exchanged until places that are near have different
//! ones (swaps.rs).

use super::jittered;
use super::over::{Over, PixelGrid, Places, Points, part};
use super::swaps::{self, Group};
use super::torus::Torus;
use crate::sampling::pcg::Pcg32;
use crate::sampling::sobol;
use rayon::prelude::*;

/// How often every place moves to the middle of its cell. Ours: low frequencies are gone then, and no other one stands out
/// (the test below).
const RELAXATION_COUNT: u32 = 6;
/// Nearest place to the edge of a pixel, px: what parts of sides are rounded by does not lift it into the next.
const FROM_EDGE_PX: f64 = 1e-6;
/// Darts of one radius for each place that is wanted.
const DARTS_PER_PLACE: u32 = 24;

/// Relaxed places, or the middles of pixels, with the rest exchanged between them. A single one lies in the middle of the
/// basis.
pub fn points(over: &Over, pixels: Option<PixelGrid>, places: Places) -> Points {
    let mut random = Pcg32::new(u64::from(over.seed), 16);
    let in_px = |point: &Vec<f64>| [0, 1].map(|axis| point[axis] * over.sides_px[axis]);
    let quota = pixels.filter(|_| places == Places::Counted);
    let places = match (pixels, over.count) {
        (Some(grid), _) if places == Places::Middles => {
            Torus::new(over.sides_px, grid.points(|_, _| vec![0.5; 2]).iter().map(in_px).collect())
        }
        (_, 1) => Torus::new(over.sides_px, vec![over.sides_px.map(|side| 0.5 * side)]),
        (_, count) => {
            let mut places = thrown(over.sides_px, count, quota, &mut random).into_places();
            if let Some(grid) = quota {
                places.sort_by_key(|place| grid.pixel_of(*place));
            }
            relaxed(over.sides_px, places, quota.is_some())
        }
    };
    let mut points: Points = places
        .places()
        .iter()
        .map(|place| [0, 1].map(|axis| part(place[axis] / over.sides_px[axis])).to_vec())
        .collect();
    // A pair of the last two, as a lens has, and before it a number by itself, as time is.
    let single = over.dimensions % 2 == 1;
    if single {
        let order = jittered::shuffled(over.count, &mut random);
        for (point, index) in points.iter_mut().zip(order) {
            point.push((f64::from(index) + f64::from(random.unit())) / f64::from(over.count));
        }
        swaps::exchange(&mut points, &places, Group::Single(2), &mut random);
    }
    let pair_count = (over.dimensions - 2) / 2;
    for pair in 0..pair_count {
        let first = 2 + usize::from(single) + 2 * pair;
        let order = jittered::shuffled(over.count, &mut random);
        let seed = sobol::pair_seed(sobol::pixel_seed([0, 0], over.seed), pair as u32);
        for (point, index) in points.iter_mut().zip(order) {
            point.extend(sobol::pair(index, seed).map(f64::from));
        }
        swaps::exchange(&mut points, &places, Group::Pair(first), &mut random);
    }
    points
}

/// `count` places, none nearer to another than the last radius that was tried, and in each pixel of `quota` as many as it says.
fn thrown(sides: [f64; 2], count: u32, quota: Option<PixelGrid>, random: &mut Pcg32) -> Torus {
    let mut left = quota.map(|grid| vec![grid.samples; (grid.sides[0] * grid.sides[1]) as usize]);
    // The densest packing of discs has this radius between middles.
    let mut radius = (2.0 / 3f64.sqrt() * sides[0] * sides[1] / f64::from(count)).sqrt();
    let mut board = Torus::empty(sides, radius);
    while board.places().len() < count as usize {
        for _ in 0..DARTS_PER_PLACE * count {
            let place = sides.map(|side| side * f64::from(random.unit()));
            let own = left.as_mut().zip(quota).map(|(left, grid)| &mut left[grid.pixel_of(place)]);
            let has_room = own.as_ref().is_none_or(|own| **own > 0) && board.places().len() < count as usize;
            if has_room && !board.has_within(place, radius) {
                board.push(place);
                own.into_iter().for_each(|own| *own -= 1);
            }
        }
        radius *= 0.9;
    }
    board
}

/// The places after some steps of Lloyd's method, by the middles of a fine raster's points. `in_pixels`: none leaves the pixel in
/// which it began.
fn relaxed(sides: [f64; 2], places: Vec<[f64; 2]>, in_pixels: bool) -> Torus {
    let mut torus = Torus::new(sides, places);
    let count = torus.places().len();
    // Points along each spacing: enough that a middle is known within a hundredth of it.
    let per_spacing = if count > 1 << 14 { 4.0 } else { 8.0 };
    let spacing = (sides[0] * sides[1] / count as f64).sqrt();
    let [columns, rows] = sides.map(|side| (per_spacing * side / spacing).ceil() as usize);
    for _ in 0..RELAXATION_COUNT {
        let point = |row: usize, column: usize| {
            [(column as f64 + 0.5) * sides[0] / columns as f64, (row as f64 + 0.5) * sides[1] / rows as f64]
        };
        let owners: Vec<Vec<u32>> = (0..rows)
            .into_par_iter()
            .map(|row| (0..columns).map(|column| torus.nearest(point(row, column))).collect())
            .collect();
        // Summed in one order, whatever the threads.
        let mut sums = vec![[0.0f64; 3]; count];
        for (row, owners) in owners.iter().enumerate() {
            for (column, owner) in owners.iter().enumerate() {
                let [x, y] = torus.way(torus.places()[*owner as usize], point(row, column));
                let sum = &mut sums[*owner as usize];
                *sum = [sum[0] + x, sum[1] + y, sum[2] + 1.0];
            }
        }
        let moved = torus.places().iter().zip(&sums).map(|(place, [x, y, own])| {
            let step = if *own > 0.0 { [x / own, y / own] } else { [0.0; 2] };
            [0, 1].map(|axis| {
                let (to, pixel) = (place[axis] + step[axis], place[axis].floor());
                if in_pixels {
                    to.clamp(pixel + FROM_EDGE_PX, pixel + 1.0 - FROM_EDGE_PX)
                } else {
                    part(to / sides[axis]) * sides[axis]
                }
            })
        });
        torus = Torus::new(sides, moved.collect());
    }
    torus
}

#[cfg(test)]
mod tests {
    use crate::sampling::basis::Basis;
    use crate::sampling::pattern::Dimension;
    use crate::sampling::periodogram::Periodogram;
    use crate::sampling::sampler::{Places, Sampler};
    use crate::sampling::side::Side;

    fn basis(side: u32, further: &[Dimension], samples: f64) -> Basis {
        Basis::new([Side::new(side, 1); 2], further, samples, Sampler::Relaxed, Places::Spread, 3).unwrap()
    }

    /// Blue noise: little power below half of the mean frequency of samples, none that stands out as in a lattice.
    #[test]
    fn low_frequencies_are_gone_and_no_other_stands_out() {
        let pattern = basis(8, &[], 4.0).pattern();
        // 16 samples lie along a side of 8 px: 16 cycles a period.
        let spectrum = Periodogram::new(&pattern, [24, 24], |_| true);
        let all = (-24i32..=24).flat_map(|v| (-24i32..=24).map(move |u| [u, v])).filter(|at| *at != [0, 0]);
        let powers: Vec<(f64, f32)> =
            all.map(|[u, v]| (f64::from(u * u + v * v).sqrt(), spectrum.power([u, v]))).collect();
        let low: Vec<f32> = powers.iter().filter(|(radius, _)| *radius < 8.0).map(|(_, power)| *power).collect();
        let mean = low.iter().sum::<f32>() / low.len() as f32;
        let greatest = powers.iter().map(|(_, power)| *power).fold(0.0, f32::max);
        assert!(mean < 0.05, "{mean}");
        // A lattice of 256 samples has 256.
        assert!(greatest < 64.0, "{greatest}");
        let least = pattern.least_distance_px().unwrap();
        assert!(least > 0.3, "two samples {least} px apart, of 0.54 px that are possible");
    }

    /// The times of a pixel's samples are spread over the shutter, and its lenses over the lens.
    #[test]
    fn near_places_have_different_times_and_lenses() {
        let further = [Dimension::Time, Dimension::LensU, Dimension::LensV];
        let pattern = basis(2, &further, 16.0).pattern();
        let (mut filled, mut quarters, mut pixels) = (0, 0, 0);
        for pixel in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let samples = pattern.samples_of(pixel);
            let eighths: std::collections::BTreeSet<u32> =
                samples.iter().map(|sample| (8.0 * sample.further[0]) as u32).collect();
            let lens: std::collections::BTreeSet<u32> = samples
                .iter()
                .map(|sample| (3.0 * sample.further[1]) as u32 * 3 + (3.0 * sample.further[2]) as u32)
                .collect();
            (filled, quarters, pixels) = (filled + eighths.len(), quarters + lens.len(), pixels + 1);
        }
        // Sixteen independent ones leave 7.05 of eight eighths with one, and 7.6 of nine ninths of a lens.
        assert!(filled as f64 / f64::from(pixels) >= 7.5, "{filled}");
        assert!(quarters as f64 / f64::from(pixels) >= 8.0, "{quarters}");
    }
}
