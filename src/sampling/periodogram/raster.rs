//! The periodogram of values on a raster, such as the errors of a picture's pixels, by a fast Fourier transform.
//!
//! Why this way: the transform is taken without instructions that only some processors have, so that every machine
//! computes the same powers.

use super::Periodogram;
use rayon::prelude::*;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Transforms each row of `width` values and returns the columns of what comes out as rows.
fn turned(mut values: Vec<Complex<f64>>, width: usize) -> Vec<Complex<f64>> {
    let transform = FftPlanner::new().plan_fft_forward(width);
    values.par_chunks_mut(width).for_each(|row| transform.process(row));
    let height = values.len() / width;
    (0..width)
        .flat_map(|column| (0..height).map(move |row| [row, column]))
        .map(|[y, x]| values[y * width + x])
        .collect()
}

impl Periodogram {
    /// The powers of a raster: |sum over its N values e of e exp(-2 pi i f p)|^2 / N at the places p of its pixels.
    ///
    /// `values`: row by row; `size_px`: width and height, each at least 1. A frequency for each value, from -0.5 cycles
    /// a pixel to less than 0.5. The powers have the mean square of the values as their mean (Parseval): values that
    /// are independent of each other, with the mean 0, have their variance at every frequency on average.
    pub fn of_raster(values: &[f64], size_px: [u32; 2]) -> Self {
        let [width, height] = size_px.map(|side| side as usize);
        assert!(width > 0 && values.len() == width * height, "{} values of {width}x{height}", values.len());
        let values = values.iter().map(|value| Complex::new(*value, 0.0)).collect();
        let sums = turned(turned(values, width), height);
        let reach = size_px.map(|side| side / 2);
        // The transform begins with frequency 0; those below it stand at the end.
        let [column, row] = [width, height].map(|side| move |index: usize| (index + side - side / 2) % side);
        let power = |[y, x]: [usize; 2]| (sums[row(y) * width + column(x)].norm_sqr() / (width * height) as f64) as f32;
        let powers = (0..height).flat_map(|y| (0..width).map(move |x| [y, x])).map(power).collect();
        Self { period_px: size_px, reach, size: size_px, powers }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pcg::Pcg32;
    use std::f64::consts::TAU;

    fn noise(size_px: [u32; 2], seed: u64) -> Vec<f64> {
        let mut random = Pcg32::new(seed, 0);
        (0..size_px[0] * size_px[1]).map(|_| f64::from(random.unit()) - 0.5).collect()
    }

    /// All frequencies of a raster, cycles a period.
    fn frequencies([width, height]: [u32; 2]) -> impl Iterator<Item = [i32; 2]> {
        let along = |side: u32| -(side as i32 / 2)..side as i32 - side as i32 / 2;
        along(height).flat_map(move |v| along(width).map(move |u| [u, v]))
    }

    /// The mean of the powers is the mean square, whatever the sides.
    #[test]
    fn powers_have_the_mean_square_as_their_mean() {
        for size_px in [[1, 1], [2, 3], [16, 9], [45, 34], [64, 64], [97, 13]] {
            let values = noise(size_px, 3);
            let found = Periodogram::of_raster(&values, size_px);
            let square: f64 = values.iter().map(|value| value * value).sum();
            let sum: f64 = found.powers().iter().map(|power| f64::from(*power)).sum();
            assert!((sum - square).abs() < 1e-6 * square, "{size_px:?}: {sum} of {square}");
        }
    }

    /// a cos(2 pi f p) has the power a^2 N / 4 at f and -f and none elsewhere.
    #[test]
    fn a_wave_is_a_pair_of_peaks() {
        for (size_px, [u, v]) in [([24, 18], [5, -4]), ([15, 7], [-7, 2]), ([8, 8], [0, 3])] {
            let [width, height] = size_px;
            let at = |index: u32| [index % width, index / width].map(f64::from);
            let cycles = |[x, y]: [f64; 2]| f64::from(u) * x / f64::from(width) + f64::from(v) * y / f64::from(height);
            let values: Vec<f64> =
                (0..width * height).map(|index| 3.0 * (TAU * cycles(at(index)) + 0.7).cos()).collect();
            let found = Periodogram::of_raster(&values, size_px);
            let peak = (9.0 * width as f64 * height as f64 / 4.0) as f32;
            for frequency in frequencies(size_px) {
                let expected = if [[u, v], [-u, -v]].contains(&frequency) { peak } else { 0.0 };
                assert!((found.power(frequency) - expected).abs() < 1e-5 * peak, "{size_px:?} at {frequency:?}");
            }
        }
    }

    /// The sum, written plainly, at every frequency of sides that are odd, even and prime.
    #[test]
    fn it_is_the_sum_at_every_frequency() {
        for size_px in [[7, 5], [6, 4], [11, 1], [1, 6]] {
            let values = noise(size_px, 11);
            let [width, height] = size_px.map(f64::from);
            let found = Periodogram::of_raster(&values, size_px);
            assert_eq!(found.powers().len(), values.len());
            for frequency in frequencies(size_px) {
                let [u, v] = frequency.map(f64::from);
                let mut sum = [0.0, 0.0];
                for (index, value) in values.iter().enumerate() {
                    let [x, y] = [index as u32 % size_px[0], index as u32 / size_px[0]].map(f64::from);
                    let (sin, cos) = (-TAU * (u * x / width + v * y / height)).sin_cos();
                    sum = [sum[0] + value * cos, sum[1] + value * sin];
                }
                let expected = (sum[0] * sum[0] + sum[1] * sum[1]) / values.len() as f64;
                let power = f64::from(found.power(frequency));
                assert!((power - expected).abs() < 1e-6 * expected.max(0.1), "{size_px:?} at {frequency:?}: {power}");
            }
        }
    }
}
