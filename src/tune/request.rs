//! What a search is asked for.

use crate::bench::sweep::Axis;
use crate::job::Job;
use crate::metrics::gate::Gate;
use std::path::Path;
use std::time::Duration;

/// What is asked for.
pub struct Request<'a> {
    /// Scene, device, reference, and the settings that are not searched; ratios are to these settings as they are.
    pub job: &'a Job,
    /// At least one.
    pub axes: &'a [Axis],
    /// Bounds on the error of the picture, at least one.
    pub bounds: &'a [Gate],
    /// About as long as it takes: no measurement but the last one begins after it.
    pub time: Duration,
    /// Where rows and their pictures go; None: nowhere.
    pub folder: Option<&'a Path>,
    /// Rounds of the last measurement, at least three.
    pub repeat: usize,
}
