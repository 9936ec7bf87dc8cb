//! The rows of a sweep as one HTML file that needs nothing else: error against time, heat maps of pairs of axes, pictures, and a table that
//! sorts.

mod heat;
mod scatter;

use super::numbers::{NUMBERS, Number};
use super::row::BenchRow;
use super::sweep::Axis;
use super::table;
use crate::error::Result;
use crate::metrics::Metrics;
use crate::page::{self, pictures};
use crate::report::command_line::command_line;
use maud::{Markup, html};
use std::path::{Path, PathBuf};

/// What a page shows.
pub struct Shown<'a> {
    /// What was measured, where.
    pub title: &'a str,
    /// What ratios and errors are to.
    pub legend: &'a str,
    /// What a reader should know, a sentence an entry.
    pub notes: &'a [String],
    pub command: &'a [String],
    pub axes: &'a [Axis],
    pub rows: &'a [BenchRow],
    /// Where the rows are, and below it their pictures.
    pub folder: &'a Path,
}

/// The file of a row's picture in the folder of its sweep, whether it is there or not; None of a row without a picture. Equal pictures
/// share one.
pub fn picture_file(folder: &Path, row: &BenchRow) -> Option<PathBuf> {
    const DIGITS: usize = 16;
    let hash = row.image_hash.as_ref()?;
    let is_hash = hash.len() >= DIGITS && hash.bytes().all(|letter| letter.is_ascii_hexdigit());
    is_hash.then(|| folder.join("pictures").join(format!("{}.png", &hash[..DIGITS])))
}

/// The page.
///
/// Errors: a picture cannot be read (exit code 2).
pub fn text(shown: &Shown<'_>) -> Result<String> {
    let pictures = pictures(shown)?;
    let body = html! {
        p.note { (shown.legend) ". Made by " code { "quincunx bench" } "." }
        pre { (command_line(shown.command)) }
        @for measure in ["flip", "rmse"] { @if let Some(plot) = scatter::plot(measure, shown.rows) { (plot) } }
        @for map in heat::maps(shown.axes, shown.rows) { (map) }
        (pictures)
        h2 { "Rows" }
        (rows(shown.rows))
        @for note in shown.notes { p.note { (note) } }
    };
    Ok(page::document(shown.title, &body))
}

/// Pictures of rows, one of each hash, that are there.
fn pictures(shown: &Shown<'_>) -> Result<Markup> {
    let mut files: Vec<(String, PathBuf)> = Vec::new();
    for row in shown.rows {
        let Some(file) = picture_file(shown.folder, row).filter(|file| file.is_file()) else { continue };
        match files.iter_mut().find(|(_, known)| *known == file) {
            Some((title, _)) => title.push_str(&format!("; {}", row.title())),
            None => files.push((row.title().to_owned(), file)),
        }
    }
    let markup = pictures::markup(files.iter().map(|(title, path)| (title.as_str(), path.clone())))?;
    Ok(html! { @if !files.is_empty() { h2 { "Pictures" } } (markup) })
}

fn rows(rows: &[BenchRow]) -> Markup {
    let has_errors = rows.iter().any(|row| row.best_known_errors().is_some());
    let measures = if has_errors { Metrics::MEASURES } else { &[] };
    let mut columns = vec![("variant", false), ("Pareto set", false)];
    columns.extend(NUMBERS.iter().map(|(name, _)| (*name, true)));
    columns.extend(measures.iter().map(|measure| (measure.title, true)));
    columns.push(("why it was not measured", false));
    let word = |text: &str| (html! { (text) }, None);
    let row = |row: &BenchRow| {
        let mut cells = vec![word(row.title()), word(if row.pareto == Some(true) { table::MARK } else { "" })];
        cells.extend(NUMBERS.iter().map(|(_, read)| number(read(row))));
        let errors = row.best_known_errors();
        cells
            .extend(measures.iter().map(|measure| number(errors.map(|errors| Number::exact((measure.value)(errors))))));
        cells.push(word(row.skipped.as_deref().unwrap_or_default()));
        cells
    };
    page::table(&columns, &rows.iter().map(row).collect::<Vec<_>>())
}

fn number(number: Option<Number>) -> (Markup, Option<f64>) {
    let Some(Number { value, interval }) = number.filter(|number| number.value.is_finite()) else {
        return (html! {}, None);
    };
    let text = match interval {
        Some([low, high]) => format!("{value:.3} ({low:.3} to {high:.3})"),
        None if value.fract() == 0.0 => format!("{value}"),
        None => format!("{value:.4}"),
    };
    (html! { (text) }, Some(value))
}
