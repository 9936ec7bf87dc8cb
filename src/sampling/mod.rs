//! Where samples are: numbers only, the same on every machine.

pub mod pattern;
pub mod pcg;
pub mod periodogram;
pub mod sobol;
