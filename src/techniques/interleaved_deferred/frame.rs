//! Interleaved deferred shading on the device: its passes and its resources, and the passes that not every frame has.
//! `mod.rs` has their order.

use super::accumulate::Accumulate;
use super::choices::Choices;
use super::composite::Composite;
use super::filter::{FilterStage, FilteredIrradiance};
use super::runs::ManyRuns;
use super::shade::{ShadeGpu, SubsetLights};
use super::split_passes::SplitPasses;
use super::vpl_shadow::{self, FindHidden, Sought};
use crate::error::Result;
use crate::gpu::shader::structs::{LightBlock, ShadeParams};
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Image};
use crate::lights::object_lists::ObjectLists;
use crate::passes::blend::{self, Blend, BlendLights, BlendTarget, Over, SolidPicture};
use crate::passes::cull::{Cull, CullLights};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::{GBuffer, GBufferPass};
use crate::plan::Resources;
use crate::resident::{Coverage, SceneGpu};
use crate::techniques::Inputs;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

/// What lights a frame.
pub struct FrameLights<'a> {
    pub subsets: &'a SubsetLights,
    /// The scene's own.
    pub direct: &'a [LightBlock],
    /// Lists of those for what blends.
    pub blended: &'a ObjectLists,
    /// Least distance at which a virtual point light is evaluated.
    pub vpl_clamp_m: f32,
}

pub struct InterleavedFrame {
    pub gbuffer_pass: GBufferPass,
    pub gbuffer: GBuffer,
    pub runs: Option<ManyRuns>,
    pub accumulate: Option<Accumulate>,
    pub cull: Option<Cull>,
    pub direct: DirectGpu,
    /// The composite shades every punctual light.
    pub is_lit_fully: bool,
    pub shade: ShadeGpu,
    pub hidden: Option<FindHidden>,
    pub split_passes: SplitPasses,
    pub filter: Option<FilterStage>,
    pub composite: Composite,
    pub color: Image,
    pub blend: Option<Blend>,
    pub blend_lists: Option<Buffer>,
}

impl InterleavedFrame {
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        lights: &FrameLights<'_>,
        runs: Option<ManyRuns>,
    ) -> Result<Self> {
        let Choices { shading, mapping, .. } = choices;
        let FrameLights { subsets, direct: direct_lights, blended, vpl_clamp_m } = *lights;
        let has_emissive = inputs.stats.has_emissive;
        let tree = choices.tree(inputs)?;
        let direct = DirectGpu::new(gpu, resources, NAME, direct_lights, shading.culls(direct_lights.len()), tree)?;
        let least_squared = vpl_clamp_m * vpl_clamp_m;
        let params = ShadeParams {
            mapping: *mapping,
            least_squared,
            cluster_size: choices.cluster_size() as f32,
            weight: choices.direct_subset_count() as f32,
            subset_first: 0,
            words_a_point: vpl_shadow::words_a_point(choices),
            _unused: [0; 3],
        };
        let shade = ShadeGpu::new(gpu, resources, subsets, params, choices.shaded())?;
        let (early, reader) = choices.read_of_frame();
        let lit_count = if choices.direct_full { direct_lights.len() } else { 0 };
        Ok(Self {
            gbuffer_pass: GBufferPass::new(
                gpu,
                scene,
                inputs.draw_list(scene, Coverage::Middle),
                shading.position,
                has_emissive,
            )?,
            cull: direct.masks.as_ref().map(|_| Cull::new(gpu, shading.position, shading.cull_by)).transpose()?,
            hidden: FindHidden::new(
                gpu,
                inputs,
                scene,
                resources,
                &Sought { choices, lights: subsets, least_squared },
            )?,
            split_passes: SplitPasses::new(gpu, resources, choices)?,
            filter: FilterStage::new(gpu, inputs, resources, choices)?,
            composite: Composite::new(gpu, choices, has_emissive, direct.masks.is_some(), lit_count)?,
            color: resources.image(&format!("{NAME}.composite.color")),
            blend: Blend::new(
                gpu,
                scene,
                inputs.view,
                choices.blend_params(least_squared),
                &choices.blend_constants(),
                &BlendTarget {
                    vpl_shadow: choices.blend_axis(),
                    over: if choices.run_count > 1 { Over::Nothing } else { Over::Picture },
                    ..BlendTarget::plain(blended)
                },
            )?,
            blend_lists: (inputs.stats.has_blend)
                .then(|| blend::upload_lists(gpu, resources, NAME, blended))
                .transpose()?,
            gbuffer: GBuffer::new(gpu, resources, NAME, shading.position, has_emissive)?
                .kept(choices.run_count > 1)
                .read_early(early, reader.samples()),
            runs,
            accumulate: Accumulate::new(gpu, resources, choices, inputs.stats.has_blend)?,
            direct,
            is_lit_fully: choices.direct_full,
            shade,
        })
    }

    /// What all runs share: the G-buffer, masks of the punctual lights, the split.
    pub fn record_opening(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<Edge<'_, GBuffer>> {
        let gbuffer = self.record_gbuffer(cmd, scene, frame)?;
        let gbuffer = self.record_cull(cmd, frame, gbuffer)?;
        self.split_passes.record_split(cmd, &self.shade, gbuffer)
    }

    /// A run's irradiance in frame order. `is_split_anew`: the opening is recorded with it.
    pub fn record_irradiance<'a>(
        &'a self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        (frame, is_split_anew): (&Buffer, bool),
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<(Edge<'a, GBuffer>, Edge<'a, Buffer>)> {
        let gbuffer = self.record_hidden(cmd, scene, frame, gbuffer)?;
        let (gbuffer, flags) = self.record_flags_of_gather(cmd, frame, gbuffer)?;
        let framed = (frame, is_split_anew);
        self.split_passes.record_shade(cmd, framed, &self.shade, &self.direct, gbuffer, flags)
    }

    /// The picture of what is solid under this irradiance; hands the G-buffer on as it leaves it. `masks_from`: how the
    /// masks of the punctual lights were touched last.
    pub fn record_solid<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        (gbuffer, masks_from): (Edge<'a, GBuffer>, Access),
        irradiance: Edge<'a, Buffer>,
    ) -> Result<Edge<'a, GBuffer>> {
        let (gbuffer, irradiance) = self.record_filter(cmd, frame, gbuffer, irradiance)?;
        let direct = self.direct.from(masks_from);
        self.composite.record(cmd, frame, direct, gbuffer, irradiance, &self.color)
    }

    /// What many runs sum up: this one's irradiance, and what blends. Hands both on as it leaves them.
    pub fn record_run<'a>(
        &'a self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        frame: &Buffer,
        (accumulate, run): (&Accumulate, u32),
        (gbuffer, irradiance): (Edge<'a, GBuffer>, Edge<'a, Buffer>),
    ) -> Result<(Edge<'a, GBuffer>, Edge<'a, Buffer>)> {
        if let Some(layer) = accumulate.layer() {
            self.record_blend(cmd, scene, frame, gbuffer, layer.from(Access::ComputeRead))?;
            gbuffer.resource.restore_depth(cmd);
        }
        Ok((gbuffer, accumulate.record_sums(cmd, run, irradiance)?))
    }

    /// The G-buffer, as it is drawn.
    fn record_gbuffer(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<Edge<'_, GBuffer>> {
        self.gbuffer_pass.record(cmd, NAME, frame, scene, &self.gbuffer)?;
        Ok(self.gbuffer.drawn())
    }

    /// Masks of the punctual lights, where they are culled.
    fn record_cull<'a>(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<Edge<'a, GBuffer>> {
        let (Some(cull), Some(masks)) = (&self.cull, &self.direct.masks) else { return Ok(gbuffer) };
        let lights = CullLights { blocks: &self.direct.lights, count: self.direct.light_count };
        cull.record(cmd, NAME, gbuffer, frame, lights, masks)?;
        Ok(gbuffer.after(Access::ComputeSample))
    }

    /// The virtual lights that pixels do not see, where any are looked for.
    fn record_hidden<'a>(
        &self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<Edge<'a, GBuffer>> {
        match &self.hidden {
            Some(hidden) => hidden.record(cmd, frame, scene, &self.shade, &self.direct, gbuffer),
            None => Ok(gbuffer),
        }
    }

    /// Discontinuities before the gather, where it filters.
    fn record_flags_of_gather<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<(Edge<'a, GBuffer>, Option<Edge<'a, Buffer>>)> {
        match &self.filter {
            Some(filter) => filter.record_before_gather(cmd, frame, gbuffer),
            None => Ok((gbuffer, None)),
        }
    }

    /// Discontinuities and the filter, where there is one.
    fn record_filter<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
        irradiance: Edge<'a, Buffer>,
    ) -> Result<(Edge<'a, GBuffer>, FilteredIrradiance<'a>)> {
        match &self.filter {
            Some(filter) => filter.record(cmd, frame, gbuffer, irradiance),
            None => Ok((gbuffer, FilteredIrradiance { irradiance, flags: None })),
        }
    }

    /// Blended surfaces over the picture, where there are any, or over nothing into the layer of a run.
    pub fn record_blend(
        &self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        frame: &Buffer,
        gbuffer: Edge<'_, GBuffer>,
        picture: Edge<'_, Image>,
    ) -> Result<()> {
        let (Some(blend), Some(lists)) = (&self.blend, &self.blend_lists) else { return Ok(()) };
        let lights = BlendLights {
            lights: &self.direct.lights,
            vpls: &self.shade.vpls,
            subsets: &self.shade.subsets,
            bvh_nodes: &self.direct.bvh_nodes,
            bvh_triangles: &self.direct.bvh_triangles,
            lists,
            shadow_maps: None,
        };
        let solid = SolidPicture { depth: gbuffer.resource.depth_edge(gbuffer.from), color: picture };
        blend.record(cmd, NAME, frame, scene, &lights, solid)
    }
}
