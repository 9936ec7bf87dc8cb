//! Upscale: sub-sampled irradiance back to the frame, bilinear (Segovia 2006, section 5.4). Shader: upscale.comp.
//! reads  shade.irradiance  buffer, a texel a pattern      writes  gather.irradiance  buffer, frame order, 8 B a pixel

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::ShadingSettings;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct Upscale {
    pipeline: ComputePipeline,
}

impl Upscale {
    pub fn new(gpu: &Arc<Gpu>, settings: &ShadingSettings) -> Result<Self> {
        let shader = &crate::gpu::shader::techniques::interleaved_deferred::upscale::COMP;
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &settings.workgroup_constants())? })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Buffer>,
        irradiance: &Buffer,
    ) -> Result<()> {
        let pixels = u64::from(mapping.width_px) * u64::from(mapping.height_px);
        let traffic =
            Traffic { read_bytes: Some(4 * pixels * 8), written_bytes: Some(pixels * 8), invocations: Some(pixels) };
        cmd.pass(&format!("{NAME}.upscale"), traffic, |cmd| {
            cmd.barriers([source.to(Access::ComputeRead), irradiance.discard(Access::ComputeWrite)]);
            let bound = [("Source", Bound::Buffer(source.resource)), ("Irradiance", Bound::Buffer(irradiance))];
            let groups = self.pipeline.groups([mapping.width_px, mapping.height_px, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(mapping), &bound, groups)
        })
    }
}
