//! What rows of benchmarks say, in the units that papers print.

use super::recipe::{Figure, FigureKind, Number};
use crate::bench::row::BenchRow;

fn figure(kind: FigureKind, read: impl Fn(&BenchRow) -> Option<Number> + 'static) -> Figure {
    Figure { kind, read: Box::new(read) }
}

fn of_time(row: &BenchRow) -> Option<Number> {
    row.times_ms().map(|times| Number { value: times.median, bounds: Some([times.min, times.max]) })
}

/// Milliseconds of the frame or of the stage: the median, with the least and the greatest.
pub fn ms() -> Figure {
    figure(FigureKind::Time, of_time)
}

/// The same in seconds.
pub fn seconds() -> Figure {
    figure(FigureKind::Time, |row| Some(of_time(row)?.times(1e-3)))
}

fn count(row: &BenchRow, name: &str) -> Option<f64> {
    row.counters.as_ref()?.get(name).copied()
}

/// What a counter of the report says.
pub fn counter(name: &'static str) -> Figure {
    figure(FigureKind::Other, move |row| count(row, name).map(Number::exact))
}

/// Frames a second.
pub fn per_second() -> Figure {
    figure(FigureKind::Rate, |row| Some(of_time(row)?.divides(1000.0)))
}

/// Any number of a row, which has no bounds.
pub fn exact(read: fn(&BenchRow) -> Option<f64>) -> Figure {
    figure(FigureKind::Other, move |row| read(row).map(Number::exact))
}

/// How many times as fast as its baseline, with the 95 % interval.
pub fn times_as_fast() -> Figure {
    figure(FigureKind::Other, |row| {
        let ratio = row.speed_up.as_ref()?.ratio;
        Some(Number { value: ratio.mean, bounds: ratio.interval })
    })
}

/// How many times as long as its baseline, with the 95 % interval.
pub fn times_the_baseline() -> Figure {
    figure(FigureKind::Other, |row| {
        let ratio = row.ratio.as_ref()?;
        Some(Number { value: ratio.mean, bounds: ratio.interval })
    })
}

/// Pixels whose HDR-FLIP error is over the threshold, in per cent.
pub fn over_threshold_percent() -> Figure {
    figure(FigureKind::Other, |row| Some(Number::exact(100.0 * row.errors.as_ref()?.metrics.over_threshold)))
}

/// How much a sequence's frames flicker.
pub fn flicker() -> Figure {
    figure(FigureKind::Other, |row| row.flicker.map(Number::exact))
}

/// Median milliseconds of passes together, by their names behind the technique's; a name stands for `NAME.*` too. None
/// where the row has none of them.
fn passes_ms(row: &BenchRow, passes: &[&str]) -> Option<f64> {
    let all = row.pass_ms.as_ref()?.as_ref()?;
    let is_one = |name: &str| {
        passes.iter().any(|pass| name.strip_prefix(pass).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')))
    };
    let own = all.iter().filter(|(name, _)| name.split_once('.').is_some_and(|(_, name)| is_one(name)));
    own.map(|(_, ms)| *ms).reduce(|sum, ms| sum + ms)
}

/// Millions of pixels of a row's frame.
fn megapixels(row: &BenchRow) -> Option<f64> {
    let size = row.settings.get("size")?.to_string();
    let (width, height) = size.split_once('x')?;
    Some(width.parse::<f64>().ok()? * height.parse::<f64>().ok()? / 1e6)
}

/// Milliseconds of passes a million pixels.
pub fn passes_ms_per_megapixel(passes: &'static [&'static str]) -> Figure {
    figure(FigureKind::Other, |row| Some(Number::exact(passes_ms(row, passes)? / megapixels(row)?)))
}

/// The same of one light, where each pixel meets as many as the counter says.
pub fn passes_ms_per_megapixel_and_light(passes: &'static [&'static str], counter: &'static str) -> Figure {
    figure(FigureKind::Other, |row| {
        let lights = count(row, counter)?;
        Some(Number::exact(passes_ms(row, passes)? / megapixels(row)? / lights))
    })
}

/// Milliseconds of passes for each of what a counter counts.
pub fn passes_ms_per(passes: &'static [&'static str], counter: &'static str) -> Figure {
    figure(FigureKind::Other, |row| Some(Number::exact(passes_ms(row, passes)? / count(row, counter)?)))
}

/// What the method adds to a frame without it, in passes of one light.
pub fn overhead_light_passes() -> Figure {
    figure(FigureKind::Other, |row| row.overhead_light_passes.flatten().map(Number::exact))
}
