//! The Pareto set of time and error: the variants that no other beats in both, as far as their intervals show.

use super::faster;
use serde_json::{Value, json};

/// The row's errors against the reference that was asked for, else against `--split none`.
pub fn errors(row: &Value) -> &Value {
    if row["errors"].is_object() { &row["errors"] } else { &row["error_against_none"] }
}

/// The row's time ratio to the baseline and the RMSE of its `errors`, each better when less. None where one of them is
/// missing, or there is no interval: then it is unknown whether another is faster.
fn place(row: &Value) -> Option<[f64; 2]> {
    row["ratio"]["interval_95"][1].as_f64()?;
    Some([row["ratio"]["mean"].as_f64()?, errors(row)["rmse"].as_f64()?])
}

/// Marks the rows of the set: no other with at most their error is proven to be faster. Those that are in it because
/// the intervals do not decide are marked with the rows that they are not told apart from.
pub fn mark(rows: &mut [Value]) {
    let places: Vec<_> = rows.iter().map(place).collect();
    let marks: Vec<Option<Vec<Value>>> = (0..rows.len())
        .map(|index| {
            let [time, error] = places[index]?;
            let rivals = || {
                let others = places.iter().enumerate().filter(|(other, _)| *other != index);
                others.filter_map(|(other, place)| Some((other, (*place)?))).filter(|(_, [_, theirs])| *theirs <= error)
            };
            if rivals().any(|(other, _)| faster::is_faster(&rows[other], &rows[index])) {
                return None;
            }
            let quicker = rivals().filter(|(_, [theirs, _])| *theirs < time);
            Some(quicker.map(|(other, _)| rows[other]["variant"].clone()).collect())
        })
        .collect();
    for (row, untold) in rows.iter_mut().zip(marks) {
        // Kept rows may be anything but a map, which takes no keys.
        let (Some(untold), Some(row)) = (untold, row.as_object_mut()) else { continue };
        row.insert("pareto".to_owned(), json!(true));
        if !untold.is_empty() {
            row.insert("pareto_not_told_from".to_owned(), json!(untold));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(variant: &str, ratio: f64, reach: f64, rmse: f64) -> Value {
        let interval = [ratio - reach, ratio + reach];
        json!({
            "variant": variant,
            "ratio": { "mean": ratio, "interval_95": interval },
            "error_against_none": { "rmse": rmse },
        })
    }

    fn marked(mut rows: Vec<Value>) -> Vec<bool> {
        mark(&mut rows);
        rows.iter().map(|row| row["pareto"] == true).collect()
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
            json!({ "variant": "x", "skipped": "impossible" }),
            json!({ "ratio": { "mean": 0.1, "interval_95": [0.1, 0.1] } }),
            json!(7),
        ];
        assert_eq!(marked(rows), [true, true, false, true, false, false, false, false]);
        assert_eq!(marked(Vec::new()), [false; 0]);
    }

    #[test]
    fn a_rival_that_is_not_told_to_be_faster_beats_nobody() {
        let mut rows = vec![row("a", 0.5, 0.1, 0.0), row("b", 0.6, 0.1, 0.01), row("c", 0.9, 0.1, 0.01)];
        mark(&mut rows);
        let told: Vec<_> =
            rows.iter().map(|row| (row["pareto"] == true, row["pareto_not_told_from"].clone())).collect();
        assert_eq!(told, [(true, Value::Null), (true, json!(["a"])), (false, Value::Null)]);
        // One round, or two, have no interval: nothing is marked.
        let mut few = row("a", 0.5, 0.0, 0.0);
        few["ratio"]["interval_95"] = Value::Null;
        assert_eq!(marked(vec![few, row("b", 0.6, 0.1, 0.01)]), [false, true]);
    }
}
