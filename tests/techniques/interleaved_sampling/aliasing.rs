//! What a basis makes of frequencies near the pixel's own (figure 1): moire of the energy that its periodogram says.

use super::NAME;
use crate::support::watched::Watched;
use quincunx::sampling::pattern::Pattern;
use quincunx::sampling::periodogram::{Periodogram, pixel_frequency};
use quincunx::techniques::patterns;
use std::f64::consts::{FRAC_2_PI, TAU};

const SIDE_PX: u32 = 64;
/// Cycles a metre in the middle, which are a cycle a pixel, and how they grow.
const FREQUENCY: f64 = 64.0;
const GROWTH: f64 = 32.0;

/// What the plate shows at a place in pixels.
fn plate(x_px: f64, y_px: f64) -> f64 {
    let side = f64::from(SIDE_PX);
    let (x, y) = (x_px / side - 0.5 + FREQUENCY / GROWTH, 0.5 - y_px / side);
    let cycles = 0.5 * GROWTH * (x * x + y * y);
    f64::from(u8::from(cycles.fract() < 0.5))
}

/// The plate's mean over a pixel.
fn mean(x: u32, y: u32) -> f64 {
    const PARTS: u32 = 32;
    let part = |index: u32| (f64::from(index) + 0.5) / f64::from(PARTS);
    let places = (0..PARTS).flat_map(|j| (0..PARTS).map(move |i| [part(i), part(j)]));
    places.map(|[i, j]| plate(f64::from(x) + i, f64::from(y) + j)).sum::<f64>() / f64::from(PARTS * PARTS)
}

/// The greatest frequency that is slow, cycles a pixel.
const LOW: f64 = 0.125;

type Complex = [f64; 2];

fn sum(numbers: impl Iterator<Item = Complex>) -> Complex {
    numbers.fold([0.0; 2], |sum, number| [sum[0] + number[0], sum[1] + number[1]])
}

fn product([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

fn wave(cycles: f64) -> Complex {
    let (sin, cos) = (TAU * cycles).sin_cos();
    [cos, sin]
}

/// A wave of `cycles` a pixel, across and down, leaves an error in each pixel of the pattern's period, which repeats: the mean over
/// its samples less the mean over the pixel. The squared part of these errors that repeats `line` times a pixel.
fn error(pattern: &Pattern, cycles: [f64; 2], line: [f64; 2]) -> f64 {
    // Integrals over the pixel, of one axis each.
    let [across, down] = cycles.map(|cycles| {
        let angle = TAU * cycles;
        if angle.abs() < 1e-9 { [1.0, 0.0] } else { [angle.sin() / angle, (1.0 - angle.cos()) / angle] }
    });
    let whole = product(across, down);
    let [width, height] = pattern.period_px();
    let of_pixel = |[x, y]: [u32; 2]| {
        let samples = pattern.samples_of([x, y]);
        let count = samples.len() as f64;
        let places = samples.iter().map(|sample| sample.place_px.map(f64::from));
        let found = sum(places.map(|[x, y]| wave(cycles[0] * x + cycles[1] * y)));
        let off = [found[0] / count - whole[0], found[1] / count - whole[1]];
        product(off, wave(line[0] * f64::from(x) + line[1] * f64::from(y)))
    };
    let [real, imaginary] = sum((0..height).flat_map(|y| (0..width).map(move |x| [x, y])).map(of_pixel));
    (real * real + imaginary * imaginary) / f64::from(width * height).powi(2)
}

/// Energy of slow errors on the plate: a square wave's harmonics 1, 3 and 5 have amplitudes of 2 / pi over their order, and half the
/// squares as energy. They are slow where they are near a frequency at which the pattern repeats.
fn expected(pattern: &Pattern) -> f64 {
    let side = f64::from(SIDE_PX);
    let [width, height] = pattern.period_px().map(f64::from);
    let at = |[x, y]: [u32; 2]| -> f64 {
        let [x, y] = [x, y].map(|pixel| GROWTH * ((f64::from(pixel) + 0.5) / side - 0.5) / side);
        let harmonic = |order: f64| {
            let cycles = [order * (FREQUENCY / side + x), order * y];
            let line = [(cycles[0] * width).round() / width, (cycles[1] * height).round() / height];
            match (cycles[0] - line[0]).hypot(cycles[1] - line[1]) < LOW {
                true => error(pattern, cycles, line) / (order * order),
                false => 0.0,
            }
        };
        0.5 * FRAC_2_PI.powi(2) * [1.0, 3.0, 5.0].map(harmonic).iter().sum::<f64>()
    };
    let pixels = (0..SIDE_PX).flat_map(|y| (0..SIDE_PX).map(move |x| [x, y]));
    pixels.map(at).sum::<f64>() / (side * side)
}

/// Slow errors of a plate whose rings are about a pixel wide have the energy that the pattern gives them by a closed form: that of
/// independent samples falls by the pixels of the basis, to a fourth with 2x2, and that of relaxed ones is next to nothing.
#[test]
fn moire_has_the_energy_of_the_pixel_frequency() {
    let watched = Watched::open("zone-plate:frequency=64,growth=32");
    let exact: Vec<f64> = (0..SIDE_PX).flat_map(|y| (0..SIDE_PX).map(move |x| mean(x, y))).collect();
    for sampler in ["random", "jittered", "relaxed"] {
        let sums = ["1x1", "2x2"].map(|basis| {
            let (mut sums, mut parts) = ([0.0; 2], 0.0);
            // A pixel without a sample would show its neighbour's.
            let spec = |seed: &u32| format!("basis:basis={basis},samples=4,sampler={sampler},seed={seed}");
            let is_whole = |seed: &u32| patterns::open(&spec(seed)).unwrap().pattern.samples_per_pixel()[0] > 0;
            for seed in (1..).filter(is_whole).take(16) {
                let pattern = patterns::open(&spec(&seed)).unwrap().pattern;
                let seed = seed.to_string();
                let own = [("size", "64x64"), ("basis", basis), ("sampler", sampler), ("seed", &seed)];
                let picture = watched.picture(NAME, &own);
                let errors: Vec<f64> =
                    picture.pixels.iter().zip(&exact).map(|(pixel, exact)| f64::from(pixel[0]) - exact).collect();
                sums[0] += Periodogram::of_raster(&errors, [SIDE_PX; 2]).energy_below(LOW);
                sums[1] += expected(&pattern);
                parts += pixel_frequency(&pattern)[0] / 16.0;
            }
            println!("{sampler} {basis}: {sums:.5?}, {parts:.4} of the pixel frequency");
            sums
        });
        for [found, expected] in sums {
            // What is faster leaks over the edge of the plate: about a tenth of what relaxed samples leave at all.
            assert!((found - expected).abs() < 0.15 * expected + 0.004, "{sampler}: {found}, not {expected}");
        }
        let factor = sums[0][0] / sums[1][0];
        println!("{sampler}: {factor:.2} times as much with 1x1 as with 2x2");
        if sampler == "random" {
            assert!((factor - 4.0).abs() < 1.5, "{factor}");
        }
    }
}
