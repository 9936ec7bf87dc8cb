//! The technique's name, which begins those of its passes and of what it holds.

pub const NAME: &str = "interleaved_deferred";
