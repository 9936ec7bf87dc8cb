//! A report as text for a reader.

use super::run::{PassRow, RunReport};
use crate::techniques;
use crate::techniques::notes::Figures;
use crate::units::Bytes;
use std::fmt::Write;

/// What a pass's statistics say of its shaders; None where it has none.
fn invocations(pass: &PassRow) -> Option<String> {
    let counts = pass.statistics.as_ref()?;
    let count = |stage: &str| counts.get(&format!("{stage}_shader_invocations")).copied().unwrap_or_default();
    let stages = ["vertex", "geometry", "fragment", "compute"].into_iter().filter(|stage| count(stage) > 0);
    let told: Vec<String> = stages.map(|stage| format!("{stage} {}", count(stage))).collect();
    Some(format!("{} invocations", if told.is_empty() { "no".to_owned() } else { told.join(", ") }))
}

/// What the least time of a pass is of its time; None where it is not known.
fn share(pass: &PassRow) -> Option<String> {
    let least = pass.least.as_ref()?;
    let impossible = if least.is_impossible { ", impossible" } else { "" };
    Some(format!("{:.1} % by {}{impossible}", 100.0 * least.share, least.bound.name()))
}

impl RunReport {
    /// The report as text for a reader.
    pub fn text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text).expect("writing to a string");
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let scene = &self.scene;
        writeln!(
            text,
            "{}  {} triangles, {} draws, {} lights, {} materials",
            scene.name, scene.triangles, scene.draws, scene.lights, scene.materials
        )?;
        for warning in &scene.warnings {
            writeln!(text, "  note: {warning}")?;
        }
        let device = &self.device.identity;
        writeln!(text, "{}  ({}, Vulkan {})", device.name, device.driver_info, device.api)?;
        self.write_times(text)?;
        for line in self.told_by_technique() {
            writeln!(text, "{line}")?;
        }
        let sums = &self.memory.sums;
        writeln!(
            text,
            "memory: {} planned, {} allocated, {} saved by sharing, {} in memory blocks",
            Bytes(sums.planned_bytes),
            Bytes(sums.allocated_bytes.unwrap_or_default()),
            Bytes(sums.aliased_bytes.unwrap_or_default()),
            Bytes(self.memory.memory_block_bytes.unwrap_or_default())
        )?;
        if let (Some(touched), Some(of)) = (sums.touched_bytes, sums.touched_of_bytes) {
            let (touched, of) = (Bytes(touched), Bytes(of));
            let over = match &self.memory.touched {
                Some(counted) => format!("in pieces of {} B", counted.granule_bytes),
                None => "over the resources in which the frame counts".to_owned(),
            };
            writeln!(text, "  touched: {touched} of {of}, {over}")?;
        }
        if let Some(errors) = &self.errors {
            writeln!(text, "errors against {}", errors.reference)?;
            for (measure, value) in errors.metrics.each() {
                writeln!(text, "{}", measure.line(value, errors.threshold, !errors.cut.is_empty()))?;
            }
        }
        for note in &self.notes {
            writeln!(text, "note: {note}")?;
        }
        if let Some(exposure_ev) = self.image.exposure_ev.filter(|exposure_ev| *exposure_ev != 0.0) {
            writeln!(text, "exposure {exposure_ev} EV")?;
        }
        writeln!(text, "image hash {}", self.image.hash)?;
        writeln!(text, "wrote {}", self.image.path)
    }

    fn write_times(&self, text: &mut String) -> std::fmt::Result {
        for pass in &self.times.passes {
            let place = pass.place.as_ref().map_or_else(String::new, |place| format!("  ({place})"));
            let time = pass.median_ms().map(|ms| format!("{ms:>10.3} ms{place}"));
            let told: Vec<String> = time.into_iter().chain(share(pass)).chain(invocations(pass)).collect();
            if !told.is_empty() {
                writeln!(text, "  {:<44} {}", pass.name, told.join("  "))?;
            }
        }
        let software = if self.device.identity.is_software() { ", software driver" } else { "" };
        let warm = if self.times.warmup_frames == 0 { ", first frame, shader compilation included" } else { "" };
        let total = self.times.total_ms.as_ref().map_or(0.0, |total| total.median);
        writeln!(text, "  {:<44} {total:>10.3} ms{software}{warm}", "frame")?;
        if self.times.passes.iter().any(|pass| pass.least.is_some()) {
            writeln!(
                text,
                "  %: the least time that this device needs for a pass, by what takes it, as a share of the pass's time"
            )?;
        }
        self.times.timing_warnings.iter().try_for_each(|warning| writeln!(text, "  note: {warning}"))
    }

    /// Lines of the technique; none where this program does not have it.
    fn told_by_technique(&self) -> Vec<String> {
        let Ok(technique) = techniques::find(&self.technique) else { return Vec::new() };
        technique.notes(&Figures {
            counters: &self.counters,
            settings: &self.settings,
            pass_ms: self.times.passes.iter().map(|pass| (pass.name.as_str(), pass.median_ms())).collect(),
        })
    }
}
