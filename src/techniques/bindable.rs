//! Requests too large for a device to draw, to bind at once or to hold: they are refused with one that fits, found by
//! planning.

use super::{Inputs, Technique};
use crate::error::{Error, Result};
use crate::frame::View;
use crate::lights::LightSet;
use crate::plan::Plan;
use crate::settings::Values;
use crate::units::Extent;

/// Sizes that are tried: each half as wide and high as the one before.
const MOST_HALVINGS: u32 = 14;

/// Adds to `error`, by which the plan of `inputs` was refused, what the device would take: each setting of
/// `Technique::shorter` that is enough by itself, and a picture that is small enough. Where no picture is, the scene is too large.
pub fn advise(error: Error, technique: &dyn Technique, inputs: &Inputs<'_>) -> Error {
    let fits = |inputs: &Inputs<'_>| {
        let is_able = super::fitness::require(technique, inputs.values, inputs.caps, inputs.stats.has_blend).is_ok();
        is_able && planned(technique, inputs).and_then(|plan| plan.check(&inputs.caps.limits)).is_ok()
    };
    let mut ways = shortened(technique, inputs.values, |values| fits(&Inputs { values, ..*inputs }));
    let extent = inputs.view.extent;
    let halved =
        (1..=MOST_HALVINGS).map(|times| Extent::new((extent.width >> times).max(1), (extent.height >> times).max(1)));
    let smaller = halved.into_iter().find(|extent| {
        let Ok(view) = View::new(inputs.scene, inputs.values.text("camera"), *extent) else { return false };
        let Ok(lights) = LightSet::new(inputs.scene, &view, inputs.values) else { return false };
        fits(&Inputs { view: &view, lights: &lights, ..*inputs })
    });
    ways.extend(smaller.map(|extent| format!("--size {extent}")));
    if ways.is_empty() {
        return error.note("a scene with fewer triangles or lights would fit");
    }
    error.note(format!("{} would fit", joined(&ways)))
}

/// Changes that need less memory than the plan of `inputs`: settings of `Technique::shorter` that halve it, and a
/// smaller picture.
pub fn lessen(technique: &dyn Technique, inputs: &Inputs<'_>) -> String {
    let bytes = |values: &Values| planned(technique, &Inputs { values, ..*inputs }).map(|plan| plan.bytes());
    let now = bytes(inputs.values).unwrap_or_default();
    let mut ways = shortened(technique, inputs.values, |values| bytes(values).is_ok_and(|bytes| bytes <= now / 2));
    ways.push("a smaller --size".to_owned());
    format!("{} would need less", joined(&ways))
}

fn planned(technique: &dyn Technique, inputs: &Inputs<'_>) -> Result<Plan> {
    technique.prepare(inputs)?.plan(inputs)
}

/// Each of `Technique::shorter` that changes `values` to ones that `helps` takes, as on the command line.
fn shortened(technique: &dyn Technique, values: &Values, helps: impl Fn(&Values) -> bool) -> Vec<String> {
    let changed = |(key, text): &(&'static str, &str)| {
        let setting = technique.settings().iter().copied().flatten().find(|setting| setting.key == *key);
        let mut changed = values.clone();
        changed.set(setting.expect("a technique names its own settings"), text).expect("and values that they take");
        (changed != *values && helps(&changed)).then(|| format!("--{key} {text}"))
    };
    technique.shorter().iter().filter_map(changed).collect()
}

fn joined(ways: &[String]) -> String {
    match ways.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => ways.concat(),
    }
}
