//! What a technique says of a picture's figures, as lines of the report's text.

use crate::settings::written::{SettingValue, WrittenSettings};
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

/// How many evaluations of the scene's own lights there were, where they were counted. `pass`: full name of the pass
/// that makes them, whose time is divided among them.
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

/// How far the mean of `samples`, in words, is from what it tends to, and whether that is what `--until-error` asked for; `more`:
/// the setting that would have more of them.
pub fn estimated_error(figures: &Figures<'_>, samples: &str, more: &str) -> Vec<String> {
    let error = figures.counter("estimated_error");
    let words = error.map_or(String::new(), |error| format!(", estimated error {error:.5}"));
    let most = figures.settings.get("until-error").and_then(SettingValue::as_f64).filter(|most| *most > 0.0);
    let missed = most.filter(|most| error.is_some_and(|error| error > *most));
    let missed = missed.map(|most| format!("  note: --until-error {most} is not reached; a larger {more} would help"));
    [format!("{samples}{words}")].into_iter().chain(missed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques;

    fn told(technique: &str, counters: &[(&str, f64)]) -> Vec<String> {
        let counters = counters.iter().map(|(key, count)| ((*key).to_owned(), *count)).collect();
        let until_error = ("until-error".to_owned(), SettingValue::of("0.01"));
        let settings = [until_error].into_iter().collect();
        let passes = [format!("{technique}.shade"), format!("{technique}.composite")];
        let pass_ms = passes.iter().map(String::as_str).zip([Some(2.0), Some(8.0)]).collect();
        techniques::find(technique).unwrap().notes(&Figures { counters: &counters, settings: &settings, pass_ms })
    }

    #[test]
    fn each_technique_says_its_own_lines() {
        let lights = [("light_evaluations", 1e6), ("light_evaluations_culled", 3e6)];
        let direct = "direct light: 1.0 million evaluations of a light at a pixel";
        let dark = [("vpls", 16.0), ("vpls_found", 9.0)];
        let found = "  note: light walks found places for 9 virtual point lights of 16; the others are dark";
        let open = [("shadow_casters_not_closed", 2.0)];
        let paths = [("samples", 4.0), ("estimated_error", 0.25)];
        // The composite has the scene's own lights of the first, the shading pass those of the second; of the others no
        // pass has them alone.
        for (technique, counters, expected) in [
            (
                "interleaved_deferred",
                &[&dark[..], &lights].concat()[..],
                &[found, &format!("{direct}, 8.00 ns each, 75 % left out by culling")][..],
            ),
            ("interleaved_deferred", &[("vpls", 16.0), ("vpls_found", 16.0)], &[]),
            (
                "interleaved_deferred",
                &[("vpls", 16.0), ("vpls_found", 16.0), ("runs", 5.0), ("estimated_error", 0.25)],
                &[
                    "5 runs, estimated error 0.25000",
                    "  note: --until-error 0.01 is not reached; a larger --accumulate would help",
                ],
            ),
            ("deferred", &lights, &[&format!("{direct}, 2.00 ns each, 75 % left out by culling")]),
            ("forward", &lights, &[&format!("{direct}, 75 % left out by culling")]),
            (
                "inferred_lighting",
                &open,
                &["  note: draws without shadow volumes, because their meshes are not closed: 2"],
            ),
            (
                "path_traced",
                &paths,
                &[
                    "4 samples a pixel, estimated error 0.25000",
                    "  note: --until-error 0.01 is not reached; a larger --spp would help",
                ],
            ),
            ("path_traced", &[("samples", 1.0)], &["1 sample a pixel"]),
            ("deep_shading", &[("samples_seen", 7.0)], &[]),
        ] {
            assert_eq!(told(technique, counters), expected, "{technique}");
        }
    }
}
