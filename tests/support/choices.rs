//! What settings can be, from the program's own rows: a choice that is added there is tested wherever all of them are.

use super::watched::{Changes, values};
use quincunx::caps::known;
use quincunx::job::Job;
use quincunx::settings::Kind;
use quincunx::{study, techniques};

/// Settings that differ from their defaults, as `Changes` that are owned.
pub type Way = Vec<(&'static str, &'static str)>;

const DIGITS: [&str; 10] = ["0", "1", "2", "3", "4", "5", "6", "7", "8", "9"];

/// The name of every technique.
pub fn techniques() -> impl Iterator<Item = &'static str> {
    techniques::ALL.iter().map(|technique| technique.name())
}

/// Those of `changes` that `technique` has a setting for.
pub fn known_to<'a>(technique: &str, changes: Changes<'a>) -> Vec<(&'a str, &'a str)> {
    let settings = techniques::settings_of(techniques::find(technique).unwrap());
    changes.iter().copied().filter(|(key, _)| settings.iter().any(|setting| setting.key == *key)).collect()
}

/// What `--key` of `technique` can be: a choice's words, or a few numbers of one digit. Without `auto`, which is one of them.
#[track_caller]
pub fn words(technique: &str, key: &str) -> Vec<&'static str> {
    let settings = techniques::settings_of(techniques::find(technique).unwrap());
    let found = settings.iter().find(|setting| setting.key == key);
    match found.unwrap_or_else(|| panic!("{technique} does not read --{key}")).kind {
        Kind::Choice(words) => words.iter().copied().filter(|word| *word != "auto").collect(),
        Kind::Integer { min, max } if max < 10 => DIGITS[min as usize..=max as usize].to_vec(),
        kind => panic!("--{key} is no choice: {kind:?}"),
    }
}

/// The words without `others`, each of which is one.
#[track_caller]
pub fn words_but(technique: &str, key: &str, others: &[&str]) -> Vec<&'static str> {
    let words = words(technique, key);
    assert!(
        others.iter().all(|other| words.contains(other)),
        "--{key} is one of {words:?}, and not all of {others:?} are"
    );
    words.into_iter().filter(|word| !others.contains(word)).collect()
}

/// Every possible combination of the words of `axes`. A key that has one possible value after the earlier ones, its default,
/// is left out: nothing reads it there, or nothing else works.
#[track_caller]
pub fn ways(technique: &str, axes: &[&'static str]) -> Vec<Way> {
    let mut ways = vec![Way::new()];
    for axis in axes {
        let (words, default) = (words(technique, axis), values(technique, &[]).text(axis).to_owned());
        let longer = |way: &Way| {
            let changed = words.iter().map(|word| [&way[..], &[(*axis, *word)]].concat());
            let possible: Vec<Way> = changed.filter(|way| is_possible(technique, way)).collect();
            match &possible[..] {
                [] => vec![way.clone()],
                [only] if only.last() == Some(&(*axis, &default)) => vec![way.clone()],
                _ => possible,
            }
        };
        ways = ways.iter().flat_map(longer).collect();
    }
    ways
}

/// Whether a small frame can be planned, every changed setting read.
pub fn is_possible(technique: &str, changes: Changes<'_>) -> bool {
    let mut job = Job::new("cornell", techniques::find(technique).unwrap());
    job.set("size", "16x16").unwrap();
    changes.iter().for_each(|(key, word)| job.set(key, word).unwrap());
    match study::planned(&job, known::DEFAULT, &known::caps(known::DEFAULT).unwrap()) {
        Ok(_) => true,
        Err(error) if error.exit_code() == 2 => false,
        Err(error) => panic!("{technique} with {changes:?}: {error}"),
    }
}

/// The ways as settings that differ.
pub fn changes(ways: &[Way]) -> Vec<Changes<'_>> {
    ways.iter().map(Vec::as_slice).collect()
}
