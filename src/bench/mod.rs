//! Benchmarks: a grid of settings, measured in turn, each row with its error, its bytes and the command that repeats it.

pub mod run;
pub mod stats;
pub mod sweep;
