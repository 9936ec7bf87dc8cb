//! Colours of groups: hues that go round by the golden angle, so that neighbours differ.

use crate::report::memory::MemoryReport;
use maud::{Markup, html};
use std::collections::BTreeSet;

const GOLDEN_ANGLE: f64 = 137.508;

/// Groups in the order of their names.
pub struct Palette<'a> {
    groups: Vec<&'a str>,
}

impl<'a> Palette<'a> {
    pub fn of(report: &'a MemoryReport) -> Self {
        let groups: BTreeSet<&str> = report.resources.iter().map(|row| row.group.as_str()).collect();
        Self { groups: groups.into_iter().collect() }
    }

    /// Light enough for dark text, dark enough for a white page.
    pub fn color(&self, group: &str) -> String {
        let index = self.groups.iter().position(|known| *known == group).unwrap_or_default();
        format!("hsl({:.0} 55% 68%)", (index as f64 * GOLDEN_ANGLE) % 360.0)
    }

    /// Squares with names, from `top` on, as many a line as have room.
    pub fn legend(&self, [left, top]: [f64; 2], width: f64) -> (Markup, f64) {
        const CELL: f64 = 150.0;
        const LINE: f64 = 20.0;
        let columns = (width / CELL).floor().max(1.0) as usize;
        let parts = html! {
            @for (index, group) in self.groups.iter().enumerate() {
                @let x = left + (index % columns) as f64 * CELL;
                @let y = top + (index / columns) as f64 * LINE;
                rect x=(x) y=(y) width="12" height="12" fill=(self.color(group)) {}
                text x=(x + 17.0) y=(y + 10.5) { (group) }
            }
        };
        (parts, self.groups.len().div_ceil(columns) as f64 * LINE)
    }
}
