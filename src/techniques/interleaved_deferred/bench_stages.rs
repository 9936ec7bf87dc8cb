//! What a benchmark times of interleaved deferred shading, and the plain form of it.

use super::choices::VplShadow;
use super::split_method::Split;
use crate::choice::Choice;
use crate::passes::filter::Filter;
use crate::settings::Values;
use crate::settings::written::WrittenSettings;
use crate::techniques::bench_stage::{BenchStage, CULL, Copying, Count, GBUFFER, PIXELS, PlainForm, Unit, Work, never};

const TAPS: Count = Count {
    unit: Unit::Tap,
    of: |done| {
        let filter = Filter::from_word(&done.settings.get("filter")?.to_string())?;
        Some(done.pixels() * filter.taps(done.number("kernel")?)?)
    },
};

/// Each pixel that is shaded meets the lights of its subset; `--split subsample` shades one pixel of each pattern.
const SUBSET_EVALUATIONS: Count = Count {
    unit: Unit::Evaluation,
    of: |done| Some(done.counter("shaded_pixels").unwrap_or(0.0) * done.counter("subset_lights_per_pixel")?),
};

/// Each pixel that is shaded looks for the virtual lights of its subset.
const VPL_TESTS: Count = Count {
    unit: Unit::Evaluation,
    of: |done| Some(done.counter("shaded_pixels").unwrap_or(0.0) * done.counter("vpls_per_pixel")?),
};

const MAP_TRIANGLES: Count = Count { unit: Unit::Triangle, of: |done| done.counter("vpl_map_triangles_drawn") };

/// A copy's time does not depend on what is copied, so one virtual point light is enough for the identity; at 1x1 every
/// pixel would meet all of them.
const COPY: Work = Work::Copy(Copying {
    identity: "pattern 1x1",
    identity_settings: &[("pattern", "1x1"), ("direct-pattern", "auto")],
    spare: &[("vpls", "1")],
    tuned: "block",
});

/// The split, where it copies nothing.
fn uncopied(values: &Values) -> Option<&'static str> {
    let split: Split = values.choice("split");
    (!Split::COPYING.contains(&split)).then(|| split.name())
}

const FUSED: Option<(&str, &str)> = Some(("fuse", "on"));

pub const STAGES: &[BenchStage] = &[
    BenchStage {
        name: "split",
        summary: "Copy of the G-buffer into sub-buffers, beside the same kernel at pattern 1x1 and vkCmdCopyBuffer",
        passes: &["split"],
        work: COPY,
        made_with: &[],
        fused_by: None,
        left_out: |values| Some(format!("--split {} makes no copy", uncopied(values)?)),
    },
    BenchStage {
        name: "shade",
        summary: "Pass that shades with the lights of the subsets, in nanoseconds an evaluation",
        passes: &["shade"],
        work: Work::Counted(&[SUBSET_EVALUATIONS]),
        made_with: &[],
        fused_by: None,
        left_out: never,
    },
    BenchStage {
        name: "vpl_maps",
        summary: "Drawing of the virtual lights' shadow maps, in nanoseconds a triangle that is drawn into one",
        passes: &["vpl_maps"],
        work: Work::Counted(&[MAP_TRIANGLES]),
        made_with: &[("vpl-shadow", "map")],
        fused_by: None,
        left_out: |values| {
            Some(format!("--vpl-shadow {} draws no maps; map does", values.choice::<VplShadow>("vpl-shadow").name()))
        },
    },
    BenchStage {
        name: "vpl_shadow",
        summary: "What finds the virtual lights that a pixel does not see, in nanoseconds a pixel and a light",
        passes: &["vpl_shadow"],
        work: Work::Counted(&[VPL_TESTS]),
        made_with: &[("vpl-shadow", "ray")],
        fused_by: None,
        left_out: |_| Some("--vpl-shadow none looks for nothing".to_owned()),
    },
    BenchStage {
        name: "gather",
        summary: "Copy of the irradiance back to the frame, beside the same kernel at 1x1 and vkCmdCopyBuffer",
        passes: &["gather"],
        work: COPY,
        made_with: &[],
        fused_by: FUSED,
        left_out: |values| Some(format!("--split {} makes no copy, and gathers nothing", uncopied(values)?)),
    },
    BenchStage {
        name: "filter",
        summary: "Discontinuity buffer and the filter that reads it, in nanoseconds a pixel and a tap",
        // The filter has no other reader of its flags.
        passes: &["discontinuity", "filter"],
        work: Work::Counted(&[PIXELS, TAPS]),
        made_with: &[],
        fused_by: FUSED,
        left_out: |values| {
            let (split, pattern) = (values.choice::<Split>("split").name(), values.text("pattern"));
            Some(match values.choice("filter") {
                Filter::None => "--filter none filters nothing".to_owned(),
                _ => format!("--split {split} --pattern {pattern} is not interleaved: nothing is filtered"),
            })
        },
    },
    GBUFFER,
    CULL,
];

/// Plain deferred shading of the same lights.
pub const PLAIN: PlainForm = PlainForm {
    settings: &[("split", "none")],
    same_picture: &["workgroup", "alias"],
    light_pass: "shade",
    lights_per_pixel: "subset_lights_per_pixel",
    one_light: &[("vpls", "1"), ("direct", "none")],
    widened,
};

/// With `--fuse on` the composite does a part of the filter's work.
fn widened(settings: &WrittenSettings) -> &'static [&'static str] {
    let is_fused = settings.get("fuse").is_some_and(|value| value.to_string() == "on");
    if is_fused { &["composite"] } else { &[] }
}
