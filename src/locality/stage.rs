//! Stages of a frame that are studied: which keys say what each of them does, and what its passes come to on a machine.

use super::access::Kernel;
use super::count::{Counts, count};
use super::machine::Machine;
use crate::choice::choices;
use crate::error::{Error, Result};
use crate::units::Extent;
use serde::Serialize;

choices! {
    /// A stage (`--stage`), in the order of a frame.
    pub enum StageKind {
        /// The G-buffer into sub-buffers.
        "split" => Split,
        /// Virtual point lights at each pixel.
        "shade" => Shade,
        /// Irradiance back to the frame.
        "gather" => Gather,
        /// Discontinuities, and the filter that stops at them.
        "filter" => Filter,
        /// Samples' triangles into the lists of deep shading.
        "insert" => Insert,
    }
}

impl StageKind {
    /// Keys of `--sweep` that it reads.
    pub const fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Split | Self::Gather => &["split", "pattern", "block", "copy", "storage", "workgroup", "size"],
            Self::Shade => &["split", "pattern", "block", "storage", "texels", "vpls", "workgroup", "size"],
            Self::Filter => &["filter", "kernel", "pattern", "texels", "workgroup", "size"],
            Self::Insert => &["spp", "tuples", "triangle", "blur", "size"],
        }
    }
}

/// A stage with its settings.
pub trait Studied {
    fn stage(&self) -> StageKind;

    /// Settings that its addresses hang on, beside size and workgroup, by the names that rows of benchmarks have them by.
    fn settings(&self) -> Vec<(&'static str, String)>;

    fn extent(&self) -> Extent;

    /// Invocations of a workgroup, across and down.
    fn workgroup(&self) -> [u32; 2];

    /// Each pass with cold caches.
    fn counted(&self, machine: &Machine) -> Vec<PassCounts>;

    /// `split=two-pass pattern=4x4 block=16x16 copy=pull storage=image`.
    fn label(&self) -> String {
        label(&self.settings())
    }
}

/// `key=value key=value`.
pub fn label(settings: &[(&'static str, String)]) -> String {
    settings.iter().map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(" ")
}

/// What a pass came to.
#[derive(Clone, Debug, Serialize)]
pub struct PassCounts {
    pub pass: &'static str,
    #[serde(flatten)]
    pub counts: Counts,
}

impl PassCounts {
    pub fn of(pass: &'static str, kernel: &dyn Kernel, machine: &Machine) -> Self {
        Self { pass, counts: count(kernel, machine) }
    }
}

/// All passes together.
pub fn total(passes: &[PassCounts]) -> Counts {
    passes.iter().fold(Counts::default(), |sum, pass| sum.plus(pass.counts))
}

/// What takes the time of a pass that does nothing else, in bytes from memory: those, and what goes between the caches by how much
/// faster it is. It explains; it does not predict.
pub fn cost(counts: &Counts, machine: &Machine) -> f64 {
    counts.memory_bytes() as f64 + counts.second_bytes(machine) as f64 / machine.second_speed
}

/// `4x2`.
pub fn pair_text([x, y]: [u32; 2]) -> String {
    format!("{x}x{y}")
}

/// Errors: a side is 0 or too large (exit code 2).
pub fn check_sides(extent: Extent, pattern: [u32; 2], block: [u32; 2], workgroup: [u32; 2]) -> Result<()> {
    let (across, down) = (extent.width, extent.height);
    let sides = [pattern, block, workgroup].into_iter().flatten().chain([across, down]);
    if sides.clone().any(|side| side == 0 || side > 16_384) || pattern.iter().any(|side| *side > 64) {
        return Err(Error::request(format!(
            "a frame of {across}x{down}, a pattern of {pattern:?}, blocks of {block:?}, workgroups of {workgroup:?}: sides are 1 \
             to 16384, those of a pattern up to 64"
        )));
    }
    Ok(())
}

/// The block rounded up to whole patterns; the pattern itself where the split has no blocks.
pub fn rounded_block(has_blocks: bool, pattern: [u32; 2], block: [u32; 2]) -> [u32; 2] {
    let rounded = [0, 1].map(|axis: usize| block[axis].next_multiple_of(pattern[axis]));
    if has_blocks { rounded } else { pattern }
}
