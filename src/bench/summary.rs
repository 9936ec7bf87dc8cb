//! The summary of a sweep: all its rows with the Pareto set marked, the best blocks, what was skipped and why.

use super::machine::{BUSY_SHARE, is_busy};
use super::stats::LEAST_PAIRS;
use super::sweep::Axis;
use super::table::{MARK, Table};
use super::what::What;
use super::{blocks, pareto};
use crate::error::Result;
use crate::whole_file::write_whole;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// A finished sweep, or the part of it that was.
pub struct Summary {
    what: What,
    rows: Vec<Value>,
    best_blocks: Vec<Value>,
    command: Vec<String>,
}

impl Summary {
    /// `rows`: at least one, in the order of the grid; `command`: the argv that repeats it.
    pub fn new(what: What, axes: &[Axis], mut rows: Vec<Value>, command: &[String]) -> Self {
        pareto::mark(&mut rows);
        // Where a stage is no copy, its blocks are another's choice.
        let best_blocks = if what.copies() { blocks::best(axes, &rows) } else { Vec::new() };
        Self { what, rows, best_blocks, command: command.to_vec() }
    }

    pub fn json(&self) -> Value {
        let first = &self.rows[0];
        json!({
            "schema": 1,
            "bench": self.what.name(),
            "command": self.command,
            "device": first["device"],
            "commit": first["commit"],
            "scene": first["scene"],
            "technique": first["technique"],
            "baseline": first["baseline"],
            "repeat": first["repeat"],
            "pareto_of": ["ratio.mean", if first["reference"].is_null() { "error_against_none.rmse" } else { "errors.rmse" }],
            "rows": self.rows,
            "best_blocks": self.best_blocks,
        })
    }

    /// What a terminal shows.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n{}\n\n{}", self.place(), self.legend(), Table::new(self.what, &self.rows).text());
        for line in self.notes() {
            text.push_str(&line);
            text.push('\n');
        }
        text
    }

    pub fn markdown(&self) -> String {
        let title = format!("bench {}: {}", self.what.name(), self.place());
        let table = Table::new(self.what, &self.rows).markdown();
        let mut text = format!("# {title}\n\n{}\n\n    {}\n\n{table}", self.legend(), self.command.join(" "));
        let notes = self.notes();
        if !notes.is_empty() {
            text.push('\n');
        }
        for line in notes {
            text.push_str(&format!("- {line}\n"));
        }
        text
    }

    /// Writes `summary.json` and `summary.md`.
    ///
    /// Errors: they cannot be written (exit code 2).
    pub fn write(&self, folder: &Path) -> Result<()> {
        write_whole(&folder.join("summary.json"), |out| writeln!(out, "{:#}", self.json()))?;
        write_whole(&folder.join("summary.md"), |out| out.write_all(self.markdown().as_bytes()))
    }

    fn place(&self) -> String {
        let first = &self.rows[0];
        let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let device = &first["device"];
        let software = if device["type"] == "cpu" { ", software driver" } else { "" };
        format!(
            "{} on {} ({}{software})",
            word(&first["scene"]["name"]),
            word(&device["name"]),
            word(&device["driver_info"])
        )
    }

    fn legend(&self) -> String {
        let baseline = self.rows[0]["baseline"].as_str().unwrap_or_default();
        let errors = self.rows[0]["reference"]["name"].as_str().unwrap_or("--split none");
        let rounds = &self.rows[0]["repeat"];
        let told = match rounds.as_u64() {
            Some(few) if few < LEAST_PAIRS as u64 => {
                format!("below {LEAST_PAIRS} rounds no interval is printed, and no two rows are told apart")
            }
            _ => format!("{MARK}: no row with at most its rmse is faster by the interval of their ratio"),
        };
        format!("time ratios to {baseline}, of {rounds} rounds; errors against {errors}; {told}")
    }

    fn notes(&self) -> Vec<String> {
        let skipped = self.rows.iter().filter_map(|row| {
            let reason = row["skipped"].as_str()?;
            Some(format!("skipped {}: {reason}", row["variant"].as_str().unwrap_or_default()))
        });
        self.best_blocks.iter().map(blocks::sentence).chain(self.untold()).chain(self.busy()).chain(skipped).collect()
    }

    /// Rows that are in the Pareto set because there were too few rounds.
    fn untold(&self) -> Option<String> {
        let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let pair = |row: &Value| {
            let rivals: Vec<String> = row["pareto_not_told_from"].as_array()?.iter().map(word).collect();
            Some(format!("{} ({})", word(&row["variant"]), rivals.join(", ")))
        };
        let pairs: Vec<String> = self.rows.iter().filter_map(pair).collect();
        let which = pairs.join("; ");
        (!pairs.is_empty()).then(|| {
            format!("marked because the rounds do not prove that a rival with a shorter time is faster: {which}")
        })
    }

    /// Rows whose times others have had a part in.
    fn busy(&self) -> Option<String> {
        let count = self.rows.iter().filter(|row| is_busy(row)).count();
        let all = self.rows.iter().filter(|row| row["skipped"].is_null()).count();
        let percent = 100.0 * BUSY_SHARE;
        (count > 0).then(|| {
            format!(
                "{count} of {all} rows were measured while the machine was busy: over {percent} % of its processors' time \
                 went to others; measure them again when it is not"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(variant: &str, ratio: f64, rmse: f64) -> Value {
        json!({
            "variant": variant,
            "baseline": "a",
            "repeat": 5,
            "scene": { "name": "box" },
            "device": { "name": "d", "type": "cpu", "driver_info": "i" },
            "ratio": { "mean": ratio, "interval_95": [0.9 * ratio, 1.1 * ratio] },
            "error_against_none": { "rmse": rmse },
        })
    }

    #[test]
    fn a_kept_row_may_say_anything() {
        let mut kept = row("a", 1e308, f64::MAX);
        kept["bytes_read"] = json!(u64::MAX);
        kept["bytes_written"] = json!(u64::MAX);
        // Longer than a column can be padded to.
        kept["variant"] = json!("x".repeat(70_000));
        kept["settings"] = json!([1, { "block": null }]);
        let rows = vec![kept, json!({}), json!({ "ratio": 7, "device": [] })];
        for what in [What::Frame, What::Split, What::Shade] {
            let summary = Summary::new(what, &[], rows.clone(), &[]);
            assert!(summary.text().contains("xxx") && summary.markdown().contains("xxx"));
        }
    }

    #[test]
    fn a_summary_marks_the_pareto_set_and_says_what_was_skipped() {
        let mut skipped = row("c", 0.0, 0.0);
        skipped["skipped"] = json!("it cannot be");
        skipped["ratio"] = Value::Null;
        let rows = vec![row("a", 1.0, 0.0), row("b", 2.0, 0.0), skipped];
        let summary = Summary::new(What::Frame, &[], rows, &["quincunx".to_owned()]);
        let marks: Vec<&Value> = summary.rows.iter().map(|row| &row["pareto"]).collect();
        assert_eq!(marks, [&json!(true), &Value::Null, &Value::Null]);
        let text = summary.text();
        assert!(text.starts_with("box on d (i, software driver)\n"), "{text}");
        assert!(text.contains("skipped c: it cannot be") && !text.contains("busy"), "{text}");
        let lines: Vec<&str> = text.lines().filter(|line| line.ends_with(MARK)).collect();
        assert!(lines.len() == 1 && lines[0].starts_with("a "), "{text}");
        assert!(summary.markdown().contains("| variant | median ms |"), "{}", summary.markdown());
        assert_eq!(summary.json()["rows"].as_array().unwrap().len(), 3);
    }

    #[test]
    fn two_rounds_tell_nothing_and_say_so() {
        let few = |mut row: Value| {
            row["repeat"] = json!(2);
            row["ratio"]["interval_95"] = Value::Null;
            row
        };
        let summary = Summary::new(What::Frame, &[], vec![few(row("a", 1.0, 0.0)), few(row("b", 2.0, 0.0))], &[]);
        let text = summary.text();
        assert!(text.contains("below 3 rounds no interval is printed, and no two rows are told apart"), "{text}");
        assert!(text.lines().all(|line| !line.ends_with(MARK)), "{text}");
    }

    #[test]
    fn rows_of_a_busy_machine_are_marked_and_counted() {
        let mut busy = row("a", 1.0, 0.0);
        busy["machine"] = json!({ "other_cpu_share": 0.2, "steal_share": 0.0, "busy": true });
        let text = Summary::new(What::Shade, &[], vec![busy, row("b", 2.0, 0.0)], &[]).text();
        assert!(text.contains("1 of 2 rows were measured while the machine was busy: over 5 %"), "{text}");
        let lines: Vec<&str> = text.lines().filter(|line| line.ends_with("  busy")).collect();
        assert!(lines.len() == 1 && lines[0].starts_with("a "), "{text}");
    }

    #[test]
    fn rows_that_rounds_do_not_tell_apart_are_named() {
        let text = Summary::new(What::Frame, &[], vec![row("a", 1.0, 0.0), row("b", 1.05, 0.1)], &[]).text();
        assert!(
            text.contains("marked because the rounds do not prove that a rival with a shorter time is faster: b (a)"),
            "{text}"
        );
    }
}
