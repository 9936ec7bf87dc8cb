//! Passes of a report held against what the device can do: the least time that their bytes take, as a share of the time that they took.

use crate::bench::table::Table;
use crate::error::{Error, Result};
use crate::report::run::{PassRow, RunReport};
use crate::report::work_row::WorkRow;
use serde::Serialize;

/// Shares above this are impossible: what is measured here is not exact.
const IMPOSSIBLE_FROM: f64 = 1.1;

/// A pass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explained {
    pub pass: String,
    /// Median milliseconds.
    pub ms: f64,
    /// Milliseconds that its bytes take at least, from and to memory.
    pub least_ms: f64,
    /// `least_ms` in parts of `ms`.
    pub share: f64,
    /// Whether it would move more than the device moves: what it says of its bytes is not so, or caches have held them.
    #[serde(rename = "impossible")]
    pub is_impossible: bool,
}

/// What the device moves at most.
struct Limits {
    read_gb_per_s: f64,
    write_gb_per_s: f64,
    /// Both ways together.
    copy_gb_per_s: f64,
}

impl Limits {
    /// None where there is no such work among the rows.
    fn of(rows: &[WorkRow]) -> Option<Self> {
        let best = |works: &[&str]| {
            let known = rows.iter().filter(|row| works.contains(&row.work.as_str())).map(|row| row.gb_per_s);
            known.reduce(f64::max)
        };
        Some(Self {
            read_gb_per_s: best(&["read"])?,
            write_gb_per_s: best(&["write", "clear"])?,
            copy_gb_per_s: best(&["shader copy", "copy command"])?,
        })
    }

    fn least_ms(&self, read_bytes: u64, written_bytes: u64) -> f64 {
        let ms = |bytes: u64, gb_per_s: f64| bytes as f64 / gb_per_s / 1e6;
        let [reads, writes] = [ms(read_bytes, self.read_gb_per_s), ms(written_bytes, self.write_gb_per_s)];
        // What only reads is not bound by what copies do.
        let both = if read_bytes > 0 && written_bytes > 0 {
            ms(2 * read_bytes.min(written_bytes), self.copy_gb_per_s.max(self.read_gb_per_s).max(self.write_gb_per_s))
        } else {
            0.0
        };
        reads.max(writes).max(both)
    }
}

/// The timed passes of a report.
///
/// Errors: it has no times of passes, or is of another device (exit code 2).
pub fn explained(report: &RunReport, rows: &[WorkRow]) -> Result<Vec<Explained>> {
    let limits = Limits::of(rows).ok_or_else(|| Error::request("the device's rows lack read, write or copy"))?;
    let device = rows.first().map(|row| &row.device);
    if device != Some(&report.device.identity) {
        let (theirs, ours) = (&report.device.identity.name, device.map_or("", |device| device.name.as_str()));
        return Err(Error::request(format!("the report is of {theirs}, and the device is {ours}")));
    }
    let pass = |pass: &PassRow| {
        let ms = pass.ms.as_ref()?.as_ref()?.median;
        let least_ms = limits.least_ms(pass.bytes_read??, pass.bytes_written??);
        let share = least_ms / ms;
        Some(Explained { pass: pass.name.clone(), ms, least_ms, share, is_impossible: share > IMPOSSIBLE_FROM })
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
    let mut lines = vec![["pass", "ms", "its bytes take", "share", ""].map(str::to_owned).to_vec()];
    lines.extend(passes.iter().map(|pass| {
        let remark = if pass.is_impossible { "impossible: not all of these bytes came from memory" } else { "" };
        let share = format!("{:.1} %", 100.0 * pass.share);
        vec![pass.pass.clone(), format!("{:.3}", pass.ms), format!("{:.3}", pass.least_ms), share, remark.to_owned()]
    }));
    Table::of_lines(lines).text()
}
