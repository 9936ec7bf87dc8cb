//! Adaptive interleaved sampling on the device: its passes and its resources. `mod.rs` has their order.

use super::choices::Choices;
use super::components::Samples;
use super::composite::Composite;
use super::host::HostTrace;
use super::resources::{COLOR, NAME, NO_VPLS};
use super::settings::{Component, Trace};
use super::smooth::Smoothing;
use super::steps::ComponentSteps;
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Image};
use crate::passes::blend::{self, Blend, BlendLights, BlendTarget, SolidPicture};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::{GBuffer, GBufferPass};
use crate::plan::Resources;
use crate::resident::{Coverage, SceneGpu};
use crate::techniques::Inputs;
use std::sync::Arc;

pub struct AdaptiveFrame {
    pub gbuffer_pass: GBufferPass,
    pub gbuffer: GBuffer,
    pub direct: DirectGpu,
    /// Where the host estimates the components.
    pub host: Option<HostTrace>,
    pub components: Vec<ComponentSteps>,
    /// As `Choices::recorded_together` has it.
    pub recorded_together: usize,
    pub smoothing: Smoothing,
    pub composite: Composite,
    pub color: Image,
    /// What blends, and what it binds; None where nothing does.
    pub blended: Option<Blended>,
}

/// BLEND surfaces over the finished picture.
pub struct Blended {
    blend: Blend,
    lists: Buffer,
    no_vpls: Buffer,
}

impl Blended {
    fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
    ) -> Result<Option<Self>> {
        let params = blend::all_lights(choices.vpl_clamp_m * choices.vpl_clamp_m);
        let (constants, target) = (choices.direct.light_constants(), BlendTarget::plain(&choices.blended));
        let Some(blend) = Blend::new(gpu, scene, inputs.view, params, &constants, &target)? else { return Ok(None) };
        Ok(Some(Self {
            blend,
            lists: blend::upload_lists(gpu, resources, NAME, &choices.blended)?,
            no_vpls: resources.buffer(NO_VPLS),
        }))
    }
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
        let host = (choices.trace == Trace::Host).then(|| HostTrace {
            position,
            offset_m: choices.direct.ray_offset,
            lights: choices.lights.clone(),
        });
        let list = inputs.draw_list(scene, Coverage::Middle);
        let components = choices.components.iter().zip(samples);
        Ok(Self {
            gbuffer_pass: GBufferPass::new(gpu, scene, list, position, has_emissive)?,
            gbuffer: GBuffer::new(gpu, resources, NAME, position, has_emissive)?,
            direct: DirectGpu::new(gpu, resources, NAME, &choices.lights, false, choices.device_tree(inputs)?)?,
            host,
            components: components
                .map(|(choice, samples)| ComponentSteps::new(gpu, resources, choices, choice, samples))
                .collect::<Result<_>>()?,
            recorded_together: choices.recorded_together(),
            smoothing: Smoothing::new(gpu, inputs, resources, choices)?,
            composite: Composite::new(gpu, choices, has_emissive, scene.has_extras)?,
            color: resources.image(COLOR),
            blended: Blended::new(gpu, inputs, scene, resources, choices)?,
        })
    }

    /// BLEND surfaces, under the scene's own lights and the virtual ones. `gbuffer`: as the passes before left it.
    pub fn record_blend(
        &self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        frame: &Buffer,
        gbuffer: Edge<'_, GBuffer>,
    ) -> Result<()> {
        let Some(Blended { blend, lists, no_vpls }) = &self.blended else { return Ok(()) };
        let id = self.components.iter().find(|steps| steps.buffers.component == Component::Id);
        let lights = BlendLights {
            lights: &self.direct.lights,
            vpls: id.map_or(no_vpls, |id| &id.buffers.sources),
            subsets: no_vpls,
            bvh_nodes: &self.direct.bvh_nodes,
            bvh_triangles: &self.direct.bvh_triangles,
            lists,
            shadow_maps: None,
        };
        let depth = gbuffer.resource.depth_edge(Access::ComputeSample);
        let solid = SolidPicture { depth, color: self.color.from(Access::ComputeWrite) };
        blend.record(cmd, NAME, frame, scene, &lights, solid)
    }
}
