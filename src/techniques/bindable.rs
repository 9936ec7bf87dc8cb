//! What is too large for a device to draw, or to bind at once: refused with what is not, which is found by planning it.

use super::{Inputs, Technique};
use crate::error::Error;
use crate::frame::View;
use crate::lights::LightSet;
use crate::units::Extent;

/// Sizes that are tried: each half as wide and high as the one before.
const MOST_HALVINGS: u32 = 14;

/// Adds to `error`, by which the plan of `inputs` was refused, what the device would take: each setting of
/// `Technique::shorter` that is enough by itself, and a picture that is small enough. Where no picture is, the scene is too large.
pub fn advise(error: Error, technique: &dyn Technique, inputs: &Inputs<'_>) -> Error {
    let fits = |inputs: &Inputs<'_>| {
        let is_able = super::fitness::require(technique, inputs.values, inputs.caps, inputs.stats.has_blend).is_ok();
        is_able && technique.plan(inputs).and_then(|plan| plan.check(&inputs.caps.limits)).is_ok()
    };
    let mut ways: Vec<String> = Vec::new();
    for (key, text) in technique.shorter() {
        let setting = technique.settings().iter().copied().flatten().find(|setting| setting.key == *key);
        let mut values = inputs.values.clone();
        values.set(setting.expect("a technique names its own settings"), text).expect("and values that they take");
        if values != *inputs.values && fits(&Inputs { values: &values, ..*inputs }) {
            ways.push(format!("--{key} {text}"));
        }
    }
    let extent = inputs.view.extent;
    let halved =
        (1..=MOST_HALVINGS).map(|times| Extent::new((extent.width >> times).max(1), (extent.height >> times).max(1)));
    let smaller = halved.into_iter().find(|extent| {
        let Ok(view) = View::new(inputs.scene, inputs.values.text("camera"), *extent) else { return false };
        let Ok(lights) = LightSet::new(inputs.scene, &view, inputs.values) else { return false };
        fits(&Inputs { view: &view, lights: &lights, ..*inputs })
    });
    ways.extend(smaller.map(|extent| format!("--size {extent}")));
    error.note(match ways.split_last() {
        None => "a scene with fewer triangles or lights would fit".to_owned(),
        Some((only, [])) => format!("{only} would fit"),
        Some((last, others)) => format!("{} or {last} would fit", others.join(", ")),
    })
}
