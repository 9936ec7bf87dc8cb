//! The flags that judge an error: what `compare` and everything with a `--reference` share.

use crate::error::{Error, Result};
use crate::metrics::gate::{Bound, Gate};
use crate::metrics::{DEFAULT_THRESHOLD, Metrics};
use clap::{Arg, ArgAction, ArgMatches, Command};

/// Adds --max, --min and --threshold.
pub fn with_gate_args(command: Command) -> Command {
    let gate = |bound: Bound, help: String| {
        let name = bound.name();
        Arg::new(name).long(name).value_name("METRIC=VALUE").action(ArgAction::Append).help(help)
    };
    let threshold = Arg::new("threshold").long("threshold").value_name("T").allow_negative_numbers(true).help(format!(
        "HDR-FLIP error, 0 to 1, above which a pixel counts in over_threshold [default: {DEFAULT_THRESHOLD}]"
    ));
    let names = Metrics::NAMES.join(", ");
    command
        .arg(gate(Bound::Max, format!("Fail when METRIC ({names}) is above VALUE; may be repeated")))
        .arg(gate(Bound::Min, "Fail when METRIC is below VALUE; may be repeated".to_owned()))
        .arg(threshold)
}

/// The gates in the order max, min, each as given.
///
/// Errors: no such metric, or no number (exit code 2).
pub fn gates(matches: &ArgMatches) -> Result<Vec<Gate>> {
    [Bound::Max, Bound::Min]
        .into_iter()
        .flat_map(|bound| {
            let arguments = matches.get_many::<String>(bound.name()).into_iter().flatten();
            arguments.map(move |argument| Gate::parse(bound.name(), bound, argument))
        })
        .collect()
}

/// Errors: it is not a number from 0 to 1 (exit code 2).
pub fn threshold(matches: &ArgMatches) -> Result<f64> {
    let Some(text) = matches.get_one::<String>("threshold") else { return Ok(DEFAULT_THRESHOLD) };
    text.parse().ok().filter(|threshold| (0.0..=1.0).contains(threshold)).ok_or_else(|| {
        Error::request(format!("--threshold {text}: it must be an HDR-FLIP error, 0 to 1"))
            .note(format!("the default is {DEFAULT_THRESHOLD}"))
    })
}
