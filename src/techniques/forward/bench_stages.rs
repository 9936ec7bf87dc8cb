//! What a benchmark times of forward shading.

use crate::techniques::bench_stage::{BenchStage, LIGHT_EVALUATIONS, SHADOW_MAPS, TRIANGLES, Work, never};

pub const STAGES: &[BenchStage] = &[
    BenchStage {
        name: "depth",
        summary: "Depth pre-pass, in nanoseconds a triangle",
        passes: &["depth"],
        work: Work::Counted(&[TRIANGLES]),
        made_with: &[],
        fused_by: None,
        left_out: |values| (!values.is_on("depth-prepass")).then(|| "--depth-prepass off draws none".to_owned()),
    },
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
