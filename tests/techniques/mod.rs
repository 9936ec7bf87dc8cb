//! Techniques, each in its folder; collapse.rs is of several.

mod adaptive_interleaved;
mod collapse;
mod deep_shading;
mod forward;
mod inferred_lighting;
pub mod interleaved_deferred;
mod interleaved_sampling;
pub mod own_pass;
mod path_traced;
