//! Shade: every punctual light on every pixel. Shader: shade.comp.
//! reads  the G-buffer, the lights, the tree      writes  deferred.shade.color  image, RGBA32F, frame extent

use crate::error::Result;
use crate::gpu::Bound;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deferred::shade::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::direct::{DirectGpu, ShadingSettings};
use crate::passes::gbuffer::{GBuffer, emissive_name};
use std::sync::Arc;

pub struct Shade {
    pipeline: ComputePipeline,
    /// Pixels of a column that a thread shades.
    texels: u32,
}

impl Shade {
    pub fn new(
        gpu: &Arc<Gpu>,
        settings: &ShadingSettings,
        has_emissive: bool,
        tiled: bool,
        light_count: usize,
    ) -> Result<Self> {
        let cull = if tiled { "tiled" } else { "none" };
        let shader = variant(COMP_VARIANTS, &[settings.position.name(), emissive_name(has_emissive), cull]);
        let texels = settings.texels.of_column(settings.direct.load(light_count));
        let constants =
            [&settings.workgroup_constants()[..], &settings.direct.light_constants(), &[("TEXELS", texels)]].concat();
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)?, texels })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        direct: Edge<'_, DirectGpu>,
        gbuffer: Edge<'_, GBuffer>,
        color: &Image,
    ) -> Result<()> {
        let extent = color.description.extent;
        let pixels = extent.pixel_count();
        let threads = u64::from(extent.width) * u64::from(extent.height.div_ceil(self.texels));
        let light_bytes = direct.resource.read_bytes(threads);
        let traffic = Traffic {
            read_bytes: light_bytes.map(|bytes| pixels * gbuffer.resource.shading_bytes() + bytes),
            written_bytes: Some(pixels * 16),
            invocations: Some(threads),
        };
        cmd.pass("deferred.shade", traffic, |cmd| {
            cmd.barriers(gbuffer.shading_to_sampled());
            cmd.barriers([color.discard(Access::ComputeWrite)]);
            cmd.barriers(direct.masks_to(Access::ComputeRead));
            let mut bound = gbuffer.resource.bound_shading();
            bound.extend(direct.resource.bound());
            bound.extend([("Frame", Bound::Buffer(frame)), ("color", Bound::Storage(color))]);
            let groups = self.pipeline.groups([extent.width, extent.height.div_ceil(self.texels), 1]);
            cmd.dispatch(&self.pipeline, &[], &bound, groups)
        })
    }
}
