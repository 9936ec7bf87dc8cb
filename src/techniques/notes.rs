//! What a technique says of a picture's figures, as lines of the report's text.

use crate::settings::written::WrittenSettings;
use std::collections::BTreeMap;

/// The figures of a picture.
pub struct Figures<'a> {
    /// The report's `counters`.
    pub counters: &'a BTreeMap<String, f64>,
    /// Settings as they were used.
    pub settings: &'a WrittenSettings,
    /// Full names of the passes with their median milliseconds, in their order; None of what was not timed.
    pub pass_ms: Vec<(&'a str, Option<f64>)>,
}

impl Figures<'_> {
    pub fn counter(&self, key: &str) -> Option<f64> {
        self.counters.get(key).copied()
    }

    /// Median milliseconds of the pass of this full name; None where it is not there, or was not timed.
    pub fn ms_of(&self, pass: &str) -> Option<f64> {
        self.pass_ms.iter().find(|(name, _)| *name == pass).and_then(|(_, ms)| *ms)
    }
}

/// How many evaluations of the scene's own lights there were, where they were counted. `pass`: full name of the pass that
/// makes them, whose time is divided among them.
pub fn direct_light(figures: &Figures<'_>, pass: Option<&str>) -> Option<String> {
    let evaluated = figures.counter("light_evaluations")?;
    let left_out = figures.counter("light_evaluations_culled")?;
    if evaluated + left_out <= 0.0 {
        return None;
    }
    let each = pass.and_then(|pass| figures.ms_of(pass)).map(|ms| 1e6 * ms / evaluated.max(1.0));
    Some(format!(
        "direct light: {:.1} million evaluations of a light at a pixel{}, {:.0} % left out by culling",
        evaluated / 1e6,
        each.map_or(String::new(), |ns| format!(", {ns:.2} ns each")),
        100.0 * left_out / (evaluated + left_out)
    ))
}
