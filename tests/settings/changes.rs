//! What a setting's row says it changes, compared with pictures: `nothing` and `file` leave every bit, others show.

use crate::support::watched::{Changes as Values, Watched, both, require_silence};
use quincunx::gpu::commands::Submits;
use quincunx::settings::{self, COMMON, Changes, Kind, Setting};
use quincunx::techniques::{self, Technique, settings_of};
use std::collections::BTreeMap;

/// A setting's key and its value.
type Change = (&'static str, &'static str);

const SCENE: &str = "lamps:objects=5,lights=12";
const SIZE: Change = ("size", "16x9");

/// Without which many settings have nothing to do, by technique.
fn base(technique: &str) -> Vec<Change> {
    let own: &[Change] = match technique {
        "deep_shading" => &[("spp", "4"), ("aperture", "0.2"), ("direct-shadow", "none")],
        "interleaved_deferred" => &[("vpls", "16"), ("pattern", "2x2")],
        "path_traced" => &[("spp", "2")],
        _ => &[],
    };
    [&[SIZE], own].concat()
}

/// What makes other settings read, tried in this order.
const OTHERS: &[Change] = &[
    ("direct-shadow", "map"),
    ("cull", "tiled"),
    ("volumes", "auto"),
    ("motion-vectors", "on"),
    ("stack", "short"),
    ("split", "two-pass"),
    ("split", "fragment"),
    ("visibility", "instancing"),
    ("visibility", "stochastic"),
    ("visibility", "ray"),
    ("shading", "texture-space"),
    ("shading", "indirect-gbuffer"),
];

/// Values that are not the default: each word of a choice, one of anything else.
fn other_values(setting: &Setting) -> Vec<&'static str> {
    let some: &[&'static str] = match setting.kind {
        Kind::Choice(words) => words,
        Kind::Pair { .. } => &["8x8"],
        Kind::Sides { .. } => &["8"],
        Kind::Integer { .. } => &["1"],
        Kind::Number { .. } => &["0.0001"],
        Kind::Bytes => &["1TiB"],
        Kind::PowerOfBytes { .. } => &["1MiB"],
        _ => panic!("--{} has no other value here", setting.key),
    };
    some.iter().copied().filter(|value| *value != setting.default).collect()
}

/// Pictures of one technique, by what was asked for; None: it contradicts itself, or the device lacks something.
struct Pictures<'a> {
    watched: &'a Watched,
    technique: &'static dyn Technique,
    rows: Vec<Setting>,
    known: BTreeMap<Vec<Change>, Option<String>>,
}

impl Pictures<'_> {
    fn hash(&mut self, changes: &[Change]) -> Option<String> {
        let name = self.technique.name();
        let (watched, known) = (self.watched, &mut self.known);
        let made = || {
            let renderer = watched.try_renderer(name, changes, &[], Submits::One).ok()?;
            renderer.frame().unwrap();
            let hash = renderer.picture().unwrap().hash().unwrap();
            require_silence(&watched.session.gpu, &format!("{name} with {changes:?}"));
            Some(hash)
        };
        known.entry(changes.to_vec()).or_insert_with(made).clone()
    }

    /// Whether it has all of these settings, and something reads each.
    fn are_read(&self, changes: &[Change]) -> bool {
        let row = |key: &str| self.rows.iter().find(|row| row.key == key);
        let mut values = settings::Values::defaults(&self.rows);
        let are_set = changes.iter().all(|(key, text)| row(key).is_some_and(|row| values.set(row, text).is_ok()));
        are_set && changes.iter().all(|(key, _)| row(key).is_some_and(|row| (row.unread)(&values).is_none()))
    }

    /// What to ask for beside `change`, so that it is read, and the pictures without and with it.
    fn pair(&mut self, change: Change) -> Option<(Vec<Change>, String, String)> {
        let base = base(self.technique.name());
        let with_one = OTHERS.iter().filter(|(key, _)| *key != change.0).map(|other| both(&base, &[*other]));
        let contexts: Vec<Vec<Change>> = std::iter::once(base.clone()).chain(with_one).collect();
        contexts.into_iter().find_map(|context| {
            let changed = both(&context, &[change]);
            let is_read = self.are_read(&changed);
            let [without, with] = if is_read { [&context, &changed].map(|all| self.hash(all)) } else { [None, None] };
            Some((context, without?, with?))
        })
    }
}

/// What `Setting::changing` leaves empty and no row may.
#[test]
fn every_row_has_a_key_a_help_and_a_possible_default() {
    for technique in techniques::ALL {
        for row in settings_of(*technique) {
            assert!(!row.key.is_empty() && !row.help.is_empty(), "{}: {row:?}", technique.name());
            settings::Values::defaults(&[row]).set(&row, row.default).unwrap();
        }
    }
}

/// Settings of the device that is opened, which a picture's values do not reach: tests/techniques/collapse.rs and tests/memory.
const OF_DEVICE: [&str; 5] = ["allocation", "memory-block", "image-tiling", "memory-budget", "touched"];

/// Compares each value of each such row of the technique's own tables, or of the common one; `least`: how many values.
fn require_same(technique: &str, is_common: bool, least: usize) {
    let technique = techniques::find(technique).unwrap();
    let watched = Watched::open(SCENE);
    let mut pictures = Pictures { watched: &watched, technique, rows: settings_of(technique), known: BTreeMap::new() };
    let own = technique.settings().iter().copied().flatten();
    let rows: Vec<&Setting> = if is_common { COMMON.iter().collect() } else { own.collect() };
    let (mut count, mut wrong, mut skipped) = (0, Vec::new(), Vec::new());
    for row in rows {
        if !matches!(row.changes, Changes::Nothing | Changes::File) || OF_DEVICE.contains(&row.key) {
            continue;
        }
        for value in other_values(row) {
            match pictures.pair((row.key, value)) {
                None => skipped.push(format!("--{} {value}", row.key)),
                Some((_, without, with)) if without == with => count += 1,
                Some((context, ..)) => wrong.push(format!("--{} {value} beside {context:?}", row.key)),
            }
        }
    }
    println!("{}: {count} values leave the picture, not tried here: {}", technique.name(), skipped.join(", "));
    assert!(wrong.is_empty(), "another picture:\n{}", wrong.join("\n"));
    assert!(count >= least, "{count} values were tried");
}

#[test]
fn what_changes_no_picture_of_any_technique_leaves_every_bit() {
    require_same("deferred", true, 6);
}

#[test]
fn what_changes_no_picture_of_deferred_shading_leaves_every_bit() {
    require_same("deferred", false, 9);
}

#[test]
fn what_changes_no_picture_of_forward_shading_leaves_every_bit() {
    require_same("forward", false, 6);
}

#[test]
fn what_changes_no_picture_of_interleaved_deferred_leaves_every_bit() {
    require_same("interleaved_deferred", false, 12);
}

#[test]
fn what_changes_no_picture_of_inferred_lighting_leaves_every_bit() {
    require_same("inferred_lighting", false, 12);
}

#[test]
fn what_changes_no_picture_of_deep_shading_leaves_every_bit() {
    require_same("deep_shading", false, 16);
}

#[test]
fn what_changes_no_picture_of_path_tracing_leaves_every_bit() {
    require_same("path_traced", false, 7);
}

#[test]
fn what_changes_a_picture_or_its_samples_shows() {
    let watched = Watched::open(SCENE);
    let shown: &[(&str, Values<'static>)] = &[
        ("deferred", &[("brdf", "lambert"), ("ambient", "0.3"), ("direct-shadow", "ray")]),
        ("forward", &[("direct-shadow", "ray"), ("supersample", "2"), ("msaa", "4")]),
        ("interleaved_deferred", &[("vpls", "17"), ("pattern", "1x1"), ("split", "subsample"), ("filter", "none")]),
        ("inferred_lighting", &[("light-size", "8x5"), ("light-filter", "nearest"), ("l-buffer", "fixed")]),
        ("deep_shading", &[("spp", "2"), ("accumulate", "2"), ("shading-scale", "0.5"), ("visibility", "stochastic")]),
        ("path_traced", &[("spp", "3"), ("transport", "direct"), ("seed", "2")]),
    ];
    let mut same = Vec::new();
    for (technique, changes) in shown {
        let rows = settings_of(techniques::find(technique).unwrap());
        let base = base(technique);
        let plain = watched.hash(technique, &base);
        for change in *changes {
            let row = rows.iter().find(|row| row.key == change.0).unwrap();
            assert!(matches!(row.changes, Changes::Picture | Changes::Samples), "{technique}: {change:?}");
            if watched.hash(technique, &both(&base, &[*change])) == plain {
                same.push(format!("{technique}: {change:?}"));
            }
        }
    }
    assert_eq!(same, [] as [&str; 0]);
}
