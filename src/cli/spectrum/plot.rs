//! A plot of a periodogram's rings: radial mean and anisotropy over frequency, both by powers of ten.

use crate::sampling::periodogram::Ring;
use crate::svg;
use std::fmt::Write;

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 480.0;
/// Left edge, width and height of a panel.
const LEFT: f64 = 72.0;
const ACROSS: f64 = 544.0;
const DOWN: f64 = 160.0;
/// What lies this many powers of ten below the greatest value is drawn at the bottom: rounding, where theory has 0.
const MOST_DECADES: i32 = 6;

/// The plot as the text of an SVG file. `title`: whose rings they are.
pub fn svg(rings: &[Ring], title: &str) -> String {
    let mut text = String::new();
    write(&mut text, rings, title).expect("a string takes any text");
    text
}

fn write(text: &mut String, rings: &[Ring], title: &str) -> std::fmt::Result {
    svg::begin(text, [WIDTH, HEIGHT])?;
    writeln!(text, "<text x=\"{LEFT}\" y=\"20\">{}</text>", svg::escaped(title))?;
    let last = rings.last().map_or(1.0, |ring| ring.cycles_per_px);
    let power = rings.iter().map(|ring| (ring.cycles_per_px / last, Some(ring.power)));
    panel(text, 56.0, "radial mean of the power", power.collect())?;
    let anisotropy = rings.iter().map(|ring| (ring.cycles_per_px / last, ring.anisotropy));
    panel(text, 264.0, "anisotropy: variance over the ring / squared mean", anisotropy.collect())?;
    for part in 0..=4 {
        let part = f64::from(part) / 4.0;
        let (x, y) = (LEFT + part * ACROSS, 264.0 + DOWN + 16.0);
        writeln!(text, "<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">{:.3}</text>", part * last)?;
    }
    let middle = LEFT + ACROSS / 2.0;
    writeln!(text, "<text x=\"{middle}\" y=\"464\" text-anchor=\"middle\">frequency, cycles a pixel</text>\n</svg>")
}

/// One panel, from `top` down. `points`: place from left to right, 0 to 1, and the value there.
fn panel(text: &mut String, top: f64, label: &str, points: Vec<(f64, Option<f64>)>) -> std::fmt::Result {
    writeln!(text, "<text x=\"{LEFT}\" y=\"{}\">{label}</text>", top - 8.0)?;
    let frame = format!("x=\"{LEFT}\" y=\"{top}\" width=\"{ACROSS}\" height=\"{DOWN}\"");
    writeln!(text, "<rect {frame} fill=\"none\" stroke=\"grey\"/>")?;
    let values = || points.iter().filter_map(|(_, value)| *value).filter(|value| *value > 0.0);
    let greatest = values().fold(0.0, f64::max);
    if greatest == 0.0 {
        return Ok(());
    }
    let highest = greatest.log10().ceil() as i32;
    let least = values().fold(greatest, f64::min).log10().floor() as i32;
    let lowest = least.max(highest - MOST_DECADES).min(highest - 1);
    let height = |value: f64| {
        let part = (value.log10() - f64::from(lowest)) / f64::from(highest - lowest);
        top + DOWN * (1.0 - part.clamp(0.0, 1.0))
    };
    for decade in lowest..=highest {
        let y = height(10f64.powi(decade));
        writeln!(text, "<path d=\"M{LEFT} {y:.1}h{ACROSS}\" stroke=\"lightgrey\"/>")?;
        writeln!(text, "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">1e{decade}</text>", LEFT - 6.0, y + 4.0)?;
    }
    let known = points.iter().filter_map(|(place, value)| Some((LEFT + place * ACROSS, height((*value)?))));
    let line: Vec<String> = known.map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    writeln!(text, "<polyline points=\"{}\" fill=\"none\" stroke=\"black\"/>", line.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A value at a power of ten lies on its line; what is 0 or unknown neither widens the axis nor breaks it.
    #[test]
    fn values_lie_where_the_axis_says() {
        let ring = |cycles_per_px, power, anisotropy| Ring { cycles_per_px, frequency_count: 8, power, anisotropy };
        let rings = [ring(0.25, 100.0, None), ring(0.5, 1.0, Some(1.0)), ring(1.0, 0.0, Some(0.1))];
        let drawn = svg(&rings, "a < b & c");
        assert!(drawn.contains(">a &lt; b &amp; c<"), "{drawn}");
        let lines: Vec<&str> =
            drawn.lines().filter_map(|line| line.strip_prefix("<polyline points=\"")?.split('"').next()).collect();
        assert_eq!(lines, ["208.0,56.0 344.0,216.0 616.0,216.0", "344.0,264.0 616.0,424.0"]);
        assert_eq!(drawn.matches(">1e").count(), 5, "1, 10 and 100; 0.1 and 1: {drawn}");
        assert!(drawn.starts_with("<svg ") && drawn.ends_with("</svg>\n"));
        for empty in [&[][..], &[ring(1.0, 0.0, None)]] {
            assert!(!svg(empty, "").contains("polyline"));
        }
    }
}
