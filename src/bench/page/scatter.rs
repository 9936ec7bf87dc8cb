//! Error against time: a point a row, those of the Pareto set filled.

use crate::bench::row::BenchRow;
use crate::metrics::Measure;
use crate::page::scale::{Scale, short};
use maud::{Markup, html};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 360.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;

struct Point<'a> {
    name: &'a str,
    time: f64,
    interval: [f64; 2],
    error: f64,
    is_best: bool,
}

/// The plot of a measure's error; None where there are no two rows that differ in both.
pub fn plot(measure: &str, rows: &[BenchRow]) -> Option<Markup> {
    let measure = Measure::named(measure)?;
    let points: Vec<Point<'_>> = rows.iter().filter_map(|row| point(measure, row)).collect();
    let x = Scale::of(points.iter().flat_map(|point| point.interval), [LEFT, WIDTH - RIGHT])?;
    let y = Scale::of(points.iter().map(|point| point.error), [HEIGHT - BOTTOM, TOP])?;
    let title = format!("{} against time", measure.title);
    Some(html! {
        h2 { (title) }
        div.scroll {
            svg role="img" aria-label=(title) viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } {
                @for tick in x.ticks() {
                    @let at = x.place(tick);
                    line.grid x1=(at) x2=(at) y1=(TOP) y2=(HEIGHT - BOTTOM) {}
                    text.tick x=(at) y=(HEIGHT - BOTTOM + 16.0) { (short(tick)) }
                }
                @for tick in y.ticks() {
                    @let at = y.place(tick);
                    line.grid x1=(LEFT) x2=(WIDTH - RIGHT) y1=(at) y2=(at) {}
                    text.label x=(LEFT - 8.0) y=(at + 4.0) { (short(tick)) }
                }
                text.tick x=((LEFT + WIDTH - RIGHT) / 2.0) y=(HEIGHT - 8.0) { "time, in parts of the baseline's" }
                @for point in &points {
                    @let at = y.place(point.error);
                    line.bounds.faint x1=(x.place(point.interval[0])) x2=(x.place(point.interval[1])) y1=(at) y2=(at) {}
                    circle class=(if point.is_best { "ours" } else { "other" }) cx=(x.place(point.time)) cy=(at) r="4.5" {
                        title { (point.name) ": " (short(point.time)) ", " (measure.name) " " (short(point.error)) }
                    }
                }
            }
        }
        p.note { "Filled: no row with at most its RMSE is faster by the interval of their ratio. Further down is nearer, further left is faster." }
    })
}

fn point<'a>(measure: &Measure, row: &'a BenchRow) -> Option<Point<'a>> {
    let ratio = row.ratio.as_ref()?;
    let error = Some((measure.value)(row.best_known_errors()?)).filter(|error| error.is_finite())?;
    Some(Point {
        name: row.title(),
        time: ratio.mean,
        interval: row.interval().unwrap_or([ratio.mean; 2]),
        error,
        is_best: row.pareto == Some(true),
    })
}
