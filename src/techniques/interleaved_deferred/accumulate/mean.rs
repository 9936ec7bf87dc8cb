//! Mean: the irradiance of all runs, or of a half of them. Shader: mean.comp.
//! reads  accumulate.sums      writes  irradiance in frame order, 8 B a pixel

use super::super::choices::Choices;
use super::sums::SUM_BYTES;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::{MappingParams, RunMeanParams};
use crate::gpu::shader::techniques::interleaved_deferred::accumulate::mean::COMP;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub fn pass() -> String {
    format!("{NAME}.accumulate.mean")
}

pub struct Mean {
    pipeline: ComputePipeline,
    mapping: MappingParams,
}

impl Mean {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let pipeline = ComputePipeline::new(gpu, &COMP, &choices.shading.workgroup_constants())?;
        Ok(Self { pipeline, mapping: choices.mapping })
    }

    /// `weights`: what the sums of even and of odd runs count.
    pub fn record(
        &self,
        cmd: &mut Commands,
        weights: [f32; 2],
        sums: Edge<'_, Buffer>,
        irradiance: Edge<'_, Buffer>,
    ) -> Result<()> {
        let MappingParams { width_px, height_px, .. } = self.mapping;
        let pixels = u64::from(width_px) * u64::from(height_px);
        let traffic = Traffic {
            read_bytes: Some(2 * pixels * SUM_BYTES),
            written_bytes: Some(pixels * 8),
            invocations: Some(pixels),
        };
        let [even_weight, odd_weight] = weights;
        let params = RunMeanParams { mapping: self.mapping, even_weight, odd_weight };
        cmd.pass(&pass(), traffic, |cmd| {
            cmd.barriers([sums.to(Access::ComputeRead), irradiance.to(Access::ComputeWrite)]);
            let bound = [("Sums", Bound::Buffer(sums.resource)), ("Irradiance", Bound::Buffer(irradiance.resource))];
            let groups = self.pipeline.groups([width_px, height_px, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &bound, groups)
        })
    }
}
