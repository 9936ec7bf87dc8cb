//! Irradiance and flags into one RGBA16F image, for `gauss_fast`. Shader: gauss_pack.comp.
//! reads  an irradiance buffer and flags      writes  an image of half floats, through its integer view

use super::StopBits;
use crate::error::Result;
use crate::gpu::Bound;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::GaussPackParams;
use crate::gpu::{Buffer, Commands, Gpu, Image};
use crate::units::Extent;
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
    #[allow(clippy::too_many_arguments)]
    pub fn record(
        &self,
        cmd: &mut Commands,
        extent: Extent,
        row_pitch: u32,
        stop_bits: StopBits,
        source: &Buffer,
        flags: &Buffer,
        target: &Image,
    ) -> Result<()> {
        let params = GaussPackParams {
            width_px: extent.width,
            height_px: extent.height,
            row_pitch,
            stop_bits_x: stop_bits.x,
            stop_bits_y: stop_bits.y,
        };
        let bound =
            [("Source", Bound::Buffer(source)), ("Flags", Bound::Buffer(flags)), ("target", Bound::Storage(target))];
        let groups = self.pipeline.groups([extent.width, extent.height, 1]);
        cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &bound, groups)
    }
}
