//! How coarse triangles may be in shading space, each by its blur (`--shading-rate blur`; Clarberg & Munkberg 2014, section 6, has
//! "scaling triangles in shading space"). Shader: scales.comp; readers: scaled.glsl.
//! reads   the scene, the tuples
//! writes  scales: buffer, 8 B a triangle

use super::choices::Choices;
use super::primitives::Primitives;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::ScalesParams;
use crate::gpu::shader::techniques::deep_shading::scales::{COMP, SCALES_ROW};
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Traffic};
use crate::plan::{Plan, Resources};
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::resources::full;
use std::sync::Arc;

pub const SCALES: &str = "scales";

/// `triangles`: of the scene.
pub fn plan(plan: &mut Plan, triangles: u64) {
    plan.buffer("scales", full(SCALES), triangles * 8);
}

pub struct Scales {
    pipeline: ComputePipeline,
    pub scales: Buffer,
    params: ScalesParams,
}

impl Scales {
    /// None: triangles are shaded at the full rate.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        choices: &Choices,
        primitives: &Primitives,
    ) -> Result<Option<Self>> {
        let Some(blur_pixels) = choices.blur_pixels else { return Ok(None) };
        Ok(Some(Self {
            pipeline: ComputePipeline::new(gpu, &COMP, &constants_of(choices, &[Some(&COMP)]))?,
            scales: resources.buffer(&full(SCALES)),
            params: ScalesParams { triangle_count: primitives.count as u32, blur_pixels },
        }))
    }

    /// `bound`: what shaders of the technique may read.
    pub fn record(&self, cmd: &mut Commands, bound: &[(&'static str, Bound<'_>)]) -> Result<()> {
        let count = self.params.triangle_count;
        // Three indices, and three places of each end of the exposure.
        let traffic = Traffic {
            read_bytes: Some(u64::from(count) * 3 * (4 + 2 * 12)),
            written_bytes: Some(self.scales.bytes),
            invocations: Some(u64::from(count)),
        };
        cmd.pass(&full(SCALES), traffic, |cmd| {
            cmd.barriers([self.scales.discard(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.push(("Scales", Bound::Buffer(&self.scales)));
            let groups = self.pipeline.groups([count.min(SCALES_ROW), count.div_ceil(SCALES_ROW), 1]);
            let params = bytemuck::bytes_of(&self.params);
            cmd.dispatch(&self.pipeline, params, &self.pipeline.interface.own(&bound), groups)
        })
    }
}
