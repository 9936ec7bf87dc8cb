//! The columns of a table that a reader sees, as text and as a page: those that say something of one of its numbers.

use super::digits::{digits, number};
use super::outcome::{CellOutcome, TableOutcome};

/// A column: its title, and what it says of a number.
pub struct Column {
    pub title: String,
    pub text: fn(&CellOutcome) -> String,
    /// What it sorts by; None where it is words.
    pub value: Option<fn(&CellOutcome) -> Option<f64>>,
}

/// The columns of `table`, which has a number, from the left.
pub fn columns(table: &TableOutcome) -> Vec<Column> {
    let words = |title: &str, text: fn(&CellOutcome) -> String| Column { title: title.to_owned(), text, value: None };
    let numbers = |title: String, text: fn(&CellOutcome) -> String, value: fn(&CellOutcome) -> Option<f64>| {
        let is_there = table.cells.iter().any(|cell| !text(cell).is_empty());
        is_there.then_some(Column { title, text, value: Some(value) })
    };
    let part = |of: &str| format!("{of}, in parts of {}", table.parts_of.as_deref().unwrap_or_default());
    let has_columns = table.cells.iter().any(|cell| cell.column != table.cells[0].column);
    let all = [
        Some(words(&table.title, |cell| cell.row.clone())),
        has_columns.then(|| words("column", |cell| cell.column.clone())),
        numbers(
            format!("published, {}", table.unit),
            |cell| cell.published.map(digits).unwrap_or_default(),
            |cell| cell.published,
        ),
        numbers(
            format!("ours, {}", table.unit),
            |cell| cell.ours.as_ref().map(number).unwrap_or_default(),
            |cell| cell.ours.map(|ours| ours.value),
        ),
        numbers(
            part("published"),
            |cell| cell.published_part.map(digits).unwrap_or_default(),
            |cell| cell.published_part,
        ),
        numbers(
            part("ours"),
            |cell| cell.our_part.as_ref().map(number).unwrap_or_default(),
            |cell| cell.our_part.map(|part| part.value),
        ),
        numbers(
            "ours in parts of the published".to_owned(),
            |cell| cell.ratio.as_ref().map(number).unwrap_or_default(),
            |cell| cell.ratio.map(|ratio| ratio.value),
        ),
    ];
    all.into_iter().flatten().collect()
}

/// Lines that say why numbers of ours are missing.
pub fn missing(table: &TableOutcome) -> impl Iterator<Item = String> {
    table.cells.iter().filter_map(|cell| Some(format!("{} {}: {}", cell.row, cell.column, cell.missing.as_ref()?)))
}
