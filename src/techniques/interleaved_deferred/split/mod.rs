//! G-buffer splitting (BS): position, normal and, as in the paper, colour of the frame's pixels into n x m sub-buffers. Segovia
//! 2006, sections 3.2, 3.3 and 4.2.

pub mod blocks;
pub mod fragment;
mod from_frame;
pub mod one_pass;
pub mod tile;
pub mod translate;

use super::choices::Choices;
use super::split_method::{Copier, Copies};
use super::sub_buffers::{Moved, Surface};
use crate::error::Result;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::{Access, Commands, Edge, Gpu};
use crate::passes::gbuffer::{self, GBuffer};
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::NAME;
use blocks::SplitBlocks;
use fragment::{FragmentSplit, FragmentSplitBlocks};
use one_pass::SplitOnePass;
use std::sync::Arc;
use tile::SplitTile;
use translate::SplitTranslate;

/// One of the ways to split.
#[expect(clippy::large_enum_variant, reason = "one a renderer, never moved")]
pub enum Split {
    OnePass(SplitOnePass),
    TwoPass { blocks: SplitBlocks, between: Surface, translate: SplitTranslate },
    Tile(SplitTile),
    OneFragmentPass(FragmentSplit),
    TwoFragmentPasses(FragmentSplitBlocks),
}

/// Plans the sub-buffers, what lies between two passes, and the passes.
pub fn plan(plan: &mut Plan, choices: &Choices, copies: Copies) {
    let (mapping, moved, stage) = (&choices.mapping, choices.moved_by(copies), copies.stage());
    let Moved { parts, position, .. } = moved;
    let (written, read) = (copies.storage.written(stage), copies.storage.read(stage));
    Surface::plan(plan, "split", mapping, &moved);
    fragment::plan(plan, mapping, copies.by);
    let frame = gbuffer::parts_as(NAME, position, parts, stage.samples());
    let split = Surface::touches("split", parts, written);
    if copies.is_two_pass() {
        Surface::plan(plan, "split.blocks", mapping, &moved);
        let between = |access| Surface::touches("split.blocks", parts, access);
        plan.pass(format!("{NAME}.split.blocks"), frame.into_iter().chain(between(written)));
        plan.pass(format!("{NAME}.split.translate"), between(read).chain(split));
    } else {
        plan.pass(format!("{NAME}.split"), frame.into_iter().chain(split));
    }
}

impl Split {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices, copies: Copies) -> Result<Self> {
        let mut between = || Surface::new(gpu, resources, "split.blocks", &choices.moved_by(copies));
        Ok(match copies.by {
            Copier::OnePass => Self::OnePass(SplitOnePass::new(gpu, choices, copies)?),
            Copier::TwoPass => Self::TwoPass {
                blocks: SplitBlocks::new(gpu, choices, copies)?,
                between: between()?,
                translate: SplitTranslate::new(gpu, choices, copies)?,
            },
            Copier::Tile => Self::Tile(SplitTile::new(gpu, choices, copies)?),
            Copier::OneFragmentPass => Self::OneFragmentPass(FragmentSplit::new(gpu, resources, choices)?),
            Copier::TwoFragmentPasses => {
                let between = between()?;
                Self::TwoFragmentPasses(FragmentSplitBlocks::new(gpu, resources, choices, between)?)
            }
        })
    }

    /// Fills `split` from the G-buffer.
    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        split: &Surface,
    ) -> Result<()> {
        match self {
            Self::OnePass(copy) => copy.record(cmd, mapping, gbuffer, split),
            Self::TwoPass { blocks, between, translate } => {
                blocks.record(cmd, mapping, gbuffer, between)?;
                translate.record(cmd, mapping, between.from(Access::ComputeWrite), split)
            }
            Self::Tile(copy) => copy.record(cmd, mapping, gbuffer, split),
            Self::OneFragmentPass(copy) => copy.record(cmd, mapping, gbuffer, split),
            Self::TwoFragmentPasses(copy) => copy.record(cmd, mapping, gbuffer, split),
        }
    }
}
