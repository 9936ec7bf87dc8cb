//! What points are spread over: a basis, as a whole or cell by cell.

use crate::sampling::side::Side;

/// Numbers of 0 to 1 without 1: a point's place as parts of the basis's sides, then its further dimensions.
pub type Points = Vec<Vec<f64>>;

/// Where in a basis the places of points are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Places {
    /// Where the sampler spreads them.
    Spread,
    /// There too, but as many in each pixel: the sides are whole, and the number of points allows it.
    Counted,
    /// In the middles of pixels, as many in each where the sides are whole and the number of points allows it.
    Middles,
}

/// What points are spread over.
pub struct Over {
    pub sides_px: [f64; 2],
    pub count: u32,
    pub dimensions: usize,
    pub seed: u32,
}

/// Equal cells of a basis, with the same number of points in each: its pixels, or the whole of it.
#[derive(Clone, Copy)]
pub struct PixelGrid {
    pub sides: [u32; 2],
    /// Points of a cell.
    pub samples: u32,
}

impl PixelGrid {
    /// The pixels of a basis; None: it has no whole sides, or `count` is not the same number for each of them.
    pub fn of(sides: [Side; 2], count: u32) -> Option<Self> {
        let sides = [sides[0].whole_px()?, sides[1].whole_px()?];
        let pixels = sides[0].checked_mul(sides[1])?;
        count.is_multiple_of(pixels).then(|| Self { sides, samples: count / pixels })
    }

    /// The cell in which a place lies, px from the upper left corner of the basis, in row order; cells are pixels.
    pub fn pixel_of(&self, place_px: [f64; 2]) -> usize {
        let [x, y] = [0, 1].map(|axis| (place_px[axis] as u32).min(self.sides[axis] - 1));
        (y * self.sides[0] + x) as usize
    }

    /// Points of all cells in row order, each as `in_cell` gives it, its place in the cell as a part of that one.
    pub fn points(&self, mut in_cell: impl FnMut([u32; 2], u32) -> Vec<f64>) -> Points {
        let cells = (0..self.sides[1]).flat_map(|y| (0..self.sides[0]).map(move |x| [x, y]));
        let samples = cells.flat_map(|cell| (0..self.samples).map(move |sample| (cell, sample)));
        samples
            .map(|(cell, sample)| {
                let mut point = in_cell(cell, sample);
                for axis in 0..2 {
                    point[axis] = (f64::from(cell[axis]) + point[axis]) / f64::from(self.sides[axis]);
                }
                point
            })
            .collect()
    }
}

/// What is left of a number above its whole part: 0 to 1 without 1.
pub fn part(number: f64) -> f64 {
    let part = number - number.floor();
    if part < 1.0 { part } else { 0.0 }
}
