//! A plot of a table: a line a row, the published number hollow, ours filled, with its bounds.
//!
//! Two crates were looked at: plotters draws in colours of its own, which no dark page changes, and poloto, whose colours are
//! CSS, has neither bounds nor lines that are words.

use crate::papers::digits::digits;
use crate::papers::outcome::{CellOutcome, TableOutcome};
use maud::{Markup, html};

/// Lines beyond which nobody reads a plot.
const MOST_LINES: usize = 48;

/// Ratio of the greatest number to the least from which on the scale is logarithmic.
const LOGARITHMIC_FROM: f64 = 20.0;

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

/// From numbers to places across.
struct Scale {
    least: f64,
    greatest: f64,
    is_logarithmic: bool,
}

impl Scale {
    /// None where there are no two different numbers, or one that is negative.
    fn of(lines: &[Line]) -> Option<Self> {
        let all = lines
            .iter()
            .flat_map(|line| line.published.into_iter().chain(line.ours).chain(line.bounds.into_iter().flatten()));
        let all: Vec<f64> = all.filter(|number| number.is_finite()).collect();
        let (least, greatest) =
            all.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), number| (low.min(*number), high.max(*number)));
        if least < 0.0 || greatest <= least {
            return None;
        }
        let is_logarithmic = least > 0.0 && greatest / least > LOGARITHMIC_FROM;
        let least = if is_logarithmic { least / 1.2 } else { 0.0 };
        Some(Self { least, greatest: greatest * 1.05, is_logarithmic })
    }

    fn x(&self, number: f64) -> f64 {
        let part = match self.is_logarithmic {
            true => (number.max(self.least) / self.least).ln() / (self.greatest / self.least).ln(),
            false => (number - self.least) / (self.greatest - self.least),
        };
        LABELS + part * (WIDTH - LABELS - RIGHT)
    }

    /// Round numbers to be marked.
    fn ticks(&self) -> Vec<f64> {
        if self.is_logarithmic {
            let powers = self.least.log10().ceil() as i32..=self.greatest.log10().floor() as i32;
            let powers: Vec<f64> = powers.map(|power| 10_f64.powi(power)).collect();
            if powers.len() > 1 {
                return powers;
            }
        }
        let rough = (self.greatest - self.least) / 4.0;
        let power = 10_f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|step| *step >= rough).unwrap_or(rough);
        let first = (self.least / step).ceil() as i64;
        (first..).map(|index| index as f64 * step).take_while(|tick| *tick <= self.greatest).collect()
    }
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
    let scale = Scale::of(&lines)?;
    let bottom = lines.len() as f64 * LINE;
    Some(html! {
        div.scroll {
            svg role="img" aria-label={ (table.title) ", " (unit) } viewBox={ "0 0 " (WIDTH) " " (bottom + BOTTOM + 14.0) } {
                @for tick in scale.ticks() {
                    @let x = scale.x(tick);
                    line.grid x1=(x) x2=(x) y1="0" y2=(bottom) {}
                    text.tick x=(x) y=(bottom + 14.0) { (short(tick)) }
                }
                text.tick x=((LABELS + WIDTH - RIGHT) / 2.0) y=(bottom + BOTTOM + 6.0) { (unit) }
                @for (index, one) in lines.iter().enumerate() {
                    @let y = (index as f64 + 0.5) * LINE;
                    text.label x=(LABELS - 10.0) y=(y + 4.0) { (cut(&one.name)) title { (one.name) } }
                    @if let Some([low, high]) = one.bounds { line.bounds x1=(scale.x(low)) x2=(scale.x(high)) y1=(y) y2=(y) {} }
                    @if let Some(ours) = one.ours { circle.ours cx=(scale.x(ours)) cy=(y) r="4.5" { title { "ours: " (digits(ours)) } } }
                    @if let Some(theirs) = one.published {
                        circle.published cx=(scale.x(theirs)) cy=(y) r="5" { title { "published: " (digits(theirs)) } }
                    }
                }
            }
        }
    })
}

/// A tick's number without what says nothing.
fn short(tick: f64) -> String {
    let text = format!("{tick:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
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

    fn line(published: f64, ours: f64) -> Line {
        Line { name: String::new(), published: Some(published), ours: Some(ours), bounds: None }
    }

    #[test]
    fn numbers_lie_where_their_scale_says() {
        let scale = Scale::of(&[line(1.0, 4.0)]).unwrap();
        assert!(!scale.is_logarithmic && scale.x(0.0) == LABELS);
        assert!((scale.x(2.1) - (LABELS + WIDTH - RIGHT) / 2.0).abs() < 1e-9, "half of 4.2");
        assert_eq!(scale.ticks(), [0.0, 2.0, 4.0]);
        let wide = Scale::of(&[line(1.0, 1000.0)]).unwrap();
        assert!(wide.is_logarithmic);
        let [a, b, c] = [1.0, 10.0, 100.0].map(|number| wide.x(number));
        assert!((c - b - (b - a)).abs() < 1e-9, "equal factors are equal ways");
        assert_eq!(wide.ticks(), [1.0, 10.0, 100.0, 1000.0]);
        assert!(Scale::of(&[line(1.0, 1.0)]).is_none() && Scale::of(&[line(-1.0, 1.0)]).is_none());
    }

    #[test]
    fn ticks_and_names_are_short() {
        assert_eq!((short(0.5), short(20.0), short(0.0)), ("0.5".to_owned(), "20".to_owned(), "0".to_owned()));
        assert_eq!(cut(&"a".repeat(50)).chars().count(), 44);
    }
}
