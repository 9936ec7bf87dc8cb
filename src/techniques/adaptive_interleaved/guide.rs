//! Guidance of a component: how many further iterations each tile needs (Dubla 2009, Listing 1, lines 8 to 13). Shader:
//! guide.comp.
//! reads  estimates      writes  guidance  buffer, 4 B a tile, and bins  buffer, how many tiles have as many

use super::buffers::ComponentBuffers;
use super::choices::ComponentChoice;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::adaptive_interleaved::guide::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use std::sync::Arc;

pub struct GuidePass {
    pipeline: ComputePipeline,
}

impl GuidePass {
    pub fn new(gpu: &Arc<Gpu>, choice: &ComponentChoice) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[choice.component.name()]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &[])? })
    }

    /// `estimates`: as the initial pass left them.
    pub fn record(
        &self,
        cmd: &mut Commands,
        buffers: &ComponentBuffers,
        estimates: Edge<'_, Buffer>,
        guidance: &Buffer,
        bins: &Buffer,
    ) -> Result<()> {
        let tiles = u64::from(buffers.params.tile_count);
        let read_bytes = tiles * u64::from(buffers.params.tile_size()) * 16;
        let traffic =
            Traffic { read_bytes: Some(read_bytes), written_bytes: Some(tiles * 4), invocations: Some(tiles) };
        cmd.pass(&buffers.label("guide"), traffic, |cmd| {
            cmd.barriers([bins.discard(Access::TransferWrite)]);
            cmd.clear(bins);
            cmd.barriers([
                estimates.to(Access::ComputeRead),
                guidance.discard(Access::ComputeWrite),
                bins.from(Access::TransferWrite).to(Access::ComputeWrite),
            ]);
            let bound = [
                ("Estimates", Bound::Buffer(estimates.resource)),
                ("Guidance", Bound::Buffer(guidance)),
                ("Bins", Bound::Buffer(bins)),
            ];
            let groups = self.pipeline.groups([buffers.params.tile_count, 1, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&buffers.params), &bound, groups)
        })
    }
}
