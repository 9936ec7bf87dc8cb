//! All that the papers publish, as a list: what may be compared, and why.

use super::item::{Item, Paper, Published};
use serde_json::{Value, json};
use std::fmt::Write;

/// Lines a paper, an item with its verdict and the reason.
pub fn text(items: &[(&Paper, &Item)]) -> String {
    let mut text = String::new();
    let mut before = "";
    let width = items.iter().map(|(_, item)| item.name.len()).max().unwrap_or_default();
    for (paper, item) in items {
        if paper.name != before {
            let gap = if before.is_empty() { "" } else { "\n" };
            writeln!(text, "{gap}{}  {}: {}, {}", paper.name, paper.authors, paper.title, paper.venue)
                .expect("a string grows");
            before = paper.name;
        }
        let verdict = item.verdict.name();
        writeln!(text, "  {:<width$}  {verdict:<10}  {}", item.name, item.title).expect("a string grows");
    }
    text
}

/// The same with every published number.
pub fn json(items: &[(&Paper, &Item)]) -> Value {
    let document = |(paper, item): &(&Paper, &Item)| {
        json!({
            "paper": paper.name,
            "item": item.name,
            "citation": format!("{}: {}, {}", paper.authors, paper.title, paper.venue),
            "title": item.title,
            "place": item.place,
            "verdict": item.verdict.name(),
            "reason": item.verdict.reason(),
            "published": item.published.iter().map(numbers).collect::<Vec<_>>(),
        })
    };
    json!({ "schema": 1, "items": items.iter().map(document).collect::<Vec<_>>() })
}

fn numbers(table: &Published) -> Value {
    let row = |(name, numbers): &(&str, &[f64])| {
        let numbers: Vec<Option<f64>> = numbers.iter().map(|number| (!number.is_nan()).then_some(*number)).collect();
        json!({ "row": name, "numbers": numbers })
    };
    let rows: Vec<Value> = table.rows.iter().map(row).collect();
    json!({ "title": table.title, "unit": table.unit, "columns": table.columns, "rows": rows })
}
