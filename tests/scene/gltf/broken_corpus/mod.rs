//! Broken and hostile files, each given to the program as a stranger would: it ends with exit code 2 and one message that
//! names file, element and fault, or draws a picture without NaN, soon and in little memory.
//!
//! `cargo test broken_corpus -- --nocapture` prints the table: what is broken, what is said, and what it took.

mod containers;
mod images;
mod numbers;
mod paths;
mod structure;

use crate::support::gltf_file::GltfFile;
use crate::support::program::{Program, quincunx};
use std::path::Path;
use std::time::Duration;

/// Processor time over all threads: a clock would count what else the machine does. For a picture it includes what the
/// driver takes to compile shaders. The bound is for what never ends: a sound picture of 64 MiB came to 2.2 s.
const MOST_CPU: Duration = Duration::from_secs(5);
const MOST_BYTES: u64 = 1 << 30;

/// One broken file.
pub struct Case {
    /// What is broken about it.
    name: String,
    /// The scene first.
    files: Vec<(String, Vec<u8>)>,
    /// Prepares what bytes alone are not.
    prepare: Option<fn(&Path)>,
    end: End,
}

enum End {
    /// The message holds these.
    Refused(Vec<String>),
    Picture,
    /// Whatever of the two, so long as it is one of them.
    Either,
}

impl Case {
    pub fn refused(name: impl Into<String>, bytes: Vec<u8>, words: &[&str]) -> Self {
        let words = words.iter().map(|word| (*word).to_owned()).collect();
        let files = vec![("scene.glb".to_owned(), bytes)];
        Self { name: name.into(), files, prepare: None, end: End::Refused(words) }
    }

    /// What is odd about it does no harm.
    pub fn drawn(name: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self { end: End::Picture, ..Self::refused(name, bytes, &[]) }
    }

    /// The triangle with its document changed.
    pub fn changed(name: impl Into<String>, words: &[&str], change: impl FnOnce(&mut GltfFile)) -> Self {
        let mut file = GltfFile::triangle();
        change(&mut file);
        Self::refused(name, file.glb(), words)
    }

    /// Where it is open whether it makes a picture.
    pub fn either(mut self) -> Self {
        self.end = End::Either;
        self
    }

    pub fn with_file(mut self, name: &str, bytes: Vec<u8>) -> Self {
        self.files.push((name.to_owned(), bytes));
        self
    }

    pub fn prepared(mut self, prepare: fn(&Path)) -> Self {
        self.prepare = Some(prepare);
        self
    }

    fn run(&self) {
        // A folder in a folder: what a path climbs to is this test's own.
        let program = Program::new();
        let folder = program.folder.path().join("scene");
        std::fs::create_dir(&folder).unwrap();
        for (name, bytes) in &self.files {
            std::fs::write(folder.join(name), bytes).unwrap();
        }
        if let Some(prepare) = self.prepare {
            prepare(&folder);
        }
        let arguments = ["render", "scene/scene.glb", "--technique", "deferred", "--size", "16x16", "-o", "out.exr"];
        let before = program.files();
        let measured = program.measure(&arguments);
        let err = &measured.ran.err;
        let first = err.lines().next().unwrap_or("a picture");
        let (cpu, mib) = (measured.cpu.as_secs_f64(), measured.peak_bytes >> 20);
        println!("| {} | {first} | {cpu:.2} s | {mib} MiB |", self.name);
        let took = format!("{}: {cpu:.2} s, {mib} MiB: {err}", self.name);
        let ends_well = match self.end {
            End::Refused(_) => measured.ran.code == 2,
            // A pixel that is NaN would be exit code 1.
            End::Picture => measured.ran.code == 0,
            End::Either => [0, 2].contains(&measured.ran.code),
        };
        assert!(ends_well, "exit code {}: {took}", measured.ran.code);
        if let End::Refused(words) = &self.end {
            assert!(err.starts_with("error: ") && err.contains("scene.glb"), "{took}");
            for word in words {
                assert!(err.contains(word.as_str()), "{word:?} is missing: {took}");
            }
            assert!(err.len() < 2000, "{}: a message of {} bytes", self.name, err.len());
            assert!(err.chars().all(|c| c == '\n' || !c.is_control()), "{}: {err:?}", self.name);
            assert_eq!(program.files(), before, "{took}");
        }
        assert!(measured.cpu < MOST_CPU, "{took}");
        assert!(measured.peak_bytes < MOST_BYTES, "{took}");
    }
}

/// Runs all of them, and fails with those that ended otherwise.
fn run(cases: Vec<Case>) {
    let failed: Vec<String> = cases
        .into_iter()
        .filter_map(|case| {
            let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| case.run()));
            caught.err().map(|_| case.name)
        })
        .collect();
    assert!(failed.is_empty(), "{} ended otherwise: {failed:#?}", failed.len());
}

#[test]
fn an_argument_that_is_not_utf8() {
    use std::os::unix::ffi::OsStrExt;
    let mut command = quincunx();
    let output = command.arg("render").arg(std::ffi::OsStr::from_bytes(b"a\xff.glb")).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(err, "error: the argument \"a\\xFF.glb\" is not UTF-8\n");
}

#[test]
fn containers_and_json() {
    run(containers::cases());
}

#[test]
fn counts_offsets_and_strides() {
    run(numbers::accessors());
}

#[test]
fn numbers_that_no_scene_has() {
    run(numbers::values());
}

#[test]
fn hierarchies_and_references() {
    run(structure::cases());
}

#[test]
fn few_bytes_that_stand_for_much() {
    run(structure::amplified());
}

#[test]
fn pictures() {
    run(images::cases());
}

#[test]
fn paths_that_lead_outside() {
    run(paths::cases());
}
