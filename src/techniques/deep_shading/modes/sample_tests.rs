//! Where samples are tested against triangles (`--sample-tests`).

use crate::caps::{Ability, Caps};
use crate::choice::choices;
use crate::settings::Values;
use crate::techniques::deep_shading::modes::visibility::Visibility;

choices! {
    /// How samples are tested against triangles (`--sample-tests`).
    pub enum SampleTests {
        /// Each fragment tests all samples of its pixel.
        "loop" => Loop,
        /// A layer for each tuple, where a pixel is a sample.
        "layers" => Layers,
    }
}

/// Whether samples are tested in a loop: `--sample-tests`, `auto` resolved. `bytes`: of the buffer that this takes.
pub fn is_looped(values: &Values, caps: &Caps, visibility: Visibility, bytes: u64) -> bool {
    let can = || Ability::WideAtomics.is_there(caps) && bytes <= caps.limits.max_storage_buffer_range_bytes;
    visibility == Visibility::Stochastic
        && values
            .unless_auto("sample-tests", Values::choice)
            .map_or_else(can, |tests: SampleTests| tests == SampleTests::Loop)
}

/// How buffers are reached, in the report's words.
pub fn sample_tests_name(is_looped: bool) -> &'static str {
    if is_looped { SampleTests::Loop.name() } else { SampleTests::Layers.name() }
}
