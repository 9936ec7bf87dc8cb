//! Every choice of every setting plans, compiles and records, or is refused by name.

use super::{FAMILIES, Null, is_refused};
use quincunx::settings::{Setting, Values};
use quincunx::techniques::{self, Technique, settings_of};

/// A setting's key and its value.
type Change = (&'static str, &'static str);

/// Values of settings that are no choices, but without which some choices are not read.
const OTHERS: [Change; 11] = [
    ("aperture", "0.1"),
    ("spp", "4"),
    ("shutter", "0,0.04"),
    ("medium", "0.05,0.01,0.3"),
    ("stereo", "0.1"),
    ("shadow-volumes", "4"),
    ("accumulate", "2"),
    ("pattern", "2x2"),
    ("effect", "aa,soft-shadow"),
    ("effect", "volume"),
    ("volume", "marschner-lobb"),
];

/// Whether something reads each of these changes of the defaults.
fn are_read(settings: &[Setting], changes: &[Change]) -> bool {
    let mut values = Values::defaults(settings);
    for (key, text) in changes {
        let setting = settings.iter().find(|setting| setting.key == *key).unwrap();
        if values.set(setting, text).is_err() {
            return false;
        }
    }
    let is_read = |key: &str| settings.iter().any(|setting| setting.key == key && (setting.unread)(&values).is_none());
    changes.iter().all(|(key, _)| is_read(key))
}

/// A choice, and the ways to ask for it in which something reads all of it: by itself and with one other change, or,
/// where there are none, with two.
struct ReferenceRequest {
    choice: Change,
    ways: Vec<Vec<Change>>,
}

/// Each choice that a technique has.
fn choices(technique: &dyn Technique) -> Vec<ReferenceRequest> {
    let settings = settings_of(technique);
    let of = |setting: &Setting| -> Vec<Change> {
        setting.choices().into_iter().flatten().map(|word| (setting.key, word)).collect()
    };
    let own: Vec<Change> = settings.iter().flat_map(of).collect();
    let has = |key: &str| settings.iter().any(|setting| setting.key == key);
    let others: Vec<Change> = OTHERS.into_iter().chain(own.iter().copied()).filter(|(key, _)| has(key)).collect();
    let is_way = |changes: &Vec<Change>| {
        let are_distinct = (1..changes.len()).all(|at| changes[..at].iter().all(|(key, _)| *key != changes[at].0));
        are_distinct && are_read(&settings, changes)
    };
    let asked = |choice: &Change| {
        let one = others.iter().map(|first| vec![*first, *choice]);
        let mut ways: Vec<Vec<Change>> = std::iter::once(vec![*choice]).chain(one).filter(is_way).collect();
        if ways.is_empty() {
            let two = others.iter().flat_map(|first| others.iter().map(move |second| vec![*first, *second, *choice]));
            ways.extend(two.into_iter().find(is_way));
        }
        ReferenceRequest { choice: *choice, ways }
    };
    own.iter().map(asked).collect()
}

/// What became of a way to ask for a choice.
enum Outcome {
    Made,
    /// The request contradicts itself: another way may not.
    Contradicts,
    /// What the device lacks, in the program's words.
    Lacks(String),
    Wrong(String),
}

fn try_way(null: &Null, technique: &str, changes: &[Change]) -> Outcome {
    let flags: Vec<String> = changes.iter().map(|(key, _)| format!("--{key}")).collect();
    let mut words = vec!["--technique", technique];
    for (flag, (_, text)) in flags.iter().zip(changes) {
        words.extend([&flag[..], text]);
    }
    let ran = null.render(&words, &[]);
    match ran.code {
        0 => Outcome::Made,
        2 if is_refused(&ran) => Outcome::Contradicts,
        _ if is_refused(&ran) => {
            Outcome::Lacks(ran.err.lines().find(|line| line.starts_with("error: ")).unwrap_or_default().to_owned())
        }
        code => Outcome::Wrong(format!("{words:?} ended with {code}: {}", ran.err)),
    }
}

fn compile(family: &str) {
    let Some(null) = Null::open(FAMILIES.iter().find(|known| known.name == family).unwrap()) else { return };
    let (mut made, mut lacks, mut wrong) = (0, Vec::new(), Vec::new());
    for technique in techniques::ALL {
        for ReferenceRequest { choice, ways } in choices(*technique) {
            let tried = ways.iter().map(|changes| try_way(&null, technique.name(), changes));
            let outcome = tried.into_iter().find(|outcome| !matches!(outcome, Outcome::Contradicts));
            match outcome {
                Some(Outcome::Made) => made += 1,
                Some(Outcome::Lacks(line)) => lacks.push(line),
                Some(Outcome::Wrong(line)) => wrong.push(line),
                Some(Outcome::Contradicts) | None => {
                    wrong.push(format!("{}: --{} {} is refused in every way", technique.name(), choice.0, choice.1));
                }
            }
        }
    }
    println!("{family}: {made} made, {} refused\n  {}", lacks.len(), lacks.join("\n  "));
    assert!(wrong.is_empty(), "{family}: {} went wrong\n{}", wrong.len(), wrong.join("\n"));
    assert!(made > lacks.len(), "{family}: {made} made, {} refused", lacks.len());
}

#[test]
fn polaris10_takes_every_choice_or_refuses_it() {
    compile("polaris10");
}

#[test]
fn navi21_takes_every_choice_or_refuses_it() {
    compile("navi21");
}

#[test]
fn gfx1201_takes_every_choice_or_refuses_it() {
    compile("gfx1201");
}

#[test]
fn tu104_takes_every_choice_or_refuses_it() {
    compile("tu104");
}

/// What is compiled above, counted without a device: no choice is left out, and each of them is asked for once.
#[test]
fn each_choice_of_each_technique_has_settings_that_read_it() {
    for technique in techniques::ALL {
        let choices = choices(*technique);
        for asked in &choices {
            assert!(!asked.ways.is_empty(), "{}: nothing reads {:?}", technique.name(), asked.choice);
        }
        let all: usize = settings_of(*technique).iter().filter_map(Setting::choices).map(|words| words.len()).sum();
        let mut asked: Vec<Change> = choices.iter().map(|asked| asked.choice).collect();
        asked.sort_unstable();
        asked.dedup();
        assert!(all > 0 && asked.len() == all, "{}: {} of {all}", technique.name(), asked.len());
    }
}
