//! What a benchmark times of deep shading. What shaders count, `--instrument on` counts: a benchmark takes it from a
//! frame that it does not time.

use super::modes::lists::Lists;
use super::modes::shading_kind::ShadingKind;
use crate::settings::Values;
use crate::techniques::bench_stage::{BenchStage, Count, Done, PIXELS, SHADOW_MAPS, Unit, Work, never};

/// Samples of all eyes, covered or not.
const SAMPLES: Count = Count { unit: Unit::Sample, of: |done| Some(done.pixels() * done.number("spp")? * eyes(done)) };
/// Triangles in lists, a list each.
const ENTRIES: Count = Count { unit: Unit::Entry, of: |done| done.counter("nodes_written") };
const INVOCATIONS: Count = Count { unit: Unit::Invocation, of: |done| done.counter("shader_invocations") };

fn eyes(done: &Done<'_>) -> f64 {
    let is_both = done.settings.get("stereo-eyes").is_some_and(|eyes| eyes.to_string() == "both");
    if is_both && done.number("stereo").is_some_and(|metres| metres > 0.0) { 2.0 } else { 1.0 }
}

fn shading(values: &Values) -> &'static str {
    values.choice::<ShadingKind>("shading").name()
}

fn shaded_at_once(values: &Values) -> Option<String> {
    Some(format!("--shading {} draws and shades in one pass: `bench draw` times it", shading(values)))
}

pub const STAGES: &[BenchStage] = &[
    BenchStage {
        name: "visibility",
        summary: "Pass that finds the triangle which each sample sees, in nanoseconds a sample",
        passes: &["visibility"],
        work: Work::Counted(&[SAMPLES]),
        made_with: &[],
        fused_by: None,
        left_out: |values| match (values.choice("shading"), values.choice("lists")) {
            (ShadingKind::Ssaa | ShadingKind::Msaa | ShadingKind::TextureSpace, _) => shaded_at_once(values),
            (_, Lists::Direct) => Some("--lists direct: the host finds what samples see".to_owned()),
            _ => None,
        },
    },
    BenchStage {
        name: "lists",
        summary: "Passes that list the triangles which the samples of a shading pixel see, in nanoseconds an entry",
        passes: &["lists"],
        work: Work::Counted(&[ENTRIES]),
        made_with: &[],
        fused_by: None,
        left_out: |values| match (values.choice("shading"), values.choice("lists")) {
            (ShadingKind::Deep, Lists::None) => Some("--lists none makes no lists".to_owned()),
            (ShadingKind::Deep, _) => None,
            (shading, _) => Some(format!("--shading {} makes no lists", shading.name())),
        },
    },
    BenchStage {
        name: "shade",
        summary: "Passes that shade what is listed, and samples that are not, in nanoseconds a shaded surface",
        passes: &["scales", "entries", "shade", "strays", "indirect.gbuffer", "indirect.shade"],
        work: Work::Counted(&[INVOCATIONS]),
        made_with: &[],
        fused_by: None,
        left_out: shaded_at_once,
    },
    BenchStage {
        name: "resolve",
        summary: "Mean of each pixel's samples, in nanoseconds a pixel",
        passes: &["resolve"],
        work: Work::Counted(&[PIXELS]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
    BenchStage {
        name: "reconstruct",
        summary: "Filter of what is blurred, with the layers that it works in, in nanoseconds a pixel",
        passes: &["reconstruct"],
        work: Work::Counted(&[PIXELS]),
        made_with: &[("reconstruct", "on"), ("aperture", "0.02")],
        fused_by: None,
        left_out: |values| {
            let why = match values.unless_auto("reconstruct", Values::is_on) {
                Some(false) => "--reconstruct off filters nothing",
                Some(true) => {
                    "--reconstruct on filters nothing where nothing is blurred: --aperture and --shutter blur"
                }
                _ => "--reconstruct auto filters nothing where nothing is blurred or --spp is given",
            };
            Some(why.to_owned())
        },
    },
    BenchStage {
        name: "draw",
        summary: "Pass that draws and shades samples at once, in nanoseconds a shaded surface",
        passes: &["baseline"],
        work: Work::Counted(&[INVOCATIONS]),
        made_with: &[("shading", "ssaa")],
        fused_by: None,
        left_out: |values| Some(format!("--shading {} shades in passes of their own", shading(values))),
    },
    // Drawn as `forward` draws them; how many triangles that takes is not in the report.
    BenchStage { summary: "Shadow maps of all lights", work: Work::Counted(&[]), ..SHADOW_MAPS },
];
