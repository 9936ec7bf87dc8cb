//! One-pass split: Segovia 2006, section 3.2. Shader: one_pass.comp.
//! reads   gbuffer.position, gbuffer.normal
//! writes  split.position  buffer, 4, 8 or 16 B a texel      split.normal  buffer, 8 B a texel
//!
//! Differs from the paper: colour is not split, because the irradiance of a Lambert surface does not need it.

use super::super::NAME;
use crate::error::Result;
use crate::gpu::Bound;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::split::one_pass::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::ShadingSettings;
use crate::passes::gbuffer::GBuffer;
use crate::plan::{Plan, Resources};
use std::sync::Arc;

/// The sub-buffers of the G-buffer.
pub struct SubBuffers {
    pub position: Buffer,
    pub normal: Buffer,
}

/// Plans the sub-buffers.
pub fn plan(plan: &mut Plan, mapping: &MappingParams, position_bytes: u64) {
    plan.buffer("split", format!("{NAME}.split.position"), mapping.texel_count() * position_bytes);
    plan.buffer("split", format!("{NAME}.split.normal"), mapping.texel_count() * 8);
}

/// The sub-buffers, as `access` touches them.
pub fn touches(access: Access) -> [(String, Access); 2] {
    ["position", "normal"].map(|what| (format!("{NAME}.split.{what}"), access))
}

impl SubBuffers {
    pub fn new(resources: &mut Resources) -> Self {
        Self {
            position: resources.buffer(&format!("{NAME}.split.position")),
            normal: resources.buffer(&format!("{NAME}.split.normal")),
        }
    }
}

pub struct OnePass {
    pipeline: ComputePipeline,
}

impl OnePass {
    pub fn new(gpu: &Arc<Gpu>, settings: &ShadingSettings) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[settings.position.name()]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &settings.workgroup_constants())? })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        split: &SubBuffers,
    ) -> Result<()> {
        let bytes = mapping.texel_count() * gbuffer.resource.surface_bytes();
        let pairs = [mapping.sub_width_px / 2, mapping.sub_height_px, mapping.subset_count()];
        let traffic = Traffic {
            read_bytes: bytes,
            written_bytes: bytes,
            invocations: Some(pairs.iter().map(|side| u64::from(*side)).product()),
        };
        cmd.pass(&format!("{NAME}.split"), traffic, |cmd| {
            cmd.barriers(gbuffer.surface_to_sampled());
            cmd.barriers([split.position.discard(Access::ComputeWrite), split.normal.discard(Access::ComputeWrite)]);
            let mut bound = gbuffer.resource.bound_surface();
            bound.extend([
                ("SplitPosition", Bound::Buffer(&split.position)),
                ("SplitNormal", Bound::Buffer(&split.normal)),
            ]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(mapping), &bound, self.pipeline.groups(pairs))
        })
    }
}
