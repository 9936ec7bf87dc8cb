//! Where samples are: numbers only, the same on every machine.

pub mod basis;
pub mod kept;
pub mod pairs;
pub mod pattern;
pub mod pcg;
pub mod periodogram;
pub mod sampler;
pub mod side;
pub mod sobol;
