//! Which of two rows is the faster one, as far as their rounds show. Rows may come from a file and say anything.

use super::row::BenchRow;
use super::stats::{LEAST_PAIRS, Ratio, paired_ratio};
use std::cmp::Ordering;

/// Milliseconds of each round, all positive.
fn samples(row: &BenchRow) -> Option<&[f64]> {
    let samples = &row.times_ms()?.samples;
    samples.iter().all(|ms| ms.is_finite() && *ms > 0.0).then_some(samples)
}

/// How many times as long `a` takes as `b`, where both were measured in the same three rounds or more.
pub fn paired(a: &BenchRow, b: &BenchRow) -> Option<Ratio> {
    let group = a.group.as_ref()?;
    let (long, short) = (samples(a)?, samples(b)?);
    let is_pair = b.group.as_ref() == Some(group) && long.len() == short.len() && long.len() >= LEAST_PAIRS;
    is_pair.then(|| paired_ratio(long, short))
}

/// `Less`: the interval lies below 1.
pub fn told(ratio: &Ratio) -> Option<Ordering> {
    let [low, high] = ratio.interval?;
    Some(match (low, high) {
        (_, high) if high < 1.0 => Ordering::Less,
        (low, _) if low > 1.0 => Ordering::Greater,
        _ => Ordering::Equal,
    })
}

/// Whether `a` is proven to be faster than `b`: by the interval of their ratio, or, for other rounds, if the intervals
/// of their ratios to the same baseline do not overlap.
pub fn is_faster(a: &BenchRow, b: &BenchRow) -> bool {
    if let Some(ratio) = paired(a, b) {
        return told(&ratio) == Some(Ordering::Less);
    }
    matches!((a.interval(), b.interval()), (Some([_, high]), Some([low, _])) if high < low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::spread::Spread;

    fn of_group(group: &str, samples: &[f64]) -> BenchRow {
        BenchRow { group: Some(group.to_owned()), stage_ms: Spread::of(samples), ..BenchRow::default() }
    }

    #[test]
    fn only_what_was_measured_in_the_same_rounds_is_paired() {
        let row = of_group;
        // Both grow alike: to a baseline that does not, neither interval would be narrow.
        let (slow, fast) = (row("g", &[1.1, 2.2, 4.6, 8.8]), row("g", &[1.0, 2.0, 4.0, 8.0]));
        let ratio = paired(&slow, &fast).unwrap();
        assert_eq!(told(&ratio), Some(Ordering::Greater));
        assert!(is_faster(&fast, &slow) && !is_faster(&slow, &fast));
        let noisy = row("g", &[2.0, 1.0, 8.0, 4.0]);
        assert_eq!(told(&paired(&noisy, &fast).unwrap()), Some(Ordering::Equal));
        assert!(!is_faster(&fast, &noisy) && !is_faster(&noisy, &fast));
        for other in [
            row("h", &[1.0, 2.0, 4.0, 8.0]),
            row("g", &[1.0, 2.0, 4.0]),
            row("g", &[1.0, 2.0, 4.0, -8.0]),
            BenchRow { group: None, ..row("g", &[1.0, 2.0, 4.0, 8.0]) },
            BenchRow { stage_ms: None, ..row("g", &[]) },
        ] {
            assert!(paired(&slow, &other).is_none() && paired(&other, &slow).is_none(), "{other:?}");
        }
        let few = row("g", &[1.0, 2.0]);
        assert!(paired(&few, &few).is_none(), "two rounds have no interval");
    }

    #[test]
    fn rows_of_other_rounds_meet_at_the_baseline() {
        let with = |interval| Some(Ratio { mean: 0.1, interval, pairs: 3 });
        let row = |low: f64, high: f64| BenchRow { ratio: with(Some([low, high])), ..BenchRow::default() };
        assert!(is_faster(&row(0.5, 0.6), &row(0.7, 0.8)) && !is_faster(&row(0.7, 0.8), &row(0.5, 0.6)));
        assert!(!is_faster(&row(0.5, 0.75), &row(0.7, 0.8)));
        assert!(!is_faster(&BenchRow { ratio: with(None), ..BenchRow::default() }, &row(0.7, 0.8)));
        assert!(!is_faster(&row(f64::NAN, 0.1), &row(0.7, 0.8)));
    }
}
