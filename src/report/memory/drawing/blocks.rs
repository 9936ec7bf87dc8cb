//! Memory blocks with the ranges in them; where ranges share bytes they lie under each other, a lane for each that meets one before.

use super::drawn::{Drawing, cut};
use super::palette::Palette;
use crate::report::memory::text::short;
use crate::report::memory::{MemoryReport, MemoryRow};
use crate::units::Bytes;
use maud::{Markup, html};

const LEFT: f64 = 10.0;
const WIDTH: f64 = 880.0;
const LANE: f64 = 18.0;
const HEAD: f64 = 22.0;
const GAP: f64 = 10.0;

/// None where nothing was made.
pub fn drawing(report: &MemoryReport) -> Option<Drawing> {
    let blocks = report.memory_blocks.as_ref().filter(|blocks| !blocks.is_empty())?;
    let most_bytes = blocks.iter().map(|block| block.bytes).max()?.max(1);
    let palette = Palette::of(report);
    let mut y = 0.0;
    let mut drawn: Vec<Markup> = Vec::new();
    for block in blocks {
        let mut ranges: Vec<&MemoryRow> =
            report.resources.iter().filter(|row| row.memory_block == Some(block.index)).collect();
        ranges.sort_by_key(|row| (row.offset, std::cmp::Reverse(row.bound_bytes)));
        let lanes = lanes(&ranges);
        let lane_count = lanes.iter().max().map_or(1, |lane| lane + 1);
        // Small blocks are as wide as can be seen.
        let unit = WIDTH / most_bytes as f64;
        let width = (block.bytes as f64 * unit).max(2.0);
        let at = |row: &MemoryRow| LEFT + row.offset.unwrap_or_default() as f64 * unit;
        drawn.push(html! {
            text x=(LEFT) y=(y + 15.0) {
                "memory block " (block.index) ", type " (block.memory_type) ": " (Bytes(block.bytes)) ", " (Bytes(block.free_bytes)) " free"
            }
            rect x=(LEFT) y=(y + HEAD) width=(width) height=(lane_count as f64 * LANE) fill="#ddd" stroke="#888" stroke-width="0.5" {}
            @for (row, lane) in ranges.iter().zip(&lanes) {
                @let top = y + HEAD + *lane as f64 * LANE;
                @let wide = row.bound_bytes as f64 * unit;
                rect data-name=(row.name) x=(at(row)) y=(top) width=(wide) height=(LANE) fill=(palette.color(&row.group)) stroke="#333" stroke-width="0.4" {
                    title { (row.name) ": " (Bytes(row.bound_bytes)) " from " (row.offset.unwrap_or_default()) }
                }
                @if let Some(name) = cut(short(&row.name), wide - 6.0) {
                    text x=(at(row) + 3.0) y=(top + 13.0) font-size="10" style="fill:#111" pointer-events="none" { (name) }
                }
            }
        });
        y += HEAD + lane_count as f64 * LANE + GAP;
    }
    let (legend, legend_height) = palette.legend([LEFT, y + 4.0], WIDTH);
    let parts = html! {
        @for block in &drawn { (block) }
        (legend)
    };
    Some(Drawing {
        title: "Memory blocks and what lies in them",
        size: [WIDTH + 2.0 * LEFT, y + 4.0 + legend_height],
        parts,
    })
}

/// The first lane of each range in which it meets none before it.
fn lanes(ranges: &[&MemoryRow]) -> Vec<usize> {
    let mut ends: Vec<u64> = Vec::new();
    ranges
        .iter()
        .map(|row| {
            let from = row.offset.unwrap_or_default();
            let lane = ends.iter().position(|end| *end <= from).unwrap_or_else(|| {
                ends.push(0);
                ends.len() - 1
            });
            ends[lane] = from + row.bound_bytes;
            lane
        })
        .collect()
}
