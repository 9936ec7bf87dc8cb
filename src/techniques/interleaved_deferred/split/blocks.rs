//! Block splitting, the first pass of two: Segovia 2006, section 3.3. Shader: blocks.comp.
//! reads   gbuffer.position, gbuffer.normal, gbuffer.color where it is moved
//! writes  split.blocks.position, .normal, .color  as those of split, in the block layout

use super::super::choices::Choices;
use super::super::split_method::Copies;
use super::super::sub_buffers::Surface;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::split::blocks::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Commands, Edge, Gpu};
use crate::passes::gbuffer::GBuffer;
use crate::techniques::interleaved_deferred::split::from_frame::FromFrame;
use std::sync::Arc;

pub struct SplitBlocks {
    pipeline: ComputePipeline,
    copies: Copies,
}

impl SplitBlocks {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, copies: Copies) -> Result<Self> {
        let axes =
            [choices.shading.position.name(), copies.storage.name(), copies.form.name(), choices.moved.color_name()];
        let shader = variant(COMP_VARIANTS, &axes);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &choices.split_constants())?, copies })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        blocks: &Surface,
    ) -> Result<()> {
        let threads = self.copies.padded_threads(mapping);
        FromFrame::over("split.blocks", &self.pipeline, threads).record(cmd, mapping, gbuffer, blocks)
    }
}
