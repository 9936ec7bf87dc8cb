//! Which virtual point lights a pixel does not see (`--vpl-shadow`), found for all pixels before they are shaded: a bit for each
//! light of a pixel's subset, by shadow rays or by the lights' shadow maps. Segovia 2006, section 4.3 (SSM); the shading of every split
//! skips what is hidden.
//!
//! reads   the G-buffer, the lights      writes  vpl_shadow.hidden  buffer: a word, then for each pixel as many as its lights need
//!
//! Why this way: shading reads a word for 32 lights of many pixels, as fast as without shadows, in every split; what looks for a
//! light has few of them a thread, and its time stands beside the shading's. Maps need not all be held at once: each has its turn, is
//! asked, and is drawn over by another's.

mod draws;
pub mod held;
mod index;
mod maps;
mod rays;
mod reach;
mod sought;
pub mod unrolled;

pub use held::{HIDDEN, VplMaps};
pub use sought::{Sought, read, words_a_point};

use super::choices::{Choices, VplShadow};
use super::shade::ShadeGpu;
use crate::error::Result;
use crate::gpu::shader::structs::VplBlock;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::{self, GBuffer};
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::techniques::interleaved_deferred::resources::NAME;
use crate::techniques::{Inputs, Run};
use held::{GROUP, MAPS, drawing_pass, finding_pass, turns};
use maps::HiddenByMaps;
use rays::HiddenByRays;
use sought::hidden_bytes;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Plans the bits and the passes that find them; nothing where nothing stops virtual lights.
pub fn plan(plan: &mut Plan, choices: &Choices) {
    if words_a_point(choices) == 0 {
        return;
    }
    plan.buffer(GROUP, HIDDEN, hidden_bytes(choices));
    let maps = choices.vpl_maps.as_ref();
    if let Some(maps) = maps {
        maps::plan(plan, maps, choices.vpl_count);
    }
    for turn in turns(maps, choices.vpl_count) {
        if maps.is_some() {
            plan.pass(drawing_pass(&turn), [(MAPS.to_owned(), Access::DepthWrite)]);
        }
        let cleared = (turn.index == 0).then(|| (HIDDEN.to_owned(), Access::TransferWrite));
        let asked = maps.map(|_| (MAPS.to_owned(), Access::ComputeSample));
        let written = (HIDDEN.to_owned(), Access::ComputeWrite);
        let surface = gbuffer::surface(NAME, choices.shading.position);
        plan.pass(finding_pass(&turn), surface.into_iter().chain(asked).chain(cleared).chain([written]));
    }
}

/// The passes that find them.
pub enum FindHidden {
    Rays(Box<HiddenByRays>),
    Maps(Box<HiddenByMaps>),
}

impl FindHidden {
    /// None where nothing stops virtual lights.
    ///
    /// Errors: the driver refuses, memory (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        sought: &Sought<'_>,
    ) -> Result<Option<Self>> {
        let Sought { choices, least_squared, .. } = *sought;
        Ok(match (choices.vpl_shadow, choices.vpl_maps) {
            (VplShadow::None, _) => None,
            (_, Some(maps)) => {
                Some(Self::Maps(Box::new(HiddenByMaps::new(gpu, inputs, scene, resources, maps, sought)?)))
            }
            (_, None) => Some(Self::Rays(Box::new(HiddenByRays::new(gpu, choices, least_squared)?))),
        })
    }

    /// Hands the G-buffer on as it leaves it.
    pub fn record<'a>(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        scene: &SceneGpu,
        lights: &ShadeGpu,
        direct: &DirectGpu,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<Edge<'a, GBuffer>> {
        let hidden = lights.hidden.as_ref().expect("it is planned with the pass");
        match self {
            Self::Rays(rays) => rays.record(cmd, frame, lights, direct, gbuffer, hidden)?,
            Self::Maps(maps) => maps.record(cmd, frame, scene, lights, gbuffer, hidden)?,
        }
        Ok(gbuffer.after(Access::ComputeSample))
    }

    /// From now on, what is found is of `vpls`, as many as before.
    ///
    /// Errors: as `HiddenByMaps::begin_run`.
    pub fn begin_run(&self, run: &Run<'_>, vpls: &[VplBlock]) -> Result<()> {
        match self {
            Self::Rays(_) => Ok(()),
            Self::Maps(maps) => maps.begin_run(run, vpls),
        }
    }

    /// Numbers for the report's `counters`.
    pub fn counters(&self) -> BTreeMap<&'static str, f64> {
        match self {
            Self::Rays(_) => BTreeMap::new(),
            Self::Maps(maps) => maps.counters(),
        }
    }
}
