//! Rows as a table that other programs read: `rows.csv`, a line a row, one column a setting that was typed.

use super::numbers::NUMBERS;
use super::row::BenchRow;
use crate::error::Result;
use crate::whole_file::write_whole;
use std::collections::BTreeSet;
use std::path::Path;

/// Its name in the folder of `-o`.
pub const NAME: &str = "rows.csv";

/// A column: its title, and what it says of a row; empty where that is nothing.
type Column = (&'static str, fn(&BenchRow) -> Option<String>);

const BEFORE: [Column; 5] = [
    ("bench", |row| Some(row.bench.clone())),
    ("scene", |row| Some(row.scene.name.clone())),
    ("technique", |row| Some(row.technique.clone())),
    ("variant", |row| Some(row.variant.clone())),
    ("name", |row| row.name.clone()),
];

/// Behind these come the `NUMBERS` of a row.
const BEHIND: [Column; 13] = [
    ("device", |row| Some(row.device.as_ref()?.name.clone())),
    ("commit", |row| Some(row.commit.clone())),
    ("repeat", |row| Some(row.repeat.to_string())),
    ("baseline", |row| Some(row.baseline.clone())),
    ("min_ms", |row| Some(row.times_ms()?.min.to_string())),
    ("max_ms", |row| Some(row.times_ms()?.max.to_string())),
    ("time_ratio_low", |row| Some(row.interval()?[0].to_string())),
    ("time_ratio_high", |row| Some(row.interval()?[1].to_string())),
    ("rmse", |row| Some(row.best_known_errors()?.rmse.to_string())),
    ("flip", |row| Some(row.best_known_errors()?.flip.to_string())),
    ("bytes_read", |row| Some(row.bytes_read?.to_string())),
    ("bytes_written", |row| Some(row.bytes_written?.to_string())),
    ("skipped", |row| row.skipped.clone()),
];

/// Writes all of `rows`.
///
/// Errors: the file cannot be written (exit code 2).
pub fn write(folder: &Path, rows: &[BenchRow]) -> Result<()> {
    let keys: BTreeSet<&str> = rows.iter().flat_map(|row| row.asked().keys().map(String::as_str)).collect();
    write_whole(&folder.join(NAME), |out| {
        let mut table = csv::Writer::from_writer(out);
        let titles = |columns: &'static [Column]| columns.iter().map(|(title, _)| (*title).to_owned());
        let settings = keys.iter().map(|key| format!("--{key}"));
        let numbers = NUMBERS.map(|(name, _)| name.to_owned());
        table.write_record(titles(&BEFORE).chain(settings).chain(titles(&BEHIND)).chain(numbers))?;
        for row in rows {
            let cells = |columns: &'static [Column]| columns.iter().map(|(_, cell)| cell(row).unwrap_or_default());
            let settings = keys.iter().map(|key| row.asked_text(key));
            let numbers = NUMBERS.map(|(_, read)| read(row).map(|number| number.value.to_string()).unwrap_or_default());
            table.write_record(cells(&BEFORE).chain(settings).chain(cells(&BEHIND)).chain(numbers))?;
        }
        table.flush().map_err(csv::Error::from)
    })
}
