//! What a person reads of memory.

use super::{MemoryReport, Waste};
use crate::units::Bytes;
use std::fmt::Write;

/// Signs of the longest bar.
const BAR: u64 = 48;

impl MemoryReport {
    /// A line a resource, the sums, and how many bytes there are in each pass.
    pub fn text(&self) -> String {
        let mut text = String::new();
        self.write_rows(&mut text)
            .and_then(|()| self.write_sums(&mut text))
            .and_then(|()| self.write_passes(&mut text))
            .and_then(|()| self.touched.as_ref().map_or(Ok(()), |touched| touched.write(&mut text)))
            .expect("writing to a string");
        text
    }

    fn write_rows(&self, text: &mut String) -> std::fmt::Result {
        let widest = self.resources.iter().map(|row| row.name.len()).max().unwrap_or(0);
        writeln!(
            text,
            "{:<widest$}  {:>12} {:>12} {:>6} {:>6} {:>5}  {:<34} lives in",
            "resource", "asked, B", "bound, B", "align", "waste", "type", "what"
        )?;
        for row in &self.resources {
            let lives = row.lives_in(short);
            let lives = match &row.arena {
                Some(arena) => format!("{lives}, shared from {}", arena.offset),
                None => lives,
            };
            writeln!(
                text,
                "{:<widest$}  {:>12} {:>12} {:>6} {:>6} {:>5}  {:<34} {lives}",
                row.name,
                row.bytes,
                row.bound_bytes,
                row.alignment_bytes,
                row.alignment_waste_bytes,
                row.memory_type,
                row.kind,
            )?;
        }
        Ok(())
    }

    fn write_sums(&self, text: &mut String) -> std::fmt::Result {
        let mut reasons: Vec<(u32, &str)> = self.resources.iter().map(|row| (row.memory_type, &*row.reason)).collect();
        reasons.sort_unstable();
        reasons.dedup();
        writeln!(text)?;
        for (memory_type, reason) in reasons {
            writeln!(text, "type {memory_type}: {reason}")?;
        }
        for (group, bytes) in self.sums.groups.iter().flatten() {
            writeln!(text, "{group:<18} {}", Bytes(*bytes))?;
        }
        writeln!(text, "{}", self.sums_in_words())?;
        self.waste_in_words().map_or(Ok(()), |waste| writeln!(text, "of no use: {waste}"))
    }

    /// The sums, without a full stop.
    pub fn sums_in_words(&self) -> String {
        let sums = &self.sums;
        format!(
            "{} planned, {} allocated, {} of it saved by sharing, peak {} in {}",
            Bytes(sums.planned_bytes),
            Bytes(sums.allocated_bytes.unwrap_or_default()),
            Bytes(sums.aliased_bytes.unwrap_or_default()),
            Bytes(sums.peak_bytes),
            short(sums.peak_pass.as_deref().unwrap_or_default())
        )
    }

    /// What is of no use, by reason, without a full stop; None in reports of before it was written.
    pub fn waste_in_words(&self) -> Option<String> {
        let Waste { padding_bytes, alignment_bytes, idle_bytes, free_bytes } = self.waste.as_ref()?;
        let free = free_bytes.map(|bytes| format!(", {} free in memory blocks", Bytes(bytes)));
        Some(format!(
            "{} padding, {} of alignment, {} idle where most lives{}",
            Bytes(*padding_bytes),
            Bytes(*alignment_bytes),
            Bytes(*idle_bytes),
            free.unwrap_or_default()
        ))
    }

    /// A bar a pass: what lives in it, and behind it what it holds beside that.
    fn write_passes(&self, text: &mut String) -> std::fmt::Result {
        let widest = self.passes.iter().map(|pass| short(&pass.pass).len()).max().unwrap_or(0);
        let most = self.passes.iter().map(|pass| pass.held_bytes).max().unwrap_or(0).max(1);
        let signs = |bytes: u64| (u128::from(bytes) * u128::from(BAR)).div_ceil(u128::from(most)) as usize;
        if !self.passes.is_empty() {
            writeln!(text, "\n{:<widest$}  {:>12} {:>12}  # live, - held", "pass", "live", "held")?;
        }
        for pass in &self.passes {
            let (live, held) = (signs(pass.live_bytes), signs(pass.held_bytes));
            writeln!(
                text,
                "{:<widest$}  {:>12} {:>12}  {}{}",
                short(&pass.pass),
                Bytes(pass.live_bytes).to_string(),
                Bytes(pass.held_bytes).to_string(),
                "#".repeat(live),
                "-".repeat(held.saturating_sub(live))
            )?;
        }
        Ok(())
    }
}

/// A pass without its technique.
pub(super) fn short(pass: &str) -> &str {
    pass.split_once('.').map_or(pass, |(_, rest)| rest)
}
