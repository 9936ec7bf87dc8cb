//! The table of all techniques: a new one is a line here.

use super::{
    Technique, adaptive_interleaved, deep_shading, deferred, forward, inferred_lighting, interleaved_deferred,
    interleaved_sampling, path_traced,
};
use crate::error::{Error, Result};

/// Every technique.
pub const ALL: &[&dyn Technique] = &[
    &interleaved_deferred::InterleavedDeferred,
    &inferred_lighting::InferredLighting,
    &deep_shading::DeepShading,
    &adaptive_interleaved::AdaptiveInterleaved,
    &interleaved_sampling::InterleavedSampling,
    &deferred::Deferred,
    &forward::Forward,
    &path_traced::PathTraced,
];

/// The technique of a command that names none.
pub const DEFAULT_TECHNIQUE: &str = "interleaved_deferred";

/// The technique of this name.
///
/// Errors: none has it (exit code 2).
pub fn find(name: &str) -> Result<&'static dyn Technique> {
    ALL.iter().copied().find(|technique| technique.name() == name).ok_or_else(|| {
        let names: Vec<&str> = ALL.iter().map(|technique| technique.name()).collect();
        Error::request(format!("--technique {name}: there is no such technique"))
            .note(format!("there are {}", names.join(", ")))
    })
}
