//! Patterns of samples by name: those that techniques have, and the settings that choose them.

use super::{ALL, NamedPattern, Technique, defaults, set};
use crate::error::{Error, Result};
use crate::sampling::pattern::Pattern;
use crate::settings::Values;

/// A pattern that was asked for by its name and settings.
pub struct ChosenPattern {
    pub technique: &'static dyn Technique,
    pub named: &'static NamedPattern,
    /// Every setting of the technique; those that were not named have their defaults.
    pub values: Values,
    pub pattern: Pattern,
}

impl ChosenPattern {
    /// Its name with every setting that chooses it: `grid:pattern=4x4`.
    pub fn spec(&self) -> String {
        let setting = |key: &&str| format!("{key}={}", self.values.text(key));
        format!("{}:{}", self.named.name, self.named.keys.iter().map(setting).collect::<Vec<_>>().join(","))
    }
}

/// Every pattern, with its technique.
pub fn all() -> impl Iterator<Item = (&'static dyn Technique, &'static NamedPattern)> {
    ALL.iter().flat_map(|technique| technique.patterns().iter().map(move |named| (*technique, named)))
}

/// The settings of a pattern as they were written: what stands behind a comma and is no KEY=VALUE belongs to the value before it,
/// as in `effect=aa,motion`.
fn parts(settings: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for part in settings.split(',') {
        match parts.last_mut().filter(|before| before.contains('=') && !part.contains('=')) {
            Some(before) => before.extend([",", part]),
            None => parts.push(part.to_owned()),
        }
    }
    parts
}

/// The pattern that `spec` names: `name` or `name:key=value,key=value`.
///
/// Errors: no pattern has the name, a key does not choose it or stands twice, a value is impossible (exit code 2).
pub fn open(spec: &str) -> Result<ChosenPattern> {
    let (name, settings) = spec.split_once(':').map_or((spec, None), |(name, settings)| (name, Some(settings)));
    let (technique, named) = all().find(|(_, named)| named.name == name).ok_or_else(|| {
        let names: Vec<&str> = all().map(|(_, named)| named.name).collect();
        Error::request(format!("pattern {name}: there is no such pattern"))
            .note(format!("there are {}", names.join(", ")))
    })?;
    let mut values = defaults(technique);
    let mut seen = Vec::new();
    for part in &settings.map(parts).unwrap_or_default() {
        let refused = |why: &str| {
            let keys: Vec<String> = named.keys.iter().map(|key| format!("{key}={}", values.text(key))).collect();
            Error::request(format!("pattern {name}: {part}: {why}"))
                .note(format!("for example {name}:{}", keys.join(",")))
        };
        let (key, text) = part.split_once('=').ok_or_else(|| refused("it is not KEY=VALUE"))?;
        if !named.keys.contains(&key) {
            return Err(refused("this key does not choose it"));
        }
        if seen.contains(&key) {
            return Err(refused("the key has a value already"));
        }
        seen.push(key);
        set(technique, &mut values, key, text)?;
    }
    let pattern = (named.make)(&values)?;
    Ok(ChosenPattern { technique, named, values, pattern })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques::settings_of;
    use std::collections::BTreeSet;

    #[test]
    fn every_pattern_has_a_name_of_its_own_and_is_chosen_by_settings_of_its_technique() {
        let names: BTreeSet<&str> = all().map(|(_, named)| named.name).collect();
        assert_eq!(names.len(), all().count());
        assert!(names.is_superset(&["grid", "direct-grid", "stipple", "tuples"].into()), "{names:?}");
        for (technique, named) in all() {
            let settings = settings_of(technique);
            for key in named.keys {
                assert!(settings.iter().any(|setting| setting.key == *key), "{} has no --{key}", technique.name());
            }
            let chosen = open(named.name).unwrap();
            assert_eq!(chosen.pattern, open(&chosen.spec()).unwrap().pattern);
            assert!(!chosen.pattern.samples().is_empty());
        }
    }

    #[test]
    fn settings_choose_the_pattern() {
        let made = |spec: &str| open(spec).unwrap().pattern;
        assert_eq!(made("grid"), Pattern::grid([4, 4]));
        assert_eq!(made("grid:pattern=3x2"), Pattern::grid([3, 2]));
        assert_eq!(made("direct-grid"), Pattern::grid([4, 4]));
        assert_eq!(made("direct-grid:pattern=8x6,direct-pattern=4x2"), Pattern::grid([4, 2]));
        assert_eq!(made("stipple:stipple=4x4"), Pattern::grid([4, 4]));
        assert_eq!(made("tuples:spp=4,seed=9"), Pattern::nets([2, 2], 4, 9, 0));
        assert_eq!(made("tuples:spp=2,tuples=6"), Pattern::nets([3, 1], 2, 1, 0));
        let both = open("basis:effect=aa,motion,defocus,sampler=r2,samples=2").unwrap();
        assert_eq!((both.pattern.dimension_count(), both.pattern.samples().len()), (5, 8));
        assert_eq!(both.pattern, open(&both.spec()).unwrap().pattern);
        // The same samples in both techniques, where a sampler counts by pixels.
        for sampler in ["r2", "jittered", "ign", "void-and-cluster", "blue-errors"] {
            let basis = format!("basis:effect=aa,motion,defocus,sampler={sampler},samples=2");
            assert_eq!(made(&basis), made(&format!("tuples:spp=2,tuples=8,sampler={sampler}")), "{sampler}");
        }
    }

    #[test]
    fn what_is_no_pattern_is_refused_with_what_is() {
        for (spec, said) in [
            ("grids", "there are grid, direct-grid, stipple, tuples"),
            ("", "there is no such pattern"),
            ("grid:", "it is not KEY=VALUE"),
            ("basis:effect=aa,lens", "it must be one or more of aa, motion"),
            ("grid:pattern", "for example grid:pattern=4x4"),
            ("grid:vpls=4", "does not choose it"),
            ("grid:pattern=2x2,pattern=3x3", "has a value already"),
            ("grid:pattern=65x1", "--pattern 65x1: it must be NxM, both 1 to 64"),
            ("tuples:spp=8,tuples=12", "--tuples 16 works"),
            ("direct-grid:direct-pattern=3x3", "make patterns that divide it"),
        ] {
            let error = open(spec).err().unwrap_or_else(|| panic!("{spec} is a pattern"));
            assert_eq!(error.exit_code(), 2, "{spec}");
            assert!(error.to_string().contains(said), "{spec}: {error}");
        }
    }
}
