//! How fast errors fall with one setting of a sweep, such as the number of samples: straight lines through their logarithms, for
//! each combination of the others. Seeds are no combinations: what a setting does to an error is its mean over them.

use super::row::BenchRow;
use super::stats::straight;
use super::sweep::Axis;
use crate::error::{Error, Result};
use serde_json::{Map, Value, json};

/// The errors that have rates.
pub const MEASURES: [&str; 2] = ["rmse", "flip"];

/// Errors of one combination of the other axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rate {
    /// That combination, without the seed; empty where there is no other axis.
    pub of: String,
    /// By their values.
    pub points: Vec<RatePoint>,
    /// Exponents by the names of `MEASURES`: an error grows as the value to this power, -0.5 for independent samples. None
    /// where fewer than two points have an error above 0.
    pub exponents: [Option<f64>; 2],
}

/// Errors at one value.
#[derive(Clone, Debug, PartialEq)]
pub struct RatePoint {
    pub value: f64,
    /// Means over the seeds, by the names of `MEASURES`.
    pub errors: [f64; 2],
    /// Number of seeds that they are means of, at least 1.
    pub seeds: usize,
}

impl RatePoint {
    /// The mean of these errors and one seed's.
    fn add(&mut self, errors: [f64; 2]) {
        let before = self.seeds as f64;
        self.errors = [0, 1].map(|index| (self.errors[index] * before + errors[index]) / (before + 1.0));
        self.seeds += 1;
    }
}

/// The axis of `--rate KEY`.
///
/// Errors: `key` is not swept, or not over two numbers above 0 at least (exit code 2).
pub fn axis<'a>(key: &str, axes: &'a [Axis]) -> Result<&'a Axis> {
    let axis = axes.iter().find(|axis| axis.key == key).ok_or_else(|| {
        Error::request(format!("--rate {key}: there is no --sweep {key}=")).note(format!("--sweep {key}=1,4,16 is one"))
    })?;
    match axis.values.iter().find(|value| number(value).is_none()) {
        Some(value) => Err(Error::request(format!("--rate {key}: --sweep has {value}, which is no number above 0"))),
        None if axis.values.len() < 2 => {
            Err(Error::request(format!("--rate {key}: a line wants two values at least, and --sweep has one")))
        }
        None => Ok(axis),
    }
}

fn number(text: &str) -> Option<f64> {
    text.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0)
}

/// For each combination of the other axes but the seed: its errors by the values of `key`, where they are known, and the exponents.
pub fn rates<'a>(key: &str, axes: &[Axis], rows: impl IntoIterator<Item = &'a BenchRow>) -> Vec<Rate> {
    let mut rates: Vec<Rate> = Vec::new();
    for row in rows.into_iter().filter(|row| row.was_measured()) {
        let of = row.others(&[key, "seed"], axes);
        let Some((value, errors)) = number(&row.asked_text(key)).zip(row.best_known_errors()) else { continue };
        let errors = [errors.rmse, errors.flip];
        let at = rates.iter().position(|rate| rate.of == of).unwrap_or_else(|| {
            rates.push(Rate { of, points: Vec::new(), exponents: [None; 2] });
            rates.len() - 1
        });
        match rates[at].points.iter_mut().find(|point| point.value == value) {
            Some(point) => point.add(errors),
            None => rates[at].points.push(RatePoint { value, errors, seeds: 1 }),
        }
    }
    for rate in &mut rates {
        rate.points.sort_by(|a, b| a.value.total_cmp(&b.value));
        rate.exponents = [0, 1].map(|index| {
            exponent(&rate.points.iter().map(|point| (point.value, point.errors[index])).collect::<Vec<_>>())
        });
    }
    rates
}

/// The slope of the straight line through logarithms, by least squares; points at 0 are passed over.
fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<[f64; 2]> = points
        .iter()
        .filter(|(value, error)| *value > 0.0 && *error > 0.0 && error.is_finite())
        .map(|(value, error)| [value.ln(), error.ln()])
        .collect();
    straight(&logs).map(|[_, slope]| slope)
}

/// The rates as `summary.json` has them.
pub fn json(key: &str, rates: &[Rate]) -> Value {
    let by_name =
        |values: [Value; 2]| -> Map<String, Value> { MEASURES.into_iter().map(str::to_owned).zip(values).collect() };
    let point = |point: &RatePoint| {
        let mut at = by_name(point.errors.map(Value::from));
        at.insert("value".to_owned(), point.value.into());
        at.insert("seeds".to_owned(), point.seeds.into());
        at
    };
    let rate = |rate: &Rate| {
        let points: Vec<_> = rate.points.iter().map(point).collect();
        json!({ "of": rate.of, "exponents": by_name(rate.exponents.map(Value::from)), "points": points })
    };
    json!({ "by": key, "of": rates.iter().map(rate).collect::<Vec<_>>() })
}

/// A Markdown table of the rates: errors at each value, and the exponents; and over how many seeds, because those that were
/// skipped leave no trace in a mean.
pub fn markdown(key: &str, rates: &[Rate]) -> String {
    if rates.is_empty() {
        return format!(
            "no rates by {key}: errors of these rows are not known; --reference auto compares them with paths\n"
        );
    }
    let mut values: Vec<f64> = rates.iter().flat_map(|rate| rate.points.iter().map(|point| point.value)).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let mut text = format!("| errors by {key} |");
    for name in MEASURES {
        values.iter().for_each(|value| text.push_str(&format!(" {name} at {value} |")));
        text.push_str(" exponent |");
    }
    text.push_str(&format!("\n|{}\n", " --- |".repeat(1 + MEASURES.len() * (values.len() + 1))));
    for rate in rates {
        text.push_str(&format!("| {} |", if rate.of.is_empty() { "all" } else { &rate.of }));
        for index in 0..MEASURES.len() {
            for value in &values {
                let point = rate.points.iter().find(|point| point.value == *value);
                text.push_str(&point.map_or_else(|| " |".to_owned(), |point| format!(" {:.4} |", point.errors[index])));
            }
            let exponent = rate.exponents[index].map_or_else(String::new, |exponent| format!("{exponent:.2}"));
            text.push_str(&format!(" {exponent} |"));
        }
        text.push('\n');
    }
    let seeds = || rates.iter().flat_map(|rate| &rate.points).map(|point| point.seeds);
    let (least, most) = (seeds().min().unwrap_or(0), seeds().max().unwrap_or(0));
    let count = if least == most { most.to_string() } else { format!("{least} to {most}") };
    text.push_str(&format!("\nmeasured seeds behind each error: {count}\n"));
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::sweep::axes;
    use crate::metrics::Metrics;
    use crate::settings::written::{SettingValue, WrittenSettings};

    fn row(sampler: &str, samples: &str, rmse: f64, flip: f64) -> BenchRow {
        let texts: WrittenSettings = [("sampler", sampler), ("samples", samples)]
            .iter()
            .map(|(key, text)| ((*key).to_owned(), SettingValue::Text((*text).to_owned())))
            .collect();
        BenchRow {
            asked: Some(texts),
            error_against_none: Some(Metrics { rmse, flip, ..Metrics::EQUAL }),
            ..BenchRow::default()
        }
    }

    /// Errors of a known power have that exponent; what is 0, unknown or skipped has no part in it.
    #[test]
    fn exponents_are_those_of_the_powers() {
        let sweep = axes(&["sampler=a,b".to_owned(), "samples=1,4,16".to_owned()]).unwrap();
        let mut rows = Vec::new();
        for samples in ["1", "4", "16"] {
            let count: f64 = samples.parse().unwrap();
            rows.push(row("a", samples, 0.3 * count.powf(-0.5), 2.0 * count.powf(-0.75)));
            rows.push(row("b", samples, if samples == "1" { 0.0 } else { count.powi(-1) }, 0.0));
        }
        rows.push(BenchRow { skipped: Some("impossible".to_owned()), ..row("b", "4", 9.0, 9.0) });
        let found = rates("samples", &sweep, &rows);
        assert_eq!(found.iter().map(|rate| rate.of.as_str()).collect::<Vec<_>>(), ["sampler=a", "sampler=b"]);
        let near = |exponent: Option<f64>, wanted: f64| (exponent.unwrap() - wanted).abs() < 1e-9;
        assert!(near(found[0].exponents[0], -0.5) && near(found[0].exponents[1], -0.75), "{found:?}");
        assert!(near(found[1].exponents[0], -1.0) && found[1].exponents[1].is_none(), "{found:?}");
        assert_eq!(found[1].points.len(), 3);
        assert!(found.iter().flat_map(|rate| &rate.points).all(|point| point.seeds == 1), "{found:?}");
        let nothing = rates("samples", &sweep, &[BenchRow { error_against_none: None, ..rows[0].clone() }]);
        assert!(nothing.is_empty() && markdown("samples", &nothing).contains("--reference auto"));
        let text = markdown("samples", &found);
        assert!(
            text.contains("| sampler=a | 0.3000 | 0.1500 | 0.0750 | -0.50 | 2.0000 | 0.7071 | 0.2500 | -0.75 |"),
            "{text}"
        );
        assert_eq!(
            text.lines().next().unwrap().matches('|').count(),
            text.lines().nth(1).unwrap().matches('|').count()
        );
    }

    /// Seeds are no combination of their own: errors are means over them.
    #[test]
    fn errors_are_means_over_seeds() {
        let sweep = axes(&["seed=1,2,3".to_owned(), "samples=1,4".to_owned()]).unwrap();
        let mut rows = Vec::new();
        for (seed, errors) in [("1", [0.5, 0.1]), ("2", [0.6, 0.3]), ("3", [1.0, 0.2])] {
            for (samples, error) in ["1", "4"].into_iter().zip(errors) {
                let mut row = row("a", samples, error, error);
                let asked = row.asked.as_mut().unwrap();
                asked.insert("seed".to_owned(), SettingValue::Text(seed.to_owned()));
                rows.push(row);
            }
        }
        let found = rates("samples", &sweep, &rows);
        let [rate] = found.as_slice() else { panic!("{found:?}") };
        assert!(rate.of.is_empty() && rate.points.iter().all(|point| point.seeds == 3), "{found:?}");
        assert!(markdown("samples", &found).ends_with("\nmeasured seeds behind each error: 3\n"));
        rows.pop();
        let fewer = markdown("samples", &rates("samples", &sweep, &rows));
        assert!(fewer.ends_with("\nmeasured seeds behind each error: 2 to 3\n"), "{fewer}");
        for (point, wanted) in rate.points.iter().zip([0.7, 0.2]) {
            assert!((point.errors[0] - wanted).abs() < 1e-12 && point.errors[1] == point.errors[0], "{found:?}");
        }
        assert!((rate.exponents[0].unwrap() - (0.2_f64 / 0.7).ln() / 4.0_f64.ln()).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn an_axis_without_numbers_has_no_rate() {
        let sweep = axes(&["samples=1,4".to_owned(), "sampler=a,b".to_owned(), "seed=1".to_owned()]).unwrap();
        assert_eq!(axis("samples", &sweep).unwrap().key, "samples");
        for (key, words) in [
            ("planes", "no --sweep planes="),
            ("sampler", "a, which is no number above 0"),
            ("seed", "two values at least"),
        ] {
            let error = axis(key, &sweep).unwrap_err();
            assert!(error.exit_code() == 2 && error.message().contains(words), "{error}");
        }
    }
}
