//! Resources over the passes of a frame: across the passes, down the bytes. What shares bytes lies at the same height in other
//! passes; what has bytes of its own holds them in all, faint where it does not live.

use super::drawn::{Drawing, cut};
use super::palette::Palette;
use crate::report::memory::text::short;
use crate::report::memory::{MemoryReport, MemoryRow};
use crate::units::Bytes;
use maud::{Markup, html};

const LEFT: f64 = 70.0;
const COLUMNS: f64 = 820.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 118.0;
const BYTES: f64 = 460.0;
/// A scene takes as much room as this, however large it is: a frame is what the picture is of.
const SCENE: f64 = 26.0;
/// Sides of a rectangle in which a name can be read.
const READABLE: f64 = 11.0;

/// A resource's place.
struct Bar<'a> {
    row: &'a MemoryRow,
    /// Bytes from the top.
    from: u64,
    /// First and last column.
    lives: [usize; 2],
    is_shared: bool,
}

/// None where a report has no passes.
pub fn drawing(report: &MemoryReport) -> Option<Drawing> {
    let names: Vec<&str> = report.passes.iter().map(|pass| pass.pass.as_str()).collect();
    if names.is_empty() {
        return None;
    }
    // What is read back lives on after the last pass.
    let is_read =
        report.resources.iter().any(|row| row.last_pass.as_deref().is_some_and(|last| !names.contains(&last)));
    let columns = names.len() + usize::from(is_read);
    let column = |pass: &Option<String>| {
        let pass = pass.as_deref()?;
        Some(names.iter().position(|name| *name == pass).unwrap_or(columns - 1))
    };
    let lives = |row: &MemoryRow| {
        let ends = column(&row.first_pass).zip(column(&row.last_pass));
        ends.map_or([0, columns - 1], |(first, last)| [first, last])
    };
    let (scene, frame): (Vec<&MemoryRow>, Vec<&MemoryRow>) =
        report.resources.iter().partition(|row| row.name.starts_with("scene."));
    let mut bars = Vec::new();
    let mut end = 0;
    for (index, arena) in report.arenas.iter().enumerate() {
        for row in &frame {
            if let Some(place) = row.arena.as_ref().filter(|place| place.index == index) {
                bars.push(Bar { row, from: end + place.offset, lives: lives(row), is_shared: true });
            }
        }
        end += arena.bytes;
    }
    let mut own: Vec<&MemoryRow> = frame.into_iter().filter(|row| row.arena.is_none()).collect();
    own.sort_by(|a, b| a.group.cmp(&b.group).then(b.bound_bytes.cmp(&a.bound_bytes)));
    for row in own {
        bars.push(Bar { row, from: end, lives: lives(row), is_shared: false });
        end += row.bound_bytes;
    }
    let palette = Palette::of(report);
    let (unit_x, unit_y) = (COLUMNS / columns as f64, BYTES / end.max(1) as f64);
    let (legend, legend_height) = palette.legend([LEFT, TOP + BYTES + SCENE + 24.0], COLUMNS);
    let scene_bytes: u64 = scene.iter().map(|row| row.bound_bytes).sum();
    let parts = html! {
        @for (index, name) in names.iter().copied().chain(is_read.then_some("readback")).enumerate() {
            @let x = LEFT + (index as f64 + 0.5) * unit_x;
            text transform={ "translate(" (x + 4.0) " " (TOP - 6.0) ") rotate(-60)" } font-size="10" {
                (cut(short(name), 105.0).unwrap_or_default()) title { (name) }
            }
        }
        (ruler(end, unit_y))
        @for bar in &bars { (rectangle(bar, columns, [unit_x, unit_y], &palette.color(&bar.row.group))) }
        @for index in 0..=columns {
            @let x = LEFT + index as f64 * unit_x;
            line x1=(x) x2=(x) y1=(TOP) y2=(TOP + BYTES) stroke="#888" stroke-width="0.3" {}
        }
        rect x=(LEFT) y=(TOP + BYTES + 8.0) width=(COLUMNS) height=(SCENE - 8.0) fill="#bbb" {}
        text x=(LEFT + 6.0) y=(TOP + BYTES + SCENE - 5.0) style="fill:#111" { "the scene, in every pass, not to scale: " (Bytes(scene_bytes)) }
        (legend)
    };
    let height = TOP + BYTES + SCENE + 24.0 + legend_height;
    Some(Drawing { title: "Resources over the passes of a frame", size: [LEFT + COLUMNS + RIGHT, height], parts })
}

fn rectangle(bar: &Bar<'_>, columns: usize, [unit_x, unit_y]: [f64; 2], color: &str) -> Markup {
    let Bar { row, from, lives: [first, last], is_shared } = bar;
    let (y, height) = (TOP + *from as f64 * unit_y, row.bound_bytes as f64 * unit_y);
    let (x, width) = (LEFT + *first as f64 * unit_x, (last + 1 - first) as f64 * unit_x);
    let shared = row.arena.as_ref().map(|arena| arena.shares_with.join(", ")).filter(|names| !names.is_empty());
    let name = short(&row.name);
    html! {
        @if !is_shared {
            rect x=(LEFT) y=(y) width=(columns as f64 * unit_x) height=(height) fill=(color) fill-opacity="0.25" {}
        }
        rect data-name=(row.name) x=(x) y=(y) width=(width) height=(height) fill=(color) stroke="#333" stroke-width=(if *is_shared { 1.0 } else { 0.4 }) {
            title {
                (row.name) ": " (Bytes(row.bound_bytes))
                @if let Some(names) = shared { ", shares bytes with " (names) }
            }
        }
        @if height >= READABLE {
            @if let Some(name) = cut(name, width - 8.0) {
                text x=(x + 4.0) y=(y + height.min(30.0) / 2.0 + 3.5) font-size="10" style="fill:#111" pointer-events="none" { (name) }
            }
        }
    }
}

/// Round numbers of bytes down the side.
fn ruler(bytes: u64, unit_y: f64) -> Markup {
    let step = (bytes / 5).max(1).next_power_of_two();
    html! {
        @for tick in (0..=bytes / step).map(|tick| tick * step) {
            @let y = TOP + tick as f64 * unit_y;
            line x1=(LEFT - 5.0) x2=(LEFT) y1=(y) y2=(y) stroke="#888" {}
            text x=(LEFT - 8.0) y=(y + 4.0) text-anchor="end" font-size="10" { (Bytes(tick)) }
        }
    }
}
