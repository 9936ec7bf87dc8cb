//! The Pareto set of time and error: the variants that no other beats in both, as far as their intervals show.

use super::faster;
use super::row::BenchRow;

/// The row's time ratio to the baseline and the RMSE of its errors, each better when less. None where one of them is
/// missing, or there is no interval: then it is unknown whether another is faster.
fn place(row: &BenchRow) -> Option<[f64; 2]> {
    row.interval()?;
    let rmse = Some(row.best_known_errors()?.rmse).filter(|rmse| !rmse.is_nan())?;
    Some([row.ratio.as_ref()?.mean, rmse])
}

/// Marks the rows of the set: no other with at most their error is proven to be faster. Those that are in it because
/// the intervals do not decide are marked with the rows that they are not told apart from.
pub fn mark(rows: &mut [BenchRow]) {
    let places: Vec<_> = rows.iter().map(place).collect();
    let marks: Vec<Option<Vec<String>>> = (0..rows.len())
        .map(|index| {
            let [time, error] = places[index]?;
            let rivals = || {
                // Ratios to another baseline say nothing of these.
                let others = places
                    .iter()
                    .enumerate()
                    .filter(|(other, _)| *other != index && rows[*other].baseline == rows[index].baseline);
                others.filter_map(|(other, place)| Some((other, (*place)?))).filter(|(_, [_, theirs])| *theirs <= error)
            };
            if rivals().any(|(other, _)| faster::is_faster(&rows[other], &rows[index])) {
                return None;
            }
            let quicker = rivals().filter(|(_, [theirs, _])| *theirs < time);
            Some(quicker.map(|(other, _)| rows[other].variant.clone()).collect())
        })
        .collect();
    for (row, untold) in rows.iter_mut().zip(marks) {
        row.pareto = untold.is_some().then_some(true);
        row.pareto_not_told_from = untold.filter(|untold| !untold.is_empty());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::stats::Ratio;
    use crate::metrics::Metrics;

    fn row(variant: &str, ratio: f64, reach: f64, rmse: f64) -> BenchRow {
        let interval = Some([ratio - reach, ratio + reach]);
        BenchRow {
            variant: variant.to_owned(),
            ratio: Some(Ratio { mean: ratio, interval, pairs: 3 }),
            error_against_none: Some(Metrics { rmse, ..Metrics::EQUAL }),
            ..BenchRow::default()
        }
    }

    fn marked(mut rows: Vec<BenchRow>) -> Vec<bool> {
        mark(&mut rows);
        rows.iter().map(|row| row.pareto == Some(true)).collect()
    }

    #[test]
    fn only_rows_that_nothing_beats_are_in_the_set() {
        let rows = vec![
            row("a", 1.0, 0.0, 0.0),
            row("b", 0.3, 0.02, 0.01),
            // Slower and worse than the second.
            row("c", 0.5, 0.02, 0.015),
            row("d", 0.2, 0.02, 0.05),
            // As bad as the first, and slower.
            row("e", 1.5, 0.1, 0.0),
            BenchRow { skipped: Some("impossible".to_owned()), ..BenchRow::default() },
            BenchRow { error_against_none: None, ..row("x", 0.1, 0.0, 0.0) },
            BenchRow::default(),
        ];
        assert_eq!(marked(rows), [true, true, false, true, false, false, false, false]);
        assert_eq!(marked(Vec::new()), [false; 0]);
    }

    #[test]
    fn rows_of_another_baseline_are_no_rivals() {
        let of = |baseline: &str, row: BenchRow| BenchRow { baseline: baseline.to_owned(), ..row };
        let rows = vec![
            of("vpls=1", row("a", 1.0, 0.0, 0.1)),
            of("vpls=1", row("b", 0.5, 0.01, 0.1)),
            of("vpls=2", row("c", 1.0, 0.0, 0.1)),
        ];
        assert_eq!(marked(rows), [false, true, true]);
    }

    #[test]
    fn a_rival_that_is_not_told_to_be_faster_beats_nobody() {
        let mut rows = vec![row("a", 0.5, 0.1, 0.0), row("b", 0.6, 0.1, 0.01), row("c", 0.9, 0.1, 0.01)];
        mark(&mut rows);
        let told: Vec<_> = rows.iter().map(|row| (row.pareto, row.pareto_not_told_from.clone())).collect();
        assert_eq!(told, [(Some(true), None), (Some(true), Some(vec!["a".to_owned()])), (None, None)]);
        // One round, or two, have no interval: nothing is marked.
        let mut few = row("a", 0.5, 0.0, 0.0);
        few.ratio.as_mut().unwrap().interval = None;
        assert_eq!(marked(vec![few, row("b", 0.6, 0.1, 0.01)]), [false, true]);
    }
}
