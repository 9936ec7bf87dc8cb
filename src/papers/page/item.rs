//! One item on the page.

use super::dots;
use crate::error::Result;
use crate::page::{self, pictures};
use crate::papers::columns::{columns, missing};
use crate::papers::outcome::{Outcome, TableOutcome};
use crate::report::command_line::command_line;
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
    let files = outcome.pictures.iter().map(|picture| (picture.title.as_str(), folder.join(&picture.file)));
    let pictures = pictures::markup(files)?;
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
                @for line in missing(one) { p.failed { (line) } }
                @for plot in dots::plots(one) { (plot) }
            }
            (pictures)
            @for (name, reason) in failed() { p.failed { (name) " failed: " (reason) } }
            @if !outcome.steps.is_empty() {
                details {
                    summary { (outcome.steps.len()) " commands" }
                    @for step in &outcome.steps { pre { "quincunx " (command_line(&step.command)) } }
                }
            }
        }
    })
}

/// A table whose head sorts it.
fn table(table: &TableOutcome) -> Markup {
    let columns = columns(table);
    let titles: Vec<(&str, bool)> =
        columns.iter().map(|column| (column.title.as_str(), column.value.is_some())).collect();
    let row = |cell| {
        let cells = columns.iter().map(|column| {
            let text = (column.text)(cell);
            (html! { (text) }, column.value.and_then(|value| value(cell)))
        });
        cells.collect()
    };
    page::table(&titles, &table.cells.iter().map(row).collect::<Vec<_>>())
}
