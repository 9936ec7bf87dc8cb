//! What a benchmark times of interleaved sampling: a run is a member.

use crate::settings::written::SettingValue;
use crate::techniques::bench_stage::{BenchStage, Count, DEPTH, SHADOW_MAPS, Unit, Work, never};

/// Samples of one member.
const SAMPLES: Count = Count { unit: Unit::Sample, of: |done| done.counter("samples_per_member") };

/// Samples of one member on all of its planes.
const SLICED: Count = Count {
    unit: Unit::Sample,
    of: |done| {
        let planes = done.settings.get("planes").and_then(SettingValue::as_f64)?;
        done.counter("samples_per_member").map(|samples| samples * planes)
    },
};

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
        name: "slices",
        summary: "Planes of a volume over a member, in nanoseconds a sample and plane",
        passes: &["slices"],
        work: Work::Counted(&[SLICED]),
        made_with: &[("effect", "volume"), ("volume", "marschner-lobb")],
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
