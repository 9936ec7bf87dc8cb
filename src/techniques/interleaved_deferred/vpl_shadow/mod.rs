//! Which virtual point lights a pixel does not see (`--vpl-shadow`), found for all pixels before they are shaded: a bit for each
//! light of a pixel's subset. Segovia 2006, section 4.3 (SSM); shading.glsl of every split skips what is hidden.
//!
//! reads   the G-buffer, the lights      writes  vpl_shadow.hidden  buffer: a word, then for each pixel as many as its lights need
//!
//! Why this way: shading reads a word for 32 lights of many pixels, as fast as without shadows, in every split; what looks for a
//! light has few of them a thread, and its time stands beside the shading's.

mod rays;

use super::choices::{Choices, VplShadow};
use super::shade::ShadeGpu;
use super::split_method::SplitMethod;
use crate::error::Result;
use crate::gpu::shader::structs::HiddenParams;
use crate::gpu::shader::techniques::interleaved_deferred::vpl_shadow::hidden::{HIDDEN_HEAD, LIGHTS_A_WORD};
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::{self, GBuffer};
use crate::plan::Plan;
use crate::techniques::interleaved_deferred::resources::NAME;
use rays::HiddenByRays;
use std::sync::Arc;

/// Full name of the buffer of bits.
pub const HIDDEN: &str = "interleaved_deferred.vpl_shadow.hidden";

/// Words that a point has; 0 where nothing is looked for.
pub fn words_a_point(choices: &Choices) -> u32 {
    match choices.vpl_shadow {
        VplShadow::None => 0,
        VplShadow::Ray => choices.most_vpls_a_subset().div_ceil(LIGHTS_A_WORD),
    }
}

/// Points whose lights are looked for, with the padding: pixels, or with `--split subsample` cells of the pattern.
fn point_count(choices: &Choices) -> u64 {
    choices.mapping.sub_texel_count() * u64::from(choices.subset_count())
}

/// Parameters of every pass that writes bits.
pub fn params(choices: &Choices, least_squared: f32) -> HiddenParams {
    HiddenParams {
        mapping: choices.mapping,
        least_squared,
        words_a_point: words_a_point(choices),
        is_of_cells: u32::from(choices.split == SplitMethod::Subsample),
        _unused: 0,
    }
}

/// Plans the bits and the pass that finds them; nothing where nothing stops virtual lights.
pub fn plan(plan: &mut Plan, choices: &Choices) {
    let words = words_a_point(choices);
    if words == 0 {
        return;
    }
    let bytes = 4 * (u64::from(HIDDEN_HEAD) + point_count(choices) * u64::from(words));
    plan.buffer("vpl_shadow", HIDDEN, bytes);
    let written = [(HIDDEN.to_owned(), Access::TransferWrite), (HIDDEN.to_owned(), Access::ComputeWrite)];
    let surface = gbuffer::surface(NAME, choices.shading.position);
    plan.pass(format!("{NAME}.vpl_shadow"), surface.into_iter().chain(written));
}

/// The bits, as a pass touches them that shades by `access`.
pub fn read(choices: &Choices, access: Access) -> Option<(String, Access)> {
    (words_a_point(choices) > 0).then(|| (HIDDEN.to_owned(), access))
}

/// The pass that finds them.
pub struct FindHidden {
    rays: HiddenByRays,
}

impl FindHidden {
    /// None where nothing stops virtual lights.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, least_squared: f32) -> Result<Option<Self>> {
        Ok(match choices.vpl_shadow {
            VplShadow::None => None,
            VplShadow::Ray => Some(Self { rays: HiddenByRays::new(gpu, choices, least_squared)? }),
        })
    }

    /// Hands the G-buffer on as it leaves it.
    pub fn record<'a>(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        lights: &ShadeGpu,
        direct: &DirectGpu,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<Edge<'a, GBuffer>> {
        let hidden = lights.hidden.as_ref().expect("it is planned with the pass");
        self.rays.record(cmd, frame, lights, direct, gbuffer, hidden)?;
        Ok(gbuffer.after(Access::ComputeSample))
    }
}
