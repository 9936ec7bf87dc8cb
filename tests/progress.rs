//! What is said while something takes long: lines where standard error is no terminal, a bar where it is one.

use crate::support::program::{Program, Ran, quincunx};
use std::fs::File;
use std::io::Read;
use std::os::fd::{AsRawFd, FromRawFd};
use std::process::Stdio;

const PATHS: [&str; 6] = ["render", "cornell", "--technique", "path_traced", "--size", "64x64"];
/// Far enough above the second from which on something is said.
const LONG_S: f64 = 3.0;
const REPORT: [&str; 4] = ["--report", "a.json", "-o", "a.png"];

fn long(program: &Program, samples: u32, more: &[&str]) -> Ran {
    program.run(&[&PATHS[..], &REPORT, &["--spp", &samples.to_string()], more].concat())
}

/// What rendering took by the report, in seconds.
fn rendering_s(program: &Program) -> f64 {
    let text = std::fs::read_to_string(program.path("a.json")).unwrap();
    serde_json::from_str::<serde_json::Value>(&text).unwrap()["total_ms"]["median"].as_f64().unwrap() / 1000.0
}

/// Samples that take this machine and its driver at least half of `LONG_S`, also where other work slowed the first try down.
fn long_samples(program: &Program) -> u32 {
    let mut samples = 24;
    loop {
        assert_eq!(long(program, samples, &["--quiet"]).code, 0);
        let seconds = rendering_s(program);
        if seconds > 0.5 * LONG_S || samples > 32_768 {
            return samples;
        }
        samples = (LONG_S / seconds * f64::from(samples)).clamp(8.0, 65_536.0) as u32;
    }
}

#[test]
fn without_a_terminal_what_took_over_a_second_has_a_line_with_its_time() {
    let program = Program::new();
    let samples = long_samples(&program);
    let ran = long(&program, samples, &[]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
    let seconds = rendering_s(&program);
    let lines: Vec<&String> = ran.progress.iter().filter(|line| line.contains("rendering")).collect();
    assert!(seconds > 1.05, "the test asks for too few samples: {seconds} s");
    assert_eq!(lines.len(), 1, "{:?}", ran.progress);
    let said = lines[0].strip_prefix(&format!("progress: rendering {samples} samples took "));
    let said = said.unwrap_or_else(|| panic!("{lines:?}"));
    let said: f64 = said.trim_end().strip_suffix(" s").unwrap().parse().unwrap();
    // The stage is around the runs that the report sums up, and begins before the first.
    assert!(said > seconds - 0.06 && said < 1.5 * seconds + 1.0, "{said} s said, {seconds} s reported");
    // What is over sooner has none.
    let brief = program.run(&["render", "cornell", "--size", "8x8", "--vpls", "4", "-o", "b.png"]);
    assert!(brief.progress.iter().all(|line| !line.contains("rendering")), "{:?}", brief.progress);
}

#[test]
fn quiet_is_silent_and_json_stands_alone_on_standard_output() {
    let program = Program::new();
    let samples = long_samples(&program);
    let quiet = long(&program, samples, &["--quiet"]);
    assert_eq!((quiet.code, quiet.out.as_str(), quiet.err.as_str()), (0, "", ""));
    assert_eq!(quiet.progress, [] as [&str; 0]);
    let json = long(&program, samples, &["--json"]);
    assert_eq!(json.code, 0);
    assert_eq!(json.json()["counters"]["samples"], f64::from(samples));
}

/// A terminal: what a program writes into the second file is read from the first.
fn terminal() -> (File, File) {
    let (mut ours, mut theirs) = (0, 0);
    let (name, mode, size) = (std::ptr::null_mut(), std::ptr::null(), std::ptr::null());
    // SAFETY: two places for descriptors; null asks for defaults.
    let code = unsafe { libc::openpty(&raw mut ours, &raw mut theirs, name, mode, size) };
    assert_eq!(code, 0, "{}", std::io::Error::last_os_error());
    // SAFETY: fresh descriptors that nobody else has.
    unsafe { (File::from_raw_fd(ours), File::from_raw_fd(theirs)) }
}

#[test]
fn a_terminal_gets_a_bar_with_its_count_and_what_is_left() {
    let program = Program::new();
    let samples = long_samples(&program).to_string();
    let (mut ours, theirs) = terminal();
    let size = libc::winsize { ws_row: 24, ws_col: 160, ws_xpixel: 0, ws_ypixel: 0 };
    // SAFETY: a live descriptor of a terminal, and the struct that the request takes.
    assert_eq!(unsafe { libc::ioctl(theirs.as_raw_fd(), libc::TIOCSWINSZ, &raw const size) }, 0);
    let child = quincunx()
        .current_dir(program.folder.path())
        .env("TERM", "xterm")
        .args(PATHS)
        .args(["--spp", &samples, "-o", "b.png", "--json"])
        .stdout(Stdio::piped())
        .stderr(theirs)
        .spawn()
        .unwrap();
    let reader = std::thread::spawn(move || {
        let mut said = Vec::new();
        let mut piece = [0; 4096];
        // The end is an error: the other side is closed.
        while let Ok(count @ 1..) = ours.read(&mut piece) {
            said.extend(&piece[..count]);
        }
        String::from_utf8_lossy(&said).into_owned()
    });
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    serde_json::from_slice::<serde_json::Value>(&output.stdout).expect("only the report on standard output");
    let said = reader.join().unwrap();
    for word in ["█", "rendering, ", &format!(" of {samples} samples, about "), " s left"] {
        assert!(said.contains(word), "no {word:?} in {said:?}");
    }
    assert!(!said.contains("progress: "), "{said:?}");
}
