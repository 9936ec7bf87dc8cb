//! A row of `bench device`: one kind of work and how fast the device does it. Keys: docs/bench.md.

use super::spread::Spread;
use crate::caps::Identity;
use crate::error::{Error, Result};
use crate::whole_file::read_document;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Number of the set of keys.
pub const SCHEMA: u32 = 1;
/// What `WorkRow::bench` is.
pub const BENCH: &str = "device";

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
    /// `read`, `random`, `fill` and the like.
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
    /// Triangles a second of the median, where it is they that take the time; None of the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub triangles_per_s: Option<f64>,
    /// Pixels a second of the median, where it is they that take the time; None of the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pixels_per_s: Option<f64>,
}

impl WorkRow {
    /// As rows are written: one line, without its end.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("its keys are texts")
    }

    /// The rows of a file, one a line; empty lines are passed over.
    ///
    /// Errors: it cannot be read, or a line is no such row (exit code 2).
    pub fn read(path: &Path) -> Result<Vec<Self>> {
        let row = |(line, at): (&str, usize)| {
            let refused = |why: &dyn std::fmt::Display| {
                Error::request(format!("{}:{at}: it is no row of `bench device`: {why}", path.display()))
                    .note("`quincunx bench device --json` prints them")
            };
            let row: Self = serde_json::from_str(line).map_err(|error| refused(&error))?;
            if (row.schema, row.bench.as_str()) != (SCHEMA, BENCH) {
                return Err(refused(&format!("it is of `bench {}`, schema {}", row.bench, row.schema)));
            }
            Ok(row)
        };
        read_document(path)?.lines().zip(1..).filter(|(line, _)| !line.trim().is_empty()).map(row).collect()
    }
}
