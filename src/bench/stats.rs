//! Medians, paired ratios and their 95 % interval.

use crate::report::nullable::{interval, or_nan};
use crate::report::spread;
use serde::{Deserialize, Serialize};

/// Rounds that an interval takes: Student's factor is 12.7 for two, whose intervals go from nothing to 10^17 and say
/// nothing, and 4.3 for three.
pub const LEAST_PAIRS: usize = 3;

/// How many times as long one thing takes as another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ratio {
    /// Geometric mean of the paired ratios; null in JSON where it is not finite.
    #[serde(deserialize_with = "or_nan")]
    pub mean: f64,
    /// 95 % interval of that mean; None with fewer than `LEAST_PAIRS`.
    #[serde(default, rename = "interval_95", deserialize_with = "interval")]
    pub interval: Option<[f64; 2]>,
    /// Rounds that both were measured in.
    pub pairs: usize,
}

/// Ratio of `long` to `short`, where `long[i]` and `short[i]` were measured in the same round; at least one pair, all
/// positive.
///
/// The interval is Student's, on logarithms: a ratio and its inverse are then the same finding.
pub fn paired_ratio(long: &[f64], short: &[f64]) -> Ratio {
    assert!(!short.is_empty() && long.len() == short.len(), "rounds come in pairs");
    let logs: Vec<f64> = long.iter().zip(short).map(|(l, s)| (l / s).ln()).collect();
    let count = logs.len() as f64;
    let mean = logs.iter().sum::<f64>() / count;
    let interval = (logs.len() >= LEAST_PAIRS).then(|| {
        let variance = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let reach = t_quantile(logs.len() - 1) * (variance / count).sqrt();
        [(mean - reach).exp(), (mean + reach).exp()]
    });
    Ratio { mean: mean.exp(), interval, pairs: logs.len() }
}

/// Median of at least one sample, in any order.
pub fn median(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    spread::median(&sorted)
}

/// The straight line through points (x, y) by least squares: its height at 0 and its slope. None through fewer than two places.
pub fn straight(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let spread: f64 = points.iter().map(|point| (point[0] - x).powi(2)).sum();
    let together: f64 = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum();
    let slope = (spread > 0.0).then(|| together / spread)?;
    Some([y - slope * x, slope])
}

/// 97.5 % quantile of Student's t; beyond 30 degrees of freedom within 2 % of the normal one.
fn t_quantile(freedom: usize) -> f64 {
    const TABLE: [f64; 30] = [
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
        2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042,
    ];
    TABLE.get(freedom.wrapping_sub(1)).copied().unwrap_or(2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_goes_through_its_points() {
        let [height, slope] = straight(&[[1.0, 12.0], [3.0, 18.0], [5.0, 24.0]]).unwrap();
        assert!((height - 9.0).abs() < 1e-12 && (slope - 3.0).abs() < 1e-12, "{height} {slope}");
        assert_eq!(straight(&[[1.0, 2.0], [1.0, 3.0]]), None);
        assert_eq!(straight(&[]), None);
    }

    #[test]
    fn equal_pairs_have_a_ratio_without_width() {
        let ratio = paired_ratio(&[4.0, 8.0, 2.0], &[2.0, 4.0, 1.0]);
        assert!((ratio.mean - 2.0).abs() < 1e-12);
        let [low, high] = ratio.interval.unwrap();
        assert!((low - 2.0).abs() < 1e-9 && (high - 2.0).abs() < 1e-9);
    }

    #[test]
    fn drift_that_both_share_drops_out_and_noise_that_one_has_widens_the_interval() {
        let shared = paired_ratio(&[10.0, 20.0, 40.0, 80.0], &[1.0, 2.0, 4.0, 8.0]);
        assert!((shared.mean - 10.0).abs() < 1e-9);
        let noisy = paired_ratio(&[10.0, 20.0, 10.0, 20.0], &[1.0; 4]);
        let [low, high] = noisy.interval.unwrap();
        assert!(low < noisy.mean && noisy.mean < high && high / low > 2.0);
    }

    #[test]
    fn an_interval_takes_three_rounds() {
        assert_eq!(paired_ratio(&[2.0], &[1.0]).interval, None);
        assert_eq!(paired_ratio(&[2.0, 4.0], &[1.0, 1.0]).interval, None);
        assert!(paired_ratio(&[2.0, 4.0, 2.0], &[1.0; 3]).interval.is_some());
    }
}
