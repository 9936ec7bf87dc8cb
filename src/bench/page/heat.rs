//! Heat maps: the time of each pair of values of two axes.

use crate::bench::row::BenchRow;
use crate::bench::sweep::Axis;
use maud::{Markup, html};

/// Axes beyond which, and values beyond which, nobody reads a map.
const MOST_MAPS: usize = 6;
const MOST_VALUES: usize = 24;

const CELL: [f64; 2] = [70.0, 26.0];
const LABELS: f64 = 130.0;
const TOP: f64 = 44.0;

/// A map of each pair of axes with several values. Where there are more axes, a cell is the fastest of its rows.
pub fn maps(axes: &[Axis], rows: &[BenchRow]) -> Vec<Markup> {
    let has_several = |axis: &&Axis| (2..=MOST_VALUES).contains(&axis.values.len());
    let several: Vec<&Axis> = axes.iter().filter(has_several).collect();
    let pairs = several
        .iter()
        .enumerate()
        .flat_map(|(index, down)| several[index + 1..].iter().map(move |across| (*down, *across)));
    pairs.take(MOST_MAPS).filter_map(|(down, across)| map(down, across, several.len() > 2, rows)).collect()
}

/// A cell: the fastest row that has both values; None where none was measured.
fn fastest<'a>(rows: &'a [BenchRow], pairs: [(&Axis, &str); 2]) -> Option<(&'a BenchRow, f64)> {
    let has = |row: &&BenchRow| pairs.iter().all(|(axis, value)| row.asked_text(&axis.key) == *value);
    let timed = rows.iter().filter(has).filter_map(|row| Some((row, row.ratio.as_ref()?.mean)));
    timed.filter(|(_, ratio)| ratio.is_finite() && *ratio > 0.0).min_by(|(_, a), (_, b)| a.total_cmp(b))
}

fn map(down: &Axis, across: &Axis, has_others: bool, rows: &[BenchRow]) -> Option<Markup> {
    let cell = |y: &str, x: &str| fastest(rows, [(down, y), (across, x)]);
    let all = || down.values.iter().flat_map(|y| across.values.iter().filter_map(move |x| cell(y, x)));
    let least = all().map(|(_, ratio)| ratio).fold(f64::INFINITY, f64::min);
    let most = all().map(|(_, ratio)| ratio).fold(0.0, f64::max);
    if all().count() < 2 {
        return None;
    }
    // The fastest has the full colour, the slowest none.
    let strength = |ratio: f64| if most > least { (most / ratio).ln() / (most / least).ln() } else { 1.0 };
    let [width, height] = [LABELS + across.values.len() as f64 * CELL[0], TOP + down.values.len() as f64 * CELL[1]];
    let title = format!("Time by {} and {}", down.key, across.key);
    Some(html! {
        h2 { (title) }
        div.scroll {
            svg.map role="img" aria-label=(title) viewBox={ "0 0 " (width) " " (height) } style={ "width:" (width) "px" } {
                text.tick x=((LABELS + width) / 2.0) y="14" { (across.key) }
                text.label x=(LABELS - 8.0) y="34" { (down.key) }
                @for (column, x) in across.values.iter().enumerate() {
                    text.tick x=(LABELS + (column as f64 + 0.5) * CELL[0]) y="34" { (x) }
                }
                @for (line, y) in down.values.iter().enumerate() {
                    @let top = TOP + line as f64 * CELL[1];
                    text.label x=(LABELS - 8.0) y=(top + 17.0) { (y) }
                    @for (column, x) in across.values.iter().enumerate() {
                        @let left = LABELS + column as f64 * CELL[0];
                        @if let Some((row, ratio)) = cell(y, x) {
                            rect.ours x=(left + 1.0) y=(top + 1.0) width=(CELL[0] - 2.0) height=(CELL[1] - 2.0) fill-opacity=(format!("{:.3}", 0.6 * strength(ratio))) {}
                            text.tick.cell x=(left + 0.5 * CELL[0]) y=(top + 17.0) { (format!("{ratio:.3}")) title { (row.title()) } }
                        } @else {
                            text.tick x=(left + 0.5 * CELL[0]) y=(top + 17.0) { "–" }
                        }
                    }
                }
            }
        }
        p.note {
            "Time in parts of the baseline's; the fastest is the darkest."
            @if has_others { " A cell is the fastest of all rows with both values; the other axes are free." }
        }
    })
}
