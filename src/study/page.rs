//! The memory of techniques as one HTML file: pictures and tables that sort.

use super::Study;
use crate::page;
use crate::report::memory::drawing::{Drawing, PICTURES};
use crate::report::memory::{MemoryReport, MemoryRow};
use maud::{Markup, html};

/// A technique's study.
pub struct Shown<'a> {
    pub technique: &'a str,
    pub study: &'a Study,
}

/// One page of all of them.
pub fn text(all: &[Shown<'_>]) -> String {
    let title = match all {
        [only] => format!("Memory of {} on {}", only.technique, only.study.scene),
        _ => "Memory of several techniques".to_owned(),
    };
    let body = html! {
        p.note {
            "Made by " code { "quincunx memory" } ". A resource is as wide as its life in passes and as high as its bytes; what shares bytes lies at "
            "the same height in other passes. What has bytes of its own holds them in passes in which it does not live, where it is faint."
        }
        @for shown in all { (section(shown)) }
    };
    page::document(&title, &body)
}

fn section(Shown { technique, study }: &Shown<'_>) -> Markup {
    let report = study.table.report();
    html! {
        section {
            h2 { (technique) " on " (study.scene) ", " (study.device) }
            p { (report.sums_in_words()) "." }
            @if let Some(waste) = report.waste_in_words() { p { "Of no use: " (waste) "." } }
            @for (_, draw) in PICTURES { @if let Some(drawing) = draw(&report) { (picture(&drawing)) } }
            (passes(&report))
            (resources(&report))
        }
    }
}

fn picture(drawing: &Drawing) -> Markup {
    html! {
        h3 { (drawing.title) }
        div.scroll { (drawing.inline()) }
    }
}

fn bytes(bytes: u64) -> (Markup, Option<f64>) {
    (html! { (bytes) }, Some(bytes as f64))
}

fn word(text: &str) -> (Markup, Option<f64>) {
    (html! { (text) }, None)
}

fn passes(report: &MemoryReport) -> Markup {
    let rows: Vec<_> = report
        .passes
        .iter()
        .enumerate()
        .map(|(index, pass)| {
            vec![bytes(index as u64), word(&pass.pass), bytes(pass.live_bytes), bytes(pass.held_bytes)]
        })
        .collect();
    page::table(&[("number", true), ("pass", false), ("live, bytes", true), ("held, bytes", true)], &rows)
}

fn resources(report: &MemoryReport) -> Markup {
    let columns = [
        ("resource", false),
        ("group", false),
        ("asked, bytes", true),
        ("bound, bytes", true),
        ("alignment", true),
        ("what", false),
        ("lives in", false),
        ("shares with", false),
        ("memory type", false),
    ];
    let row = |row: &MemoryRow| {
        let shares = row.arena.as_ref().map(|arena| arena.shares_with.join(", ")).unwrap_or_default();
        vec![
            word(&row.name),
            word(&row.group),
            bytes(row.bytes),
            bytes(row.bound_bytes),
            bytes(row.alignment_bytes),
            word(&row.kind),
            word(&row.lives_in(|pass| pass)),
            word(&shares),
            word(&format!("{}: {}", row.memory_type, row.reason)),
        ]
    };
    page::table(&columns, &report.resources.iter().map(row).collect::<Vec<_>>())
}
