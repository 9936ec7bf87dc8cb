//! Shadow rays from every pixel to the lights of its subset that would light it. Shader: rays.comp.
//! reads  the G-buffer, the lights, the tree      writes  vpl_shadow.hidden

use super::super::choices::Choices;
use super::super::shade::ShadeGpu;
use super::params;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::HiddenParams;
use crate::gpu::shader::techniques::interleaved_deferred::vpl_shadow::rays::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
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
        let points = choices.mapping.sub_texel_count().div_ceil(u64::from(settings.lane_count()));
        Ok(Self {
            pipeline: ComputePipeline::new(gpu, shader, &constants)?,
            groups: [points as u32, params.words_a_point, choices.subset_count()],
            params,
        })
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
        let [points, words, subsets] = self.groups.map(u64::from);
        let lanes: u64 = self.pipeline.workgroup.iter().map(|side| u64::from(*side)).product();
        let invocations = points * words * subsets * lanes;
        let traffic = Traffic {
            read_bytes: invocations * gbuffer.resource.surface_bytes(),
            written_bytes: 2 * hidden.bytes,
            invocations: Some(invocations),
        };
        cmd.pass(&format!("{NAME}.vpl_shadow"), traffic, |cmd| {
            cmd.barriers([hidden.discard(Access::TransferWrite)]);
            cmd.clear(hidden);
            cmd.barriers([hidden.from(Access::TransferWrite).to(Access::ComputeWrite)]);
            cmd.barriers(gbuffer.surface_to_sampled());
            let mut bound = gbuffer.resource.bound_surface();
            bound.extend([
                ("Frame", Bound::Buffer(frame)),
                ("Vpls", Bound::Buffer(&lights.vpls)),
                ("Subsets", Bound::Buffer(&lights.subsets)),
                ("BvhNodes", Bound::Buffer(&direct.bvh_nodes)),
                ("BvhTriangles", Bound::Buffer(&direct.bvh_triangles)),
                ("Hidden", Bound::Buffer(hidden)),
            ]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, self.groups)
        })
    }
}
