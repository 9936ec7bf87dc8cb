//! Light: every light into the L-buffer, at its own size. Kircher 2009, section 2.2.
//!
//! The L-buffer holds irradiance and what `--highlight` keeps of highlights in two words a texel (store.rs). Sums are float
//! and in the order of the lights in every method, so all leave the same bits; `--l-buffer half` blends in half floats
//! as the paper did, which loses light (drivers round towards zero).
//!
//! ways   tiled      one dispatch, a list of lights a tile
//!        volumes    a draw a light, into sums that `pack` rounds once, or into the L-buffer itself, where it has as many
//!                   channels as `--l-buffer half` with `--highlight intensity`; lights may cast `shadow_volumes` before

pub mod pack;
pub mod reach;
pub mod shadow_volumes;
pub mod store;
pub mod tiled;
pub mod volumes;

use crate::choice::choices;
use crate::gpu::Access;
use crate::plan::Plan;
use crate::techniques::inferred_lighting::resources::NAME;
use crate::units::Extent;
use ash::vk;
use store::Store;

choices! {
    /// How texels meet their lights (`--volumes`).
    pub enum Volumes {
        "tiled" => Tiled,
        "quad" => Quad,
        "scissor" => Scissor,
        /// Over the frame, where the light's volume meets a surface.
        "stencil" => Stencil,
        /// The same within the rectangle.
        "both" => Both,
        /// The same, except for small lights, which have the rectangle alone.
        "auto" => Auto,
    }
}

impl Volumes {
    /// Whether lights are counted into a stencil.
    pub fn counts(self) -> bool {
        matches!(self, Self::Stencil | Self::Both | Self::Auto)
    }
}

const WORDS: vk::Format = vk::Format::R32G32_UINT;
const HALVES: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// How lights come into the L-buffer, and what it keeps.
#[derive(Clone, Copy, Debug)]
pub struct LBuffer {
    pub store: Store,
    pub volumes: Volumes,
    /// Lights that are drawn are blended in half floats.
    pub in_halves: bool,
    /// A sampler reads its channels, not a shader its words.
    pub is_sampled: bool,
}

impl LBuffer {
    /// Lights are drawn into the L-buffer itself.
    pub fn is_drawn(self) -> bool {
        self.in_halves && self.store.has_channels()
    }

    /// Lights are drawn into sums, which a pass packs.
    pub fn has_sums(self) -> bool {
        self.volumes != Volumes::Tiled && !self.is_drawn()
    }

    /// What draws of lights are blended in, a format a target.
    pub fn target_formats(self) -> Vec<vk::Format> {
        let format = if self.in_halves { HALVES } else { FLOATS };
        vec![format; if self.store.has_channels() { 1 } else { 2 }]
    }

    /// The value of the axis TARGETS of their shaders.
    pub fn targets_axis(self) -> &'static str {
        if self.store.has_channels() { "one" } else { "two" }
    }

    /// What the L-buffer is drawn or stored as, and what it is read as.
    fn formats(self) -> [vk::Format; 2] {
        let channels = if matches!(self.store, Store::Fixed { .. }) { vk::Format::R16G16B16A16_UNORM } else { HALVES };
        let read = if self.is_sampled { channels } else { WORDS };
        [if self.is_drawn() { HALVES } else { read }, read]
    }
}

/// Full name of the L-buffer.
pub fn l_buffer() -> String {
    format!("{NAME}.light.l_buffer")
}

/// Full names of the sums that draws leave, an image a target; of lights drawn into the L-buffer none.
pub fn sums(l_buffer: LBuffer) -> Vec<String> {
    let names = ["sums", "more_sums"].map(|name| format!("{NAME}.light.{name}"));
    let count = if l_buffer.has_sums() { l_buffer.target_formats().len() } else { 0 };
    names.into_iter().take(count).collect()
}

/// Plans the L-buffer, and the sums where there are any.
pub fn plan(plan: &mut Plan, extent: Extent, described: LBuffer) {
    use vk::ImageUsageFlags as Usage;
    let written = if described.is_drawn() { Usage::COLOR_ATTACHMENT } else { Usage::STORAGE };
    let usage = written | Usage::SAMPLED | Usage::TRANSFER_SRC;
    plan.reinterpreted("l-buffer", l_buffer(), extent, described.formats(), usage);
    if matches!(described.store, Store::Fixed { .. }) {
        // What is held at its most is counted.
        plan.read_back(&l_buffer());
    }
    for (name, format) in sums(described).into_iter().zip(described.target_formats()) {
        plan.image("l-buffer", name, extent, format, Usage::COLOR_ATTACHMENT | Usage::SAMPLED);
    }
}

/// The access with which the last pass of the lights left the L-buffer.
pub fn last_access(l_buffer: LBuffer) -> Access {
    if l_buffer.is_drawn() { Access::ColorWrite } else { Access::ComputeWrite }
}
