//! Every case of the self-test, as data: a file a technique, and what all of them share.
//!
//! Bounds on other devices were not measured on a GPU, because none was at hand. They are what the compilers' liberties
//! amount to on lavapipe, where products and sums were fused and last bits turned at random (RMSE below 1e-4, FLIP
//! below 0.0005, one pixel in 500 along edges where paths go), with room for an edge that falls otherwise; a row or a
//! tile that is missing, and a hundredth of the light, stay outside of them. Bounds of two ways to nearly the same
//! picture are some three times the most that lavapipe of Mesa 22.3.6 and 25.0.7 and SwiftShader are off by.

mod adaptive;
mod baselines;
pub(super) mod bounds;
mod deep;
mod formulas;
mod inferred;
mod interleaved;
mod paths;
mod sampled;

pub use interleaved::SPLITS;

use super::case::{Case, Group};

/// All cases in the order in which they run: those of one scene together, where that is possible.
pub fn all() -> impl Iterator<Item = Case> {
    let tables: [&'static [Group]; 8] = [
        formulas::GROUPS,
        baselines::GROUPS,
        interleaved::GROUPS,
        inferred::GROUPS,
        deep::GROUPS,
        adaptive::GROUPS,
        sampled::GROUPS,
        paths::GROUPS,
    ];
    let groups = tables.into_iter().flatten();
    groups.flat_map(|group| group.methods.iter().map(move |method| Case { group, method }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::selftest::case::{Place, Twin, job};
    use crate::settings::{Changes, Kind};
    use crate::techniques::{ALL, settings_of};
    use std::collections::BTreeSet;

    /// No case asks for what cannot be, or for what nothing reads: the picture would be its twin's whatever the device
    /// does.
    #[test]
    fn every_case_is_possible_and_names_are_its_own() {
        let mut names = BTreeSet::new();
        for case in all() {
            let name = case.name();
            let made = job(case.group.place, case.group.technique, &case.settings()).unwrap();
            made.require_read().unwrap_or_else(|error| panic!("{name}: {error}"));
            if let Some((technique, settings)) = case.twin_settings() {
                let twin = job(case.group.place, technique, &settings).unwrap();
                twin.require_read().unwrap_or_else(|error| panic!("{name}: its twin: {error}"));
            }
            let size = made.values.extent("size");
            assert!(size.width <= 64 && size.height <= 64, "{name}: {size}");
            assert_eq!(
                matches!(case.group.place, Place::Formula(_)),
                matches!(case.group.twin, Twin::Formula),
                "{name}"
            );
            assert!(names.insert(name.clone()), "{name} is there twice");
        }
        assert!(names.len() > 100, "{}", names.len());
    }

    /// Every choice of every setting is tried, so that a new one is not forgotten here.
    #[test]
    fn every_choice_of_a_method_is_among_the_cases() {
        // Other pictures by intent, or the same shaders with other numbers.
        const NO_METHODS: [&str; 31] = [
            "mode",
            "pixel",
            "ss-guidance",
            "direct-light",
            "rig",
            "sun",
            "brdf",
            "vpl-brdf",
            "light-visibility",
            "vpl-visibility",
            "ambient-visibility",
            "punctual",
            "transport",
            "airlight",
            "emissive",
            "direct",
            "blend-lights",
            "discontinuity",
            "shading-texture-size",
            "assignment",
            "alpha",
            "motion-vectors",
            "texture-gutters",
            "texture-level",
            "direct-shadow",
            "stereo-eyes",
            "texels",
            "shadow-maps",
            "geometry",
            "instrument",
            "sampler",
        ];
        let mut forgotten = Vec::new();
        for technique in ALL {
            for setting in settings_of(*technique) {
                let Kind::Choice(choices) = setting.kind else { continue };
                if setting.changes == Changes::File || NO_METHODS.contains(&setting.key) {
                    continue;
                }
                for choice in choices.iter().filter(|choice| **choice != "auto") {
                    let uses = |settings: &[(&str, &str)]| {
                        let last = settings.iter().rev().find(|(key, _)| *key == setting.key);
                        last.map_or(setting.default, |(_, text)| *text) == *choice
                    };
                    // How memory is kept and what is counted is the device's, whatever is drawn.
                    let is_device_s = ["allocation", "image-tiling", "touched"].contains(&setting.key);
                    let tries = |case: &Case| is_device_s || case.group.technique == technique.name();
                    let is_tried = all().filter(tries).any(|case| {
                        let twin = case.twin_settings().filter(|(name, _)| *name == technique.name());
                        uses(&case.settings()) || twin.is_some_and(|(_, settings)| uses(&settings))
                    });
                    if !is_tried {
                        forgotten.push(format!("{}: --{} {choice}", technique.name(), setting.key));
                    }
                }
            }
        }
        assert_eq!(forgotten, [] as [&str; 0]);
    }
}
