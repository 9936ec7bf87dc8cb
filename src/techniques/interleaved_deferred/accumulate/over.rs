//! Over: what blends, of all runs or of a half of them, over the picture of what is solid. Shader: over.comp.
//! reads  accumulate.layer_sums      writes  composite.color

use super::super::choices::Choices;
use super::sums::SUM_BYTES;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::OverParams;
use crate::gpu::shader::techniques::interleaved_deferred::accumulate::over::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub fn pass() -> String {
    format!("{NAME}.accumulate.over")
}

pub struct Over {
    pipeline: ComputePipeline,
}

impl Over {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &choices.shading.workgroup_constants())? })
    }

    /// `weights`: what the sums of even and of odd runs count.
    pub fn record(
        &self,
        cmd: &mut Commands,
        weights: [f32; 2],
        sums: Edge<'_, Buffer>,
        color: Edge<'_, Image>,
    ) -> Result<()> {
        let extent = color.resource.description.extent;
        let pixels = extent.pixel_count();
        let traffic = Traffic {
            read_bytes: Some(pixels * (2 * SUM_BYTES + 16)),
            written_bytes: Some(pixels * 16),
            invocations: Some(pixels),
        };
        let [even_weight, odd_weight] = weights;
        let params = OverParams { width_px: extent.width, height_px: extent.height, even_weight, odd_weight };
        cmd.pass(&pass(), traffic, |cmd| {
            cmd.barriers([sums.to(Access::ComputeRead), color.to(Access::ComputeWrite)]);
            let bound = [("LayerSums", Bound::Buffer(sums.resource)), ("color", Bound::Storage(color.resource))];
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &bound, groups)
        })
    }
}
