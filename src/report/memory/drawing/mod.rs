//! Memory as pictures: SVG in the colours of its page, or as files of their own.

mod blocks;
mod drawn;
mod lifetimes;
mod palette;

pub use drawn::Drawing;

use super::MemoryReport;

/// What draws a report; None where it has nothing of it.
pub type Draw = fn(&MemoryReport) -> Option<Drawing>;

/// Names of pictures, and what draws them.
pub const PICTURES: [(&str, Draw); 2] = [("lifetimes", lifetimes::drawing), ("blocks", blocks::drawing)];
