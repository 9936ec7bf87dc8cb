//! Rows of `bench allocate`, and how they are made and shown.

use super::contender::{Place, Variant};
use super::line_up::contenders;
use super::play::{Measures, Script};
use super::timed::Timed;
use crate::bench::rounds::{self, Length, Probe};
use crate::bench::stats::{Ratio, paired_ratio};
use crate::bench::table::{Table, ratio};
use crate::error::{Error, Result};
use crate::memory::trace::{Event, Trace};
use crate::report::spread::Spread;
use crate::units::Bytes;
use serde::{Deserialize, Serialize};

/// Number of the set of keys.
const SCHEMA: u32 = 1;

/// One trace through one allocator; its fields are the keys of the JSON document, in their order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AllocateRow {
    /// Number of the set of keys.
    pub schema: u32,
    /// `allocate`.
    pub bench: String,
    /// Commit of the program.
    pub commit: String,
    /// A device's name, or `numbers`.
    pub place: String,
    pub trace: String,
    /// `quincunx`, or another's name.
    pub allocator: String,
    /// What was asked of it.
    pub variant: String,
    /// Rounds.
    pub repeat: usize,
    /// Why the trace cannot be replayed, and where; there are no figures then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
    /// Nanoseconds a take or give, each sample the mean of a round.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ns_per_operation: Option<Spread>,
    /// Time in parts of that of the trace's first row with figures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ratio: Option<Ratio>,
    #[serde(flatten)]
    pub measures: Option<Measures>,
}

impl AllocateRow {
    /// As rows are written: one line, without its end.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("its keys are texts")
    }
}

/// Replays `trace` through `variants` and the rivals that there are, in turn. `progress`: as of `rounds::run`.
///
/// Errors: the trace has a memory type that the place lacks (exit code 2); on a device it takes more than half of a heap, or
/// the device fails (4); interrupted (130).
pub fn run(
    trace: &Trace,
    place: &Place<'_>,
    variants: &[Variant],
    repeat: usize,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Vec<AllocateRow>> {
    require_possible(trace, place)?;
    let script = Script::new(trace);
    let (mut rows, mut timed) = (Vec::new(), Vec::new());
    for contender in contenders(&script, place, variants)? {
        let mut accounted = contender.accounted;
        let found = script.measure(&mut *accounted);
        let mut row = AllocateRow {
            schema: SCHEMA,
            bench: "allocate".to_owned(),
            commit: env!("QUINCUNX_COMMIT").to_owned(),
            place: place.name().to_owned(),
            trace: trace.name.clone(),
            allocator: contender.allocator.to_owned(),
            variant: contender.variant,
            repeat,
            refused: None,
            ns_per_operation: None,
            ratio: None,
            measures: None,
        };
        match found {
            Ok(measures) => {
                row.measures = Some(measures);
                timed.push((rows.len(), Timed::new(&script, contender.timed)));
            }
            Err((at, why)) => row.refused = Some(format!("event {at} ({}): {why}", name_of(trace, at))),
        }
        rows.push(row);
    }
    let probes: Vec<&dyn Probe> = timed.iter().map(|(_, timed)| timed as &dyn Probe).collect();
    if probes.is_empty() {
        return Ok(rows);
    }
    let samples = rounds::run(&probes, Length { least: repeat, until_interval: None }, progress)?;
    let first = samples[0].totals_ms();
    for ((index, timed), samples) in timed.iter().zip(&samples) {
        let ns = 1e6 / timed.operation_count() as f64;
        let times: Vec<f64> = samples.totals_ms().iter().map(|ms| ms * ns).collect();
        rows[*index].ns_per_operation = Spread::of(&times);
        rows[*index].ratio = Some(paired_ratio(&samples.totals_ms(), &first));
    }
    Ok(rows)
}

/// What the event's resource is called.
fn name_of(trace: &Trace, at: usize) -> &str {
    match &trace.events()[at] {
        Event::Take { name, .. } if !name.is_empty() => name,
        _ => "without a name",
    }
}

fn require_possible(trace: &Trace, place: &Place<'_>) -> Result<()> {
    let caps = place.caps();
    let type_count = caps.memory_types.len();
    for (at, event) in trace.events().iter().enumerate() {
        let Event::Take { name, ask, .. } = event else { continue };
        if ask.type_index as usize >= type_count {
            let why = format!(
                "{}: event {at} ({name}) takes memory type {}, and {} has {type_count}",
                trace.name, ask.type_index, caps.identity.name
            );
            return Err(Error::request(why).note("--caps names the driver that the trace is of"));
        }
    }
    // Each contender is there twice, and a driver may grant more than there is.
    let least_heap = caps.heaps.iter().map(|heap| heap.bytes).min().unwrap_or_default();
    let peak = trace.peak_live_bytes();
    if matches!(place, Place::Device(_)) && peak > least_heap / 4 {
        let [peak, heap] = [peak, least_heap].map(Bytes);
        let why =
            format!("{}: {peak} are live at once, and no more than a quarter of a heap of {heap} is tried", trace.name);
        return Err(Error::memory(why).note("without --on-device the numbers alone are replayed"));
    }
    Ok(())
}

/// The rows of one trace as a table.
pub fn text(rows: &[AllocateRow]) -> String {
    let titles = [
        "allocator",
        "variant",
        "ns an operation",
        "least to most",
        "time ratio (95 %)",
        "peak",
        "rounded up",
        "gaps",
        "lost",
        "free",
        "memory blocks",
        "fragmented: end",
        "worst",
    ];
    let mut lines = vec![titles.map(str::to_owned).to_vec()];
    lines.extend(rows.iter().map(line));
    let refused = rows.iter().filter_map(|row| {
        row.refused.as_ref().map(|why| format!("{} {}: refused at {why}\n", row.allocator, row.variant))
    });
    Table::of_lines(lines).text() + &refused.collect::<String>()
}

fn line(row: &AllocateRow) -> Vec<String> {
    let none = || "-".to_owned();
    let time = |read: fn(&Spread) -> String| row.ns_per_operation.as_ref().map_or_else(none, read);
    let bytes =
        |read: fn(&Measures) -> u64| row.measures.as_ref().map_or_else(none, |found| Bytes(read(found)).to_string());
    let part =
        |read: fn(&Measures) -> f64| row.measures.as_ref().map_or_else(none, |found| format!("{:.3}", read(found)));
    vec![
        row.allocator.clone(),
        row.variant.clone(),
        time(|ns| format!("{:.1}", ns.median)),
        time(|ns| format!("{:.1} to {:.1}", ns.min, ns.max)),
        row.ratio.as_ref().map_or_else(none, ratio),
        bytes(|found| found.peak_bytes),
        bytes(|found| found.at_peak.padding_bytes),
        bytes(|found| found.at_peak.gap_bytes),
        bytes(|found| found.at_peak.lost_bytes),
        bytes(|found| found.at_peak.free_bytes),
        row.measures.as_ref().map_or_else(none, |found| found.memory_blocks.to_string()),
        part(|found| found.end_fragmentation),
        part(|found| found.worst_fragmentation),
    ]
}
