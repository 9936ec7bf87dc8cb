//! Lights that pixels may not see: whose, how many words of bits, and what every pass that finds some begins with.

use super::held::HIDDEN;
use crate::gpu::shader::structs::HiddenParams;
use crate::gpu::shader::techniques::interleaved_deferred::vpl_shadow::hidden::{HIDDEN_HEAD, LIGHTS_A_WORD};
use crate::gpu::{Access, Buffer, Commands};
use crate::techniques::interleaved_deferred::choices::{Choices, VplShadow};
use crate::techniques::interleaved_deferred::shade::SubsetLights;
use crate::techniques::interleaved_deferred::split_method::SplitMethod;

/// Which lights pixels may not see.
pub struct Sought<'a> {
    pub choices: &'a Choices,
    pub lights: &'a SubsetLights,
    /// Square of `--vpl-clamp`, square metres.
    pub least_squared: f32,
}

/// Words that a point has; 0 where nothing is looked for.
pub fn words_a_point(choices: &Choices) -> u32 {
    match choices.vpl_shadow {
        VplShadow::None => 0,
        VplShadow::Ray | VplShadow::Map => choices.most_vpls_a_subset().div_ceil(LIGHTS_A_WORD),
    }
}

/// Points whose lights are looked for, with the padding: pixels, or with `--split subsample` cells of the pattern.
fn point_count(choices: &Choices) -> u64 {
    choices.mapping.sub_texel_count() * u64::from(choices.subset_count())
}

/// Parameters of every pass that writes bits, of all lights.
pub(super) fn params(choices: &Choices, least_squared: f32) -> HiddenParams {
    HiddenParams {
        mapping: choices.mapping,
        least_squared,
        words_a_point: words_a_point(choices),
        is_of_cells: u32::from(choices.split == SplitMethod::Subsample),
        subset_first: 0,
        word_first: 0,
        light_first: 0,
        light_end: choices.vpl_count,
        _unused: 0,
    }
}

/// Workgroups for all words of all points.
pub(super) fn groups(choices: &Choices, params: &HiddenParams) -> [u32; 3] {
    let points = choices.mapping.sub_texel_count().div_ceil(u64::from(choices.shading.lane_count()));
    [points as u32, params.words_a_point, choices.subset_count()]
}

/// No light is hidden, before the first pass that finds some.
pub(super) fn clear(cmd: &mut Commands, hidden: &Buffer) {
    cmd.barriers([hidden.discard(Access::TransferWrite)]);
    cmd.clear(hidden);
    cmd.barriers([hidden.from(Access::TransferWrite).to(Access::ComputeWrite)]);
}

/// Bytes of all points' words.
pub(super) fn hidden_bytes(choices: &Choices) -> u64 {
    4 * (u64::from(HIDDEN_HEAD) + point_count(choices) * u64::from(words_a_point(choices)))
}

/// The bits, as a pass touches them that shades by `access`.
pub fn read(choices: &Choices, access: Access) -> Option<(String, Access)> {
    (words_a_point(choices) > 0).then(|| (HIDDEN.to_owned(), access))
}
