//! `bench device`: what a device does with memory when it does nothing else, and passes held against that. Shader: glsl/bench/device.comp.

pub mod explained;
pub mod work;

use super::rounds::{self, Length, Probe, Samples};
use super::stats::median;
use super::table::Table;
use crate::caps::Identity;
use crate::error::Result;
use crate::gpu::Gpu;
use crate::report::spread::Spread;
use crate::units::Bytes;
use serde::{Deserialize, Serialize};
use std::rc::Rc;
use std::sync::Arc;
use work::{Buffers, Work, Worked};

/// Number of the set of keys.
const SCHEMA: u32 = 1;

/// A row of `bench device`; its fields are the keys of the JSON document, in their order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorkRow {
    /// Number of the set of keys.
    pub schema: u32,
    /// `device`.
    pub bench: String,
    pub device: Identity,
    /// Commit of the program.
    pub commit: String,
    /// `read`, `gather` and the like.
    pub work: String,
    /// Bytes of each of the two buffers.
    pub buffer_bytes: u64,
    /// Rounds.
    pub repeat: usize,
    pub ms: Spread,
    /// Bytes that are read.
    pub bytes_read: u64,
    /// Bytes that are written.
    pub bytes_written: u64,
    /// Those, 10^9 a second, of the median.
    pub gb_per_s: f64,
    /// Nanoseconds a word, of work on single words; None of the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ns_per_word: Option<f64>,
}

impl WorkRow {
    /// As rows are written: one line, without its end.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("its keys are texts")
    }
}

/// Measures all work in turn, over buffers of `bytes`, a power of two of at least 1 MiB. `progress` is called with the measurements
/// done, and of how many.
///
/// Errors: memory, or the device fails (exit code 4); interrupted (130).
pub fn run(gpu: &Arc<Gpu>, bytes: u64, repeat: usize, progress: &mut dyn FnMut(usize, usize)) -> Result<Vec<WorkRow>> {
    let buffers = Rc::new(Buffers::new(gpu, bytes)?);
    // A word that nothing else is.
    let worked = Work::ALL.into_iter().map(|work| Worked::new(gpu, work, &buffers, 7)).collect::<Result<Vec<_>>>()?;
    let probes: Vec<&dyn Probe> = worked.iter().map(|one| one as &dyn Probe).collect();
    let samples = rounds::run(&probes, Length { least: repeat, until_interval: None }, progress)?;
    Ok(worked.iter().zip(&samples).map(|(one, samples)| row(gpu, one.work, bytes, repeat, samples)).collect())
}

fn row(gpu: &Gpu, work: Work, bytes: u64, repeat: usize, samples: &Samples) -> WorkRow {
    let times = samples.totals_ms();
    let [bytes_read, bytes_written] = work.moved_bytes(bytes);
    // Bytes over milliseconds are kilobytes a second.
    let gb_per_s = (bytes_read + bytes_written) as f64 / median(&times) / 1e6;
    WorkRow {
        schema: SCHEMA,
        bench: "device".to_owned(),
        device: gpu.caps.identity.clone(),
        commit: env!("QUINCUNX_COMMIT").to_owned(),
        work: work.name(),
        buffer_bytes: bytes,
        repeat,
        ms: Spread::of(&times).unwrap_or_default(),
        bytes_read,
        bytes_written,
        gb_per_s,
        ns_per_word: work.word_count(bytes).map(|words| 1e6 * median(&times) / words.max(1) as f64),
    }
}

/// The rows as a table.
pub fn text(rows: &[WorkRow]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let mut lines = vec![["work", "median ms", "GB/s", "ns a word"].map(str::to_owned).to_vec()];
    lines.extend(rows.iter().map(|row| {
        let single = row.ns_per_word.map_or_else(|| "-".to_owned(), |ns| format!("{ns:.3}"));
        vec![row.work.clone(), format!("{:.3}", row.ms.median), format!("{:.2}", row.gb_per_s), single]
    }));
    let software = if first.device.is_software() { ", software driver" } else { "" };
    format!(
        "{} ({}{software}), buffers of {}, {} rounds\n\n{}",
        first.device.name,
        first.device.driver_info,
        Bytes(first.buffer_bytes),
        first.repeat,
        Table::of_lines(lines).text()
    )
}
