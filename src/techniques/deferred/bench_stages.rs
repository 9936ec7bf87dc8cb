//! What a benchmark times of deferred shading.

use crate::techniques::bench_stage::{BenchStage, CULL, GBUFFER, LIGHT_EVALUATIONS, Work, never};

pub const STAGES: &[BenchStage] = &[
    GBUFFER,
    CULL,
    BenchStage {
        name: "shade",
        summary: "Pass that sums the scene's own lights, in nanoseconds an evaluation",
        passes: &["shade"],
        work: Work::Counted(&[LIGHT_EVALUATIONS]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
];
