//! Interleaved deferred shading (Segovia et al. 2006) pass by pass; tests/techniques/collapse.rs holds its methods to one
//! picture.

mod accumulate;
mod discontinuity;
mod shade_by;
pub mod split;
mod subsample;
mod vpl_brdf;
mod vpl_maps;
mod vpl_shadow;

use crate::support::choices::{Way, is_possible, ways};
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use quincunx::caps::known;
use quincunx::job::Job;
use quincunx::picture::Picture;
use quincunx::selftest::cases::SPLITS;
use quincunx::{study, techniques};
use std::collections::BTreeSet;

const NAME: &str = "interleaved_deferred";

/// Every way to the picture of `branch`, which is the first: each split with each storage, form of copy and number of passes
/// that it knows. Without `none`, which sums every light on every pixel, and `subsample`, which interpolates: other pictures
/// by intent.
pub fn splits() -> Vec<Way> {
    let mut splits = ways(NAME, &["split", "storage", "copy", "fragment-passes"]);
    splits.retain(|way| !["none", "subsample"].contains(&way[0].1));
    splits.sort_by_key(|way| way[0].1 != "branch");
    assert_eq!(splits[0], [("split", "branch")]);
    splits
}

/// The picture of `branch`, whose bits every other split must have.
pub fn require_same_in_every_split(watched: &Watched, changes: Changes<'_>) -> Picture {
    let mut branch = None;
    for split in splits() {
        let picture = watched.picture(NAME, &both(changes, &split));
        match &branch {
            None => branch = Some(picture),
            Some(branch) => require_same(&watched.session.gpu, branch, &picture, &split),
        }
    }
    branch.expect("it is the first")
}

/// Those that copy into sub-buffers and back: others do not read `--storage`.
pub fn copies() -> Vec<Way> {
    splits().into_iter().filter(|way| is_possible(NAME, &both(way, &[("storage", "image")]))).collect()
}

/// Those that read `--block`.
pub fn splits_in_blocks() -> Vec<Way> {
    splits().into_iter().filter(|way| is_possible(NAME, &both(way, &[("block", "8")]))).collect()
}

/// The self-test's list is typed, as constants are: it is what the rows allow, and nothing is left out.
#[test]
fn the_self_test_tries_every_split_in_every_storage_and_form() {
    let caps = known::caps(known::DEFAULT).unwrap();
    let made = |way: Changes<'_>| {
        let mut job = Job::new("cornell", techniques::find(NAME).unwrap());
        job.set("size", "16x16").unwrap();
        way.iter().for_each(|(key, word)| job.set(key, word).unwrap());
        let storage = study::resolved(&job, &caps).unwrap().get("storage").cloned();
        let words = ["split", "copy", "fragment-passes"].map(|key| job.values.text(key).to_owned());
        (words, storage)
    };
    let tried: BTreeSet<_> = SPLITS.into_iter().map(made).collect();
    assert_eq!(tried.len(), SPLITS.len(), "one is there twice");
    assert_eq!(tried, splits().iter().map(|way| made(way)).collect());
}
