//! Separable Gaussian that walks until a discontinuity: Segovia 2006, section 4.5 (B, SG11). Shader: gauss.comp.
//! reads  an irradiance buffer and flags, frame order      writes  a buffer between the directions, then the target

use super::Kernel;
use crate::error::Result;
use crate::gpu::Bound;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::GaussParams;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Traffic};
use crate::units::Extent;
use std::sync::Arc;

pub struct Gauss {
    pipeline: ComputePipeline,
    extent: Extent,
    row_pitch: u32,
    kernel: Kernel,
}

impl Gauss {
    /// `workgroup`: WORKGROUP_X and WORKGROUP_Y.
    pub fn new(
        gpu: &Arc<Gpu>,
        workgroup: &[(&str, u32)],
        extent: Extent,
        row_pitch: u32,
        kernel: Kernel,
    ) -> Result<Self> {
        let pipeline = ComputePipeline::new(gpu, &crate::gpu::shader::passes::filter::gauss::COMP, workgroup)?;
        Ok(Self { pipeline, extent, row_pitch, kernel })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        technique: &str,
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
        between: &Buffer,
        target: &Buffer,
    ) -> Result<()> {
        let pixels = self.extent.pixel_count();
        let traffic = Traffic {
            read_bytes: 2 * pixels * u64::from(self.kernel.taps) * (8 + 4),
            written_bytes: 2 * pixels * 8,
            invocations: Some(2 * pixels),
        };
        cmd.pass(&format!("{technique}.filter"), traffic, |cmd| {
            cmd.barriers([
                source.to(Access::ComputeRead),
                flags.to(Access::ComputeRead),
                between.discard(Access::ComputeWrite),
            ]);
            self.direction(cmd, true, source.resource, flags.resource, between)?;
            cmd.barriers([
                between.from(Access::ComputeWrite).to(Access::ComputeRead),
                target.discard(Access::ComputeWrite),
            ]);
            self.direction(cmd, false, between, flags.resource, target)
        })
    }

    fn direction(
        &self,
        cmd: &mut Commands,
        horizontal: bool,
        source: &Buffer,
        flags: &Buffer,
        target: &Buffer,
    ) -> Result<()> {
        let params = GaussParams {
            width_px: self.extent.width,
            height_px: self.extent.height,
            row_pitch: self.row_pitch,
            horizontal: u32::from(horizontal),
            radius: self.kernel.radius(),
            stop_bits: if horizontal { self.kernel.stop_bits.x } else { self.kernel.stop_bits.y },
            falloff: self.kernel.falloff(),
        };
        let bound =
            [("Source", Bound::Buffer(source)), ("Flags", Bound::Buffer(flags)), ("Target", Bound::Buffer(target))];
        let groups = self.pipeline.groups([self.extent.width, self.extent.height, 1]);
        cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &bound, groups)
    }
}
