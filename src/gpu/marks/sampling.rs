//! What of a sampler says which texels it reads.

use crate::gpu::shader::gpu::marks::{
    MARK_BLENDS_LEVELS, MARK_EDGE, MARK_MAGNIFIES_LINEARLY, MARK_MINIFIES_LINEARLY, MARK_MIRROR, MARK_REPEAT,
};
use ash::vk;

/// As slots have it (marks.comp).
#[derive(Clone, Copy, Default)]
pub struct Sampling {
    pub wraps: u32,
    pub filters: u32,
    /// The finest and the coarsest that it reads.
    pub levels: [f32; 2],
}

impl Sampling {
    pub fn of(info: &vk::SamplerCreateInfo<'_>) -> Self {
        let wrap = |mode| match mode {
            vk::SamplerAddressMode::REPEAT => MARK_REPEAT,
            vk::SamplerAddressMode::MIRRORED_REPEAT => MARK_MIRROR,
            _ => MARK_EDGE,
        };
        let [u, v, w] = [info.address_mode_u, info.address_mode_v, info.address_mode_w].map(wrap);
        let flag = |is_set, flag| if is_set { flag } else { 0 };
        let filters = flag(info.mag_filter == vk::Filter::LINEAR, MARK_MAGNIFIES_LINEARLY)
            | flag(info.min_filter == vk::Filter::LINEAR, MARK_MINIFIES_LINEARLY)
            | flag(info.mipmap_mode == vk::SamplerMipmapMode::LINEAR, MARK_BLENDS_LEVELS);
        Self { wraps: u | v << 4 | w << 8, filters, levels: [info.min_lod, info.max_lod] }
    }
}
