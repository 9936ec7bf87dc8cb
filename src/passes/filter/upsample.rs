//! Guided bilinear upsampling of irradiance that was estimated at fewer pixels than the frame has: Dubla 2009, section
//! 4.1. Shader: upsample.comp.
//! reads  the G-buffer, an irradiance buffer of the lower extent      writes  a stretch of a buffer, frame order
//!
//! Guides are normals and positions of the full frame. Where none of the four texels around a pixel is like it, the one
//! whose place is nearest in the scene stands for it.

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::passes::filter::upsample::COMP_VARIANTS;
use crate::gpu::shader::structs::UpsampleParams;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Barrier, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::gbuffer::GBuffer;
use crate::settings::PositionStorage;
use std::sync::Arc;

pub struct Upsample {
    label: String,
    pipeline: ComputePipeline,
    params: UpsampleParams,
}

impl Upsample {
    /// The pass of this full name, over a G-buffer that has positions as `position` says. `workgroup`: WORKGROUP_X and
    /// WORKGROUP_Y.
    pub fn new(
        gpu: &Arc<Gpu>,
        label: String,
        position: PositionStorage,
        workgroup: &[(&'static str, u32)],
        params: UpsampleParams,
    ) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[position.name()]);
        Ok(Self { label, pipeline: ComputePipeline::new(gpu, shader, workgroup)?, params })
    }

    /// `becomes_writable`: the target's barrier. Hands the G-buffer on as it leaves it.
    pub fn record<'a>(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
        source: Edge<'_, Buffer>,
        target: &Buffer,
        becomes_writable: Barrier,
    ) -> Result<Edge<'a, GBuffer>> {
        let extent = gbuffer.resource.extent();
        let pixels = extent.pixel_count();
        let traffic = Traffic {
            read_bytes: Some(pixels * (5 * gbuffer.resource.surface_bytes() + 4 * 8)),
            written_bytes: Some(pixels * 8),
            invocations: Some(pixels),
        };
        cmd.pass(&self.label, traffic, |cmd| {
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers([source.to(Access::ComputeRead), becomes_writable]);
            let mut bound = gbuffer.resource.bound_surface();
            bound.extend([
                ("Frame", Bound::Buffer(frame)),
                ("Source", Bound::Buffer(source.resource)),
                ("Target", Bound::Buffer(target)),
            ]);
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })?;
        Ok(gbuffer.after(Access::ComputeSample))
    }
}
