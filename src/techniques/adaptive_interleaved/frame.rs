//! Adaptive interleaved sampling on the device: its passes and its resources. `mod.rs` has their order.

use super::buffers::TreeGpu;
use super::choices::Choices;
use super::components::Samples;
use super::composite::Composite;
use super::resources::{COLOR, FILTERED, IRRADIANCE, NAME};
use super::steps::ComponentSteps;
use crate::error::Result;
use crate::gpu::shader::structs::DiscontinuityParams;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Image};
use crate::passes::filter::box_filter::BoxFilter;
use crate::passes::filter::discontinuity::{self, Discontinuity};
use crate::passes::gbuffer::{GBuffer, GBufferPass};
use crate::passes::texels::Texels;
use crate::plan::Resources;
use crate::resident::{Coverage, SceneGpu};
use crate::techniques::Inputs;
use std::sync::Arc;

pub struct AdaptiveFrame {
    pub gbuffer_pass: GBufferPass,
    pub gbuffer: GBuffer,
    pub tree: TreeGpu,
    pub components: Vec<ComponentSteps>,
    pub irradiance: Buffer,
    /// None with tiles of one pixel.
    pub filter: Option<Filter>,
    pub composite: Composite,
    pub color: Image,
}

/// Discontinuities, the box, and what it writes.
pub struct Filter {
    discontinuity: Discontinuity,
    pub flags: Buffer,
    filter: BoxFilter,
    pub filtered: Buffer,
}

impl AdaptiveFrame {
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        // In the order of the components.
        samples: &[Samples],
    ) -> Result<Self> {
        let (position, has_emissive) = (choices.position, inputs.stats.has_emissive);
        let list = inputs.draw_list(scene, Coverage::Middle);
        let components = choices.components.iter().zip(samples);
        Ok(Self {
            gbuffer_pass: GBufferPass::new(gpu, scene, list, position, has_emissive)?,
            gbuffer: GBuffer::new(gpu, resources, NAME, position, has_emissive)?,
            tree: TreeGpu::new(gpu, resources, inputs.bvh.over(inputs.scene)?)?,
            components: components
                .map(|(choice, samples)| ComponentSteps::new(gpu, resources, choices, choice, samples))
                .collect::<Result<_>>()?,
            irradiance: resources.buffer(IRRADIANCE),
            filter: choices.is_filtered().then(|| Filter::new(gpu, inputs, resources, choices)).transpose()?,
            composite: Composite::new(gpu, choices, has_emissive, scene.has_extras)?,
            color: resources.image(COLOR),
        })
    }
}

impl Filter {
    fn new(gpu: &Arc<Gpu>, inputs: &Inputs<'_>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let (values, diagonal) = (inputs.values, inputs.scene.lasting_bounds().diagonal());
        let params = DiscontinuityParams {
            normal_threshold: values.number("normal-threshold") as f32,
            position_threshold: values.length("position-threshold", diagonal),
            row_pitch: choices.extent.width,
        };
        let (workgroup, rows) = (choices.workgroup_constants(), Texels::new(values, inputs.caps).of_filter());
        Ok(Self {
            discontinuity: Discontinuity::new(gpu, NAME, choices.position, &workgroup, rows, params)?,
            flags: resources.buffer(&discontinuity::flags(NAME)),
            filter: BoxFilter::new(
                gpu,
                format!("{NAME}.filter"),
                &workgroup,
                choices.extent,
                choices.tile_px,
                choices.components.len() as u32,
            )?,
            filtered: resources.buffer(FILTERED),
        })
    }

    /// Hands the G-buffer on as it leaves it, and what it has filtered.
    pub fn record<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
        irradiance: Edge<'_, Buffer>,
    ) -> Result<(Edge<'a, GBuffer>, Edge<'a, Buffer>)> {
        let gbuffer = self.discontinuity.record(cmd, frame, gbuffer, &self.flags)?;
        self.filter.record(cmd, irradiance, self.flags.from(Access::ComputeWrite), &self.filtered)?;
        Ok((gbuffer, self.filtered.from(Access::ComputeWrite)))
    }
}
