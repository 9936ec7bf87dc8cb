//! Gather: n x m sub-buffers back to the frame (Segovia 2006, sections 3.4 and 4.4). Shader: gather.comp.
//! reads  shade.irradiance  buffer, sub-buffers      writes  gather.irradiance  buffer, frame order, 8 B a pixel

use super::NAME;
use crate::error::Result;
use crate::gpu::Bound;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::ShadingSettings;
use std::sync::Arc;

pub struct Gather {
    pipeline: ComputePipeline,
}

impl Gather {
    pub fn new(gpu: &Arc<Gpu>, settings: &ShadingSettings) -> Result<Self> {
        let shader = &crate::gpu::shader::techniques::interleaved_deferred::gather::COMP;
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &settings.workgroup_constants())? })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Buffer>,
        irradiance: &Buffer,
    ) -> Result<()> {
        let bytes = mapping.frame_texel_count() * 8;
        let pairs = [mapping.row_pitch() / 2, mapping.height_px, 1];
        let invocations = Some(u64::from(pairs[0]) * u64::from(pairs[1]));
        let traffic = Traffic { read_bytes: bytes, written_bytes: bytes, invocations };
        cmd.pass(&format!("{NAME}.gather"), traffic, |cmd| {
            cmd.barriers([source.to(Access::ComputeRead), irradiance.discard(Access::ComputeWrite)]);
            let bound = [("Source", Bound::Buffer(source.resource)), ("Irradiance", Bound::Buffer(irradiance))];
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(mapping), &bound, self.pipeline.groups(pairs))
        })
    }
}
