//! The Pareto set of time and error: the variants that leave a choice.

use serde_json::Value;

/// The row's errors against the reference that was asked for, else against `--split none`.
pub fn errors(row: &Value) -> &Value {
    if row["errors"].is_object() { &row["errors"] } else { &row["error_against_none"] }
}

/// The row's time and error, each better when less: the ratio to the baseline, which groups share where milliseconds
/// drift, and the RMSE of its `errors`. None where it has not both.
pub fn place(row: &Value) -> Option<[f64; 2]> {
    Some([row["ratio"]["mean"].as_f64()?, errors(row)["rmse"].as_f64()?])
}

/// Whether each place belongs to the set: no other is at least as good in both and better in one.
pub fn set(places: &[Option<[f64; 2]>]) -> Vec<bool> {
    let beats = |[time, error]: [f64; 2], [other_time, other_error]: [f64; 2]| {
        time <= other_time && error <= other_error && (time < other_time || error < other_error)
    };
    places
        .iter()
        .map(|place| place.is_some_and(|place| !places.iter().flatten().any(|other| beats(*other, place))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn only_rows_that_nothing_beats_are_in_the_set() {
        let row = |ratio: f64, rmse: f64| json!({ "ratio": { "mean": ratio }, "error_against_none": { "rmse": rmse } });
        let rows = [
            row(1.0, 0.0),
            row(0.3, 0.01),
            // As fast as the one before and worse.
            row(0.3, 0.02),
            // Slower and worse than the second.
            row(0.5, 0.015),
            row(0.2, 0.05),
            // As bad as the first, and slower.
            row(1.5, 0.0),
            json!({ "variant": "x", "skipped": "impossible" }),
            json!({ "ratio": { "mean": 0.1 } }),
        ];
        let places: Vec<_> = rows.iter().map(place).collect();
        assert_eq!(set(&places), [true, true, false, false, true, false, false, false]);
        // Equals leave a choice of either.
        assert_eq!(set(&[Some([1.0, 1.0]), Some([1.0, 1.0])]), [true, true]);
        assert_eq!(set(&[]), [false; 0]);
    }
}
