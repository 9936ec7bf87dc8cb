//! A plot of errors by a setting's values: a panel a measure, a line a combination, both axes by powers.

use super::rates::{MEASURES, Rate};
use crate::svg;
use std::fmt::Write;

const LEFT: f64 = 72.0;
const ACROSS: f64 = 420.0;
const TOP: f64 = 40.0;
const DOWN: f64 = 260.0;
/// From a panel to the next, and down to the names of lines.
const PANEL: f64 = DOWN + 56.0;
/// Height of a name, and names side by side.
const NAME: f64 = 18.0;
const NAMES_ACROSS: usize = 2;
/// Colours that are told apart in print too; lines beyond them are dashed.
const COLORS: [&str; 8] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9", "#8c6d31"];
const DASHES: [&str; 4] = ["none", "6 3", "2 3", "8 3 2 3"];

/// The plot as the text of an SVG file. `key`: the setting whose values go across.
pub fn svg(key: &str, rates: &[Rate]) -> String {
    let mut text = String::new();
    write(&mut text, key, rates).expect("a string takes any text");
    text
}

fn stroke(index: usize) -> String {
    let dash = DASHES[index / COLORS.len() % DASHES.len()];
    format!("stroke=\"{}\" stroke-dasharray=\"{dash}\" fill=\"none\"", COLORS[index % COLORS.len()])
}

fn write(text: &mut String, key: &str, rates: &[Rate]) -> std::fmt::Result {
    let names = rates.len().div_ceil(NAMES_ACROSS) as f64 * NAME;
    let (width, height) = (LEFT + ACROSS + 24.0, TOP + MEASURES.len() as f64 * PANEL + names);
    svg::begin(text, [width, height])?;
    for (index, measure) in MEASURES.iter().enumerate() {
        panel(text, TOP + index as f64 * PANEL, [measure, key], index, rates)?;
    }
    for (index, rate) in rates.iter().enumerate() {
        let x = LEFT + (index % NAMES_ACROSS) as f64 * (ACROSS / NAMES_ACROSS as f64);
        let y = TOP + MEASURES.len() as f64 * PANEL + (index / NAMES_ACROSS) as f64 * NAME;
        let (name, stroke) = (svg::escaped(&rate.of), stroke(index));
        writeln!(text, "<path d=\"M{x} {}h24\" {stroke}/><text x=\"{}\" y=\"{y}\">{name}</text>", y - 4.0, x + 30.0)?;
    }
    writeln!(text, "</svg>")
}

/// Least and greatest of what is above 0, apart from each other; None: there is nothing.
fn ends(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let known = values.filter(|value| *value > 0.0 && value.is_finite());
    let [least, most] = known.fold([f64::INFINITY, 0.0], |[least, most], value| [value.min(least), value.max(most)]);
    (least <= most).then_some(if least < most { [least, most] } else { [0.5 * least, 2.0 * most] })
}

fn panel(text: &mut String, top: f64, [measure, key]: [&str; 2], index: usize, rates: &[Rate]) -> std::fmt::Result {
    let points = || rates.iter().flat_map(|rate| &rate.points);
    writeln!(text, "<text x=\"{LEFT}\" y=\"{}\">{measure}</text>", top - 8.0)?;
    writeln!(
        text,
        "<rect x=\"{LEFT}\" y=\"{top}\" width=\"{ACROSS}\" height=\"{DOWN}\" fill=\"none\" stroke=\"grey\"/>"
    )?;
    let across = ends(points().map(|point| point.value));
    let Some((across, down)) = across.zip(ends(points().map(|point| point.errors[index]))) else { return Ok(()) };
    let part = |value: f64, [least, most]: [f64; 2]| (value / least).ln() / (most / least).ln();
    let x = |value: f64| LEFT + ACROSS * part(value, across);
    let y = |value: f64| top + DOWN * (1.0 - part(value, down));
    let mut values: Vec<f64> = points().map(|point| point.value).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    for value in values {
        let at = x(value);
        writeln!(text, "<path d=\"M{at:.1} {top}v{DOWN}\" stroke=\"lightgrey\"/>")?;
        writeln!(text, "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{value}</text>", top + DOWN + 16.0)?;
    }
    for value in down {
        writeln!(
            text,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{value:.2e}</text>",
            LEFT - 6.0,
            y(value) + 4.0
        )?;
    }
    let middle = LEFT + ACROSS / 2.0;
    writeln!(
        text,
        "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
        top + DOWN + 32.0,
        svg::escaped(key)
    )?;
    for (number, rate) in rates.iter().enumerate() {
        let known = rate.points.iter().filter(|point| point.value > 0.0 && point.errors[index] > 0.0);
        let line: Vec<String> =
            known.map(|point| format!("{:.1},{:.1}", x(point.value), y(point.errors[index]))).collect();
        writeln!(text, "<polyline points=\"{}\" {}/>", line.join(" "), stroke(number))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::rates::RatePoint;

    /// Equal factors are equal distances, the ends lie in the corners; an error of 0 has no place.
    #[test]
    fn points_lie_where_the_axes_say() {
        let point = |value, error| RatePoint { value, errors: [error, 0.0], seeds: 1 };
        let rates = [
            Rate {
                of: "a<b".to_owned(),
                points: vec![point(1.0, 1.0), point(4.0, 0.1), point(16.0, 0.01)],
                exponents: [None; 2],
            },
            Rate { of: "c".to_owned(), points: vec![point(1.0, 0.0), point(16.0, 0.1)], exponents: [None; 2] },
        ];
        let drawn = svg("samples", &rates);
        let lines: Vec<&str> =
            drawn.lines().filter_map(|line| line.strip_prefix("<polyline points=\"")?.split('"').next()).collect();
        assert_eq!(lines, ["72.0,40.0 282.0,170.0 492.0,300.0", "492.0,170.0"]);
        assert!(drawn.contains(">a&lt;b<") && drawn.starts_with("<svg ") && drawn.ends_with("</svg>\n"), "{drawn}");
        assert!(!svg("samples", &[]).contains("polyline"));
    }
}
