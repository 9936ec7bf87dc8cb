//! quincunx: a headless Vulkan renderer in which five papers on interleaved, inferred and decoupled shading run side
//! by side: the same scene, the same lights, the same driver, the same ground truth.

pub mod error;
pub mod report;
pub mod sampling;
pub mod scene;
pub mod units;

pub use error::{Error, ErrorKind, Result};
