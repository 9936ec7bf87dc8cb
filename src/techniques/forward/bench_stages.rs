//! What a benchmark times of forward shading.

use crate::techniques::bench_stage::{BenchStage, DEPTH, LIGHT_EVALUATIONS, SHADOW_MAPS, Work, never};

pub const STAGES: &[BenchStage] = &[
    DEPTH,
    BenchStage {
        name: "shade",
        summary: "Pass that draws and shades materials, in nanoseconds an evaluation",
        passes: &["material"],
        work: Work::Counted(&[LIGHT_EVALUATIONS]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
    SHADOW_MAPS,
];
