//! Shade: every punctual light on every pixel. Shader: shade.comp.
//! reads  the G-buffer, the lights, the tree      writes  new_technique.shade.color  image, RGBA32F, frame extent

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::new_technique::shade::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::direct::{DirectGpu, DirectSettings};
use crate::passes::gbuffer::{GBuffer, emissive_name};
use crate::settings::{PositionStorage, Values};
use std::sync::Arc;

pub struct Shade {
    pipeline: ComputePipeline,
}

impl Shade {
    pub fn new(
        gpu: &Arc<Gpu>,
        values: &Values,
        [width, height]: [u32; 2],
        direct: &DirectSettings,
        position: PositionStorage,
        has_emissive: bool,
    ) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[position.name(), emissive_name(has_emissive), "none"]);
        let scale = values.number("light-scale") as f32;
        let own = [("WORKGROUP_X", width), ("WORKGROUP_Y", height), ("LIGHT_SCALE", scale.to_bits())];
        let constants = [&own[..], &direct.light_constants()].concat();
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)? })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        direct: &DirectGpu,
        gbuffer: Edge<'_, GBuffer>,
        color: &Image,
    ) -> Result<()> {
        let extent = color.description.extent;
        let pixels = extent.pixel_count();
        let traffic = Traffic {
            read_bytes: direct.read_bytes(pixels).map(|bytes| pixels * gbuffer.resource.shading_bytes() + bytes),
            written_bytes: Some(pixels * 16),
            invocations: Some(pixels),
        };
        cmd.pass("new_technique.shade", traffic, |cmd| {
            cmd.barriers(gbuffer.shading_to_sampled());
            cmd.barriers([color.discard(Access::ComputeWrite)]);
            let mut bound = gbuffer.resource.bound_shading();
            bound.extend(direct.bound());
            bound.extend([("Frame", Bound::Buffer(frame)), ("color", Bound::Storage(color))]);
            cmd.dispatch(&self.pipeline, &[], &bound, self.pipeline.groups([extent.width, extent.height, 1]))
        })
    }
}
