//! Guidance that sees more than its own tile (`--guidance-of`): the tiles around it, or those of other components over the
//! same pixels. Shader: spread.comp.
//! reads   guidance.own  of the component, and of others      writes  guidance, and bins  how many tiles have as many
//!
//! Differs from the paper: its guidance is local, so that tiles may be computed one by one (Dubla 2009, section 4.1); on a
//! device all tiles wait for the initial pass anyway.

use super::buffers::ComponentBuffers;
use super::choices::{Choices, ComponentChoice};
use super::settings::GuidanceOf;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::SpreadParams;
use crate::gpu::shader::techniques::adaptive_interleaved::spread::{COMP, MOST_OTHERS};
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use bytemuck::Zeroable;
use std::sync::Arc;

pub struct SpreadPass {
    pipeline: ComputePipeline,
    params: SpreadParams,
}

/// Columns and rows of a component's tiles, and the pixels of the frame that each covers in both directions.
fn grid(choice: &ComponentChoice) -> [u32; 4] {
    let params = &choice.params;
    let columns = params.tile_columns;
    [columns, params.tile_count / columns, params.tile_x * params.scale, params.tile_y * params.scale]
}

impl SpreadPass {
    /// None: each tile's guidance is its own.
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, choice: &ComponentChoice) -> Result<Option<Self>> {
        let [tile_columns, tile_rows, tile_width_px, tile_height_px] = grid(choice);
        let mut params = SpreadParams {
            tile_columns,
            tile_rows,
            tile_width_px,
            tile_height_px,
            left: choice.params.most - choice.params.base,
            ..SpreadParams::zeroed()
        };
        match choices.guidance_of {
            GuidanceOf::Tile => return Ok(None),
            GuidanceOf::Neighbours => params.has_neighbours = 1,
            GuidanceOf::Components => {
                let others = choices.components.iter().filter(|other| other.component != choice.component);
                for (index, other) in others.take(MOST_OTHERS as usize).enumerate() {
                    let [columns, rows, width_px, height_px] = grid(other);
                    params.other_count += 1;
                    params.other_columns[index] = columns;
                    params.other_rows[index] = rows;
                    params.other_width_px[index] = width_px;
                    params.other_height_px[index] = height_px;
                }
            }
        }
        Ok(Some(Self { pipeline: ComputePipeline::new(gpu, &COMP, &[])?, params }))
    }

    /// `own`: what the component's tiles ask for by themselves. `others`: the same of the other components, in their order.
    /// `bins`: as the guidance left them, to be counted anew.
    pub fn record(
        &self,
        cmd: &mut Commands,
        buffers: &ComponentBuffers,
        own: Edge<'_, Buffer>,
        others: &[Edge<'_, Buffer>],
        guidance: &Buffer,
        bins: Edge<'_, Buffer>,
    ) -> Result<()> {
        let bytes = u64::from(buffers.params.tile_count) * 4;
        let read_bytes = bytes + others.iter().map(|other| other.resource.bytes).sum::<u64>();
        let traffic =
            Traffic { read_bytes: Some(read_bytes), written_bytes: Some(bytes), invocations: Some(bytes / 4) };
        cmd.pass(&buffers.label("spread"), traffic, |cmd| {
            cmd.barriers([bins.to(Access::TransferWrite)]);
            cmd.clear(bins.resource);
            cmd.barriers([own.to(Access::ComputeRead), guidance.discard(Access::ComputeWrite)]);
            cmd.barriers(others.iter().map(|other| other.to(Access::ComputeRead)));
            cmd.barriers([bins.resource.from(Access::TransferWrite).to(Access::ComputeWrite)]);
            // Where there are fewer, the own one stands for those that are not read.
            let other = |index: usize| Bound::Buffer(others.get(index).unwrap_or(&own).resource);
            let bound = [
                ("OwnGuidance", Bound::Buffer(own.resource)),
                ("OtherGuidance0", other(0)),
                ("OtherGuidance1", other(1)),
                ("OtherGuidance2", other(2)),
                ("Guidance", Bound::Buffer(guidance)),
                ("Bins", Bound::Buffer(bins.resource)),
            ];
            let groups = self.pipeline.groups([buffers.params.tile_count, 1, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })
    }
}
