//! Baselines: what is drawn is shaded in screen space, as Clarberg and Munkberg 2014 (section 6, figure 8) compare with, on the
//! same tuples, lights, shadow maps and materials. No lists, no addresses, no SPIDs: colours and depths of samples are all.
//! reads   the scene, its lights, the tuples
//! writes  baseline.colors and baseline.depth: arrays of images, 8 and 4 B a sample
//!
//! Colours are of the middle of the exposure, from the middle of the lens, as by the lists: what differs is how many there are
//! and where on a triangle they are taken. Surfaces face as their samples see them. There is no pass for depth alone, which
//! the paper calls no good approach for stochastic rasterisation (section 3): what something nearer covers later has been
//! shaded, and is counted. Draws go front to back.

pub mod msaa;
pub mod ssaa;
pub mod texture_space;

use super::choices::Choices;
use super::stereo;
use super::visibility;
use super::visibility::repeat_frame;
use super::visibility::sample::{PipelineSets, TupleDraws};
use crate::caps::Need;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::Shader;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, ImageDescription, Layers, Traffic};
use crate::passes::shadow_maps::ShadowMaps;
use crate::plan::{Plan, Resources, Shape};
use crate::resident::{DrawList, SceneGpu};
use crate::settings::Values;
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::modes::pass_samples;
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::pass_inputs::DrawInputs;
use crate::techniques::deep_shading::resources;
use crate::techniques::deep_shading::resources::{COUNTERS, DEPTH_FORMAT, full};
use crate::techniques::deep_shading::visibility::draw::SampleStages;
use crate::techniques::deep_shading::visibility::samples::begin_counters;
use crate::units::Extent;
use ash::vk::{self, ImageUsageFlags as Usage};
use std::collections::BTreeMap;
use std::sync::Arc;
use texture_space::TextureSpace;
use texture_space::atlases::Atlases;

const COLORS: &str = "baseline.colors";
const DEPTH: &str = "baseline.depth";
const COLOR_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// What `values` need of a device, whatever is shaded.
pub fn needs(values: &Values) -> Option<Need> {
    pass_samples::needs(values)
}

impl Shading {
    /// The pass that draws.
    fn pass(self) -> &'static str {
        match self {
            Self::Ssaa => "baseline.ssaa",
            Self::Msaa { .. } => "baseline.msaa",
            Self::TextureSpace(_) => "baseline.texture_space",
            Self::Deep | Self::IndirectGbuffer => unreachable!("visibility is a pass of its own"),
        }
    }
}

/// Layers that samples are drawn into: one a tuple, of a table's part of the frame, or one a pass, of the whole frame.
fn layers(choices: &Choices, frame: Extent, format: vk::Format, usage: Usage) -> ImageDescription {
    let (table, samples) = (&choices.table, choices.shading.pass_samples());
    let (extent, layer_count) = match choices.shading {
        Shading::Msaa { .. } => (frame, table.samples / samples),
        _ => (table.layer(frame), table.tuple_count()),
    };
    ImageDescription { layer_count: Some(layer_count), ..ImageDescription::plain(extent, format, samples, usage) }
}

/// Colours and depths of a frame's samples.
pub fn plan(plan: &mut Plan, choices: &Choices, frame: Extent) {
    let attached = |format, usage| Shape::Image(layers(choices, frame, format, usage));
    plan.push("frame_buffer", full(COLORS), attached(COLOR_FORMAT, Usage::COLOR_ATTACHMENT | Usage::SAMPLED));
    plan.push("frame_buffer", full(DEPTH), attached(DEPTH_FORMAT, Usage::DEPTH_STENCIL_ATTACHMENT));
}

/// Plans the passes that touch the baseline's resources.
pub fn plan_passes(plan: &mut Plan, choices: &Choices) {
    let touch = |name: &str, access| (full(name), access);
    let mut drawn = vec![touch(COLORS, Access::ColorWrite), touch(DEPTH, Access::DepthWrite)];
    drawn.extend(choices.maps.iter().filter_map(|maps| maps.read(resources::NAME)));
    if let Shading::TextureSpace(size) = choices.shading {
        drawn.extend(size.touches());
    }
    drawn.extend([touch(COUNTERS, Access::TransferWrite), touch(COUNTERS, Access::FragmentWrite)]);
    plan.pass(full(choices.shading.pass()), drawn);
    let resolved = [touch(COLORS, Access::ComputeSample), touch(COUNTERS, Access::ComputeWrite)];
    plan.pass(full("resolve"), resolved.into_iter().chain(stereo::resolved(choices)));
}

pub struct Baseline {
    tuple_draws: TupleDraws,
    pub colors: Image,
    depth: Image,
    /// Texels are fetched: it only has to be there.
    nearest: Sampler,
    shading: Shading,
    textures: Option<TextureSpace>,
}

impl Baseline {
    /// `atlases`: with `--shading texture-space`.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        scene: &SceneGpu,
        choices: &Choices,
        atlases: Option<&Atlases>,
    ) -> Result<Self> {
        let (stages, fragment): (_, fn(&SceneGpu, &Choices, &str) -> &'static Shader) = match choices.shading {
            Shading::Msaa { .. } => (msaa::stages(), msaa::fragment),
            Shading::TextureSpace(_) => {
                (visibility::stages::stages(scene, choices, &repeat_frame::repeats(0)), texture_space::apply::fragment)
            }
            _ => (visibility::stages::stages(scene, choices, &repeat_frame::repeats(0)), ssaa::fragment),
        };
        let textures = match (choices.shading, atlases) {
            (Shading::TextureSpace(size), Some(atlases)) => {
                Some(TextureSpace::new(gpu, resources, scene, choices, size, atlases)?)
            }
            _ => None,
        };
        let pipeline = |alpha| pipeline(gpu, scene, choices, &stages, fragment(scene, choices, alpha));
        Ok(Self {
            tuple_draws: TupleDraws::of([pipeline("opaque")?, pipeline("tested")?], stages),
            colors: resources.image(&full(COLORS)),
            depth: resources.image(&full(DEPTH)),
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
            shading: choices.shading,
            textures,
        })
    }

    /// Names the access that touched its colours last.
    pub fn from(&self, access: Access) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    /// The colours as the resolve reads them.
    pub fn sampled(&self) -> Bound<'_> {
        Bound::Sampled(&self.colors, self.nearest.handle, Access::ComputeSample)
    }

    /// Bytes that a frame of `list` has touched of buffers of which it does not touch all, by full name, with `--instrument on`.
    ///
    /// Errors: memory for reading counts back (exit code 4).
    pub fn touched_bytes(&self, gpu: &Arc<Gpu>, list: &DrawList) -> Result<BTreeMap<String, u64>> {
        self.textures.as_ref().map_or_else(|| Ok(BTreeMap::new()), |textures| textures.touched_bytes(gpu, list))
    }

    /// Draws and shades every layer: what of it is in the frame.
    pub fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        maps: Option<Edge<'_, ShadowMaps>>,
        counters: &Buffer,
    ) -> Result<()> {
        let description = self.colors.description;
        let owner_bytes = self.textures.as_ref().map_or(0, |textures| textures.owner_bytes(inputs));
        let traffic = Traffic {
            // Textures of claims are owners alone; shading itself is counted after the frame.
            written_bytes: Some(description.bytes() + self.depth.description.bytes() + owner_bytes),
            ..Traffic::default()
        };
        cmd.pass(&full(self.shading.pass()), traffic, |cmd| {
            cmd.barriers(maps.and_then(|maps| maps.to(Access::FragmentSample)));
            cmd.barriers([self.colors.discard(Access::ColorWrite), self.depth.discard(Access::DepthWrite)]);
            begin_counters(cmd, counters);
            let mut bound = inputs.bound.to_vec();
            bound.push(("Counters", Bound::Buffer(counters)));
            if let Some(textures) = &self.textures {
                return textures.record(
                    cmd,
                    DrawInputs { bound: &bound, ..inputs },
                    &self.tuple_draws,
                    |cmd, lists, is_first| {
                        if !is_first {
                            // What was drawn before is tested and kept.
                            let attached = [
                                self.colors.from(Access::ColorWrite).to(Access::ColorWrite),
                                self.depth.from(Access::DepthWrite).to(Access::DepthWrite),
                            ];
                            cmd.barriers(attached);
                        }
                        self.draw(cmd, inputs, lists, is_first);
                    },
                );
            }
            let sets = self.tuple_draws.sets(cmd, &bound)?;
            self.draw(cmd, inputs, &[(inputs.list, &sets)], true);
            Ok(())
        })
    }

    /// Each of `lists` with its sets into every layer, which begins empty where they are the first.
    fn draw(&self, cmd: &mut Commands, inputs: DrawInputs<'_>, lists: &[(&DrawList, &PipelineSets)], is_first: bool) {
        let description = self.colors.description;
        for layer in 0..description.layers() {
            // Alpha is 1 where something is.
            let cleared = is_first.then_some(vk::ClearColorValue { float32: [0.0; 4] });
            let colors = ColorTarget::new(&self.colors, cleared);
            let depth = (&self.depth, is_first.then_some(0.0), Access::DepthWrite);
            cmd.begin_layers(description.extent, Layers::One(layer), &[colors], Some(depth));
            let first_tuple = match self.shading {
                Shading::Msaa { pass_samples } => layer * pass_samples,
                _ => {
                    cmd.set_scissor([0, 0], inputs.table.inside(inputs.frame, layer));
                    layer
                }
            };
            for (list, sets) in lists {
                let repeats = repeat_frame::repeats(first_tuple);
                self.tuple_draws.draw(cmd, DrawInputs { list, ..inputs }, sets, &repeats);
            }
            cmd.end_rendering();
        }
    }
}

fn pipeline(
    gpu: &Arc<Gpu>,
    scene: &SceneGpu,
    choices: &Choices,
    stages: &SampleStages,
    fragment: &'static Shader,
) -> Result<GraphicsPipeline> {
    let constants = constants_of(choices, &[Some(stages.vertex), stages.geometry, Some(fragment)]);
    GraphicsPipeline::new(
        gpu,
        &GraphicsDescription {
            vertex: stages.vertex,
            geometry: stages.geometry,
            fragment: Some(fragment),
            constants: &constants,
            vertex_buffers: &[],
            color_formats: &[COLOR_FORMAT],
            samples: choices.shading.pass_samples(),
            are_placed: false,
            blending: Blending::Replace,
            depth_format: Some(DEPTH_FORMAT),
            depth_write: true,
            depth_compare: vk::CompareOp::GREATER,
            depth_clamp: false,
            depth_bias: DepthBias::NONE,
            conservative_margin_px: None,
            stencil: None,
            foreign_sets: &[scene.material_layout],
        },
    )
}
