//! Light: every light into the L-buffer, at its own size. Kircher 2009, section 2.2.
//!
//! The L-buffer holds irradiance in three channels and the intensity of the highlight in the fourth, as half floats. Sums
//! are float and in the order of the lights in every method, so all leave the same bits; `--l-buffer half` blends in
//! half floats as the paper did, which loses light (drivers round towards zero). `--l-buffer fixed` packs the float sums to
//! 16 bits of fixed point instead.
//!
//! ways   tiled      one dispatch, a list of lights a tile
//!        volumes    a draw a light, into float sums that `pack` rounds once, or into the L-buffer itself; lights may
//!                   cast `shadow_volumes` before

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

/// What lights are blended in with `--l-buffer half`.
pub const HALF_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const SUMS_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Full name of the L-buffer.
pub fn l_buffer() -> String {
    format!("{NAME}.light.l_buffer")
}

/// Full name of the float sums that draws leave.
pub fn sums() -> String {
    format!("{NAME}.light.sums")
}

/// Plans the L-buffer, and the sums where lights are drawn and not blended in halves.
pub fn plan(plan: &mut Plan, extent: Extent, volumes: Volumes, in_halves: bool, store: Store) {
    use vk::ImageUsageFlags as Usage;
    let written = if in_halves { Usage::COLOR_ATTACHMENT } else { Usage::STORAGE };
    let usage = written | Usage::SAMPLED | Usage::TRANSFER_SRC;
    match store {
        Store::Halves => plan.image("l-buffer", l_buffer(), extent, HALF_FORMAT, usage),
        Store::Fixed { .. } => {
            plan.image("l-buffer", l_buffer(), extent, vk::Format::R16G16B16A16_UNORM, usage);
            // What is held at its most is counted.
            plan.read_back(&l_buffer());
        }
    }
    if volumes != Volumes::Tiled && !in_halves {
        plan.image("l-buffer", sums(), extent, SUMS_FORMAT, Usage::COLOR_ATTACHMENT | Usage::SAMPLED);
    }
}

/// The access with which the method's last pass left the L-buffer.
pub fn last_access(in_halves: bool) -> Access {
    if in_halves { Access::ColorWrite } else { Access::ComputeWrite }
}
