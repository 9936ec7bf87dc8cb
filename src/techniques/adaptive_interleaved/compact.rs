//! Compaction of a component: the list of the tiles that refine, those with most iterations first, and the size of the
//! dispatch over it. Shader: compact.comp.
//! reads  guidance, bins      writes  tiles  buffer, 4 B a tile, and bins

use super::buffers::ComponentBuffers;
use super::choices::Choices;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::AdaptiveParams;
use crate::gpu::shader::techniques::adaptive_interleaved::compact::{BLOCK_TILES, COMP};
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use std::sync::Arc;

pub struct CompactPass {
    pipeline: ComputePipeline,
}

impl CompactPass {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &[choices.order_constant()])? })
    }

    /// `guidance` and `bins`: as the guidance left them.
    pub fn record(
        &self,
        cmd: &mut Commands,
        buffers: &ComponentBuffers,
        guidance: Edge<'_, Buffer>,
        bins: Edge<'_, Buffer>,
        tiles: &Buffer,
    ) -> Result<()> {
        let bytes = u64::from(buffers.params.tile_count) * 4;
        let traffic = Traffic { read_bytes: Some(bytes), written_bytes: Some(bytes), invocations: Some(bytes / 4) };
        cmd.pass(&buffers.label("compact"), traffic, |cmd| {
            cmd.barriers([guidance.to(Access::ComputeRead), bins.to(Access::ComputeWrite)]);
            cmd.barriers([tiles.discard(Access::ComputeWrite)]);
            let bound = [
                ("Guidance", Bound::Buffer(guidance.resource)),
                ("Bins", Bound::Buffer(bins.resource)),
                ("Tiles", Bound::Buffer(tiles)),
            ];
            // A block of tiles each.
            let AdaptiveParams { tile_columns, tile_count, .. } = buffers.params;
            let blocks = [tile_columns, tile_count / tile_columns].map(|side| side.div_ceil(BLOCK_TILES));
            let groups = [blocks[0] * blocks[1], 1, 1];
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&buffers.params), &bound, groups)
        })
    }
}
