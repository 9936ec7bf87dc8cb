//! Split through workgroup memory, a workgroup a block (later practice). Shader: tile.comp.
//! reads   gbuffer.position, gbuffer.normal, gbuffer.color where it is moved
//! writes  split.position, split.normal, split.color      holds  a block of them in workgroup memory

use super::super::choices::Choices;
use super::super::split_method::Copies;
use super::super::sub_buffers::Surface;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::split::tile::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Commands, Edge, Gpu};
use crate::passes::gbuffer::GBuffer;
use crate::techniques::interleaved_deferred::split::from_frame::{FromFrame, product};
use std::sync::Arc;

pub struct SplitTile {
    pipeline: ComputePipeline,
}

/// Constants of tile.comp, there and back.
pub fn constants(choices: &Choices) -> Vec<(&'static str, u32)> {
    let [x, y] = choices.shading.workgroup;
    let texels = choices.mapping.block_x * choices.mapping.block_y;
    [&choices.shading.workgroup_constants()[..], &[("BLOCK_TEXELS", texels), ("THREADS", x * y)]].concat()
}

impl SplitTile {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, copies: Copies) -> Result<Self> {
        let axes = [choices.shading.position.name(), copies.storage.name(), choices.moved.color_name()];
        let constants: Vec<_> = constants(choices).into_iter().chain(choices.moved.constant()).collect();
        Ok(Self { pipeline: ComputePipeline::new(gpu, variant(COMP_VARIANTS, &axes), &constants)? })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        split: &Surface,
    ) -> Result<()> {
        let [x, y] = mapping.block_counts();
        let invocations = product([x, y, self.pipeline.workgroup.iter().product()]);
        let copy = FromFrame { pass: "split", pipeline: &self.pipeline, groups: [x, y, 1], invocations };
        copy.record(cmd, mapping, gbuffer, split)
    }
}
