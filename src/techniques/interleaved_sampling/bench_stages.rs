//! What a benchmark times of interleaved sampling: a run is a member.

use crate::techniques::bench_stage::{BenchStage, Count, DEPTH, SHADOW_MAPS, Unit, Work, never};

/// Samples of one member.
const SAMPLES: Count = Count { unit: Unit::Sample, of: |done| done.counter("samples_per_member") };

pub const STAGES: &[BenchStage] = &[
    DEPTH,
    BenchStage {
        name: "member",
        summary: "Pass that draws and shades a member, in nanoseconds a sample",
        passes: &["material"],
        work: Work::Counted(&[SAMPLES]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
    BenchStage {
        name: "combine",
        summary: "Samples of a member into their pixels, in nanoseconds a sample",
        passes: &["combine", "mean"],
        work: Work::Counted(&[SAMPLES]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
    SHADOW_MAPS,
];
