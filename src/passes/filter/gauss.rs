//! Separable Gaussian that walks until a discontinuity: Segovia 2006, section 4.5 (B). Shader: gauss.comp.
//! reads  an irradiance buffer and flags, frame order      writes  a buffer between the directions, then the target

use super::{FilterMethod, FilterPass, FilterSetup, Kernel};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::GaussParams;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::plan::{Plan, Resources};
use crate::units::Extent;
use std::sync::Arc;

/// The filter of `--filter gauss`.
pub struct GaussMethod;

/// Both directions with what they write.
struct GaussFilter {
    gauss: Gauss,
    rows: Buffer,
    irradiance: Buffer,
}

impl FilterMethod for GaussMethod {
    fn taps(&self, kernel_taps: f64) -> f64 {
        2.0 * kernel_taps
    }

    fn plan(&self, plan: &mut Plan, setup: &FilterSetup<'_>, source: String, flags: String) -> String {
        let (read, written) = (Access::ComputeRead, Access::ComputeWrite);
        let [rows, irradiance] = ["rows", "irradiance"].map(|what| setup.resource(what));
        plan.buffer("filter", &rows, setup.irradiance_bytes());
        plan.buffer("filter", &irradiance, setup.irradiance_bytes());
        let between = [(rows.clone(), written), (rows, read), (irradiance.clone(), written)];
        plan.pass(setup.label.to_owned(), [(source, read), (flags, read)].into_iter().chain(between));
        irradiance
    }

    fn build(&self, gpu: &Arc<Gpu>, resources: &mut Resources, setup: &FilterSetup<'_>) -> Result<Box<dyn FilterPass>> {
        Ok(Box::new(GaussFilter {
            gauss: Gauss::new(gpu, setup)?,
            rows: resources.buffer(&setup.resource("rows")),
            irradiance: resources.buffer(&setup.resource("irradiance")),
        }))
    }
}

impl FilterPass for GaussFilter {
    fn record(
        &self,
        cmd: &mut Commands,
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
    ) -> Result<Edge<'_, Buffer>> {
        self.gauss.record(cmd, source, flags, &self.rows, &self.irradiance)?;
        Ok(self.irradiance.from(Access::ComputeWrite))
    }

    fn irradiance(&self) -> &Buffer {
        &self.irradiance
    }
}

pub struct Gauss {
    label: String,
    pipeline: ComputePipeline,
    extent: Extent,
    row_pitch: u32,
    kernel: Kernel,
    texels: u32,
}

impl Gauss {
    pub fn new(gpu: &Arc<Gpu>, setup: &FilterSetup<'_>) -> Result<Self> {
        let FilterSetup { label, workgroup, extent, row_pitch, kernel, texels } = *setup;
        let constants = [workgroup, &[("TEXELS", texels)], &kernel.constants()].concat();
        let pipeline = ComputePipeline::new(gpu, &crate::gpu::shader::passes::filter::gauss::COMP, &constants)?;
        Ok(Self { label: label.to_owned(), pipeline, extent, row_pitch, kernel, texels })
    }

    /// Both directions.
    pub fn record(
        &self,
        cmd: &mut Commands,
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
        between: &Buffer,
        target: &Buffer,
    ) -> Result<()> {
        cmd.pass(&self.label, self.traffic(&[true, false]), |cmd| {
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
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
        target: &Buffer,
    ) -> Result<()> {
        let traffic = self.traffic(&[true]);
        cmd.pass(&self.label, traffic, |cmd| self.rows(cmd, source, flags, target))
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
            read_bytes: Some(threads * window * (8 + 4)),
            written_bytes: Some(walks.len() as u64 * self.extent.pixel_count() * 8),
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
