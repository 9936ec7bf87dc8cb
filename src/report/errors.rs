//! Errors of a picture against its reference, as reports and rows write them.

use crate::metrics::Metrics;
use crate::metrics::gate::Verdict;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// A report's `errors`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// File of the reference, or `auto`.
    pub reference: String,
    /// Name under which the reference of `auto` is kept; None of a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_key: Option<String>,
    /// Texts of the settings of the path tracing that made it; None of a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_settings: Option<IndexMap<String, String>>,
    #[serde(flatten)]
    pub metrics: Metrics,
    /// HDR-FLIP above which a pixel counts in `over_threshold`.
    pub threshold: f64,
    /// Measures of light that a PNG has cut; empty where none did.
    pub cut: Vec<String>,
    /// The gates, in the order of the command line.
    pub gates: Vec<Verdict>,
}

/// What says that the errors of two rows are against the same: the reference and the threshold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceIdentity {
    /// File, or `auto`.
    pub name: String,
    /// BLAKE3 of the file's pixels, hexadecimal; None of `auto`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hash: Option<String>,
    /// Technique that makes the picture of `auto`; None of a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub technique: Option<String>,
    /// Its samples a pixel; None of a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spp: Option<u64>,
    /// As `Errors::threshold`.
    pub threshold: f64,
}
