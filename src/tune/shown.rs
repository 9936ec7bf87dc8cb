//! What a search has seen: pictures and how near they are, and how many candidates there were.

use crate::metrics::Metrics;
use serde::Serialize;

/// A picture that some of the candidates make.
#[derive(Clone, Debug, Serialize)]
pub struct Shown {
    /// Those that make it, of the axes.
    pub settings: String,
    /// None where it was not made.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors: Option<Metrics>,
    #[serde(rename = "near")]
    pub is_near: bool,
}

impl Shown {
    pub fn unseen(settings: &str) -> Self {
        Self { settings: settings.to_owned(), errors: None, is_near: false }
    }
}

/// How many there were.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Counts {
    /// Values of the axes, all with all.
    pub combinations: usize,
    /// Those of them that can be and that differ in what is read.
    pub candidates: usize,
    /// Pictures that they make.
    pub pictures: usize,
    /// Those that are near enough.
    pub near_pictures: usize,
    /// Candidates that make these.
    pub near_candidates: usize,
    /// Those of them that were measured.
    pub measured: usize,
    /// Candidates that the device or its memory refused.
    pub refused: usize,
    /// Frames before the last measurement.
    pub search_frames: usize,
    /// Frames of a sweep over `near_candidates` with as many rounds as the last measurement has.
    pub sweep_frames: usize,
}
