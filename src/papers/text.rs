//! A reproduction as text that is Markdown too.

use super::columns::{columns, missing};
use super::outcome::{Outcome, TableOutcome};
use crate::report::command_line::command_line;
use std::fmt::Write;

/// All of it.
pub fn text(outcome: &Outcome) -> String {
    let mut text = format!(
        "# {}/{}: {}\n\n{}; {}.\n\n**{}.** {}\n",
        outcome.paper, outcome.item, outcome.title, outcome.citation, outcome.place, outcome.verdict, outcome.reason
    );
    let mut line = |line: String| writeln!(text, "{line}").expect("a string grows");
    if !outcome.steps.is_empty() {
        let device = outcome.device.as_ref().and_then(|device| device.get("name")?.as_str());
        let device = device.map_or_else(String::new, |name| format!(", {name}"));
        line(format!("\nCommit {}, {}{device}, {} effort.", outcome.commit, outcome.date, outcome.effort));
    }
    for one in outcome.tables.iter().filter(|table| !table.cells.is_empty()) {
        line(String::new());
        lines(one).into_iter().for_each(&mut line);
    }
    if !outcome.pictures.is_empty() {
        line("\n| picture | file |\n| --- | --- |".to_owned());
        outcome.pictures.iter().for_each(|picture| line(format!("| {} | {} |", picture.title, picture.file)));
    }
    if !outcome.steps.is_empty() {
        line("\nBy\n".to_owned());
    }
    for step in &outcome.steps {
        line(format!("    quincunx {}", command_line(&step.command)));
    }
    for step in &outcome.steps {
        if let Some(failed) = &step.failed {
            line(format!("\n{} failed: {failed}", step.name));
        }
    }
    text
}

/// A table of Markdown, whose columns are as wide as they need to be.
fn lines(table: &TableOutcome) -> Vec<String> {
    let columns = columns(table);
    let mut grid = vec![columns.iter().map(|column| column.title.clone()).collect::<Vec<_>>()];
    grid.extend(table.cells.iter().map(|cell| columns.iter().map(|column| (column.text)(cell)).collect()));
    let width = |column: usize| grid.iter().map(|line| line[column].chars().count()).max().unwrap_or_default();
    let widths: Vec<usize> = (0..columns.len()).map(width).collect();
    let padded = |line: &Vec<String>| {
        let cells = line.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        format!("| {} |", cells.collect::<Vec<_>>().join(" | "))
    };
    let mut lines: Vec<String> = grid.iter().map(padded).collect();
    let rule: Vec<String> = widths.iter().map(|width| "-".repeat((*width).max(3))).collect();
    lines.insert(1, format!("| {} |", rule.join(" | ")));
    lines.extend(missing(table).map(|line| format!("\n{line}")));
    lines
}
