//! Sums: a run's irradiance, and the layer of what blends, are added to those of its half of the runs. Shader: sums.comp.
//! reads  irradiance in frame order, accumulate.layer
//! writes  accumulate.sums, accumulate.layer_sums  buffers, 16 B a pixel of this half

use super::super::choices::Choices;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::{MappingParams, RunSumsParams};
use crate::gpu::shader::techniques::interleaved_deferred::accumulate::sums::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

/// Bytes of a pixel's sum over a half of the runs: four floats.
pub const SUM_BYTES: u64 = 16;

pub fn pass() -> String {
    format!("{NAME}.accumulate.sums")
}

pub struct Sums {
    pipeline: ComputePipeline,
    mapping: MappingParams,
}

impl Sums {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, has_layer: bool) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[if has_layer { "on" } else { "off" }]);
        let pipeline = ComputePipeline::new(gpu, shader, &choices.shading.workgroup_constants())?;
        Ok(Self { pipeline, mapping: choices.mapping })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        run: u32,
        irradiance: Edge<'_, Buffer>,
        sums: Edge<'_, Buffer>,
        layer: Option<(Edge<'_, Image>, Edge<'_, Buffer>)>,
    ) -> Result<()> {
        let MappingParams { width_px, height_px, .. } = self.mapping;
        let pixels = u64::from(width_px) * u64::from(height_px);
        let sum_bytes = if layer.is_some() { 2 * SUM_BYTES } else { SUM_BYTES };
        let layer_bytes = if layer.is_some() { 16 } else { 0 };
        let traffic = Traffic {
            read_bytes: Some(pixels * (8 + layer_bytes + sum_bytes)),
            written_bytes: Some(pixels * sum_bytes),
            invocations: Some(pixels),
        };
        let (half, is_first) = (run % 2, u32::from(run < 2));
        let params = RunSumsParams { mapping: self.mapping, first_px: half * width_px * height_px, is_first };
        cmd.pass(&pass(), traffic, |cmd| {
            cmd.barriers([irradiance.to(Access::ComputeRead), sums.to(Access::ComputeWrite)]);
            let mut bound =
                vec![("Irradiance", Bound::Buffer(irradiance.resource)), ("Sums", Bound::Buffer(sums.resource))];
            if let Some((layer, layer_sums)) = layer {
                cmd.barriers([layer.to(Access::ComputeRead), layer_sums.to(Access::ComputeWrite)]);
                bound.push(("LayerSums", Bound::Buffer(layer_sums.resource)));
                bound.push(("layer", Bound::Storage(layer.resource)));
            }
            let groups = self.pipeline.groups([width_px, height_px, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &bound, groups)
        })
    }
}
