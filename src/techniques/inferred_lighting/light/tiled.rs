//! Light, tiled: one dispatch, each thread sums the lights of its tile's list up. Shader: tiled.comp.
//! reads  geometry.normal, geometry.depth, geometry.extras, cull.masks      writes  light.l_buffer

use super::super::geometry::{LowGeometry, extras_name};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::inferred_lighting::light::tiled::COMP_VARIANTS;
use crate::gpu::shader::{constants_of, variant};
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::direct::{DirectGpu, ShadingSettings};
use crate::techniques::inferred_lighting::resources::NAME;
use std::sync::Arc;

pub struct Tiled {
    pipeline: ComputePipeline,
    /// Pixels of a column that a thread lights.
    texels: u32,
}

impl Tiled {
    /// `constants`: the technique's, of which the shader has some.
    pub fn new(
        gpu: &Arc<Gpu>,
        settings: &ShadingSettings,
        constants: &[(&'static str, u32)],
        has_extras: bool,
        light_count: usize,
    ) -> Result<Self> {
        let cull = if settings.culls(light_count) { "tiled" } else { "none" };
        let shader = variant(COMP_VARIANTS, &[extras_name(has_extras), cull]);
        let texels = settings.texels.of_column(settings.direct.load(light_count));
        let own = constants_of(constants, &[Some(shader)]);
        let constants = [&own[..], &settings.workgroup_constants(), &[("TEXELS", texels)]].concat();
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)?, texels })
    }

    /// `frame`: the block of the light buffer's extent.
    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        lights: Edge<'_, DirectGpu>,
        geometry: Edge<'_, LowGeometry>,
        l_buffer: &Image,
    ) -> Result<()> {
        let extent = geometry.resource.extent();
        let columns = extent.height.div_ceil(self.texels);
        let traffic = Traffic {
            // Tiles decide how many lights are read.
            read_bytes: None,
            written_bytes: Some(extent.pixel_count() * 8),
            invocations: Some(u64::from(extent.width) * u64::from(columns)),
        };
        cmd.pass(&format!("{NAME}.light"), traffic, |cmd| {
            cmd.barriers(geometry.lit_with_depth_to(Access::ComputeSample, Access::ComputeSample));
            cmd.barriers([l_buffer.discard(Access::ComputeWrite)]);
            cmd.barriers(lights.masks_to(Access::ComputeRead));
            let mut bound = geometry.resource.bound_with_depth(Access::ComputeSample, Access::ComputeSample);
            bound.extend(lights.resource.bound());
            bound.extend([("Frame", Bound::Buffer(frame)), ("l_buffer", Bound::Storage(l_buffer))]);
            let groups = self.pipeline.groups([extent.width, columns, 1]);
            cmd.dispatch(&self.pipeline, &[], &bound, groups)
        })
    }
}
