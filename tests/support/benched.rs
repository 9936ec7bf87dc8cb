//! Small benchmarks of the program, and what they leave.

use super::program::Program;
use serde_json::Value;

/// Frames that cost next to nothing.
const SMALL: [&str; 7] = ["cornell", "--size", "64x48", "--vpls", "16", "--repeat", "3"];

/// The arguments of a small `bench what`, with `more`.
pub fn bench<'a>(what: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    ["bench", what].iter().chain(&SMALL).chain(more).copied().collect()
}

/// Rows, one a line.
pub fn lines(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"))).collect()
}

/// A file of the program's folder.
pub fn read(program: &Program, name: &str) -> String {
    std::fs::read_to_string(program.path(name)).unwrap()
}
