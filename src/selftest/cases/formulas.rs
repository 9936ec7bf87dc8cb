//! Closed forms: every technique's picture of a scene that a formula knows.

use super::super::case::{Group, Place, Settings, Twin};
use super::super::closed_form::{BACKGROUND, ClosedForm};
use super::super::judge::Bounds;
use crate::selftest::judge::Must;

/// Normals of 16 bits, albedo and light in half floats are off by a few parts in ten thousand, of some 0.5 of radiance;
/// three times what is seen, with vertices placed to a sixteenth of a pixel too.
const FORMULA: Bounds = Bounds {
    apart: 0.0,
    rmse: 5e-4,
    flip: 5e-3,
    mean: 1e-3,
    why: "a formula; G-buffers hold 16 bits a number, and vertices are placed to a part of a pixel",
};
const EXACT: Must = Must::Same { why: "a background is written, not computed" };
const MATT: (&str, &str) = ("brdf", "lambert");
const AT_FRAME_SIZE: (&str, &str) = ("light-size", "61x37");
const IN_THE_MIDDLE: [(&str, &str); 2] = [("spp", "1"), ("tuples", "1")];

const fn group(name: &'static str, technique: &'static str, form: ClosedForm, common: Settings) -> Group {
    let must = if matches!(form, ClosedForm::Empty) { EXACT } else { Must::Near(FORMULA) };
    Group { name, technique, place: Place::Formula(form), common, twin: Twin::Formula, methods: &[&[]], must }
}

const fn empty(technique: &'static str, common: Settings) -> Group {
    group("background", technique, ClosedForm::Empty, common)
}

const fn sun(technique: &'static str, common: Settings) -> Group {
    group("sun", technique, ClosedForm::Sun, common)
}

const fn lamp(technique: &'static str, common: Settings) -> Group {
    group("lamp", technique, ClosedForm::Lamp, common)
}

pub const GROUPS: &[Group] = &[
    empty("forward", &[BACKGROUND]),
    empty("deferred", &[BACKGROUND]),
    empty("interleaved_deferred", &[BACKGROUND, ("vpls", "16")]),
    empty("inferred_lighting", &[BACKGROUND]),
    empty("deep_shading", &[BACKGROUND, ("spp", "2")]),
    empty("path_traced", &[BACKGROUND, ("spp", "2")]),
    sun("forward", &[MATT]),
    sun("deferred", &[MATT]),
    // The lights on a plane see nothing of it, so that direct light is all.
    sun("interleaved_deferred", &[MATT, ("vpls", "16")]),
    sun("inferred_lighting", &[MATT, AT_FRAME_SIZE]),
    sun("deep_shading", &[MATT, IN_THE_MIDDLE[0], IN_THE_MIDDLE[1]]),
    sun("path_traced", &[MATT, ("spp", "2")]),
    lamp("forward", &[MATT]),
    lamp("deferred", &[MATT]),
    lamp("interleaved_deferred", &[MATT, ("vpls", "16")]),
    lamp("inferred_lighting", &[MATT, AT_FRAME_SIZE]),
    lamp("deep_shading", &[MATT, IN_THE_MIDDLE[0], IN_THE_MIDDLE[1]]),
    // Its paths begin anywhere in a pixel: their mean is the pixel's.
    lamp("path_traced", &[MATT, ("spp", "64")]),
];
