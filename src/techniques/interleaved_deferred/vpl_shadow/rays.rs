//! Shadow rays from every pixel to the lights of its subset that would light it. Shader: rays.comp.
//! reads  the G-buffer, the lights, the tree      writes  vpl_shadow.hidden

use super::super::choices::Choices;
use super::super::shade::ShadeGpu;
use super::sought::{clear, groups, params};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::HiddenParams;
use crate::gpu::shader::techniques::interleaved_deferred::vpl_shadow::rays::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::GBuffer;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct HiddenByRays {
    pipeline: ComputePipeline,
    params: HiddenParams,
    groups: [u32; 3],
}

impl HiddenByRays {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, least_squared: f32) -> Result<Self> {
        let settings = &choices.shading;
        let constants = [&settings.workgroup_constants()[..], &[settings.direct.offset_constant()]].concat();
        let shader = variant(COMP_VARIANTS, &[settings.position.name()]);
        let params = params(choices, least_squared);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)?, groups: groups(choices, &params), params })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        lights: &ShadeGpu,
        direct: &DirectGpu,
        gbuffer: Edge<'_, GBuffer>,
        hidden: &Buffer,
    ) -> Result<()> {
        let invocations: u64 =
            self.groups.iter().chain(&self.pipeline.workgroup).map(|count| u64::from(*count)).product();
        let traffic =
            Traffic { read_bytes: None, written_bytes: Some(2 * hidden.bytes), invocations: Some(invocations) };
        cmd.pass(&format!("{NAME}.vpl_shadow"), traffic, |cmd| {
            clear(cmd, hidden);
            cmd.barriers(gbuffer.surface_to_sampled());
            let mut bound = lights.bound_to_find(frame, gbuffer.resource, hidden);
            bound.push(("BvhNodes", Bound::Buffer(&direct.bvh_nodes)));
            bound.push(("BvhTriangles", Bound::Buffer(&direct.bvh_triangles)));
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, self.groups)
        })
    }
}
