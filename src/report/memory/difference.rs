//! What two reports of memory differ in: resources by their names behind the technique's, groups and sums.

use super::text::short;
use super::{MemoryReport, MemoryRow};
use crate::units::Bytes;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fmt::Write;

/// One of the two.
#[derive(Clone, Copy)]
pub struct Side<'a> {
    /// What it is called.
    pub name: &'a str,
    pub memory: &'a MemoryReport,
}

/// Bytes of something in both; None where it is in one alone.
struct Line {
    name: String,
    bytes: [Option<u64>; 2],
}

impl Line {
    fn grown_bytes(&self) -> i128 {
        let [before, after] = self.bytes.map(|bytes| i128::from(bytes.unwrap_or_default()));
        after - before
    }

    fn json(&self) -> Value {
        json!({ "name": self.name, "bytes": self.bytes, "difference": self.grown_bytes() as i64 })
    }
}

/// What makes a sum of a report; None where it has none.
type Sum = fn(&MemoryReport) -> Option<u64>;

/// What differs, and how much is the same in both.
pub struct Difference<'a> {
    sides: [Side<'a>; 2],
    resources: Vec<Line>,
    groups: Vec<Line>,
    sums: Vec<Line>,
    /// Resources that take as many bytes in both, and how many these are.
    same: (usize, u64),
}

/// A scene's resource has its whole name.
fn name(row: &MemoryRow) -> &str {
    if row.name.starts_with("scene.") { &row.name } else { short(&row.name) }
}

impl<'a> Difference<'a> {
    pub fn new(sides: [Side<'a>; 2]) -> Self {
        let of = |side: &Side<'_>, wanted: &str| {
            let rows = side.memory.resources.iter().filter(|row| name(row) == wanted);
            rows.map(|row| row.bound_bytes).reduce(|sum, bytes| sum + bytes)
        };
        let mut seen = BTreeSet::new();
        let names = sides.iter().flat_map(|side| side.memory.resources.iter().map(name));
        let names: Vec<&str> = names.filter(|name| seen.insert(*name)).collect();
        let all = names
            .into_iter()
            .map(|name| Line { name: name.to_owned(), bytes: [&sides[0], &sides[1]].map(|side| of(side, name)) });
        let (same, mut resources): (Vec<Line>, Vec<Line>) = all.partition(|line| line.bytes[0] == line.bytes[1]);
        resources.sort_by_key(|line| std::cmp::Reverse(line.grown_bytes().abs()));
        let group = |side: &Side<'_>, name: &str| side.memory.sums.groups.as_ref()?.get(name).copied();
        let groups: BTreeSet<&String> =
            sides.iter().flat_map(|side| side.memory.sums.groups.iter().flatten().map(|(name, _)| name)).collect();
        let groups = groups
            .into_iter()
            .map(|name| Line { name: name.clone(), bytes: [&sides[0], &sides[1]].map(|side| group(side, name)) });
        let sums: [(&str, Sum); 5] = [
            ("planned", |memory| Some(memory.sums.planned_bytes)),
            ("allocated", |memory| memory.sums.allocated_bytes),
            ("saved by sharing", |memory| memory.sums.aliased_bytes),
            ("peak", |memory| Some(memory.sums.peak_bytes)),
            ("memory blocks", |memory| memory.memory_block_bytes),
        ];
        let sums = sums
            .into_iter()
            .map(|(name, read)| Line { name: name.to_owned(), bytes: sides.map(|side| read(side.memory)) });
        Self {
            sides,
            resources,
            groups: groups.filter(|line| line.bytes[0] != line.bytes[1]).collect(),
            sums: sums.filter(|line| line.bytes.iter().any(Option::is_some)).collect(),
            same: (same.len(), same.iter().filter_map(|line| line.bytes[0]).sum()),
        }
    }

    pub fn json(&self) -> Value {
        let all = |lines: &[Line]| lines.iter().map(Line::json).collect::<Vec<_>>();
        json!({
            "schema": 1,
            "of": self.sides.map(|side| side.name),
            "resources": all(&self.resources),
            "groups": all(&self.groups),
            "sums": all(&self.sums),
            "same_resources": self.same.0,
            "same_bytes": self.same.1,
        })
    }

    pub fn text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text).expect("writing to a string");
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let [before, after] = self.sides.map(|side| side.name);
        writeln!(text, "A  {before}\nB  {after}")?;
        let lines = || self.resources.iter().chain(&self.groups).chain(&self.sums);
        let widest = lines().map(|line| line.name.len()).max().unwrap_or(0);
        for (title, lines) in [("resource", &self.resources), ("group", &self.groups), ("sum", &self.sums)] {
            if lines.is_empty() {
                continue;
            }
            writeln!(text, "\n{title:<widest$}  {:>14} {:>14} {:>15}", "bytes in A", "bytes in B", "difference")?;
            for line in lines {
                let [a, b] = line.bytes.map(|bytes| bytes.map_or_else(|| "-".to_owned(), |bytes| bytes.to_string()));
                writeln!(text, "{:<widest$}  {a:>14} {b:>14} {:>+15}", line.name, line.grown_bytes())?;
            }
        }
        let (count, bytes) = self.same;
        writeln!(text, "\n{count} resources of {} are the same in both", Bytes(bytes))
    }
}
