//! What a benchmark times of inferred lighting.

use crate::techniques::bench_stage::{BenchStage, CULL, LIGHT_EVALUATIONS, PIXELS, TRIANGLES, Work, never};

pub const STAGES: &[BenchStage] = &[
    BenchStage {
        name: "geometry",
        summary: "Drawing of normals and depths at the light buffer's size, in nanoseconds a triangle",
        passes: &["geometry"],
        work: Work::Counted(&[TRIANGLES]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
    BenchStage {
        name: "light",
        summary: "Light buffer, with the pass that packs its sums, in nanoseconds an evaluation",
        passes: &["light", "pack"],
        work: Work::Counted(&[LIGHT_EVALUATIONS]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
    BenchStage {
        name: "material",
        summary: "Drawing of materials, which find their light again, in nanoseconds a pixel and a triangle",
        passes: &["material"],
        work: Work::Counted(&[PIXELS, TRIANGLES]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
    BenchStage { made_with: &[("volumes", "tiled")], ..CULL },
];
