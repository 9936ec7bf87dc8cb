//! quincunx: a headless Vulkan renderer in which five papers on interleaved, inferred and decoupled shading run side
//! by side: the same scene, the same lights, the same driver, the same ground truth.

pub mod bench;
pub mod bvh;
pub mod cli;
pub mod error;
pub mod frame;
pub mod gpu;
pub mod interrupt;
pub mod job;
pub mod lights;
pub mod memory;
pub mod metrics;
pub mod passes;
pub mod plan;
pub mod report;
pub mod resident;
pub mod sampling;
pub mod scene;
pub mod session;
pub mod settings;
pub mod shading;
pub mod techniques;
pub mod units;

pub use error::{Error, ErrorKind, Result};
