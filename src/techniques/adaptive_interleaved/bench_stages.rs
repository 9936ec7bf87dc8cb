//! What a benchmark times of adaptive interleaved sampling.

use super::settings::Trace;
use crate::settings::Values;
use crate::techniques::bench_stage::{BenchStage, Count, GBUFFER, PIXELS, Unit, Work, never};

/// Shadow rays of a frame.
const RAYS: Count = Count { unit: Unit::Ray, of: |done| Some(done.counter("rays")? * done.pixels()) };

/// The host's passes are no stages of the device.
fn on_host(values: &Values) -> Option<String> {
    let why = "--trace host: the host estimates; `bench frame` has its time in the frame's";
    values.is("trace", Trace::Host).then(|| why.to_owned())
}

const fn stage(name: &'static str, summary: &'static str, passes: &'static [&'static str]) -> BenchStage {
    BenchStage {
        name,
        summary,
        passes,
        work: Work::Counted(&[PIXELS]),
        made_with: &[],
        fused_by: Some(("refine", "fused")),
        left_out: on_host,
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
        left_out: never,
        ..stage("smooth", "Discontinuities and the box filter, in nanoseconds a pixel", &["discontinuity", "filter"])
    },
];
