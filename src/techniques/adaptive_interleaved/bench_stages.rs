//! What a benchmark times of adaptive interleaved sampling.

use crate::techniques::bench_stage::{BenchStage, Count, GBUFFER, PIXELS, Unit, Work, never};

/// Shadow rays of a frame.
const RAYS: Count = Count { unit: Unit::Ray, of: |done| Some(done.counter("rays")? * done.pixels()) };

const fn stage(name: &'static str, summary: &'static str, passes: &'static [&'static str]) -> BenchStage {
    BenchStage {
        name,
        summary,
        passes,
        work: Work::Counted(&[PIXELS]),
        made_with: &[],
        fused_by: Some(("refine", "fused")),
        left_out: never,
    }
}

pub const STAGES: &[BenchStage] = &[
    GBUFFER,
    BenchStage {
        work: Work::Counted(&[RAYS, PIXELS]),
        fused_by: None,
        ..stage(
            "estimate",
            "Initial pass, guidance and refinement of all components, in nanoseconds a shadow ray and a pixel",
            &["sample", "guide", "compact", "refine"],
        )
    },
    stage(
        "guide",
        "Guidance of all components and the list of what refines, in nanoseconds a pixel",
        &["guide", "compact"],
    ),
    BenchStage {
        fused_by: None,
        ..stage("smooth", "Discontinuities and the box filter, in nanoseconds a pixel", &["discontinuity", "filter"])
    },
];
