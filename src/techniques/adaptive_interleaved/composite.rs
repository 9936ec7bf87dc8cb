//! Composite: irradiance of all components times albedo, emission, ambient light, and the medium before it. Shader:
//! composite.comp.
//! reads  the G-buffer, the irradiance      writes  adaptive_interleaved.composite.color  image, RGBA32F, frame extent

use super::choices::Choices;
use super::resources::NAME;
use super::settings::Component;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::{ComposeParams, MediumBlock};
use crate::gpu::shader::techniques::adaptive_interleaved::composite::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::gbuffer::{GBuffer, emissive_name};
use bytemuck::Zeroable;
use std::sync::Arc;

pub struct Composite {
    pipeline: ComputePipeline,
    params: ComposeParams,
}

impl Composite {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, has_emissive: bool, has_extras: bool) -> Result<Self> {
        let extras = ("SURFACE_EXTRAS", u32::from(has_extras));
        let constants = [&choices.workgroup_constants()[..], &[extras]].concat();
        let shader = variant(COMP_VARIANTS, &[choices.position.name(), emissive_name(has_emissive)]);
        let pipeline = ComputePipeline::new(gpu, shader, &constants)?;
        let component_count = choices.components.len();
        let place = |component| choices.components.iter().position(|choice| choice.component == component);
        let params = ComposeParams {
            medium: choices.medium_block.unwrap_or_else(MediumBlock::zeroed),
            texel_count: choices.extent.pixel_count() as u32,
            component_count: component_count as u32,
            airlight: place(Component::Pm).unwrap_or(component_count) as u32,
            adds_ambient: u32::from(place(Component::Ao).is_none()),
        };
        Ok(Self { pipeline, params })
    }

    /// Hands the G-buffer on as it leaves it.
    pub fn record<'a>(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
        irradiance: Edge<'_, Buffer>,
        color: &Image,
    ) -> Result<Edge<'a, GBuffer>> {
        let extent = color.description.extent;
        let pixels = extent.pixel_count();
        let layers = u64::from(self.params.component_count);
        let traffic = Traffic {
            read_bytes: Some(pixels * (gbuffer.resource.shading_bytes() + 8 * layers)),
            written_bytes: Some(pixels * 16),
            invocations: Some(pixels),
        };
        cmd.pass(&format!("{NAME}.composite"), traffic, |cmd| {
            cmd.barriers(gbuffer.shading_to_sampled());
            cmd.barriers([irradiance.to(Access::ComputeRead), color.discard(Access::ComputeWrite)]);
            let mut bound = gbuffer.resource.bound_shading();
            bound.extend([
                ("Frame", Bound::Buffer(frame)),
                ("Irradiance", Bound::Buffer(irradiance.resource)),
                ("color", Bound::Storage(color)),
            ]);
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            let bound = self.pipeline.interface.own(&bound);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })?;
        Ok(gbuffer.after(Access::ComputeSample))
    }
}
