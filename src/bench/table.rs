//! Rows as a table: which columns a benchmark has, in plain text or Markdown.

use super::machine::is_busy;
use super::pareto::errors;
use super::what::What;
use crate::units::Bytes;
use serde_json::Value;

/// Mark of the Pareto set.
pub const MARK: &str = "*";

/// How much of a variant's name a table shows: kept rows come from a file, and a column is padded to 65,535 at most.
const MOST_NAME_CHARS: usize = 1000;

/// One column: a title, and what it says of a row.
struct Column {
    title: &'static str,
    cell: fn(&Value) -> Option<String>,
    /// Left out where it says nothing of any row.
    is_optional: bool,
}

impl Column {
    fn new(title: &'static str, cell: fn(&Value) -> Option<String>) -> Self {
        Self { title, cell, is_optional: false }
    }

    fn optional(title: &'static str, cell: fn(&Value) -> Option<String>) -> Self {
        Self { is_optional: true, ..Self::new(title, cell) }
    }
}

/// Title and cells, all rows of one length; the first column is the variant's name.
pub struct Table {
    lines: Vec<Vec<String>>,
}

fn fixed(value: &Value, digits: usize) -> Option<String> {
    value.as_f64().map(|value| format!("{value:.digits$}"))
}

/// A paired ratio with its interval.
pub fn ratio(entry: &Value) -> Option<String> {
    let mean = fixed(&entry["mean"], 3)?;
    let side = |index: usize| fixed(&entry["interval_95"][index], 3);
    Some(match (side(0), side(1)) {
        (Some(low), Some(high)) => format!("{mean} ({low} to {high})"),
        _ => mean,
    })
}

fn bytes(value: &Value) -> Option<String> {
    value.as_u64().map(|bytes| Bytes(bytes).to_string())
}

/// Read and written.
fn moved(row: &Value) -> Option<String> {
    // Kept rows come from a file: their sum may be any.
    let sum = row["bytes_read"].as_u64()?.checked_add(row["bytes_written"].as_u64()?)?;
    Some(Bytes(sum).to_string())
}

fn columns(what: What) -> Vec<Column> {
    let median: fn(&Value) -> Option<String> = match what {
        What::Frame => |row| fixed(&row["frame_ms"]["median"], 3),
        _ => |row| fixed(&row["stage_ms"]["median"], 3),
    };
    let mut columns =
        vec![Column::new("median ms", median), Column::new("time ratio (95 %)", |row| ratio(&row["ratio"]))];
    let texels =
        || Column::optional("texels a thread", |row| row["settings"]["texels"].as_u64().map(|one| one.to_string()));
    columns.extend(match what {
        What::Split | What::Gather => vec![
            Column::new("to identity (95 %)", |row| ratio(&row["identity"])),
            Column::new("to copy buffer (95 %)", |row| ratio(&row["copy"])),
            Column::new("GB/s", |row| fixed(&row["copied_gb_per_s"], 2)),
            Column::new("copied", |row| bytes(&row["copied_bytes"])),
        ],
        What::Shade => vec![texels(), Column::new("ns/evaluation", |row| fixed(&row["ns_per_evaluation"], 3))],
        What::Filter => vec![
            Column::new("ns/pixel", |row| fixed(&row["ns_per_pixel"], 2)),
            Column::new("ns/tap", |row| fixed(&row["ns_per_tap"], 3)),
        ],
        What::Frame => {
            vec![texels(), Column::new("overhead, evals/pixel", |row| fixed(&row["overhead_evaluations_per_pixel"], 2))]
        }
    });
    columns.extend([
        Column::new("moved", moved),
        Column::new("memory peak", |row| bytes(&row["memory"]["peak_bytes"])),
        Column::new("rmse", |row| fixed(&errors(row)["rmse"], 5)),
        Column::new("flip", |row| fixed(&errors(row)["flip"], 4)),
        Column::new("Pareto", |row| (row["pareto"] == true).then(|| MARK.to_owned())),
        Column::optional("machine", |row| is_busy(row).then(|| "busy".to_owned())),
    ]);
    columns
}

impl Table {
    /// A table of the rows that were measured.
    pub fn new(what: What, rows: &[Value]) -> Self {
        let measured = || rows.iter().filter(|row| row["skipped"].is_null());
        let mut columns = columns(what);
        columns.retain(|column| !column.is_optional || measured().any(|row| (column.cell)(row).is_some()));
        let titles = std::iter::once("variant").chain(columns.iter().map(|column| column.title));
        let mut lines = vec![titles.map(str::to_owned).collect::<Vec<_>>()];
        for row in measured() {
            let name = row["variant"].as_str().unwrap_or_default().chars().take(MOST_NAME_CHARS).collect();
            let cells = columns.iter().map(|column| (column.cell)(row).unwrap_or_else(|| "-".to_owned()));
            lines.push(std::iter::once(name).chain(cells).collect());
        }
        Self { lines }
    }

    /// A table of these lines, titles first: at least one, all with the same number of cells.
    pub fn of_lines(lines: Vec<Vec<String>>) -> Self {
        Self { lines }
    }

    /// In columns of spaces.
    pub fn text(&self) -> String {
        let width = |column: usize| self.lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.lines[0].len()).map(width).collect();
        let mut text = String::new();
        for line in &self.lines {
            let mut out = format!("{:<1$}", line[0], widths[0]);
            for (cell, width) in line.iter().zip(&widths).skip(1) {
                out.push_str(&format!("  {cell:>width$}"));
            }
            text.push_str(out.trim_end());
            text.push('\n');
        }
        text
    }

    pub fn markdown(&self) -> String {
        let mut text = String::new();
        for (index, line) in self.lines.iter().enumerate() {
            // A bar in a name would end the cell.
            let cells: Vec<String> = line.iter().map(|cell| cell.replace('|', "\\|")).collect();
            text.push_str(&format!("| {} |\n", cells.join(" | ")));
            if index == 0 {
                text.push_str(&format!("| --- |{}\n", " ---: |".repeat(line.len() - 1)));
            }
        }
        text
    }
}
