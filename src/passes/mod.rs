//! Passes that two or more techniques share. Each is labelled by the technique that runs it.

pub mod accumulate;
pub mod blend;
pub mod cull;
pub mod decode;
pub mod depth_prepass;
pub mod direct;
pub mod encode;
pub mod filter;
pub mod forward;
pub mod fullscreen;
pub mod gbuffer;
pub mod mesh;
pub mod next_run;
pub mod resolve;
pub mod samples;
pub mod shadow_maps;
pub mod texels;
pub mod workgroup;
