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
    texels: u32,
}

impl Gauss {
    /// `workgroup`: WORKGROUP_X and WORKGROUP_Y. `texels`: how many a thread filters, at least 1.
    pub fn new(
        gpu: &Arc<Gpu>,
        workgroup: &[(&str, u32)],
        extent: Extent,
        row_pitch: u32,
        kernel: Kernel,
        texels: u32,
    ) -> Result<Self> {
        let constants = [workgroup, &[("TEXELS", texels), ("RADIUS", kernel.radius())]].concat();
        let pipeline = ComputePipeline::new(gpu, &crate::gpu::shader::passes::filter::gauss::COMP, &constants)?;
        Ok(Self { pipeline, extent, row_pitch, kernel, texels })
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
        let Extent { width, height } = self.extent;
        let runs = |along: u32, across: u32| u64::from(along.div_ceil(self.texels)) * u64::from(across);
        let threads = runs(width, height) + runs(height, width);
        let window = u64::from(self.texels + 2 * self.kernel.radius());
        let traffic = Traffic {
            read_bytes: threads * window * (8 + 4),
            written_bytes: 2 * pixels * 8,
            invocations: Some(threads),
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
        let weights = |first: u32| [0, 1, 2, 3].map(|next| self.kernel.weight(first + next));
        let params = GaussParams {
            weights_near: weights(1),
            weights_far: weights(5),
            width_px: self.extent.width,
            height_px: self.extent.height,
            row_pitch: self.row_pitch,
            horizontal: u32::from(horizontal),
            stop_bits: if horizontal { self.kernel.stop_bits.x } else { self.kernel.stop_bits.y },
            _unused: [0; 3],
        };
        let bound =
            [("Source", Bound::Buffer(source)), ("Flags", Bound::Buffer(flags)), ("Target", Bound::Buffer(target))];
        let Extent { width, height } = self.extent;
        let threads = if horizontal {
            [width.div_ceil(self.texels), height, 1]
        } else {
            [width, height.div_ceil(self.texels), 1]
        };
        let groups = self.pipeline.groups(threads);
        cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &bound, groups)
    }
}
