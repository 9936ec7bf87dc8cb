//! Composite: albedo times filtered irradiance, or what glossy surfaces are multiplied by, direct light, emission (Segovia 2006, section 4.5). Shader: composite.comp.
//! reads  the G-buffer, the irradiance, the punctual lights      writes  composite.color  image, RGBA32F, frame extent

use super::choices::Choices;
use super::filter::FilteredIrradiance;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::CompositeParams;
use crate::gpu::shader::techniques::interleaved_deferred::composite::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::{GBuffer, emissive_name};
use crate::settings::Brdf;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct Composite {
    pipeline: ComputePipeline,
    params: CompositeParams,
    /// Pixels of a column that a thread shades.
    texels: u32,
}

impl Composite {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, has_emissive: bool, tiled: bool, light_count: usize) -> Result<Self> {
        let Choices { shading, mapping, kernel, .. } = choices;
        let cull = if tiled { "tiled" } else { "none" };
        let filter = if choices.fused { "columns" } else { "whole" };
        let shader = variant(COMP_VARIANTS, &[shading.position.name(), emissive_name(has_emissive), cull, filter]);
        let texels = shading.texels.of_column(shading.direct.load(light_count));
        let mut constants =
            [&shading.workgroup_constants()[..], &shading.direct.light_constants(), &[("TEXELS", texels)]].concat();
        if choices.fused {
            constants.extend(kernel.constants());
        }
        let params = CompositeParams {
            walk: kernel.walk(false),
            row_pitch: mapping.row_pitch(),
            direct_full: u32::from(choices.direct_full),
            opaque_zero: 0,
            is_glossy: u32::from(choices.vpl_brdf != Brdf::Lambert),
        };
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)?, params, texels })
    }

    /// Hands the G-buffer on as it leaves it.
    pub fn record<'a>(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        direct: Edge<'_, DirectGpu>,
        gbuffer: Edge<'a, GBuffer>,
        filtered: FilteredIrradiance<'_>,
        color: &Image,
    ) -> Result<Edge<'a, GBuffer>> {
        let extent = color.description.extent;
        let pixels = extent.pixel_count();
        let threads = u64::from(extent.width) * u64::from(extent.height.div_ceil(self.texels));
        let light_bytes = if self.params.direct_full == 0 { Some(0) } else { direct.resource.read_bytes(threads) };
        let traffic = Traffic {
            read_bytes: light_bytes.map(|bytes| pixels * (gbuffer.resource.shading_bytes() + 8) + bytes),
            written_bytes: Some(pixels * 16),
            invocations: Some(threads),
        };
        cmd.pass(&format!("{NAME}.composite"), traffic, |cmd| {
            cmd.barriers(gbuffer.shading_to_sampled());
            cmd.barriers([filtered.irradiance.to(Access::ComputeRead), color.discard(Access::ComputeWrite)]);
            cmd.barriers(filtered.flags.iter().map(|flags| flags.to(Access::ComputeRead)));
            cmd.barriers(direct.masks_to(Access::ComputeRead));
            let mut bound = gbuffer.resource.bound_shading();
            bound.extend(direct.resource.bound());
            bound.extend([
                ("Frame", Bound::Buffer(frame)),
                ("Irradiance", Bound::Buffer(filtered.irradiance.resource)),
                ("color", Bound::Storage(color)),
            ]);
            bound.extend(filtered.flags.iter().map(|flags| ("Flags", Bound::Buffer(flags.resource))));
            let groups = self.pipeline.groups([extent.width, extent.height.div_ceil(self.texels), 1]);
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&self.params), &bound, groups)
        })?;
        Ok(gbuffer.after(Access::ComputeSample))
    }
}
