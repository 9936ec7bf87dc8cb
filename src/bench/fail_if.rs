//! Bounds on rows, for scripts: `--fail-if "time_ratio > 1.05"`. A number with an interval is over a bound where all of the interval
//! is; one without, where it is itself.

use super::numbers::{NUMBERS, Number, Read};
use super::row::BenchRow;
use crate::error::{Error, Result};
use crate::metrics::{Measure, Metrics};

const COUNTERS: &str = "counters.";

/// What is looked at.
enum Quantity {
    Named(Read),
    Error(&'static Measure),
    Counter(String),
}

/// A condition under which a command fails.
pub struct Condition {
    text: String,
    quantity: Quantity,
    is_above: bool,
    bound: f64,
}

impl Condition {
    /// `NAME > NUMBER` or `NAME < NUMBER`.
    ///
    /// Errors: there is no such name, or no such number (exit code 2).
    pub fn parse(text: &str) -> Result<Self> {
        let refused = |why: &str| {
            Error::request(format!("--fail-if {text:?}: {why}")).note(format!(
                "for example --fail-if \"time_ratio > 1.05\"; there are {}, errors ({}) and counters.NAME",
                NUMBERS.map(|(name, _)| name).join(", "),
                Metrics::NAMES.join(", ")
            ))
        };
        let (at, is_above) = match (text.find('>'), text.find('<')) {
            (Some(at), None) => (at, true),
            (None, Some(at)) => (at, false),
            _ => return Err(refused("it must be NAME > NUMBER or NAME < NUMBER")),
        };
        let (name, number) = (text[..at].trim(), text[at + 1..].trim());
        let bound = number.parse().ok().filter(|bound: &f64| bound.is_finite());
        let bound = bound.ok_or_else(|| refused(&format!("{number:?} is not a number")))?;
        let named = NUMBERS.into_iter().find(|(known, _)| *known == name).map(|(_, read)| Quantity::Named(read));
        let counter = || Some(Quantity::Counter(name.strip_prefix(COUNTERS)?.to_owned()));
        let quantity = named.or_else(|| Measure::named(name).map(Quantity::Error)).or_else(counter);
        let quantity = quantity.ok_or_else(|| refused(&format!("no row has {name:?}")))?;
        Ok(Self { text: text.trim().to_owned(), quantity, is_above, bound })
    }

    fn found(&self, row: &BenchRow) -> Option<Number> {
        match &self.quantity {
            Quantity::Named(read) => read(row),
            Quantity::Error(measure) => row.best_known_errors().map(|errors| Number::exact((measure.value)(errors))),
            Quantity::Counter(name) => row.counters.as_ref()?.get(name).copied().map(Number::exact),
        }
    }

    fn holds(&self, Number { value, interval }: &Number) -> bool {
        let [low, high] = interval.unwrap_or([*value; 2]);
        if self.is_above { low > self.bound } else { high < self.bound }
    }

    /// Nothing that was measured, such as a shard without rows, is nothing to complain of.
    ///
    /// Errors: it holds of a row (exit code 1), which are named; no measured row has the number (2).
    pub fn require_false(&self, rows: &[BenchRow]) -> Result<()> {
        let all: Vec<(&BenchRow, Number)> = rows.iter().filter_map(|row| Some((row, self.found(row)?))).collect();
        if all.is_empty() && rows.iter().any(BenchRow::was_measured) {
            return Err(Error::request(format!("--fail-if {:?}: no row has it", self.text)));
        }
        let held: Vec<String> = all
            .iter()
            .filter(|(_, found)| self.holds(found))
            .map(|(row, Number { value, interval })| match interval {
                Some([low, high]) => format!("{} {value:.4} ({low:.4} to {high:.4})", row.title()),
                None => format!("{} {value}", row.title()),
            })
            .collect();
        match held.len() {
            0 => Ok(()),
            count => Err(Error::gate(format!(
                "--fail-if {:?}: it holds of {count} of {} rows: {}",
                self.text,
                all.len(),
                held.join("; ")
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::stats::Ratio;
    use crate::report::spread::Spread;

    fn row(variant: &str, mean: f64, interval: Option<[f64; 2]>) -> BenchRow {
        BenchRow {
            variant: variant.to_owned(),
            ratio: Some(Ratio { mean, interval, pairs: 3 }),
            frame_ms: Spread::of(&[7.0]),
            counters: Some([("lights".to_owned(), 12.0)].into()),
            ..BenchRow::default()
        }
    }

    #[test]
    fn a_condition_holds_where_the_whole_interval_is_over_it() {
        let rows = [row("a", 1.0, Some([1.0, 1.0])), row("b", 1.2, Some([1.1, 1.3])), row("c", 1.3, Some([0.9, 1.8]))];
        let failed = |text: &str| Condition::parse(text).unwrap().require_false(&rows).err();
        let error = failed("time_ratio > 1.05").unwrap();
        assert_eq!(error.exit_code(), 1);
        let said = error.message();
        assert!(said.contains("1 of 3 rows: b 1.2000 (1.1000 to 1.3000)") && !said.contains("c 1.3"), "{said}");
        for passed in ["time_ratio > 1.1", "time_ratio < 0.9", "median_ms > 7", "median_ms < 7", "counters.lights>12"] {
            assert!(failed(passed).is_none(), "{passed}");
        }
        for held in ["time_ratio<1.01", "median_ms > 6.9", "counters.lights < 13"] {
            assert_eq!(failed(held).unwrap().exit_code(), 1, "{held}");
        }
        // What was not measured is not judged.
        let skipped = BenchRow { skipped: Some("it cannot be".to_owned()), ..BenchRow::default() };
        for none in [&[][..], &[skipped]] {
            assert!(Condition::parse("time_ratio > 1.05").unwrap().require_false(none).is_ok());
        }
        // Without an interval the number itself counts.
        assert!(Condition::parse("time_ratio > 1.05").unwrap().require_false(&[row("d", 1.06, None)]).is_err());
        for unknown in ["rmse > 0", "counters.nothing > 1", "planned_bytes > 1"] {
            assert_eq!(failed(unknown).unwrap().exit_code(), 2, "{unknown}");
        }
    }

    #[test]
    fn what_is_no_condition_is_refused() {
        for text in
            ["", "time_ratio", "time_ratio = 1", "time_ratio > ", "time_ratio > nan", "nothing > 1", "1 < a > 2"]
        {
            let error = Condition::parse(text).err().unwrap_or_else(|| panic!("{text}"));
            assert!(error.exit_code() == 2 && error.to_string().contains("counters.NAME"), "{error}");
        }
    }
}
