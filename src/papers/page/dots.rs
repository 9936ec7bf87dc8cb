//! A plot of a table: a line a row, the published number hollow, ours filled, with its bounds.
//!
//! Two crates were looked at: plotters draws in colours of its own, which no dark page changes, and poloto, whose colours are
//! CSS, has neither bounds nor lines that are words.

use crate::page::scale::{Scale, short};
use crate::papers::digits::digits;
use crate::papers::outcome::{CellOutcome, TableOutcome};
use maud::{Markup, html};

/// Lines beyond which nobody reads a plot.
const MOST_LINES: usize = 48;

const LINE: f64 = 22.0;
const LABELS: f64 = 300.0;
const WIDTH: f64 = 760.0;
const RIGHT: f64 = 30.0;
const BOTTOM: f64 = 28.0;

/// A row's numbers on the plot.
struct Line {
    name: String,
    published: Option<f64>,
    ours: Option<f64>,
    bounds: Option<[f64; 2]>,
}

/// Parts where the table has parts, else the numbers.
fn line(cell: &CellOutcome, has_parts: bool) -> Line {
    let ours = if has_parts { cell.our_part } else { cell.ours };
    let name = if cell.column.is_empty() { cell.row.clone() } else { format!("{}, {}", cell.row, cell.column) };
    Line {
        name,
        published: if has_parts { cell.published_part } else { cell.published },
        ours: ours.map(|ours| ours.value),
        bounds: ours.and_then(|ours| ours.bounds),
    }
}

/// Plots of a table: one where numbers are parts of one of them, else one a column, because columns may be of other things. None
/// of what has too little or too much for a plot.
pub fn plots(table: &TableOutcome) -> Vec<Markup> {
    if let Some(whole) = &table.parts_of {
        return plot(table, |_| true, &format!("in parts of {whole}")).into_iter().collect();
    }
    let mut columns: Vec<&str> = Vec::new();
    for cell in &table.cells {
        if !columns.contains(&cell.column.as_str()) {
            columns.push(&cell.column);
        }
    }
    let of_column = |column: &str| plot(table, |cell| cell.column == column, &format!("{column}, {}", table.unit));
    columns.into_iter().filter_map(of_column).collect()
}

fn plot(table: &TableOutcome, is_in: impl Fn(&CellOutcome) -> bool, unit: &str) -> Option<Markup> {
    let has_parts = table.parts_of.is_some();
    let lines: Vec<Line> = table.cells.iter().filter(|cell| is_in(cell)).map(|cell| line(cell, has_parts)).collect();
    let lines: Vec<Line> = lines.into_iter().filter(|line| line.published.is_some() || line.ours.is_some()).collect();
    if !(2..=MOST_LINES).contains(&lines.len()) {
        return None;
    }
    let numbers = lines
        .iter()
        .flat_map(|line| line.published.into_iter().chain(line.ours).chain(line.bounds.into_iter().flatten()));
    let scale = Scale::of(numbers, [LABELS, WIDTH - RIGHT])?;
    let bottom = lines.len() as f64 * LINE;
    Some(html! {
        div.scroll {
            svg role="img" aria-label={ (table.title) ", " (unit) } viewBox={ "0 0 " (WIDTH) " " (bottom + BOTTOM + 14.0) } {
                @for tick in scale.ticks() {
                    @let x = scale.place(tick);
                    line.grid x1=(x) x2=(x) y1="0" y2=(bottom) {}
                    text.tick x=(x) y=(bottom + 14.0) { (short(tick)) }
                }
                text.tick x=((LABELS + WIDTH - RIGHT) / 2.0) y=(bottom + BOTTOM + 6.0) { (unit) }
                @for (index, one) in lines.iter().enumerate() {
                    @let y = (index as f64 + 0.5) * LINE;
                    text.label x=(LABELS - 10.0) y=(y + 4.0) { (cut(&one.name)) title { (one.name) } }
                    @if let Some([low, high]) = one.bounds { line.bounds x1=(scale.place(low)) x2=(scale.place(high)) y1=(y) y2=(y) {} }
                    @if let Some(ours) = one.ours { circle.ours cx=(scale.place(ours)) cy=(y) r="4.5" { title { "ours: " (digits(ours)) } } }
                    @if let Some(theirs) = one.published {
                        circle.published cx=(scale.place(theirs)) cy=(y) r="5" { title { "published: " (digits(theirs)) } }
                    }
                }
            }
        }
    })
}

/// As much of a name as has room.
fn cut(name: &str) -> String {
    const MOST: usize = 44;
    if name.chars().count() <= MOST {
        return name.to_owned();
    }
    name.chars().take(MOST - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_short() {
        assert_eq!(cut(&"a".repeat(50)).chars().count(), 44);
        assert_eq!(cut("a"), "a");
    }
}
