//! Settings that nothing reads: refused where they are given, and without any part in the picture.

use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use quincunx::job::Job;
use quincunx::settings::{Values, readers};
use quincunx::techniques::{self, Technique, settings_of};

const INTERLEAVED: &str = "interleaved_deferred";
const SIZE: Changes<'static> = &[("size", "33x17"), ("vpls", "16")];

fn values(technique: &str, changes: Changes<'_>) -> Values {
    let mut job = Job::new("cornell", techniques::find(technique).unwrap());
    changes.iter().for_each(|(key, text)| job.set(key, text).unwrap());
    job.values
}

/// Whether something reads the settings that `changes` names last.
fn is_read(technique: &'static dyn Technique, changes: Changes<'_>) -> bool {
    let (key, _) = changes.last().unwrap();
    let settings = settings_of(technique);
    let setting = settings.iter().find(|setting| setting.key == *key).unwrap();
    (setting.unread)(&values(technique.name(), changes)).is_none()
}

/// What the settings that decide are, and a setting that they leave unread.
const UNREAD: &[Changes<'static>] = &[
    &[("split", "none"), ("pattern", "2x2")],
    &[("split", "none"), ("filter", "none")],
    &[("split", "none"), ("direct", "interleaved"), ("direct-pattern", "2x2")],
    &[("split", "subsample"), ("filter", "gauss-fast")],
    &[("split", "subsample"), ("direct", "interleaved"), ("direct-pattern", "2x2")],
    &[("split", "branch"), ("storage", "image")],
    &[("split", "remap"), ("copy", "push")],
    &[("split", "indirect"), ("block", "8")],
    &[("split", "fragment"), ("fragment-passes", "1"), ("block", "8")],
    &[("split", "stencil"), ("fragment-passes", "1")],
    &[("block", "32")],
    &[("direct-pattern", "2x2")],
    &[("pattern", "1x1"), ("filter", "none")],
    &[("pattern", "1x1"), ("kernel", "7")],
    &[("filter", "none"), ("kernel", "7")],
    &[("filter", "none"), ("sigma", "3")],
    &[("filter", "none"), ("discontinuity", "any")],
    &[("filter", "none"), ("normal-threshold", "1")],
    &[("filter", "none"), ("position-threshold", "1")],
    &[("filter", "none"), ("fuse", "on")],
    &[("filter", "gauss-fast"), ("fuse", "on")],
    &[("direct", "none"), ("brdf", "lambert")],
    &[("direct", "none"), ("cull", "tiled")],
];

/// Settings that are read, and change the picture.
const READ: &[Changes<'static>] = &[
    &[("pattern", "2x2")],
    &[("split", "subsample"), ("pattern", "2x2")],
    &[("filter", "none")],
    &[("filter", "gauss-fast"), ("kernel", "7")],
    &[("sigma", "3")],
    &[("discontinuity", "any")],
    &[("direct", "interleaved"), ("direct-pattern", "2x2")],
    &[("brdf", "lambert")],
];

#[test]
fn a_setting_that_nothing_reads_changes_no_pixel() {
    let watched = Watched::open("lamps:objects=5,lights=20");
    let technique = techniques::find(INTERLEAVED).unwrap();
    for changes in UNREAD {
        assert!(!is_read(technique, changes), "{changes:?}");
        let [without, with] =
            [&changes[..changes.len() - 1], changes].map(|own| watched.hash(INTERLEAVED, &both(SIZE, own)));
        assert_eq!(without, with, "{changes:?}");
    }
    for changes in READ {
        assert!(is_read(technique, changes), "{changes:?}");
        let [without, with] =
            [&changes[..changes.len() - 1], changes].map(|own| watched.hash(INTERLEAVED, &both(SIZE, own)));
        assert_ne!(without, with, "{changes:?}");
    }
}

#[test]
fn what_leaves_a_setting_unread_is_a_setting_of_its_technique() {
    for technique in techniques::ALL {
        let settings = settings_of(*technique);
        let defaults = Values::defaults(&settings);
        for setting in &settings {
            // Asking for another technique's panics.
            (setting.unread)(&defaults);
        }
        // A setting at its default is never refused.
        readers::require_read(&settings, &defaults).unwrap();
    }
}

#[test]
fn a_setting_that_nothing_reads_is_refused_with_what_would_read_it() {
    let program = Program::new();
    let small = ["cornell", "--size", "32x18", "--vpls", "16"];
    for (more, words) in [
        (&["--block", "32"][..], &["--block 32 with --split one-pass", "--split two-pass, tile or fragment would"][..]),
        (&["--fuse", "on", "--filter", "gauss-fast"], &["--fuse on with --filter gauss-fast", "--filter gauss would"]),
        (&["--split", "branch", "--storage", "image"], &["--storage image with --split branch", "one-pass"]),
        (&["--split", "branch", "--copy", "push"], &["--copy push with --split branch: it copies nothing"]),
        (&["--fragment-passes", "1"], &["--fragment-passes 1 with --split one-pass", "--split fragment would"]),
        (&["--filter", "none", "--kernel", "7"], &["--kernel 7 with --filter none", "gauss or gauss-fast would"]),
        (&["--split", "none", "--pattern", "2x2"], &["--pattern 2x2 with --split none", "any other --split would"]),
    ] {
        program.fails(&[&["render"], &small[..], more].concat(), 2, words);
        program.fails(&[&["memory"], &small[..], &["--plan"], more].concat(), 2, words);
    }
    let sequence = ["--frames", "0..1", "--block", "32"];
    program.fails(&[&["render"], &small[..], &sequence].concat(), 2, &["--block 32 with --split one-pass"]);
    for (technique, more, sentence) in [
        ("forward", ["--shadow-map-size", "64"], "--shadow-map-size 64 with --direct-shadow sun"),
        ("inferred_lighting", ["--motion-interval", "1"], "--motion-interval 1 with --motion-vectors off"),
        ("deep_shading", ["--focus", "2"], "--focus 2 with --aperture 0"),
        ("deep_shading", ["--pass-samples", "1"], "--pass-samples 1 with --shading deep"),
        ("path_traced", ["--stack-entries", "4"], "--stack-entries 4 with --stack auto"),
    ] {
        program.fails(&[&["render", "cornell", "--technique", technique], &more[..]].concat(), 2, &[sentence]);
    }
    // At its default a setting goes with all.
    let defaults = ["--split", "branch", "--storage", "auto", "--copy", "pull", "--block", "16", "--fuse", "off"];
    program.run(&[&["render"], &small[..], &defaults].concat()).fine();
}
