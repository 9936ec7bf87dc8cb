//! The three steps of one component, in their order: initial pass, tile-local guidance, refinement (Dubla 2009, section
//! 3 and figure 2), or what brings their results from the host.

use super::buffers::{ComponentBuffers, Shared};
use super::choices::{Choices, ComponentChoice};
use super::compact::CompactPass;
use super::components::{Given, Point, Samples};
use super::fused::FusedPass;
use super::guide::GuidePass;
use super::host::upload::HostSteps;
use super::refine::{Listed, RefinePass};
use super::resources::{OWN_GUIDANCE, of_component};
use super::sample::SamplePass;
use super::settings::Trace;
use super::spread::SpreadPass;
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::gbuffer::GBuffer;
use crate::plan::Resources;
use std::sync::Arc;

/// One component on the device.
pub struct ComponentSteps {
    pub buffers: ComponentBuffers,
    /// Threads of a workgroup of the refinement that a tile has.
    pub tile_lanes: u32,
    steps: Steps,
}

/// How a component's pixels come to their iterations.
#[expect(clippy::large_enum_variant, reason = "one a component, never moved")]
enum Steps {
    /// The initial pass alone.
    Initial {
        sample: SamplePass,
        estimates: Buffer,
    },
    /// All in one dispatch.
    Fused {
        fused: FusedPass,
        guidance: Buffer,
    },
    Apart {
        sample: SamplePass,
        estimates: Buffer,
        refinement: Refinement,
    },
    /// The host has done all of it.
    Host(HostSteps),
}

/// Guidance, compaction, and the dispatch over what is listed.
struct Refinement {
    guide: GuidePass,
    /// Where other tiles guide too: the pass, and what tiles ask for by themselves.
    spread: Option<(SpreadPass, Buffer)>,
    compact: CompactPass,
    refine: RefinePass,
    guidance: Buffer,
    bins: Buffer,
    tiles: Buffer,
}

impl ComponentSteps {
    /// Takes what `plan` put in, fills it, and makes the pipelines.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        choices: &Choices,
        choice: &ComponentChoice,
        samples: &Samples,
    ) -> Result<Self> {
        let mut buffer = |what: &str| resources.buffer(&of_component(what, choice.component.name()));
        let steps = if choices.trace == Trace::Host {
            Steps::Host(HostSteps::new(resources, choices, choice, samples))
        } else if choices.is_fused() {
            Steps::Fused { fused: FusedPass::new(gpu, choices, choice)?, guidance: buffer("guidance") }
        } else {
            let (sample, estimates) = (SamplePass::new(gpu, choices, choice)?, buffer("estimates"));
            if choices.has_refinement() {
                let spread = SpreadPass::new(gpu, choices, choice)?.filter(|_| choices.spreads());
                let refinement = Refinement {
                    guide: GuidePass::new(gpu, choice)?,
                    spread: spread.map(|spread| (spread, buffer(OWN_GUIDANCE))),
                    compact: CompactPass::new(gpu, choices)?,
                    refine: RefinePass::new(gpu, choices, choice)?,
                    guidance: buffer("guidance"),
                    bins: buffer("bins"),
                    tiles: buffer("tiles"),
                };
                Steps::Apart { sample, estimates, refinement }
            } else {
                Steps::Initial { sample, estimates }
            }
        };
        let tile_lanes = if choices.is_by_slot() { 1 } else { choice.params.tile_size() };
        Ok(Self { buffers: ComponentBuffers::new(gpu, resources, choices, choice, samples)?, tile_lanes, steps })
    }

    /// Further iterations of each tile, a word each; None where no tile has any.
    pub fn guidance(&self) -> Option<&Buffer> {
        match &self.steps {
            Steps::Initial { .. } => None,
            Steps::Fused { guidance, .. } => Some(guidance),
            Steps::Apart { refinement, .. } => Some(&refinement.guidance),
            Steps::Host(host) => host.guidance(),
        }
    }

    /// What writes rays, irradiance and guidance last.
    pub fn last_write(&self) -> Access {
        if self.is_on_host() { Access::TransferWrite } else { Access::ComputeWrite }
    }

    pub fn is_on_host(&self) -> bool {
        matches!(self.steps, Steps::Host(_))
    }

    /// The host's part of a run; nothing where the device estimates. `points`: what the frame's pixels see.
    ///
    /// Errors: Ctrl-C (exit code 130).
    pub fn estimate_on_host(&self, given: &Given<'_>, points: &[Point]) -> Result<()> {
        match &self.steps {
            Steps::Host(host) => host.estimate(given, points),
            Steps::Initial { .. } | Steps::Fused { .. } | Steps::Apart { .. } => Ok(()),
        }
    }

    /// What its tiles ask for by themselves; None where that is all that guides them.
    pub fn own_guidance(&self) -> Option<&Buffer> {
        match &self.steps {
            Steps::Apart { refinement, .. } => refinement.spread.as_ref().map(|(_, own)| own),
            Steps::Initial { .. } | Steps::Fused { .. } | Steps::Host(_) => None,
        }
    }

    /// Records all that comes before its refinement. Hands the G-buffer on as it leaves it.
    pub fn record_initial<'a>(
        &self,
        cmd: &mut Commands,
        shared: &Shared<'_>,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<Edge<'a, GBuffer>> {
        let buffers = &self.buffers;
        match &self.steps {
            Steps::Host(host) => {
                host.record(cmd, buffers)?;
                return Ok(gbuffer);
            }
            Steps::Initial { sample, estimates } => sample.record(cmd, buffers, shared, gbuffer, estimates)?,
            Steps::Fused { fused, guidance } => fused.record(cmd, buffers, shared, gbuffer, guidance)?,
            Steps::Apart { sample, estimates, refinement } => {
                sample.record(cmd, buffers, shared, gbuffer, estimates)?;
                let Refinement { guide, spread, guidance, bins, .. } = refinement;
                let guided = spread.as_ref().map_or(guidance, |(_, own)| own);
                guide.record(cmd, buffers, estimates.from(Access::ComputeWrite), guided, bins)?;
            }
        }
        Ok(gbuffer.after(Access::ComputeSample))
    }

    /// Records its refinement, where it has one. `own_guidance`: of all components whose initial passes are recorded, this
    /// one's first.
    pub fn record_refinement<'a>(
        &self,
        cmd: &mut Commands,
        shared: &Shared<'_>,
        gbuffer: Edge<'a, GBuffer>,
        own_guidance: &[Edge<'_, Buffer>],
    ) -> Result<Edge<'a, GBuffer>> {
        let Steps::Apart { estimates, refinement, .. } = &self.steps else { return Ok(gbuffer) };
        let Refinement { spread, compact, refine, guidance, bins, tiles, .. } = refinement;
        let (buffers, written) = (&self.buffers, |buffer| Buffer::from(buffer, Access::ComputeWrite));
        if let (Some((spread, _)), [own, others @ ..]) = (spread, own_guidance) {
            spread.record(cmd, buffers, *own, others, guidance, written(bins))?;
        }
        compact.record(cmd, buffers, written(guidance), written(bins), tiles)?;
        let listed = Listed {
            // The guidance has read them, and the list was made from it.
            estimates: written(estimates).after(Access::ComputeRead),
            guidance: written(guidance).after(Access::ComputeRead),
            rays: written(&buffers.rays),
            irradiance: written(&buffers.irradiance),
            bins: written(bins),
            tiles: written(tiles),
        };
        refine.record(cmd, buffers, shared, gbuffer, &listed)?;
        Ok(gbuffer.after(Access::ComputeSample))
    }
}
