//! Passes of a report held against what the device can do: the least time that they take, as a share of the time that they took.

use crate::bench::table::Table;
use crate::error::{Error, Result};
use crate::report::roofline::{Least, Roofline};
use crate::report::run::{PassRow, RunReport};
use serde::Serialize;

/// A pass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explained {
    pub pass: String,
    /// Median milliseconds.
    pub ms: f64,
    #[serde(flatten)]
    pub least: Least,
}

/// The timed passes of a report.
///
/// Errors: it has no times of passes, or is of another device (exit code 2).
pub fn explained(report: &RunReport, roofline: &Roofline) -> Result<Vec<Explained>> {
    roofline.require(&report.device.identity, "the device of the report")?;
    let pass = |pass: &PassRow| {
        let (ms, least) = (pass.median_ms()?, pass.least_under(roofline)?);
        Some(Explained { pass: pass.name.clone(), ms, least })
    };
    let passes: Vec<Explained> = report.times.passes.iter().filter_map(pass).collect();
    if passes.is_empty() {
        return Err(
            Error::request("the report has no times of passes").note("render --profile --report FILE.json has them")
        );
    }
    Ok(passes)
}

/// The passes as a table.
pub fn text(passes: &[Explained]) -> String {
    let mut lines = vec![["pass", "ms", "at least", "share", "by", ""].map(str::to_owned).to_vec()];
    lines.extend(passes.iter().map(|Explained { pass, ms, least }| {
        vec![
            pass.clone(),
            format!("{ms:.3}"),
            format!("{:.3}", least.least_ms),
            format!("{:.1} %", 100.0 * least.share),
            least.bound.name().to_owned(),
            least.remark().to_owned(),
        ]
    }));
    Table::of_lines(lines).text()
}
