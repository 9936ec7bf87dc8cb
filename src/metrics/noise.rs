//! How far a mean of samples is from what it tends to, by the samples themselves: without a reference.
//!
//! Why this way: others compare two halves of the samples (Cycles; Dammertz et al. 2010), which needs a second buffer and a
//! count that halves. The sum of squares says it at any count. It assumes independent samples; those of a scrambled
//! Sobol sequence are better than that, so that the estimate is too high rather than too low. Neither method can know
//! what no sample has hit: a bright path of small probability.

use super::linear::RELMSE_EPSILON;

/// Samples a pixel before which nothing is estimated: too few to know their own spread.
const LEAST_SAMPLES: u64 = 16;

/// Whether `--until-error` looks at the error after this many samples a pixel: 16, 24, 32, 48, 64 and so on, so that what
/// is sampled in vain is at most half of what is needed, and looking costs nothing beside sampling.
pub fn is_checked(sample_count: u64) -> bool {
    sample_count >= LEAST_SAMPLES && is_round(sample_count)
}

/// Whether a count is a power of two, or three of one.
fn is_round(count: u64) -> bool {
    let odd_part = count >> count.trailing_zeros().min(63);
    odd_part == 1 || odd_part == 3
}

/// The estimated relative standard error of a picture: the root of the mean over pixels of V / (|m|^2 + 0.03), where m is
/// the pixel's mean and V the estimated variance of that mean, both over the three channels together.
///
/// It estimates the root of `Metrics::relmse` against the picture of endless samples, equal to it where pixels are grey:
/// 0.03 is three channels' worth of the 0.01 there. 0 to about 1: a pixel whose light all came by one sample counts 1.
/// `sums`: red, green, blue, and the sum of the squared lengths, of `sample_count` samples each, at least 2. NaN or infinite
/// where a sum is.
pub fn relative_error(sums: &[[f32; 4]], sample_count: u64) -> f64 {
    assert!(sample_count >= 2, "one sample has no spread");
    let count = sample_count as f64;
    let of = |sum: &[f32; 4]| {
        let [r, g, b, squares] = sum.map(|sum| f64::from(sum) / count);
        let mean_squared = r * r + g * g + b * b;
        let spread = squares - mean_squared;
        // Rounding takes the spread of equal samples below 0; NaN must stay what it is.
        let variance = if spread < 0.0 { 0.0 } else { spread / (count - 1.0) };
        variance / (mean_squared + 3.0 * RELMSE_EPSILON)
    };
    (sums.iter().map(of).sum::<f64>() / sums.len().max(1) as f64).sqrt()
}

/// Whether `--until-error` looks at the error of two halves after this many runs: 2, 4, 6, 8, 12, 16 and so on, so that both halves
/// have as many.
pub fn is_checked_in_halves(run_count: u64) -> bool {
    run_count.is_multiple_of(2) && is_round(run_count)
}

/// The estimate of `relative_error` for a picture that is the mean of two: `halves`, row-major, of as many independent runs each as
/// `counts` says, at least one. A pixel's variance is what its two values say, which is nothing for one pixel and enough for many.
///
/// What both have in common it does not see: a filter's blur, say.
pub fn error_of_halves(halves: [&[[f32; 3]]; 2], counts: [u32; 2]) -> f64 {
    let [first, second] = counts.map(f64::from);
    let count = first + second;
    // Their difference has the variance s / first + s / second, the mean s / count.
    let share = first * second / (count * count);
    let of = |(a, b): (&[f32; 3], &[f32; 3])| {
        let mean_squared: f64 =
            a.iter().zip(b).map(|(a, b)| ((f64::from(*a) * first + f64::from(*b) * second) / count).powi(2)).sum();
        let apart: f64 = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
        apart * share / (mean_squared + 3.0 * RELMSE_EPSILON)
    };
    let pixels = halves[0].iter().zip(halves[1]);
    (pixels.map(of).sum::<f64>() / halves[0].len().max(1) as f64).sqrt()
}

/// Samples a pixel at which an error of `most` is expected, where that of `sample_count` is `error`: errors fall with the
/// root of their number.
pub fn samples_for(most: f64, sample_count: u64, error: f64) -> u64 {
    (sample_count as f64 * (error / most).powi(2)).ceil() as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pcg::Pcg32;

    fn sums_of(samples: &[[f32; 3]]) -> [f32; 4] {
        samples
            .iter()
            .fold([0.0; 4], |[r, g, b, squares], [x, y, z]| [r + x, g + y, b + z, squares + (x * x + y * y + z * z)])
    }

    #[test]
    fn by_hand() {
        // Means of 1 with a variance of 1/3 in one channel of one pixel; the other pixel has no spread.
        let first = sums_of(&[[0.0, 1.0, 1.0], [2.0, 1.0, 1.0], [0.0, 1.0, 1.0], [2.0, 1.0, 1.0]]);
        let second = sums_of(&[[0.5; 3]; 4]);
        let expected = (4.0f64 / 3.0 / 4.0 / 3.03 / 2.0).sqrt();
        assert!((relative_error(&[first, second], 4) - expected).abs() < 1e-7);
        // One sample of many brought all the light: off by all of it.
        let mut rare = [[0.0; 3]; 1000];
        rare[7] = [3e3; 3];
        assert!((relative_error(&[sums_of(&rare)], 1000) - 1.0).abs() < 1e-2);
        assert_eq!(relative_error(&[[0.0; 4]], 16), 0.0);
        assert!(relative_error(&[[f32::NAN, 0.0, 0.0, f32::NAN]], 16).is_nan());
    }

    /// The estimate for independent samples is the error that their means have.
    #[test]
    fn independent_samples_are_as_far_off_as_they_say() {
        let mut random = Pcg32::new(5, 0);
        let (pixel_count, sample_count) = (4000, 32);
        let mut squares = 0.0;
        let sums: Vec<[f32; 4]> = (0..pixel_count)
            .map(|_| {
                let samples: Vec<[f32; 3]> = (0..sample_count).map(|_| [random.between(0.0, 2.0); 3]).collect();
                let sum = sums_of(&samples);
                squares += 3.0 * (f64::from(sum[0]) / sample_count as f64 - 1.0).powi(2) / 3.03;
                sum
            })
            .collect();
        let (found, actual) = (relative_error(&sums, sample_count), (squares / pixel_count as f64).sqrt());
        // 4000 pixels: either is known to some 2 %.
        assert!((found / actual - 1.0).abs() < 0.05, "{found} estimated, {actual} found");
    }

    /// Two halves of independent samples say the same as their squares do, whichever is larger.
    #[test]
    fn halves_are_as_far_apart_as_their_mean_is_off() {
        let mut random = Pcg32::new(7, 0);
        for counts in [[16u32, 16], [17, 16], [20, 5]] {
            let mut squares = 0.0;
            let mut mean_of = |count: u32| (0..count).map(|_| random.between(0.0, 2.0)).sum::<f32>() / count as f32;
            let (mut halves, pixel_count) = ([Vec::new(), Vec::new()], 20_000);
            for _ in 0..pixel_count {
                let means = counts.map(&mut mean_of);
                let weights = counts.map(|count| f64::from(count) / f64::from(counts[0] + counts[1]));
                let mean: f64 = (0..2).map(|half| f64::from(means[half]) * weights[half]).sum();
                squares += 3.0 * (mean - 1.0).powi(2) / (3.0 * mean * mean + 0.03);
                (0..2).for_each(|half| halves[half].push([means[half]; 3]));
            }
            let found = error_of_halves([&halves[0], &halves[1]], counts);
            let actual = (squares / f64::from(pixel_count)).sqrt();
            assert!((found / actual - 1.0).abs() < 0.05, "{counts:?}: {found} estimated, {actual} found");
        }
        assert!(error_of_halves([&[[f32::NAN; 3]], &[[0.0; 3]]], [1, 1]).is_nan());
    }

    #[test]
    fn it_is_looked_at_often_enough_and_no_oftener() {
        let halves: Vec<u64> = (0..=100).filter(|count| is_checked_in_halves(*count)).collect();
        assert_eq!(halves, [2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96]);
        let checked: Vec<u64> = (0..=200).filter(|count| is_checked(*count)).collect();
        assert_eq!(checked, [16, 24, 32, 48, 64, 96, 128, 192]);
        assert!(is_checked(1 << 63));
        assert_eq!(samples_for(0.01, 64, 0.02), 256);
        assert_eq!(samples_for(1e-30, 64, 1.0), u64::MAX);
    }
}
