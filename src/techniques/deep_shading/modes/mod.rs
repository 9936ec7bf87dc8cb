//! What settings choose between: a file for each, with what it may be, how it is parsed and which settings go with it.
//! The work that a choice stands for lies with the pass that does it.

pub mod barycentrics;
pub mod conservative;
pub mod coverage_test;
pub mod layer_from;
pub mod lists;
pub mod pass_samples;
pub mod pixel_samples;
pub mod polygon_from;
pub mod pool_size;
pub mod sample_tests;
pub mod shade_by;
pub mod shading;
pub mod shading_kind;
pub mod shading_rate;
pub mod vertices;
pub mod visibility;
pub mod warp;
