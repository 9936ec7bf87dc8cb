//! The triangles that samples see, drawn once more by the stages that drew them for visibility: every sample is found
//! once, by the triangle that it sees, and the shader that follows says what is done with it. Shaders: those before
//! fragments of visibility, redraw.glsl.
//! reads  the scene, visibility.spids, visibility.depth

use super::choices::Choices;
use super::pass_inputs::DrawInputs;
use super::stray_draws::StrayDraws;
use super::visibility;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::Shader;
use crate::gpu::{Access, Bound, Commands, Gpu};
use crate::passes::mesh;
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::resources::DEPTH_FORMAT;
use crate::techniques::deep_shading::visibility::draw;
use crate::techniques::deep_shading::visibility::samples::SeenSamples;
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

pub struct TriangleRedraw {
    pipeline: GraphicsPipeline,
    stages: draw::SampleStages,
    stray_draws: Option<StrayDraws>,
    visibility: Visibility,
    /// One, and how many of them.
    layers: (Extent, u32),
}

/// The value of the shaders' axis VISIBILITY: polygons have no depth that samples have. The SPIDs alone say what is seen: a
/// triangle covers a sample once.
pub fn axis(choices: &Choices) -> &'static str {
    if choices.visibility.has_polygons() { "stochastic" } else { "interleaved" }
}

impl TriangleRedraw {
    /// `frame`: its extent; `fragment`: what is done with a sample.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        frame: Extent,
        fragment: &'static Shader,
    ) -> Result<Self> {
        let repeats = choices.visibility.repeats(scene, &gpu.caps.limits, choices.table.tuple_count());
        let stages = visibility::stages::stages(scene, choices, &repeats);
        let constants = constants_of(choices, &[Some(stages.vertex), stages.geometry, Some(fragment)]);
        let pipeline = GraphicsPipeline::new(
            gpu,
            &GraphicsDescription {
                vertex: stages.vertex,
                geometry: stages.geometry,
                fragment: Some(fragment),
                constants: &constants,
                vertex_buffers: &[],
                color_formats: &[],
                samples: 1,
                blending: Blending::Replace,
                depth_format: (!choices.visibility.has_polygons()).then_some(DEPTH_FORMAT),
                depth_write: false,
                depth_compare: vk::CompareOp::EQUAL,
                depth_clamp: false,
                depth_bias: DepthBias::NONE,
                conservative_margin_px: None,
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        let stray_draws = if choices.lists.has_stray_count {
            Some(StrayDraws::new(gpu, resources, scene, &stages, &repeats)?)
        } else {
            None
        };
        let layers = (choices.table.layer(frame), choices.table.tuple_count());
        Ok(Self { pipeline, stages, stray_draws, visibility: choices.visibility, layers })
    }

    /// Whether draws depend on a count.
    pub fn stray_draws(&self) -> Option<&StrayDraws> {
        self.stray_draws.as_ref()
    }

    /// Bytes of vertices and of what says what samples see.
    pub fn read_bytes(&self, gpu: &Gpu, inputs: DrawInputs<'_>, seen: Option<SeenSamples<'_>>) -> u64 {
        let DrawInputs { scene, list, .. } = inputs;
        let (_, layers) = self.layers;
        let repeats = self.visibility.repeats(scene, &gpu.caps.limits, layers);
        let rounds = self.visibility.round_count(&repeats, layers);
        u64::from(rounds) * mesh::read_bytes(scene, list.calls())
            + seen.map_or(0, |seen| seen.spids.resource.spids.description.bytes())
    }

    /// Waits for the samples, and draws. `bound`: all that shaders read and write except for SPIDs.
    pub fn record<'a>(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        seen: Option<SeenSamples<'a>>,
        mut bound: Vec<(&'static str, Bound<'a>)>,
    ) -> Result<()> {
        let DrawInputs { scene, list, primitives, .. } = inputs;
        let (layer, layers) = self.layers;
        let repeats = self.visibility.repeats(scene, &cmd.gpu().caps.limits, layers);
        cmd.barriers(seen.map(|seen| seen.spids.spids_to(Access::FragmentSample)));
        let depth = seen.and_then(|seen| seen.depth).filter(|_| !self.visibility.has_polygons());
        cmd.barriers(depth.map(|depth| depth.to(Access::DepthTest)));
        let samples = seen.map(|seen| seen.spids.resource);
        let spids = samples.map(|samples| samples.sampled(&samples.spids, Access::FragmentSample));
        bound.extend(spids.map(|spids| ("spids", spids)));
        let set = cmd.set_for(&self.pipeline, &self.pipeline.interface.own(&bound))?;
        let Some(first) = list.calls().next() else { return Ok(()) };
        self.visibility.for_layers(&repeats, layers, |at, repeats| {
            let depth = depth.map(|depth| (depth.resource, None, Access::DepthTest));
            cmd.begin_layers(layer, at, &[], depth);
            cmd.bind_with_set(&self.pipeline, bytemuck::bytes_of(&primitives.params(scene, first)), set);
            if let Some(stray_draws) = &self.stray_draws {
                draw::draw_by(cmd, &self.pipeline, self.stages.sides, inputs, &scene.calls, repeats, |call| {
                    stray_draws.draw(cmd, call.draw);
                });
            } else {
                draw::draw(cmd, &self.pipeline, &self.stages, inputs, list.calls(), repeats);
            }
            cmd.end_rendering();
        });
        Ok(())
    }
}
