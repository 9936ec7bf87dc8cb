//! The technique's name, which begins those of its passes and of what it holds.

pub const NAME: &str = "interleaved_deferred";

/// The pass that flags discontinuities.
pub const DISCONTINUITY: &str = "interleaved_deferred.discontinuity";
