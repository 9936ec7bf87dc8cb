//! Entries, each shaded once by a compute shader: what lists have, what strays see, or each sample (`--lists none`). A colour is a
//! function of triangle and shading pixel alone, so that nothing has to be drawn for it; the paper's way, fragments of a
//! conservative pass that find their triangle in a list, is `--shade-by fragment`. Entries are sorted by material, whose
//! textures a dispatch has bound. Until it is shaded an entry waits in the place of its colour.
//! writes  entries.order  buffer, 4 B a sample: places of colours, one material's after the other
//!         entries.spans  buffer, 24 B a material: its part of the order, and its workgroups

pub mod order;
mod plan;
pub mod samples;
pub mod shade;
pub mod sort;
mod spans;

pub use plan::{plan, plan_sort, read};
