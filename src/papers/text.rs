//! A reproduction as text that is Markdown too.

use super::digits::{digits, number};
use super::outcome::{CellOutcome, Outcome, TableOutcome};
use std::fmt::Write;

/// A cell without a number.
const NOTHING: &str = "";

fn or_nothing<T>(value: Option<T>, text: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| NOTHING.to_owned(), text)
}

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
        line(format!("    quincunx {}", step.command.join(" ")));
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
    let has = |some: fn(&CellOutcome) -> bool| table.cells.iter().any(some);
    let has_columns = table.cells.iter().any(|cell| cell.column != table.cells[0].column);
    let part = |of: &str| format!("{of}, in parts of {}", table.parts_of.as_deref().unwrap_or_default());
    type Words = fn(&CellOutcome) -> String;
    let columns: [(bool, String, Words); 7] = [
        (true, table.title.clone(), |cell| cell.row.clone()),
        (has_columns, NOTHING.to_owned(), |cell| cell.column.clone()),
        (has(|cell| cell.published.is_some()), format!("published, {}", table.unit), |cell| {
            or_nothing(cell.published, digits)
        }),
        (has(|cell| cell.ours.is_some() || cell.missing.is_some()), format!("ours, {}", table.unit), |cell| {
            or_nothing(cell.ours.as_ref(), number)
        }),
        (has(|cell| cell.published_part.is_some()), part("published"), |cell| or_nothing(cell.published_part, digits)),
        (has(|cell| cell.our_part.is_some()), part("ours"), |cell| or_nothing(cell.our_part.as_ref(), number)),
        (has(|cell| cell.ratio.is_some()), "ours in parts of the published".to_owned(), |cell| {
            or_nothing(cell.ratio.as_ref(), number)
        }),
    ];
    let columns: Vec<_> = columns.into_iter().filter(|(is_there, _, _)| *is_there).collect();
    let mut grid = vec![columns.iter().map(|(_, title, _)| title.clone()).collect::<Vec<_>>()];
    grid.extend(table.cells.iter().map(|cell| columns.iter().map(|(_, _, words)| words(cell)).collect()));
    let width = |column: usize| grid.iter().map(|line| line[column].chars().count()).max().unwrap_or_default();
    let widths: Vec<usize> = (0..columns.len()).map(width).collect();
    let padded = |line: &Vec<String>| {
        let cells = line.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        format!("| {} |", cells.collect::<Vec<_>>().join(" | "))
    };
    let mut lines: Vec<String> = grid.iter().map(padded).collect();
    let rule: Vec<String> = widths.iter().map(|width| "-".repeat((*width).max(3))).collect();
    lines.insert(1, format!("| {} |", rule.join(" | ")));
    for cell in &table.cells {
        if let Some(missing) = &cell.missing {
            lines.push(format!("\n{} {}: {missing}", cell.row, cell.column));
        }
    }
    lines
}
