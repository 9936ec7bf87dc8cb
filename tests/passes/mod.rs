//! Passes that several techniques use.

mod blended;
mod depth_prepass;
mod filter;
mod gbuffer;
mod samples;
mod shadow_maps;
