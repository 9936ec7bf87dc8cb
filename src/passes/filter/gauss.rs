//! Separable Gaussian that walks until a discontinuity: Segovia 2006, section 4.5 (B). Shader: gauss.comp.
//! reads  an irradiance buffer and flags, frame order      writes  a buffer between the directions, then the target

use super::Kernel;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::GaussParams;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
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

    /// Both directions.
    pub fn record(
        &self,
        cmd: &mut Commands,
        technique: &str,
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
        between: &Buffer,
        target: &Buffer,
    ) -> Result<()> {
        cmd.pass(&format!("{technique}.filter"), self.traffic(&[true, false]), |cmd| {
            self.rows(cmd, source, flags, between)?;
            cmd.barriers([
                between.from(Access::ComputeWrite).to(Access::ComputeRead),
                target.discard(Access::ComputeWrite),
            ]);
            self.direction(cmd, false, between, flags.resource, target)
        })
    }

    /// Along the rows only: the reader of `target` walks its columns.
    pub fn record_rows(
        &self,
        cmd: &mut Commands,
        technique: &str,
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
        target: &Buffer,
    ) -> Result<()> {
        let traffic = self.traffic(&[true]);
        cmd.pass(&format!("{technique}.filter"), traffic, |cmd| self.rows(cmd, source, flags, target))
    }

    fn rows(
        &self,
        cmd: &mut Commands,
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
        target: &Buffer,
    ) -> Result<()> {
        cmd.barriers([
            source.to(Access::ComputeRead),
            flags.to(Access::ComputeRead),
            target.discard(Access::ComputeWrite),
        ]);
        self.direction(cmd, true, source.resource, flags.resource, target)
    }

    /// Traffic of passes along x (true) and y.
    fn traffic(&self, walks: &[bool]) -> Traffic {
        let count = |threads: [u32; 3]| threads.map(u64::from).iter().product::<u64>();
        let threads: u64 = walks.iter().map(|horizontal| count(self.threads(*horizontal))).sum();
        let window = u64::from(self.texels + 2 * self.kernel.radius());
        Traffic {
            read_bytes: threads * window * (8 + 4),
            written_bytes: walks.len() as u64 * self.extent.pixel_count() * 8,
            invocations: Some(threads),
        }
    }

    fn threads(&self, horizontal: bool) -> [u32; 3] {
        let Extent { width, height } = self.extent;
        match horizontal {
            true => [width.div_ceil(self.texels), height, 1],
            false => [width, height.div_ceil(self.texels), 1],
        }
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
            walk: self.kernel.walk(horizontal),
            width_px: self.extent.width,
            height_px: self.extent.height,
            row_pitch: self.row_pitch,
            horizontal: u32::from(horizontal),
        };
        let bound =
            [("Source", Bound::Buffer(source)), ("Flags", Bound::Buffer(flags)), ("Target", Bound::Buffer(target))];
        let groups = self.pipeline.groups(self.threads(horizontal));
        cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &bound, groups)
    }
}
