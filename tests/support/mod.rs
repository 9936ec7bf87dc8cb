//! What several test files share.

// Each test file is a program of its own and uses a part of this.
#![allow(dead_code)]

pub mod counted;
pub mod gltf_file;
pub mod program;
pub mod watched;

use std::path::PathBuf;

/// The folder of the shared scenes, which QUINCUNX_SCENES names; None, with a line that says so, where it is not set.
///
/// Panics where CI is `true`: a skip in CI is a failure.
pub fn shared_scenes() -> Option<PathBuf> {
    let folder = std::env::var_os("QUINCUNX_SCENES").map(PathBuf::from);
    if folder.is_none() {
        skip("QUINCUNX_SCENES is not set");
    }
    folder
}

/// Says that a test, or the rest of one, does not run here.
///
/// Panics where CI is `true`: a skip in CI is a failure.
pub fn skip(why: &str) {
    assert!(std::env::var("CI").as_deref() != Ok("true"), "skipped in CI: {why}");
    println!("skipped: {why}");
}
