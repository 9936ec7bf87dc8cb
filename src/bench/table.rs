//! Rows as a table: which columns a benchmark has, in plain text or Markdown.

use super::row::{BenchRow, Beside};
use super::stats::Ratio;
use super::units;
use super::what::What;
use crate::techniques::bench_stage::Unit;
use crate::units::Bytes;

/// Mark of the Pareto set.
pub const MARK: &str = "*";

/// How much of what a row is called a table shows: kept rows come from a file, and a column is padded to 65,535 at most.
const MOST_NAME_CHARS: usize = 1000;

/// What a column says of a row; None where it says nothing.
type Cell = Box<dyn Fn(&BenchRow) -> Option<String>>;

/// One column: a title, and what it says of a row.
struct Column {
    title: &'static str,
    cell: Cell,
    /// Left out where it says nothing of any row.
    is_optional: bool,
}

impl Column {
    fn new(title: &'static str, cell: impl Fn(&BenchRow) -> Option<String> + 'static) -> Self {
        Self { title, cell: Box::new(cell), is_optional: false }
    }

    fn optional(title: &'static str, cell: impl Fn(&BenchRow) -> Option<String> + 'static) -> Self {
        Self { is_optional: true, ..Self::new(title, cell) }
    }
}

/// Title and cells, all rows of one length; the first column is what a row is called.
pub struct Table {
    lines: Vec<Vec<String>>,
}

fn fixed(value: f64, digits: usize) -> String {
    format!("{value:.digits$}")
}

/// A paired ratio with its interval.
pub fn ratio(ratio: &Ratio) -> String {
    let mean = fixed(ratio.mean, 3);
    match ratio.interval {
        Some([low, high]) => format!("{mean} ({} to {})", fixed(low, 3), fixed(high, 3)),
        None => mean,
    }
}

fn bytes(bytes: u64) -> String {
    Bytes(bytes).to_string()
}

/// Read and written.
fn moved(row: &BenchRow) -> Option<String> {
    // Kept rows come from a file: their sum may be any.
    row.bytes_read?.checked_add(row.bytes_written?).map(bytes)
}

fn beside(entry: &Option<Beside>) -> Option<String> {
    entry.as_ref()?.ratio().map(ratio)
}

/// The columns of what is particular to `what`.
fn own_columns(what: What) -> Vec<Column> {
    let mut units: Vec<Unit> = Vec::new();
    for count in what.stages().iter().flat_map(|(_, stage)| stage.counts()) {
        if !units.contains(&count.unit) {
            units.push(count.unit);
        }
    }
    let mut columns = Vec::new();
    if what == What::Frame || units.contains(&Unit::Evaluation) {
        let texels = |row: &BenchRow| row.settings.get("texels")?.as_f64().map(|texels| texels.to_string());
        columns.push(Column::optional("texels a thread", texels));
    }
    if what.copies() {
        columns.extend([
            Column::new("to identity (95 %)", |row| beside(&row.identity)),
            Column::new("to copy buffer (95 %)", |row| beside(&row.copy)),
            Column::new("GB/s", |row| row.copied_gb_per_s.map(|gb| fixed(gb, 2))),
            Column::new("copied", |row| row.copied_bytes.map(bytes)),
        ]);
    }
    columns.extend(units.into_iter().map(|unit| {
        let (title, digits) = units::column(unit);
        Column::optional(title, move |row| row.unit_times.get(unit).map(|ns| fixed(ns, digits)))
    }));
    if what == What::Frame {
        let overhead = |row: &BenchRow| row.overhead_evaluations_per_pixel.map(|count| fixed(count, 2));
        columns.push(Column::new("overhead, evals/pixel", overhead));
    }
    columns
}

fn columns(what: What) -> Vec<Column> {
    let mut columns = vec![
        Column::new("median ms", |row| row.times_ms().map(|times| fixed(times.median, 3))),
        Column::new("time ratio (95 %)", |row| row.ratio.as_ref().map(ratio)),
    ];
    if what == What::Frame {
        columns.extend([
            Column::optional("tree ms", |row| row.frame_parts_ms.map(|parts| fixed(parts.tree, 3))),
            Column::optional("flicker", |row| row.flicker.map(|flicker| fixed(flicker, 5))),
            Column::optional("flicker of error", |row| row.flicker_error.map(|flicker| fixed(flicker, 5))),
        ]);
    }
    columns.extend(own_columns(what));
    columns.extend([
        Column::new("moved", moved),
        Column::new("memory peak", |row| row.memory.as_ref().map(|memory| bytes(memory.peak_bytes))),
        Column::new("rmse", |row| row.best_known_errors().map(|errors| fixed(errors.rmse, 5))),
        Column::new("flip", |row| row.best_known_errors().map(|errors| fixed(errors.flip, 4))),
        Column::new("Pareto", |row| (row.pareto == Some(true)).then(|| MARK.to_owned())),
        Column::optional("machine", |row| row.is_busy().then(|| "busy".to_owned())),
    ]);
    columns
}

impl Table {
    /// A table of the rows that were measured.
    pub fn new(what: What, rows: &[BenchRow]) -> Self {
        let measured = || rows.iter().filter(|row| row.was_measured());
        let mut columns = columns(what);
        columns.retain(|column| !column.is_optional || measured().any(|row| (column.cell)(row).is_some()));
        let titles = std::iter::once("variant").chain(columns.iter().map(|column| column.title));
        let mut lines = vec![titles.map(str::to_owned).collect::<Vec<_>>()];
        for row in measured() {
            let name = row.title().chars().take(MOST_NAME_CHARS).collect();
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
