//! Interleaved deferred shading on the device: its passes and its resources. `mod.rs` records them.

use super::NAME;
use super::choices::{Choices, Filter};
use super::composite::Composite;
use super::discontinuity::Discontinuity;
use super::roads::Roads;
use super::shade::{ShadeGpu, SubsetLights};
use crate::error::Result;
use crate::gpu::shader::structs::{CompositeParams, DiscontinuityParams, LightBlock, ShadeParams};
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Image};
use crate::lights::cull::Cull;
use crate::passes::blend::Blend;
use crate::passes::direct::DirectGpu;
use crate::passes::filter::gauss::Gauss;
use crate::passes::filter::gauss_fast::GaussFast;
use crate::passes::gbuffer::{GBuffer, GBufferPass};
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::Inputs;
use std::sync::Arc;

/// Discontinuities, the filter that stops at them, and what they write.
pub struct FilterStage {
    discontinuity: Discontinuity,
    pub flags: Buffer,
    gauss: AnyGauss,
    pub irradiance: Buffer,
}

#[expect(clippy::large_enum_variant, reason = "one a renderer, never moved")]
enum AnyGauss {
    Walk(Gauss, Buffer),
    Fast(GaussFast, [Image; 2]),
}

pub struct InterleavedFrame {
    pub gbuffer_pass: GBufferPass,
    pub gbuffer: GBuffer,
    pub cull: Option<Cull>,
    pub direct: DirectGpu,
    /// The composite shades every punctual light.
    pub is_lit_fully: bool,
    pub shade: ShadeGpu,
    pub roads: Roads,
    pub filter: Option<FilterStage>,
    pub composite: Composite,
    pub color: Image,
    pub blend: Option<Blend>,
}

impl InterleavedFrame {
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        lights: &SubsetLights,
        direct_lights: &[LightBlock],
    ) -> Result<Self> {
        let Choices { shading, mapping, .. } = choices;
        let has_emissive = inputs.stats.has_emissive;
        let tree = shading.tree(inputs.bvh, inputs.scene)?;
        let direct = DirectGpu::new(gpu, resources, NAME, direct_lights, shading, tree)?;
        let least = inputs.values.length("vpl-clamp", inputs.scene.lasting_bounds().diagonal());
        let params = ShadeParams {
            mapping: *mapping,
            least_squared: least * least,
            cluster_size: choices.cluster_size() as f32,
            weight: choices.direct_subset_count() as f32,
            subset_first: 0,
        };
        let shade = ShadeGpu::new(gpu, resources, lights, params)?;
        let lit_count = if choices.direct_full { direct_lights.len() } else { 0 };
        let params = CompositeParams { row_pitch: mapping.row_pitch(), direct_full: u32::from(choices.direct_full) };
        Ok(Self {
            gbuffer_pass: GBufferPass::new(gpu, scene, inputs.draw_list(scene), shading.position, has_emissive)?,
            cull: direct.masks.as_ref().map(|_| Cull::new(gpu, shading.position)).transpose()?,
            roads: Roads::new(gpu, resources, choices)?,
            filter: FilterStage::new(gpu, inputs, resources, choices)?,
            composite: Composite::new(gpu, shading, has_emissive, direct.masks.is_some(), params, lit_count)?,
            color: resources.image(&format!("{NAME}.composite.color")),
            blend: Blend::new(
                gpu,
                scene,
                inputs.view,
                choices.blend_params(least * least),
                &shading.light_constants(),
            )?,
            gbuffer: GBuffer::new(gpu, resources, NAME, shading.position, has_emissive)?,
            direct,
            is_lit_fully: choices.direct_full,
            shade,
        })
    }
}

impl FilterStage {
    fn new(gpu: &Arc<Gpu>, inputs: &Inputs<'_>, resources: &mut Resources, choices: &Choices) -> Result<Option<Self>> {
        let Choices { shading, mapping, kernel, .. } = choices;
        if choices.filter == Filter::None {
            return Ok(None);
        }
        let extent = inputs.view.extent;
        let workgroup = shading.workgroup_constants();
        let pitch = mapping.row_pitch();
        let gauss = match choices.filter {
            Filter::GaussFast => AnyGauss::Fast(
                GaussFast::new(gpu, &workgroup, extent, pitch, *kernel)?,
                ["packed", "horizontal"].map(|what| resources.image(&format!("{NAME}.filter.{what}"))),
            ),
            Filter::Gauss | Filter::None => AnyGauss::Walk(
                Gauss::new(gpu, &workgroup, extent, pitch, *kernel, shading.texels.of_filter())?,
                resources.buffer(&format!("{NAME}.filter.horizontal")),
            ),
        };
        let params = DiscontinuityParams {
            normal_threshold: inputs.values.number("normal-threshold") as f32,
            position_threshold: inputs.values.length("position-threshold", inputs.scene.lasting_bounds().diagonal()),
            row_pitch: pitch,
        };
        Ok(Some(Self {
            discontinuity: Discontinuity::new(gpu, shading, params)?,
            flags: resources.buffer(&format!("{NAME}.discontinuity.flags")),
            gauss,
            irradiance: resources.buffer(&format!("{NAME}.filter.irradiance")),
        }))
    }

    pub fn record<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'_, GBuffer>,
        irradiance: Edge<'_, Buffer>,
    ) -> Result<Edge<'a, Buffer>> {
        self.discontinuity.record(cmd, frame, gbuffer, &self.flags)?;
        let flags = self.flags.from(Access::ComputeWrite);
        match &self.gauss {
            AnyGauss::Walk(gauss, between) => {
                gauss.record(cmd, NAME, irradiance, flags, between, &self.irradiance)?;
            }
            AnyGauss::Fast(gauss, [packed, horizontal]) => {
                gauss.record(cmd, NAME, irradiance, flags, [packed, horizontal], &self.irradiance)?;
            }
        }
        Ok(self.irradiance.from(Access::ComputeWrite))
    }
}
