//! The program from outside, in a folder of its own.

use assert_cmd::Command;
use serde_json::Value;
use std::ffi::OsStr;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// How a program is started: as it is, or through what QUINCUNX_RUNNER names, with its path as the first argument. The runner must
/// become that program, whose process is interrupted and measured.
pub fn start(program: impl AsRef<OsStr>) -> std::process::Command {
    let mut command = match std::env::var_os("QUINCUNX_RUNNER") {
        Some(runner) => {
            let mut command = std::process::Command::new(runner);
            command.arg(program);
            command
        }
        None => std::process::Command::new(program),
    };
    // The defaults of whoever runs the tests are none of theirs.
    command.env("QUINCUNX_DEFAULTS", "");
    command
}

/// The program of this package.
pub fn quincunx() -> std::process::Command {
    start(env!("CARGO_BIN_EXE_quincunx"))
}

/// The program in an empty folder.
pub struct Program {
    pub folder: tempfile::TempDir,
}

/// What a run left.
pub struct Ran {
    pub code: i32,
    pub out: String,
    /// Without `progress`.
    pub err: String,
    /// Lines of what took over a second: there on a busy machine, and not on a quiet one.
    pub progress: Vec<String>,
}

impl Program {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_str().unwrap().to_owned()
    }

    pub fn run(&self, arguments: &[&str]) -> Ran {
        self.run_with(arguments, &[])
    }

    pub fn run_with(&self, arguments: &[&str], variables: &[(&str, &str)]) -> Ran {
        let mut command = Command::from_std(quincunx());
        command.current_dir(self.folder.path()).args(arguments).envs(variables.iter().copied());
        Ran::of(command)
    }

    /// Starts the program, and interrupts it as soon as it handles that and `is_time`. Returns its code and what it said,
    /// progress left out.
    #[cfg(target_os = "linux")]
    pub fn interrupted(&self, arguments: &[&str], is_time: impl Fn() -> bool) -> (Option<i32>, String) {
        let mut child = quincunx()
            .current_dir(self.folder.path())
            .args(arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let started = Instant::now();
        while !handles_interrupts(child.id()) || !is_time() {
            assert!(
                started.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none(),
                "{arguments:?}"
            );
            std::thread::sleep(Duration::from_millis(1));
        }
        // SAFETY: a child that has not been waited for: the number is its own.
        assert_eq!(unsafe { libc::kill(child.id() as i32, libc::SIGINT) }, 0);
        let output = child.wait_with_output().unwrap();
        (output.status.code(), without_progress(&String::from_utf8(output.stderr).unwrap()).1)
    }

    /// Names in the folder, sorted.
    pub fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().to_str().unwrap().to_owned()).collect();
        names.sort();
        names
    }

    /// A run that must fail with `code` and say all of `words`, print nothing else and leave no new file.
    pub fn fails(&self, arguments: &[&str], code: i32, words: &[&str]) {
        let before = self.files();
        let ran = self.run(arguments);
        assert_eq!(ran.code, code, "{arguments:?}: {}", ran.err);
        assert!(ran.err.starts_with("error: "), "{arguments:?}: {}", ran.err);
        for word in words {
            assert!(ran.err.contains(word), "{arguments:?} does not say {word}: {}", ran.err);
        }
        assert_eq!(ran.out, "", "{arguments:?}");
        assert_eq!(self.files(), before, "{arguments:?} left something");
    }
}

/// Whether a process is the program, and handles SIGINT itself, as the kernel says: a runner's shell, which it is first,
/// handles it too.
#[cfg(target_os = "linux")]
fn handles_interrupts(id: u32) -> bool {
    let maps = std::fs::read_to_string(format!("/proc/{id}/maps")).unwrap_or_default();
    if !maps.contains(env!("CARGO_BIN_EXE_quincunx")) {
        return false;
    }
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    caught.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap() & 1 << 1 != 0)
}

/// The lines that report progress, and all others.
pub fn without_progress(said: &str) -> (Vec<String>, String) {
    let (progress, other): (Vec<&str>, Vec<&str>) =
        said.split_inclusive('\n').partition(|line| line.starts_with("progress: "));
    (progress.into_iter().map(str::to_owned).collect(), other.concat())
}

impl Ran {
    fn of(mut command: Command) -> Self {
        let output = command.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let code = output.status.code().expect("it ended by itself");
        Self::new(code, text(output.stdout), &text(output.stderr))
    }

    /// `said`: on standard error.
    ///
    /// A layer that watches a program which does not listen says on standard output what it has found.
    pub fn new(code: i32, out: String, said: &str) -> Self {
        assert!(!out.contains("Validation Error: ["), "{out}");
        let (progress, err) = without_progress(said);
        Self { code, out, err, progress }
    }

    /// It succeeded and had nothing to complain about.
    pub fn fine(self) -> Self {
        assert_eq!(self.code, 0, "{}", self.err);
        assert_eq!(self.err, "");
        self
    }

    pub fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error}: {}", self.out))
    }
}
