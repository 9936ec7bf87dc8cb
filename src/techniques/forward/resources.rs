//! The technique's name, and the names of what it holds.

pub const NAME: &str = "forward";
pub const DEPTH: &str = "forward.depth.reversed";

/// What surfaces are drawn into.
pub const DRAWN: &str = "forward.material.color";

/// The mean of its samples.
pub const RESOLVED: &str = "forward.resolve.color";
