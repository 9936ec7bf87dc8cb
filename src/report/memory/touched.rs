//! What a report says of the bytes that a frame touched: pass by pass, and a resource by its levels.

use crate::gpu::marks::counted::{FrameTouches, Touches};
use crate::units::Bytes;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A frame that counted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TouchedReport {
    /// Bytes of the pieces in which was counted.
    pub granule_bytes: u64,
    /// In the order in which they ran.
    pub passes: Vec<TouchedPass>,
    /// What all of them together touched, by resource.
    pub resources: Vec<TouchedRow>,
}

/// A pass that touched something.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TouchedPass {
    /// Its full name.
    pub pass: String,
    /// Invocations of its compute shader, or of its fragment shaders.
    #[serde(default)]
    pub invocations: u64,
    pub resources: Vec<TouchedRow>,
    /// Names of resources that it touched in a way that nobody counts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unknown: Vec<String>,
}

/// A resource that was touched, all in bytes. Pieces count whole, but for the last one of a buffer and those at an image's edge.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TouchedRow {
    pub resource: String,
    /// Its size.
    pub bytes: u64,
    /// Pieces that were read or written.
    pub touched_bytes: u64,
    pub read_bytes: u64,
    pub written_bytes: u64,
    /// Asked for by all reads, each anew: over `read_bytes` it is how often these were read.
    pub asked_read_bytes: u64,
    /// Asked for by all writes.
    pub asked_written_bytes: u64,
    /// Mip levels of an image with several, the finest first: bytes of each, and touched ones.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<[u64; 2]>,
}

impl TouchedRow {
    fn of(name: &str, touches: &Touches) -> Self {
        let shape = &touches.shape;
        let touched = shape.marked_bytes(&touches.all_marks());
        let sum = |marks: &[u32]| shape.marked_bytes(marks).into_iter().sum();
        let levels = shape.level_bytes();
        let has_levels = levels.len() > 1;
        Self {
            resource: name.to_owned(),
            bytes: shape.bytes(),
            touched_bytes: touched.iter().sum(),
            read_bytes: sum(&touches.reads.marks),
            written_bytes: sum(&touches.writes.marks),
            asked_read_bytes: touches.reads.asked_bytes,
            asked_written_bytes: touches.writes.asked_bytes,
            levels: levels
                .into_iter()
                .zip(touched)
                .map(|(all, touched)| [all, touched])
                .filter(|_| has_levels)
                .collect(),
        }
    }
}

impl TouchedReport {
    pub fn of(granule_bytes: u64, frame: &FrameTouches) -> Self {
        let passes = frame.passes.iter().map(|pass| TouchedPass {
            pass: pass.pass.clone(),
            invocations: pass.invocations,
            resources: pass.resources.iter().map(|(name, touches)| TouchedRow::of(name, touches)).collect(),
            unknown: pass.unknown.iter().cloned().collect(),
        });
        let resources = frame.resources();
        Self {
            granule_bytes,
            passes: passes.collect(),
            resources: resources.iter().map(|(name, touches)| TouchedRow::of(name, touches)).collect(),
        }
    }

    /// A line a pass, and a line a resource: what is touched, and how often what is touched is read.
    pub fn write(&self, text: &mut String) -> std::fmt::Result {
        let often = |row: &TouchedRow| row.asked_read_bytes as f64 / row.read_bytes.max(1) as f64;
        let widest = self.resources.iter().map(|row| row.resource.len());
        let widest = widest.chain(self.passes.iter().map(|pass| pass.pass.len())).max().unwrap_or(0);
        writeln!(text, "\ntouched, in pieces of {}", Bytes(self.granule_bytes))?;
        writeln!(
            text,
            "{:<widest$}  {:>12} {:>12} {:>16} {:>16} {:>12}",
            "pass", "read, B", "written, B", "asked, B", "stored, B", "invocations"
        )?;
        for pass in &self.passes {
            let sum = |bytes: fn(&TouchedRow) -> u64| pass.resources.iter().map(bytes).sum::<u64>();
            writeln!(
                text,
                "{:<widest$}  {:>12} {:>12} {:>16} {:>16} {:>12}{}",
                pass.pass,
                sum(|row| row.read_bytes),
                sum(|row| row.written_bytes),
                sum(|row| row.asked_read_bytes),
                sum(|row| row.asked_written_bytes),
                pass.invocations,
                if pass.unknown.is_empty() { String::new() } else { format!("  unknown: {}", pass.unknown.join(", ")) }
            )?;
        }
        writeln!(text, "{:<widest$}  {:>12} {:>12} {:>8} {:>8}", "resource", "touched, B", "of, B", "share", "reads")?;
        for row in &self.resources {
            let share = 100.0 * row.touched_bytes as f64 / row.bytes.max(1) as f64;
            writeln!(
                text,
                "{:<widest$}  {:>12} {:>12} {share:>7.1}% {:>8.1}",
                row.resource,
                row.touched_bytes,
                row.bytes,
                often(row)
            )?;
        }
        Ok(())
    }

    /// Whether a pass touched it in a way that nobody counts.
    pub fn is_unknown(&self, resource: &str) -> bool {
        self.passes.iter().any(|pass| pass.unknown.iter().any(|name| name == resource))
    }

    /// Touched bytes by resource.
    pub fn by_resource(&self) -> BTreeMap<String, u64> {
        self.resources.iter().map(|row| (row.resource.clone(), row.touched_bytes)).collect()
    }
}
