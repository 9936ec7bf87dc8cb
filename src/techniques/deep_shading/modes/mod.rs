//! What settings choose between: an enum each, parsed from its setting, and nothing else. What is done for a choice lies with the pass
//! that does it.

pub mod conservative;
pub mod layer_from;
pub mod pass_samples;
pub mod polygon_from;
pub mod pool_size;
pub mod sample_tests;
pub mod shading;
pub mod visibility;
