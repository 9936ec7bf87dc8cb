//! The box of N x M pixels that Dubla 2009, section 3, takes from Wald 2002: the plain mean of what a pixel's
//! neighbourhood of the pattern's own size holds and no discontinuity parts from it. Shader: box_filter.comp.
//! reads  an irradiance buffer and flags, frame order      writes  a stretch of a buffer, frame order
//!
//! A box of the pattern's size holds each place of the pattern once, so that where nothing parts them the mean is over
//! all of the pattern's samples. Its middle is the pixel; of an even side it lies a pixel further right, or below.

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::passes::filter::box_filter::COMP;
use crate::gpu::shader::structs::BoxParams;
use crate::gpu::{Access, Barrier, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::units::Extent;
use std::sync::Arc;

/// The pass over a buffer of irradiance.
pub struct BoxFilter {
    label: String,
    pipeline: ComputePipeline,
    params: BoxParams,
    /// Pixels that a thread filters: of a column.
    rows: u32,
    /// Pixels of the box: columns and rows.
    size_px: [u32; 2],
}

impl BoxFilter {
    /// `size_px`: of the box. `rows`: of pixels that a thread filters, at least 1; the same bits for every count.
    /// `target_first`: texel of the target at which it begins to write.
    pub fn new(
        gpu: &Arc<Gpu>,
        label: String,
        workgroup: &[(&'static str, u32)],
        rows: u32,
        extent: Extent,
        size_px: [u32; 2],
        target_first: u32,
    ) -> Result<Self> {
        let [width, height] = size_px;
        let reach = [
            ("LEFT", (width - 1) / 2),
            ("RIGHT", width / 2),
            ("ABOVE", (height - 1) / 2),
            ("BELOW", height / 2),
            ("ROWS", rows),
        ];
        let pipeline = ComputePipeline::new(gpu, &COMP, &[workgroup, &reach].concat())?;
        let params = BoxParams { width_px: extent.width, height_px: extent.height, target_first };
        Ok(Self { label, pipeline, params, rows, size_px })
    }

    /// `becomes_writable`: the target's barrier.
    pub fn record(
        &self,
        cmd: &mut Commands,
        source: Edge<'_, Buffer>,
        flags: Edge<'_, Buffer>,
        target: &Buffer,
        becomes_writable: Barrier,
    ) -> Result<()> {
        let BoxParams { width_px, height_px, .. } = self.params;
        let down = height_px.div_ceil(self.rows);
        let [texels, threads] = [height_px, down].map(|rows| u64::from(width_px) * u64::from(rows));
        let taps = u64::from(self.size_px[0]) * u64::from(self.size_px[1] + self.rows - 1);
        let traffic = Traffic {
            read_bytes: Some(threads * taps * 12),
            written_bytes: Some(texels * 8),
            invocations: Some(threads),
        };
        cmd.pass(&self.label, traffic, |cmd| {
            cmd.barriers([source.to(Access::ComputeRead), flags.to(Access::ComputeRead), becomes_writable]);
            let bound = [
                ("Source", Bound::Buffer(source.resource)),
                ("Flags", Bound::Buffer(flags.resource)),
                ("Target", Bound::Buffer(target)),
            ];
            let groups = self.pipeline.groups([width_px, down, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })
    }
}
