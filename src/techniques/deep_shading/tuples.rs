//! Tuples, and how they are spread over pixels (Clarberg & Munkberg 2014, section 4.2; Keller & Heidrich 2001
//! interleave samples in the same way).
//!
//! Samples of a pixel are its cell's tuples. The table of cells repeats over the frame, so that all samples of one tuple are a
//! regular grid, which the rasteriser draws as a picture of its own.
//!
//! With two eyes (`--stereo`) the left eye's tuples come first and then the right eye's: the same places in a pixel, on
//! the lens and in time, with the lens at another place.

use crate::error::{Error, Result};
use crate::gpu::shader::structs::TupleBlock;
use crate::lens::on_unit_disc;
use crate::sampling::basis::Basis;
use crate::sampling::pattern::grid::squarest;
use crate::sampling::pattern::{Dimension, Pattern, Sample};
use crate::sampling::sampler::{Places, Sampler};
use crate::sampling::side::Side;
use crate::sampling::sobol;
use crate::settings::Values;
use crate::techniques::NamedPattern;
use crate::techniques::deep_shading::resources::NAME;
use crate::techniques::deep_shading::sample_count;
use crate::units::Extent;

/// Patterns that the settings choose.
pub const PATTERNS: &[NamedPattern] = &[NamedPattern {
    name: "tuples",
    summary: "Places in a pixel, on the lens and in time at which all samples of a blurred picture are taken, over a table of pixels",
    keys: &["spp", "tuples", "sampler", "seed"],
    make: |values| {
        let samples = sample_count::up_to(values, sample_count::BLURRED);
        Ok(TupleTable::from_settings(values, samples, true)?.pattern(values.integer("seed") as u32, 0))
    },
}];

/// How samples are spread over pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TupleTable {
    /// Pixels that have tuples of their own.
    pub cells: [u32; 2],
    /// Samples a pixel, of one eye.
    pub samples: u32,
    /// 1 or 2.
    pub eyes: u32,
    pub sampler: Sampler,
}

impl TupleTable {
    /// The table of `--tuples` and as many samples a pixel, for one eye.
    ///
    /// Errors: `--tuples` is no multiple of `samples` (exit code 2).
    pub fn from_settings(values: &Values, samples: u32, is_blurred: bool) -> Result<Self> {
        let tuples = sample_count::tuples(values, samples, is_blurred);
        if !tuples.is_multiple_of(samples) {
            return Err(Error::request(format!("--tuples {tuples}: it must be a multiple of --spp {samples}"))
                .within(NAME)
                .note(format!("--tuples {} works", tuples.next_multiple_of(samples))));
        }
        Ok(Self { sampler: values.choice("sampler"), ..Self::new(samples, tuples) })
    }

    /// For one eye, of one Sobol sequence. `tuples` is a multiple of `samples`, both at least 1. The cells are as square as
    /// their number allows.
    pub fn new(samples: u32, tuples: u32) -> Self {
        Self { cells: squarest(tuples / samples), samples, eyes: 1, sampler: Sampler::Sobol }
    }

    /// Number of tuples of one eye, each a place in a pixel, on the lens and in time.
    pub fn tuples_of_eye(&self) -> u32 {
        self.cells[0] * self.cells[1] * self.samples
    }

    /// Number of tuples of all eyes, each a layer.
    pub fn tuple_count(&self) -> u32 {
        self.eyes * self.tuples_of_eye()
    }

    /// Number of a tuple among those of all runs, the twin of tuple_number in space.glsl; both eyes have the same
    /// numbers.
    pub fn number(&self, run: u32, tuple: u32) -> u32 {
        run.wrapping_mul(self.tuples_of_eye()).wrapping_add(tuple % self.tuples_of_eye())
    }

    /// Pixels of a layer: one for each cell that begins in the frame.
    pub fn layer(&self, frame: Extent) -> Extent {
        Extent::new(frame.width.div_ceil(self.cells[0]), frame.height.div_ceil(self.cells[1]))
    }

    /// Number of samples of all layers, including those beyond the frame.
    pub fn sample_count(&self, frame: Extent) -> u64 {
        self.layer(frame).pixel_count() * u64::from(self.tuple_count())
    }

    /// Whether all of every layer lies in the frame.
    pub fn divides(&self, frame: Extent) -> bool {
        frame.width.is_multiple_of(self.cells[0]) && frame.height.is_multiple_of(self.cells[1])
    }

    /// Where in the table the pixels of a tuple lie, of either eye.
    fn cell_of(&self, tuple: u32) -> [u32; 2] {
        let cell = tuple / self.samples;
        [cell % self.cells[0], cell / self.cells[0] % self.cells[1]]
    }

    /// The pixel of the frame that a pixel of a tuple's layer is.
    pub fn pixel_of(&self, tuple: u32, [x, y]: [u32; 2]) -> [u32; 2] {
        let [column, row] = self.cell_of(tuple);
        [x * self.cells[0] + column, y * self.cells[1] + row]
    }

    /// How much of a tuple's layer lies in the frame, from its first pixel on.
    pub fn inside(&self, frame: Extent, tuple: u32) -> Extent {
        let [x, y] = self.cell_of(tuple);
        let count = |side: u32, first: u32, cells: u32| side.saturating_sub(first).div_ceil(cells);
        Extent::new(count(frame.width, x, self.cells[0]), count(frame.height, y, self.cells[1]))
    }

    /// Where the first sample of a pixel of the frame, of the left eye, lies in what has one entry a sample: layer by layer, row by row.
    pub fn first_sample(&self, frame: Extent, [x, y]: [u32; 2]) -> usize {
        let (layer, [width, height]) = (self.layer(frame), self.cells);
        let tuple = u64::from((y % height * width + x % width) * self.samples);
        let row = tuple * u64::from(layer.height) + u64::from(y / height);
        (row * u64::from(layer.width) + u64::from(x / width)) as usize
    }

    /// The tuples of one set, eye by eye and cell by cell in row order. `run`: another one for each set of a picture; `eyes`: where
    /// their lenses are on the unit disk (`Lens::places`).
    pub fn tuples(&self, frame: Extent, seed: u32, run: u32, eyes: &[f32]) -> Vec<TupleBlock> {
        assert_eq!(eyes.len(), self.eyes as usize);
        let of_middle = self.of_eye(frame, seed, run);
        let beside = |eye: f32, tuple: &TupleBlock| {
            let [x, y] = tuple.lens.map(|place| (1.0 - eye.abs()) * place);
            TupleBlock { lens: [eye + x, y], eye, ..*tuple }
        };
        eyes.iter().flat_map(|eye| of_middle.iter().map(|tuple| beside(*eye, tuple))).collect()
    }

    /// The tuples of one eye as a pattern over the table's cells. `run`: as for `tuples`; another stretch of Sobol's
    /// sequence, and another seed of what is no sequence.
    pub fn pattern(&self, seed: u32, run: u32) -> Pattern {
        if self.sampler == Sampler::Sobol {
            return Pattern::nets(self.cells, self.samples, seed, run);
        }
        let seed = if run == 0 { seed } else { sobol::pair_seed(seed, run) };
        let sides = self.cells.map(|side| Side::new(side, 1));
        let further = [Dimension::Time, Dimension::LensU, Dimension::LensV];
        let basis = Basis::new(sides, &further, f64::from(self.samples), self.sampler, Places::Counted, seed);
        basis.expect("every pixel has as many samples").pattern()
    }

    /// What a sample of `tuple` has in `pixel` of the frame, where pixels have samples of their own: own_samples.glsl's twin.
    pub fn of_pixel(&self, frame: Extent, tuple: &TupleBlock, pixel: [u32; 2]) -> TupleBlock {
        let seed = sobol::pixel_seed(pixel, 0);
        let turned = |number: f32, purpose: u32| turned(number, sobol::pair_seed(seed, purpose));
        let place = [turned(tuple.place_px[0], 0), turned(tuple.place_px[1], 1)];
        let lens_unit = [turned(tuple.lens_unit[0], 2), turned(tuple.lens_unit[1], 3)];
        let layer = self.layer(frame);
        let sides = [self.cells[0] * layer.width, self.cells[1] * layer.height];
        let shift =
            [0, 1].map(|axis| tuple.shift[axis] - 2.0 * (place[axis] - tuple.place_px[axis]) / sides[axis] as f32);
        let [x, y] = on_unit_disc(lens_unit).to_array().map(|place| (1.0 - tuple.eye.abs()) * place);
        let time = turned(tuple.time, 4);
        TupleBlock { shift, lens: [tuple.eye + x, y], time, place_px: place, lens_unit, ..*tuple }
    }

    /// Those of one eye whose lens is the unit disk.
    fn of_eye(&self, frame: Extent, seed: u32, run: u32) -> Vec<TupleBlock> {
        let layer = self.layer(frame);
        let block = |(cell, sample): ([u32; 2], &Sample)| {
            let [time, u, v, ..] = sample.further;
            let axis = |pixels: u32, side: u32, cells: u32, cell: u32, place: f32| {
                let (pixels, side, cells) = (f64::from(pixels), f64::from(side), f64::from(cells));
                let offset = f64::from(cell) + f64::from(place);
                let scale = pixels / (cells * side);
                let shift = (pixels / cells + 1.0 - 2.0 * offset / cells) / side - 1.0;
                [scale as f32, shift as f32]
            };
            let [width, height] = self.cells;
            let x = axis(frame.width, layer.width, width, cell[0], sample.place_px[0]);
            let y = axis(frame.height, layer.height, height, cell[1], sample.place_px[1]);
            TupleBlock {
                scale: [x[0], y[0]],
                shift: [x[1], y[1]],
                lens: on_unit_disc([u, v]).to_array(),
                time,
                eye: 0.0,
                place_px: sample.place_px,
                lens_unit: [u, v],
            }
        };
        self.pattern(seed, run).placed().map(block).collect()
    }
}

/// A number of 0 to 1 without 1, in steps of 2^-24, with other binary digits.
fn turned(number: f32, turn: u32) -> f32 {
    const STEPS: f32 = 16_777_216.0;
    ((number * STEPS) as u32 ^ (turn >> 8)) as f32 / STEPS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_as_square_as_its_cells_allow() {
        for (samples, tuples, cells) in
            [(8, 32, [2, 2]), (8, 8, [1, 1]), (4, 64, [4, 4]), (4, 32, [4, 2]), (2, 6, [3, 1]), (1, 12, [4, 3])]
        {
            assert_eq!(TupleTable::new(samples, tuples), TupleTable { cells, ..TupleTable::new(samples, samples) });
            assert_eq!(TupleTable::new(samples, tuples).tuple_count(), tuples);
        }
    }

    #[test]
    fn a_frame_that_the_table_does_not_divide_has_layers_that_cover_it() {
        let layer = TupleTable::new(8, 32).layer(Extent::new(101, 31));
        assert_eq!((layer.width, layer.height), (51, 16));
        let inside = [0, 8, 16, 24].map(|tuple| TupleTable::new(8, 32).inside(Extent::new(101, 31), tuple));
        assert_eq!(inside.map(|part| (part.width, part.height)), [(51, 16), (50, 16), (51, 15), (50, 15)]);
    }

    #[test]
    fn a_pixel_s_first_sample_lies_in_its_cell_s_first_layer() {
        let (table, frame) = (TupleTable::new(8, 32), Extent::new(101, 31));
        // A layer has 51 x 16 entries.
        let places = [[0, 0], [1, 0], [2, 1], [100, 30]].map(|pixel| table.first_sample(frame, pixel));
        assert_eq!(places, [0, 8 * 816, 16 * 816 + 1, 15 * 51 + 50]);
    }

    /// What the transform puts into the middle of a layer's pixel is the tuple's place in the frame's pixel.
    #[test]
    fn the_middle_of_a_layer_s_pixel_is_the_tuple_s_place() {
        let (table, frame) = (TupleTable::new(4, 16), Extent::new(30, 17));
        let layer = table.layer(frame);
        for (index, tuple) in table.tuples(frame, 1, 0, &[0.0]).iter().enumerate() {
            let cell = index as u32 / 4;
            for at in [[0, 0], [3, 2], [14, 8]] {
                let middle = [0, 1].map(|axis| {
                    let side = [layer.width, layer.height][axis];
                    2.0 * (at[axis] as f32 + 0.5) / side as f32 - 1.0
                });
                let ndc = [0, 1].map(|axis| (middle[axis] - tuple.shift[axis]) / tuple.scale[axis]);
                let place = [0, 1].map(|axis| {
                    let pixels = [frame.width, frame.height][axis] as f32;
                    let cell = [cell % table.cells[0], cell / table.cells[0]][axis];
                    (ndc[axis] + 1.0) * 0.5 * pixels - (at[axis] * table.cells[axis] + cell) as f32
                });
                assert!(place.iter().all(|place| (-1e-3..1.001).contains(place)), "{place:?}");
            }
        }
        let alone = TupleTable::new(1, 1).tuples(frame, 1, 0, &[0.0])[0];
        assert_eq!((alone.scale, alone.shift), ([1.0; 2], [0.0; 2]));
    }

    #[test]
    fn lens_and_time_are_evenly_spread_and_runs_differ() {
        let (table, frame) = (TupleTable::new(8, 32), Extent::new(64, 64));
        let tuples = table.tuples(frame, 7, 0, &[0.0]);
        let inside = tuples.iter().filter(|tuple| tuple.lens[0].hypot(tuple.lens[1]) < 0.5f32.sqrt()).count();
        assert_eq!(inside, 16, "half of the disk's area");
        for cell in tuples.chunks(8) {
            assert_eq!(cell.iter().filter(|tuple| tuple.time < 0.5).count(), 4);
        }
        assert_ne!(tuples, table.tuples(frame, 7, 1, &[0.0]));
    }

    /// Eight samples stay one in each eighth, on each axis; of all pixels they are everywhere, and no pixel has its neighbour's.
    #[test]
    fn a_pixel_s_own_samples_are_as_evenly_spread_as_the_tuples() {
        let (table, frame) = (TupleTable::new(8, 32), Extent::new(64, 64));
        let tuples = table.tuples(frame, 7, 0, &[0.0]);
        let numbers = |tuple: &TupleBlock| {
            let ([x, y], [u, v]) = (tuple.place_px, tuple.lens_unit);
            [x, y, u, v, tuple.time]
        };
        let mut sums = [0.0; 5];
        let mut before = None;
        for pixel in (0..64).flat_map(|y| (0..64).map(move |x| [x, y])) {
            let cell = (pixel[1] % 2 * 2 + pixel[0] % 2) as usize;
            let own = tuples[8 * cell..][..8].iter().map(|tuple| table.of_pixel(frame, tuple, pixel));
            let own: Vec<[f32; 5]> = own.map(|tuple| numbers(&tuple)).collect();
            for axis in 0..5 {
                let mut eighths: Vec<u32> = own.iter().map(|numbers| (8.0 * numbers[axis]) as u32).collect();
                eighths.sort_unstable();
                assert_eq!(eighths, [0, 1, 2, 3, 4, 5, 6, 7], "{pixel:?}, {axis}");
                sums[axis] += own.iter().map(|numbers| f64::from(numbers[axis])).sum::<f64>();
            }
            assert_ne!(before.replace(own.clone()), Some(own), "{pixel:?}");
        }
        let means = sums.map(|sum| sum / f64::from(8 * 64 * 64));
        assert!(means.iter().all(|mean| (mean - 0.5).abs() < 0.001), "{means:?}");
    }

    /// What the transform puts into the middle of a layer's pixel is the sample's own place, and its lens one on the disk.
    #[test]
    fn a_pixel_s_own_sample_lies_in_the_middle_of_its_layer_s_pixel() {
        let (table, frame) = (TupleTable::new(4, 16), Extent::new(30, 17));
        let layer = table.layer(frame);
        for (index, tuple) in table.tuples(frame, 1, 0, &[0.0]).iter().enumerate() {
            for at in [[0, 0], [3, 2], [14, 7]] {
                let pixel = table.pixel_of(index as u32, at);
                let own = table.of_pixel(frame, tuple, pixel);
                for axis in 0..2 {
                    let side = [layer.width, layer.height][axis];
                    let middle = 2.0 * (at[axis] as f32 + 0.5) / side as f32 - 1.0;
                    let ndc = (middle - own.shift[axis]) / own.scale[axis];
                    let place = (ndc + 1.0) * 0.5 * [frame.width, frame.height][axis] as f32 - pixel[axis] as f32;
                    assert!((place - own.place_px[axis]).abs() < 1e-4, "{place} for {}", own.place_px[axis]);
                }
                assert!((own.lens[0].hypot(own.lens[1]).powi(2) - own.lens_unit[0]).abs() < 1e-5);
            }
        }
    }

    /// Lenses of a quarter of the disk's radius that touch its rim.
    #[test]
    fn both_eyes_have_the_same_tuples_with_lenses_of_their_own() {
        let (frame, one) = (Extent::new(101, 31), TupleTable::new(8, 32));
        let two = TupleTable { eyes: 2, ..one };
        let (alone, both) = (one.tuples(frame, 7, 1, &[0.0]), two.tuples(frame, 7, 1, &[-0.75, 0.75]));
        assert_eq!((both.len(), two.sample_count(frame)), (64, 2 * one.sample_count(frame)));
        for (index, tuple) in both.iter().enumerate() {
            let (middle, eye) = (alone[index % 32], if index < 32 { -0.75 } else { 0.75 });
            let lens = [eye + 0.25 * middle.lens[0], 0.25 * middle.lens[1]];
            assert_eq!(*tuple, TupleBlock { lens, eye, ..middle });
            assert_eq!(two.inside(frame, index as u32), one.inside(frame, index as u32 % 32));
            assert_eq!(two.number(3, index as u32), one.number(3, index as u32 % 32));
        }
    }
}
