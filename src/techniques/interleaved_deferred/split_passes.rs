//! The split of a frame on the device, and what follows from it: from the G-buffer to irradiance in frame order.

use super::choices::Choices;
use super::drawn_irradiance::DrawnIrradiance;
use super::gather::{self, Gather};
use super::mask::{self, Mask};
use super::shade::ShadeGpu;
use super::shade::branch::ShadeBranch;
use super::shade::drawn::ShadeDrawn;
use super::shade::masked::{Masked, ShadeMasked};
use super::shade::strided::{Dispatches, ShadeStrided};
use super::shade::sub_buffers::ShadeSubBuffers;
use super::shade::subsample::ShadeSubsample;
use super::split::{self, Split};
use super::split_method::{Copies, SplitMethod};
use super::sub_buffers::{Stage, Surface, Texels};
use super::upscale::Upscale;
use super::vpl_shadow;
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::{self, GBuffer};
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

/// How pixels meet their lights.
#[expect(clippy::large_enum_variant, reason = "one a renderer, never moved")]
pub enum SplitPasses {
    Branch { shade: ShadeBranch, irradiance: Buffer },
    Strided { shade: ShadeStrided, irradiance: Buffer },
    Subsample { shade: ShadeSubsample, cells: Buffer, upscale: Upscale, irradiance: Buffer },
    Masked { mask: Mask, shade: ShadeMasked, irradiance: Buffer },
    SubBuffers(SubBuffers),
}

/// What shades sub-buffers.
enum ShadeCopied {
    Dispatched(ShadeSubBuffers),
    Drawn(ShadeDrawn),
}

/// Split, shade, gather.
pub struct SubBuffers {
    pub copies: Copies,
    split: Split,
    pub surface: Surface,
    shade: ShadeCopied,
    pub shaded: Texels,
    gather: Gather,
    pub gathered: Buffer,
}

/// Plans the split, where there is one: its results are kept where many runs shade them.
pub fn plan_split(plan: &mut Plan, choices: &Choices) {
    let Some(copies) = choices.split.copies() else { return };
    split::plan(plan, choices, copies);
    if choices.run_count > 1 {
        Surface::touches("split", choices.moved, Access::ComputeRead).for_each(|(part, _)| plan.keep(&part));
    }
}

/// Plans resources and passes from the shading on; returns the name of the irradiance in frame order.
pub fn plan(plan: &mut Plan, choices: &Choices) -> String {
    let Choices { shading, split, mapping, .. } = choices;
    let parts = choices.shaded();
    let frame_bytes = mapping.frame_texel_count() * 8;
    let (shaded, shade) = (format!("{NAME}.shade.irradiance"), format!("{NAME}.shade"));
    let surface = |stage: Stage| gbuffer::parts_as(NAME, shading.position, parts, stage.samples()).into_iter();
    let hidden = |stage: Stage| vpl_shadow::read(choices, stage.reads());
    let (read, written) = (Access::ComputeRead, Access::ComputeWrite);
    match split {
        SplitMethod::None | SplitMethod::Branch | SplitMethod::Indirect | SplitMethod::Remap => {
            plan.buffer("irradiance", &shaded, frame_bytes);
            plan.pass(shade, surface(Stage::Compute).chain(hidden(Stage::Compute)).chain([(shaded.clone(), written)]));
            shaded
        }
        SplitMethod::Subsample => {
            let upscaled = format!("{NAME}.upscale.irradiance");
            plan.buffer("irradiance", &shaded, mapping.sub_texel_count() * 8);
            plan.buffer("irradiance", &upscaled, frame_bytes);
            plan.pass(shade, surface(Stage::Compute).chain(hidden(Stage::Compute)).chain([(shaded.clone(), written)]));
            plan.pass(format!("{NAME}.upscale"), [(shaded, read), (upscaled.clone(), written)]);
            upscaled
        }
        SplitMethod::Masked(kind) => {
            mask::plan(plan, *kind, mapping);
            plan.buffer("irradiance", &shaded, frame_bytes);
            DrawnIrradiance::plan(plan, "shade", mapping);
            let tested = (kind.resource(), Access::DepthTest);
            let read = surface(Stage::Fragment).chain(hidden(Stage::Fragment)).chain([tested]);
            plan.pass(shade, read.chain(DrawnIrradiance::touches("shade")));
            shaded
        }
        SplitMethod::Copy(copies) => {
            let storage = copies.storage;
            let stage = choices.shade_stage();
            storage.plan(plan, "irradiance", "shade.irradiance", mapping, 8, stage);
            let surface = Surface::touches("split", parts, storage.read(stage)).chain(hidden(stage));
            plan.pass(shade, surface.chain([(shaded.clone(), storage.written(stage))]));
            gather::plan(plan, choices, *copies, shaded)
        }
    }
}

impl SplitPasses {
    /// Takes what `plan` put in.
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let shading = &choices.shading;
        let mut buffer = |what: &str| resources.buffer(&format!("{NAME}.{what}.irradiance"));
        Ok(match choices.split {
            SplitMethod::Branch => Self::Branch { shade: ShadeBranch::new(gpu, choices)?, irradiance: buffer("shade") },
            SplitMethod::None | SplitMethod::Indirect | SplitMethod::Remap => {
                let per_subset = choices.split == SplitMethod::Indirect;
                let dispatches = if per_subset { Dispatches::PerSubset } else { Dispatches::One };
                let shade = ShadeStrided::new(gpu, choices, dispatches)?;
                Self::Strided { shade, irradiance: buffer("shade") }
            }
            SplitMethod::Subsample => Self::Subsample {
                shade: ShadeSubsample::new(gpu, choices)?,
                cells: buffer("shade"),
                upscale: Upscale::new(gpu, shading)?,
                irradiance: buffer("upscale"),
            },
            SplitMethod::Masked(kind) => {
                let irradiance = buffer("shade");
                let mask = Mask::new(gpu, resources, kind)?;
                Self::Masked { mask, shade: ShadeMasked::new(gpu, resources, choices, kind)?, irradiance }
            }
            SplitMethod::Copy(copies) => Self::SubBuffers(SubBuffers {
                copies,
                gathered: resources.buffer(&format!("{NAME}.{}", gather::target(choices))),
                split: Split::new(gpu, resources, choices, copies)?,
                surface: Surface::new(gpu, resources, "split", &choices.moved_by(copies))?,
                shade: match choices.shade_stage() {
                    Stage::Compute => ShadeCopied::Dispatched(ShadeSubBuffers::new(gpu, choices, copies.storage)?),
                    Stage::Fragment => ShadeCopied::Drawn(ShadeDrawn::new(gpu, choices)?),
                },
                shaded: Texels::new(gpu, resources, "shade.irradiance", copies.storage)?,
                gather: Gather::new(gpu, resources, choices, copies)?,
            }),
        })
    }

    /// Irradiance in frame order.
    pub fn irradiance(&self) -> &Buffer {
        match self {
            Self::Branch { irradiance, .. }
            | Self::Strided { irradiance, .. }
            | Self::Subsample { irradiance, .. }
            | Self::Masked { irradiance, .. } => irradiance,
            Self::SubBuffers(SubBuffers { gathered, .. }) => gathered,
        }
    }

    /// Records the split, where there is one; hands the G-buffer on as it leaves it.
    pub fn record_split<'a>(
        &self,
        cmd: &mut Commands,
        lights: &ShadeGpu,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<Edge<'a, GBuffer>> {
        let Self::SubBuffers(SubBuffers { copies, split, surface, .. }) = self else { return Ok(gbuffer) };
        split.record(cmd, lights.mapping(), gbuffer, surface)?;
        Ok(gbuffer.after(copies.stage().samples()))
    }

    /// Records shade and gather, or what replaces them; hands the G-buffer on as it leaves it, and irradiance in frame
    /// order. `is_split_anew`: the split came in the same frame before it, and not in an earlier run. `flags`: as
    /// `Gather::record`.
    pub fn record_shade<'a>(
        &'a self,
        cmd: &mut Commands,
        (frame, is_split_anew): (&Buffer, bool),
        lights: &ShadeGpu,
        direct: &DirectGpu,
        gbuffer: Edge<'a, GBuffer>,
        flags: Option<Edge<'_, Buffer>>,
    ) -> Result<(Edge<'a, GBuffer>, Edge<'a, Buffer>)> {
        let mapping = lights.mapping();
        let (irradiance, last, stage) = match self {
            Self::Branch { shade, irradiance } => {
                shade.record(cmd, frame, lights, direct, gbuffer, irradiance)?;
                (irradiance, Access::ComputeWrite, Stage::Compute)
            }
            Self::Strided { shade, irradiance } => {
                shade.record(cmd, frame, lights, direct, gbuffer, irradiance)?;
                (irradiance, Access::ComputeWrite, Stage::Compute)
            }
            Self::Subsample { shade, cells, upscale, irradiance } => {
                shade.record(cmd, frame, lights, direct, gbuffer, cells)?;
                upscale.record(cmd, mapping, cells.from(Access::ComputeWrite), irradiance)?;
                (irradiance, Access::ComputeWrite, Stage::Compute)
            }
            Self::Masked { mask, shade, irradiance } => {
                mask.record(cmd, mapping)?;
                let masked = Masked { mask: mask.from(Access::DepthWrite), irradiance };
                shade.record(cmd, frame, lights, direct, gbuffer, masked)?;
                (irradiance, Access::TransferWrite, Stage::Fragment)
            }
            Self::SubBuffers(SubBuffers { copies, surface, shade, shaded, gather, gathered, .. }) => {
                let storage = copies.storage;
                let shaded_in = match shade {
                    ShadeCopied::Dispatched(_) => Stage::Compute,
                    ShadeCopied::Drawn(_) => Stage::Fragment,
                };
                let surface = surface.from(match is_split_anew {
                    true => storage.written(copies.stage()),
                    false => storage.read(shaded_in),
                });
                let shaded_by = match shade {
                    ShadeCopied::Dispatched(shade) => {
                        shade.record(cmd, frame, lights, direct, surface, shaded)?;
                        Access::ComputeWrite
                    }
                    ShadeCopied::Drawn(shade) => {
                        shade.record(cmd, frame, lights, direct, surface, shaded)?;
                        Access::ColorWrite
                    }
                };
                let last = gather.record(cmd, mapping, shaded.from(shaded_by), flags, gathered)?;
                return Ok((gbuffer, gathered.from(last)));
            }
        };
        Ok((gbuffer.after(stage.samples()), irradiance.from(last)))
    }
}
