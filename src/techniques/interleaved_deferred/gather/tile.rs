//! Gather through workgroup memory, a workgroup a block (later practice). Shader: tile.comp.
//! reads   shade.irradiance  sub-buffers
//! writes  gather.irradiance  buffer, frame order, 8 B a pixel      holds  a block of it in workgroup memory

use super::super::choices::Choices;
use super::super::split::tile::constants;
use super::super::split_method::Copies;
use super::super::sub_buffers::Texels;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::gather::tile::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu};
use crate::techniques::interleaved_deferred::gather::traffic::to_frame;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct GatherTile {
    pipeline: ComputePipeline,
    copies: Copies,
}

impl GatherTile {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, copies: Copies) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[copies.storage.name()]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants(choices))?, copies })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Texels>,
        irradiance: &Buffer,
    ) -> Result<()> {
        let [x, y] = mapping.block_counts();
        let traffic = to_frame(mapping, false, [x, y, self.pipeline.workgroup.iter().product()]);
        cmd.pass(&format!("{NAME}.gather"), traffic, |cmd| {
            let read = self.copies.storage.read(self.copies.stage());
            cmd.barriers([source.to(read), irradiance.discard(Access::ComputeWrite)]);
            let bound = [("source_irradiance", source.resource.source()), ("irradiance", Bound::Buffer(irradiance))];
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(mapping), &bound, [x, y, 1])
        })
    }
}
