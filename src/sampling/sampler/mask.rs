//! One sequence for all pixels, turned by masks of blue noise, which void-and-cluster makes: Ulichney 1993, "The
//! void-and-cluster method for dither array generation".
//!
//! A mask is an order of the pixels of a tile: the first so many of it are always spread evenly, over copies of it too. A
//! basis that is larger than a tile has copies.

use super::over::{Over, PixelGrid, Points};
use super::recurrence;
use crate::sampling::pcg::Pcg32;

/// Pixels on each side of one whose energy it raises: beyond it a Gaussian of the paper's 1.5 px is below a millionth.
const REACH: i32 = 8;
/// exp(-1 / (2 * 1.5^2)): energies are its powers, by the squared distance.
const FALL: f64 = 0.800_737_402_916_808;

/// R2's points in each pixel, turned in each dimension by the rank that a mask of its own gives the pixel.
pub fn points(over: &Over, grid: &PixelGrid) -> Points {
    let tile = tile(grid.sides);
    let count = f64::from(tile[0] * tile[1]);
    let ranks: Vec<Vec<u32>> = (0..over.dimensions)
        .map(|dimension| mask(tile, &mut Pcg32::new(u64::from(over.seed), 4 + dimension as u64)))
        .collect();
    // Where in a step of the ranks: without it all seeds would take the same numbers, and patterns of several seeds together would be
    // no better than one.
    let mut random = Pcg32::new(u64::from(over.seed), 15);
    let within: Vec<f64> = ranks.iter().map(|_| f64::from(random.unit())).collect();
    let steps = recurrence::steps(over.dimensions);
    grid.points(|[x, y], sample| {
        let pixel = (y % tile[1] * tile[0] + x % tile[0]) as usize;
        let turned: Vec<f64> =
            ranks.iter().zip(&within).map(|(ranks, within)| (f64::from(ranks[pixel]) + within) / count).collect();
        recurrence::point(sample, &turned, &steps)
    })
}

/// Sides of what is repeated over a basis, px. Ours: the time that a mask takes grows with the square of its pixels.
pub fn tile(sides: [u32; 2]) -> [u32; 2] {
    sides.map(|side| side.min(64))
}

/// The rank of each pixel, row by row: 0 to all of them.
fn mask(sides: [u32; 2], random: &mut Pcg32) -> Vec<u32> {
    let count = (sides[0] * sides[1]) as usize;
    let mut field = Field::new(sides);
    // The initial pattern: a tenth of the pixels, moved from the tightest cluster to the largest void until nothing moves.
    let first_count = (count / 10).max(1);
    while field.set_count < first_count {
        let pixel = random.below(count as u32) as usize;
        if !field.is_set[pixel] {
            field.turn(pixel);
        }
    }
    // Each move lowers the energy of the whole; the bound only guards against rounding.
    for _ in 0..16 * count {
        let cluster = field.tightest();
        field.turn(cluster);
        let void = field.largest();
        field.turn(void);
        if void == cluster {
            break;
        }
    }
    let mut ranks = vec![0; count];
    // Backwards from the initial pattern, its tightest cluster the last of it; then forwards, the largest void the next.
    let initial = field.clone();
    while field.set_count > 0 {
        let cluster = field.tightest();
        field.turn(cluster);
        ranks[cluster] = field.set_count as u32;
    }
    let mut field = initial;
    while field.set_count < count {
        let void = field.largest();
        ranks[void] = field.set_count as u32;
        field.turn(void);
    }
    ranks
}

/// Pixels that are set, and what each place feels of them.
#[derive(Clone)]
struct Field {
    sides: [i32; 2],
    is_set: Vec<bool>,
    set_count: usize,
    energies: Vec<f64>,
    /// The set pixel of the greatest energy in each row, and the other one of the least.
    tightest_of_row: Vec<Option<usize>>,
    largest_of_row: Vec<Option<usize>>,
    /// Energies by squared distance.
    falls: Vec<f64>,
}

impl Field {
    fn new(sides: [u32; 2]) -> Self {
        let count = (sides[0] * sides[1]) as usize;
        let falls = std::iter::successors(Some(1.0), |fall| Some(fall * FALL)).take((2 * REACH * REACH + 1) as usize);
        let sides = sides.map(|side| side as i32);
        let mut field = Self {
            sides,
            is_set: vec![false; count],
            set_count: 0,
            energies: vec![0.0; count],
            tightest_of_row: vec![None; sides[1] as usize],
            largest_of_row: vec![None; sides[1] as usize],
            falls: falls.collect(),
        };
        (0..sides[1]).for_each(|row| field.look_at(row));
        field
    }

    /// Sets a pixel that is not, or the other way round.
    fn turn(&mut self, pixel: usize) {
        let [width, height] = self.sides;
        let sign = if self.is_set[pixel] { -1.0 } else { 1.0 };
        self.set_count = if self.is_set[pixel] { self.set_count - 1 } else { self.set_count + 1 };
        self.is_set[pixel] = !self.is_set[pixel];
        let (x, y) = (pixel as i32 % width, pixel as i32 / width);
        let mut rows = vec![false; height as usize];
        for down in -REACH..=REACH {
            let row = (y + down).rem_euclid(height);
            rows[row as usize] = true;
            for across in -REACH..=REACH {
                let at = (row * width + (x + across).rem_euclid(width)) as usize;
                self.energies[at] += sign * self.falls[(across * across + down * down) as usize];
            }
        }
        for row in (0..height).filter(|row| rows[*row as usize]) {
            self.look_at(row);
        }
    }

    /// Finds the extremes of a row anew.
    fn look_at(&mut self, row: i32) {
        let width = self.sides[0] as usize;
        let pixels = || row as usize * width..(row as usize + 1) * width;
        let by_energy = |a: &usize, b: &usize| self.energies[*a].total_cmp(&self.energies[*b]);
        let tightest = pixels().filter(|pixel| self.is_set[*pixel]).max_by(by_energy);
        let largest = pixels().filter(|pixel| !self.is_set[*pixel]).min_by(by_energy);
        (self.tightest_of_row[row as usize], self.largest_of_row[row as usize]) = (tightest, largest);
    }

    /// The set pixel that feels the most; there is one.
    fn tightest(&self) -> usize {
        let found = self.tightest_of_row.iter().flatten();
        *found.max_by(|a, b| self.energies[**a].total_cmp(&self.energies[**b])).expect("a set pixel")
    }

    /// The pixel that is not set and feels the least; there is one.
    fn largest(&self) -> usize {
        let found = self.largest_of_row.iter().flatten();
        *found.min_by(|a, b| self.energies[**a].total_cmp(&self.energies[**b])).expect("a pixel that is not set")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pattern::{Pattern, Sample};
    use crate::sampling::periodogram::Periodogram;

    #[test]
    fn ranks_are_each_there_once() {
        for sides in [[1, 1], [2, 2], [5, 3], [16, 16], [40, 7]] {
            let mut ranks = mask(sides, &mut Pcg32::new(1, 0));
            ranks.sort_unstable();
            assert_eq!(ranks, (0..sides[0] * sides[1]).collect::<Vec<_>>());
        }
    }

    /// Any part of the ranks from the first on has little power at low frequencies: 1 would be white noise.
    #[test]
    fn the_first_of_a_mask_are_blue_noise() {
        let side = 32;
        let ranks = mask([side, side], &mut Pcg32::new(7, 0));
        for first in [102, 256, 512] {
            let pixels = (0..).zip(&ranks).filter(|(_, rank)| **rank < first);
            let samples =
                pixels.map(|(pixel, _): (u32, _)| ([pixel % side, pixel / side], Sample::middle(0))).collect();
            let spectrum = Periodogram::new(&Pattern::new([side, side], &[], samples), [4, 4], |_| true);
            let low = (-4i32..=4).flat_map(|v| (-4i32..=4).map(move |u| [u, v])).filter(|at| *at != [0, 0]);
            let powers: Vec<f32> = low.map(|[u, v]| spectrum.power([u, v])).collect();
            let mean = powers.iter().sum::<f32>() / powers.len() as f32;
            assert!(mean < 0.1, "{first}: {mean}");
        }
    }
}
