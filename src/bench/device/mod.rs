//! `bench device`: what a device does with memory and with triangles when it does nothing else, and passes held against that. Shaders:
//! glsl/bench/device.comp, glsl/bench/device/.

pub mod explained;
pub mod triangles;
pub mod work;

use super::rounds::{self, Length, Probe, Samples};
use super::table::Table;
use crate::error::Result;
use crate::gpu::Gpu;
use crate::report::spread::Spread;
use crate::report::work_row::{BENCH, SCHEMA, WorkRow};
use crate::units::Bytes;
use std::rc::Rc;
use std::sync::Arc;
use triangles::{Drawing, Drawn};
use work::{Buffers, Work, Worked};

/// Measures all work in turn, over buffers of `bytes`, a power of two of at least 1 MiB. `progress` is called with the measurements
/// done, and of how many.
///
/// Errors: memory, or the device fails (exit code 4); interrupted (130).
pub fn run(gpu: &Arc<Gpu>, bytes: u64, repeat: usize, progress: &mut dyn FnMut(usize, usize)) -> Result<Vec<WorkRow>> {
    let buffers = Rc::new(Buffers::new(gpu, bytes)?);
    // A word that nothing else is.
    let worked = Work::ALL.into_iter().map(|work| Worked::new(gpu, work, &buffers, 7)).collect::<Result<Vec<_>>>()?;
    let drawn = Drawn::ALL.into_iter().map(|one| Drawing::new(gpu, one, one.grid())).collect::<Result<Vec<_>>>()?;
    let mut probes: Vec<&dyn Probe> = worked.iter().map(|one| one as &dyn Probe).collect();
    probes.extend(drawn.iter().map(|one| one as &dyn Probe));
    let samples = rounds::run(&probes, Length { least: repeat, until_interval: None }, progress)?;
    let (of_work, of_drawn) = samples.split_at(worked.len());
    let row = |name, moved_bytes, samples| row(gpu, name, bytes, moved_bytes, repeat, samples);
    let mut rows = Vec::new();
    for (one, samples) in worked.iter().zip(of_work) {
        let row = row(one.work.name(), one.work.moved_bytes(bytes), samples);
        let ns_per_word = one.work.word_count(bytes).map(|words| 1e6 * row.ms.median / words.max(1) as f64);
        rows.push(WorkRow { ns_per_word, ..row });
    }
    for (one, samples) in drawn.iter().zip(of_drawn) {
        let row = row(one.drawn.name().to_owned(), one.drawn.moved_bytes(one.grid), samples);
        let per_s = |count: Option<u64>| Some(1e3 * count? as f64 / row.ms.median);
        let triangles_per_s = per_s(one.drawn.triangle_count(one.grid));
        let pixels_per_s = per_s(one.drawn.pixel_count(one.grid));
        rows.push(WorkRow { triangles_per_s, pixels_per_s, ..row });
    }
    Ok(rows)
}

/// The row of a work without what single kinds of work have beside. `bytes`: of each of the two buffers.
fn row(gpu: &Gpu, work: String, bytes: u64, moved_bytes: [u64; 2], repeat: usize, samples: &Samples) -> WorkRow {
    let ms = Spread::of(&samples.totals_ms()).unwrap_or_default();
    let [bytes_read, bytes_written] = moved_bytes;
    WorkRow {
        schema: SCHEMA,
        bench: BENCH.to_owned(),
        device: gpu.caps.identity.clone(),
        commit: env!("QUINCUNX_COMMIT").to_owned(),
        work,
        buffer_bytes: bytes,
        repeat,
        bytes_read,
        bytes_written,
        // Bytes over milliseconds are kilobytes a second.
        gb_per_s: (bytes_read + bytes_written) as f64 / ms.median / 1e6,
        ns_per_word: None,
        triangles_per_s: None,
        pixels_per_s: None,
        ms,
    }
}

/// The rows as a table.
pub fn text(rows: &[WorkRow]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let titles = ["work", "median ms", "GB/s", "ns a word", "million triangles/s", "million pixels/s"];
    let mut lines = vec![titles.map(str::to_owned).to_vec()];
    lines.extend(rows.iter().map(|row| {
        let if_known =
            |number: Option<f64>, digits: usize| number.map_or("-".to_owned(), |it| format!("{it:.digits$}"));
        let millions = |per_s: Option<f64>| if_known(per_s.map(|per_s| per_s / 1e6), 1);
        vec![
            row.work.clone(),
            format!("{:.3}", row.ms.median),
            format!("{:.2}", row.gb_per_s),
            if_known(row.ns_per_word, 3),
            millions(row.triangles_per_s),
            millions(row.pixels_per_s),
        ]
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
