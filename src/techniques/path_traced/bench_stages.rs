//! What a benchmark times of path tracing.

use crate::techniques::bench_stage::{BenchStage, Count, Unit, Work, never};

pub const STAGES: &[BenchStage] = &[BenchStage {
    name: "sample",
    summary: "Pass that traces one path for each pixel, in nanoseconds a path",
    passes: &["sample"],
    work: Work::Counted(&[Count { unit: Unit::Sample, of: |done| Some(done.pixels()) }]),
    made_with: &[],
    fused_by: None,
    left_out: never,
}];
