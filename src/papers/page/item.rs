//! One item on the page.

use super::{dots, pictures};
use crate::error::Result;
use crate::papers::digits::{digits, number};
use crate::papers::outcome::{CellOutcome, Outcome, TableOutcome};
use maud::{Markup, html};
use std::path::Path;

/// What a link to it names.
pub fn anchor(outcome: &Outcome) -> String {
    let scene = outcome.scene.as_deref().unwrap_or_default();
    let kept = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '-' };
    format!("{}-{}-{scene}", outcome.paper, outcome.item).chars().map(kept).collect()
}

/// Verdict, tables, plots, pictures and commands.
///
/// Errors: a picture cannot be read (exit code 2).
pub fn markup(outcome: &Outcome, folder: &Path) -> Result<Markup> {
    let pictures = pictures::markup(outcome, folder)?;
    let device = outcome.device.as_ref().and_then(|device| device.get("name")?.as_str());
    let failed = || outcome.steps.iter().filter_map(|step| Some((&step.name, step.failed.as_ref()?)));
    Ok(html! {
        section id=(anchor(outcome)) {
            h2 { (outcome.paper) "/" (outcome.item) ": " (outcome.title) }
            p.cite { (outcome.citation) "; " (outcome.place) "." }
            p { span.verdict { (outcome.verdict) } " " (outcome.reason) }
            p.note {
                "Commit " code { (outcome.commit) } ", " (outcome.date)
                @if let Some(device) = device { ", " (device) }
                @if let Some(scene) = &outcome.scene { ", scene " code { (scene) } }
                ", " (outcome.effort) " effort."
            }
            @for one in outcome.tables.iter().filter(|table| !table.cells.is_empty()) {
                (table(one))
                @for plot in dots::plots(one) { (plot) }
            }
            (pictures)
            @for (name, reason) in failed() { p.failed { (name) " failed: " (reason) } }
            @if !outcome.steps.is_empty() {
                details {
                    summary { (outcome.steps.len()) " commands" }
                    @for step in &outcome.steps { pre { "quincunx " (step.command.join(" ")) } }
                }
            }
        }
    })
}

/// A column: its title, and what it says of a cell, as text and, where it sorts by it, as a number.
struct Column {
    title: String,
    text: fn(&CellOutcome) -> String,
    value: Option<fn(&CellOutcome) -> Option<f64>>,
}

fn columns(table: &TableOutcome) -> Vec<Column> {
    let has = |some: fn(&CellOutcome) -> bool| table.cells.iter().any(some);
    let part = |of: &str| format!("{of}, in parts of {}", table.parts_of.as_deref().unwrap_or_default());
    let mut columns = vec![Column { title: table.title.clone(), text: |cell| cell.row.clone(), value: None }];
    let mut add =
        |is_there: bool, title: String, text: fn(&CellOutcome) -> String, value: fn(&CellOutcome) -> Option<f64>| {
            if is_there {
                columns.push(Column { title, text, value: Some(value) });
            }
        };
    add(
        has(|cell| cell.published.is_some()),
        format!("published, {}", table.unit),
        |cell| cell.published.map(digits).unwrap_or_default(),
        |cell| cell.published,
    );
    add(
        has(|cell| cell.ours.is_some() || cell.missing.is_some()),
        format!("ours, {}", table.unit),
        |cell| cell.ours.as_ref().map(number).or_else(|| cell.missing.clone()).unwrap_or_default(),
        |cell| cell.ours.map(|ours| ours.value),
    );
    add(
        has(|cell| cell.published_part.is_some()),
        part("published"),
        |cell| cell.published_part.map(digits).unwrap_or_default(),
        |cell| cell.published_part,
    );
    add(
        has(|cell| cell.our_part.is_some()),
        part("ours"),
        |cell| cell.our_part.as_ref().map(number).unwrap_or_default(),
        |cell| cell.our_part.map(|part| part.value),
    );
    add(
        has(|cell| cell.ratio.is_some()),
        "ours in parts of the published".to_owned(),
        |cell| cell.ratio.as_ref().map(number).unwrap_or_default(),
        |cell| cell.ratio.map(|ratio| ratio.value),
    );
    let of_column = |cell: &CellOutcome| cell.column != table.cells[0].column;
    if table.cells.iter().any(of_column) {
        columns.insert(1, Column { title: "column".to_owned(), text: |cell| cell.column.clone(), value: None });
    }
    columns
}

/// A table whose head sorts it.
fn table(table: &TableOutcome) -> Markup {
    let columns = columns(table);
    html! {
        div.scroll {
            table {
                thead {
                    tr { @for column in &columns { th scope="col" { button type="button" { (column.title) } } } }
                }
                tbody {
                    @for cell in &table.cells {
                        tr {
                            @for column in &columns {
                                @let value = column.value.and_then(|value| value(cell));
                                td class=[column.value.map(|_| "number")] data-value=[value] { ((column.text)(cell)) }
                            }
                        }
                    }
                }
            }
        }
    }
}
