//! Where samples are tested against triangles (`--sample-tests`).

use crate::caps::{Ability, Caps};
use crate::settings::Values;
use crate::techniques::deep_shading::modes::visibility::Visibility;

/// Whether samples are tested in a loop: `--sample-tests`, `auto` resolved. `bytes`: of the buffer that this takes.
pub fn is_looped(values: &Values, caps: &Caps, visibility: Visibility, bytes: u64) -> bool {
    let can = || Ability::WideAtomics.is_there(caps) && bytes <= caps.limits.max_storage_buffer_range_bytes;
    visibility == Visibility::Stochastic
        && match values.text("sample-tests") {
            "loop" => true,
            "layers" => false,
            _ => can(),
        }
}

/// How buffers are reached, in the report's words.
pub fn sample_tests_name(is_looped: bool) -> &'static str {
    if is_looped { "loop" } else { "layers" }
}
