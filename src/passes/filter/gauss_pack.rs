//! Irradiance and flags into one RGBA16F image, for `gauss_fast`. Shader: gauss_pack.comp.
//! reads  an irradiance buffer and flags      writes  an image of half floats, through its integer view

use crate::error::Result;
use crate::gpu::Bound;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::GaussPackParams;
use crate::gpu::{Buffer, Commands, Gpu, Image};
use std::sync::Arc;

pub struct GaussPack {
    pipeline: ComputePipeline,
}

impl GaussPack {
    pub fn new(gpu: &Arc<Gpu>, workgroup: &[(&str, u32)]) -> Result<Self> {
        let pipeline = ComputePipeline::new(gpu, &crate::gpu::shader::passes::filter::gauss_pack::COMP, workgroup)?;
        Ok(Self { pipeline })
    }

    /// Inside a pass; the caller stated the barriers.
    pub fn record(
        &self,
        cmd: &mut Commands,
        params: &GaussPackParams,
        source: &Buffer,
        flags: &Buffer,
        target: &Image,
    ) -> Result<()> {
        let bound =
            [("Source", Bound::Buffer(source)), ("Flags", Bound::Buffer(flags)), ("target", Bound::Storage(target))];
        let groups = self.pipeline.groups([params.width_px, params.height_px, 1]);
        cmd.dispatch(&self.pipeline, bytemuck::bytes_of(params), &bound, groups)
    }
}
