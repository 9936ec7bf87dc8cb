//! The technique's name and the names of what it holds.

pub const NAME: &str = "path_traced";

/// The finished picture.
pub const COLOR: &str = "path_traced.color";

/// What is summed from run to run.
pub const SUMS: &str = "path_traced.sums";
