//! Numbers exchanged between places until near places have different ones: the energy of Georgiev and Fajardo 2016,
//! "Blue-noise dithered sampling", with quotients instead of exponentials, lowered by exchanges that lower it.

use super::over::Points;
use super::torus::Torus;
use crate::sampling::pcg::Pcg32;

/// Places that one looks at: those in its own pixel and around it.
const NEIGHBOUR_COUNT: f64 = 16.0;
const EXCHANGES_PER_POINT: usize = 100;
/// The most of all points together: some seconds.
const MOST_EXCHANGES: usize = 1 << 23;

/// Which numbers of a point are exchanged together.
#[derive(Clone, Copy)]
pub enum Group {
    /// One, of this index.
    Single(usize),
    /// Two from this index on.
    Pair(usize),
}

impl Group {
    /// What two sets of numbers feel of each other: 1 where they are the same, half of it where they are as far apart as
    /// `count` evenly spread ones are.
    fn nearness(self, a: &[f64], b: &[f64], count: f64) -> f64 {
        let apart = |index: usize| a[index] - b[index];
        match self {
            Self::Single(index) => 1.0 / (1.0 + (apart(index) * count).powi(2)),
            Self::Pair(index) => 1.0 / (1.0 + (apart(index).powi(2) + apart(index + 1).powi(2)) * count),
        }
    }

    fn exchange(self, points: &mut Points, a: usize, b: usize) {
        let (first, count) = match self {
            Self::Single(index) => (index, 1),
            Self::Pair(index) => (index, 2),
        };
        if a != b {
            let (before, after) = points.split_at_mut(a.max(b));
            let numbers = first..first + count;
            before[a.min(b)][numbers.clone()].swap_with_slice(&mut after[0][numbers]);
        }
    }
}

/// Exchanges the numbers of `group` between `points`, whose places are `places`.
pub fn exchange(points: &mut Points, places: &Torus, group: Group, random: &mut Pcg32) {
    let count = points.len();
    if count < 3 {
        return;
    }
    let radius = radius(places, count);
    let neighbours: Vec<Vec<(u32, f64)>> = (0..count as u32)
        .map(|index| {
            let weighed = places.neighbours(index, radius).into_iter();
            weighed.map(|(other, squared)| (other, (1.0 - squared / (radius * radius)).powi(2))).collect()
        })
        .collect();
    let mean = neighbours.iter().map(Vec::len).sum::<usize>() as f64 / count as f64;
    // What the point `at` would feel with the numbers of another.
    let energy = |points: &Points, at: usize, with: usize| -> f64 {
        let own = |other: usize| if other == with { at } else { other };
        let felt = neighbours[at]
            .iter()
            .map(|(other, weight)| weight * group.nearness(&points[with], &points[own(*other as usize)], mean));
        felt.sum()
    };
    for _ in 0..(EXCHANGES_PER_POINT * count).min(MOST_EXCHANGES) {
        let [a, b] = [0, 1].map(|_| random.below(count as u32) as usize);
        let (before, after) =
            (energy(points, a, a) + energy(points, b, b), energy(points, a, b) + energy(points, b, a));
        if after < before {
            group.exchange(points, a, b);
        }
    }
}

/// How far places look, px: at least over a pixel, and over so many places.
fn radius(places: &Torus, count: usize) -> f64 {
    let [width, height] = places.sides();
    let spacing_squared = width * height / count as f64;
    (NEIGHBOUR_COUNT * spacing_squared / std::f64::consts::PI).sqrt().max(1.0)
}
