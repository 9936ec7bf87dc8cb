//! Buffer gathering (BG): the irradiance of n x m sub-buffers back to the frame, by the method that split it. Segovia
//! 2006, sections 3.4 and 4.4. All end in one buffer in frame order, which the filter reads; one filters the rows on
//! the way.

pub mod blocks;
pub mod filtered;
pub mod fragment;
pub mod one_pass;
pub mod tile;
mod traffic;
pub mod translate;

use super::choices::Choices;
use super::drawn_irradiance::DrawnIrradiance;
use super::split_method::{Copier, Copies};
use super::sub_buffers::{Stage, Texels};
use crate::error::Result;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::filter::discontinuity;
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::{DISCONTINUITY, NAME};
use blocks::GatherBlocks;
use filtered::GatherFiltered;
use fragment::{FragmentGather, FragmentGatherBlocks};
use one_pass::GatherOnePass;
use std::sync::Arc;
use tile::GatherTile;
use translate::GatherTranslate;

/// One of the ways to gather.
#[expect(clippy::large_enum_variant, reason = "one a renderer, never moved")]
pub enum Gather {
    OnePass(GatherOnePass),
    Filtered(GatherFiltered),
    TwoPass { translate: GatherTranslate, between: Texels, blocks: GatherBlocks },
    Tile(GatherTile),
    OneFragmentPass(FragmentGather),
    TwoFragmentPasses(FragmentGatherBlocks),
}

/// Plans the buffer in frame order, what lies between two passes, and the passes; returns the buffer's name. `shaded`:
/// the name of the sub-buffers' irradiance.
pub fn plan(plan: &mut Plan, choices: &Choices, copies: Copies, shaded: String) -> String {
    let mapping = &choices.mapping;
    let (storage, stage) = (copies.storage, copies.stage());
    let gathered = format!("{NAME}.{}", target(choices));
    plan.buffer("irradiance", &gathered, mapping.frame_texel_count() * 8);
    fragment::plan(plan, mapping, copies.by);
    let mut source = vec![(shaded, storage.read(stage))];
    if choices.gather_filters() {
        source.push((discontinuity::flags(DISCONTINUITY), Access::ComputeRead));
    }
    let target = match stage {
        Stage::Compute => vec![(gathered.clone(), Access::ComputeWrite)],
        Stage::Fragment => DrawnIrradiance::touches("gather").to_vec(),
    };
    if copies.is_two_pass() {
        storage.plan(plan, "irradiance", "gather.blocks.irradiance", mapping, 8, stage);
        let between = |access| (format!("{NAME}.gather.blocks.irradiance"), access);
        plan.pass(format!("{NAME}.gather.translate"), source.into_iter().chain([between(storage.written(stage))]));
        plan.pass(format!("{NAME}.gather.blocks"), [between(storage.read(stage))].into_iter().chain(target));
    } else {
        plan.pass(format!("{NAME}.gather"), source.into_iter().chain(target));
    }
    gathered
}

/// Name of its result, without the technique.
pub fn target(choices: &Choices) -> &'static str {
    if choices.gather_filters() { "filter.rows" } else { "gather.irradiance" }
}

impl Gather {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices, copies: Copies) -> Result<Self> {
        let mut between = || Texels::new(gpu, resources, "gather.blocks.irradiance", copies.storage);
        Ok(match copies.by {
            Copier::OnePass if choices.gather_filters() => Self::Filtered(GatherFiltered::new(gpu, choices, copies)?),
            Copier::OnePass => Self::OnePass(GatherOnePass::new(gpu, choices, copies)?),
            Copier::TwoPass => Self::TwoPass {
                translate: GatherTranslate::new(gpu, choices, copies)?,
                between: between()?,
                blocks: GatherBlocks::new(gpu, choices, copies)?,
            },
            Copier::Tile => Self::Tile(GatherTile::new(gpu, choices, copies)?),
            Copier::OneFragmentPass => Self::OneFragmentPass(FragmentGather::new(gpu, resources, choices)?),
            Copier::TwoFragmentPasses => {
                let between = between()?;
                Self::TwoFragmentPasses(FragmentGatherBlocks::new(gpu, resources, choices, between)?)
            }
        })
    }

    /// Fills `irradiance` from the sub-buffers; says how it left it. `flags`: where walks of the filter end, for a gather that
    /// filters.
    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Texels>,
        flags: Option<Edge<'_, Buffer>>,
        irradiance: &Buffer,
    ) -> Result<Access> {
        match self {
            Self::OnePass(copy) => copy.record(cmd, mapping, source, irradiance)?,
            Self::Filtered(copy) => {
                let flags = flags.expect("discontinuities are flagged before a gather that filters");
                copy.record(cmd, mapping, source, flags, irradiance)?;
            }
            Self::TwoPass { translate, between, blocks } => {
                translate.record(cmd, mapping, source, between)?;
                blocks.record(cmd, mapping, between.from(Access::ComputeWrite), irradiance)?;
            }
            Self::Tile(copy) => copy.record(cmd, mapping, source, irradiance)?,
            Self::OneFragmentPass(copy) => {
                copy.record(cmd, mapping, source, irradiance)?;
                return Ok(Access::TransferWrite);
            }
            Self::TwoFragmentPasses(copy) => {
                copy.record(cmd, mapping, source, irradiance)?;
                return Ok(Access::TransferWrite);
            }
        }
        Ok(Access::ComputeWrite)
    }
}
