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
use super::plan::{COUNTERS, DEPTH_FORMAT};
use super::settings::SETTINGS;
use super::visibility::sample::{Sample, Sets, Stages};
use super::visibility::{self, Drawn, Visibility, begin_counters, repeat_frame};
use super::{full, stereo};
use crate::error::{Error, Result};
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::{Shader, variant};
use crate::gpu::{
    Access, Barrier, Bound, Buffer, Caps, ColorTarget, Commands, Gpu, Image, ImageDescription, Layers, Need, Traffic,
};
use crate::passes::{mesh, shadow_maps};
use crate::plan::{Plan, Resources, Shape};
use crate::resident::{DrawList, SceneGpu};
use crate::settings::{Condition, Unread, Values, readers};
use crate::units::Extent;
use ash::vk::{self, ImageUsageFlags as Usage};
use std::collections::BTreeMap;
use std::sync::Arc;
use texture_space::TextureSpace;
use texture_space::atlases::Atlases;
use texture_space::pool::PoolSize;

const COLORS: &str = "baseline.colors";
const DEPTH: &str = "baseline.depth";
const COLOR_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// Settings that not everything that is shaded reads.
pub const CONDITIONS: &[Condition] = &[
    Condition { key: "guard-band", unread: |values| Unread::unless(values, "shading", OF_SPACE, NO_SPACE) },
    Condition {
        key: "shading-scale",
        unread: |values| {
            Unread::unless(
                values,
                "shading",
                &["deep", "indirect-gbuffer", "texture-space"],
                "it shades no pixels of shading space",
            )
        },
    },
    Condition { key: "shading-warp", unread: |values| Unread::unless(values, "shading", OF_SPACE, NO_SPACE) },
    Condition { key: "warp-falloff", unread: |values| Unread::unless(values, "shading", OF_SPACE, NO_SPACE) },
    Condition { key: "lists", unread: |values| Unread::unless(values, "shading", &["deep"], NO_LISTS) },
    Condition {
        key: "list-access",
        unread: |values| Unread::unless(values, "shading", OF_SPACE, "samples' colours are in images"),
    },
    Condition { key: "duplicates", unread: |values| Unread::unless(values, "shading", &["deep"], NO_LISTS) },
    Condition { key: "compaction", unread: |values| Unread::unless(values, "shading", &["deep"], NO_LISTS) },
    Condition { key: "zmax", unread: |values| Unread::unless(values, "shading", &["deep"], NO_LISTS) },
    Condition { key: "address-buffer", unread: |values| Unread::unless(values, "shading", &["deep"], NO_LISTS) },
    Condition { key: "conservative", unread: |values| Unread::unless(values, "shading", &["deep"], NO_LISTS) },
    Condition { key: "shaded-triangles", unread: |values| Unread::unless(values, "shading", &["deep"], NO_LISTS) },
    Condition {
        key: "layer-from",
        unread: |values| Unread::unless(values, "shading", OF_SPACE, "samples are drawn layer by layer"),
    },
    Condition {
        key: "polygon-from",
        unread: |values| {
            Unread::unless(
                values,
                "shading",
                &["deep", "indirect-gbuffer", "ssaa", "texture-space"],
                "its triangles come from vertex shaders",
            )
        },
    },
    Condition {
        key: "sample-tests",
        unread: |values| {
            Unread::unless(
                values,
                "shading",
                OF_SPACE,
                "samples are drawn and coloured layer by layer, or as many at a time as an image has",
            )
        },
    },
    Condition {
        key: "pass-samples",
        unread: |values| Unread::unless(values, "shading", &["msaa"], "samples are drawn one at a time"),
    },
    Condition {
        key: "shading-cache",
        unread: |values| Unread::unless(values, "shading", &["indirect-gbuffer"], "it has no cache"),
    },
    Condition {
        key: "shading-textures",
        unread: |values| Unread::unless(values, "shading", &["texture-space"], "it has no textures of its own"),
    },
    Condition {
        key: "shading-texture-size",
        unread: |values| Unread::unless(values, "shading", &["texture-space"], "it has no textures of its own"),
    },
];
const OF_SPACE: &[&str] = &["deep", "indirect-gbuffer"];
const NO_SPACE: &str = "it has no shading space";
const NO_LISTS: &str = "it has no lists";

/// What `values` need of a device, whatever is shaded.
pub fn needs(values: &Values) -> Option<Need> {
    msaa::needs(values)
}

/// What is shaded (`--shading`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// Triangles in the lists.
    Deep,
    /// Entries of a compact geometry buffer that samples point to.
    IndirectGbuffer,
    /// Every sample that is drawn.
    Ssaa,
    /// A pixel's samples that see a triangle, once.
    Msaa {
        /// Samples a pixel that are drawn at once.
        pass_samples: u32,
    },
    /// Texels of each draw's texture.
    TextureSpace(PoolSize),
}

impl Shading {
    /// The value of `--shading`, with `spp` samples a pixel.
    ///
    /// Errors: another setting is changed that it does not read; samples of a pass that `spp` is no multiple of (exit code 2).
    pub fn new(values: &Values, caps: &Caps, spp: u32) -> Result<Self> {
        let text = values.text("shading");
        readers::require_read(CONDITIONS, SETTINGS, values)?;
        Ok(match text {
            "deep" => Self::Deep,
            "indirect-gbuffer" => Self::IndirectGbuffer,
            "ssaa" => Self::Ssaa,
            "texture-space" => Self::TextureSpace(PoolSize::of(values)),
            "msaa" => Self::Msaa { pass_samples: msaa::pass_samples(values, caps, spp)? },
            other => panic!("--shading {other} was checked"),
        })
    }

    /// How samples find what they see.
    ///
    /// Errors: what is drawn sample by sample has no such kind (exit code 2).
    pub fn visibility(self, values: &Values) -> Result<Visibility> {
        let visibility = Visibility::of(values);
        let goes_with_all = matches!(visibility, Visibility::RepeatFrame | Visibility::Stochastic);
        match self {
            Self::Deep | Self::IndirectGbuffer => Ok(visibility),
            Self::Msaa { .. } if goes_with_all => Ok(Visibility::Stochastic),
            _ if goes_with_all => Ok(visibility),
            Self::Msaa { .. } | Self::Ssaa | Self::TextureSpace(_) => {
                let [shading, kind] = ["shading", "visibility"].map(|key| values.text(key));
                let (why, advice) = match self {
                    Self::Msaa { .. } => ("a shader tests its samples", "--visibility stochastic does"),
                    _ => (
                        "samples are drawn and coloured layer by layer",
                        "--visibility repeat-frame and stochastic do so",
                    ),
                };
                Err(Error::request(format!("--visibility {kind} with --shading {shading}: {why}"))
                    .within(super::NAME)
                    .note(advice))
            }
        }
    }

    /// The pass that draws.
    fn pass(self) -> &'static str {
        match self {
            Self::Ssaa => "baseline.ssaa",
            Self::Msaa { .. } => "baseline.msaa",
            Self::TextureSpace(_) => "baseline.texture_space",
            Self::Deep | Self::IndirectGbuffer => unreachable!("visibility is a pass of its own"),
        }
    }

    /// The logarithm to 2 of a texture's side; 0: there are none.
    pub fn texture_side_bits(self) -> u32 {
        if let Self::TextureSpace(size) = self { size.side_px.ilog2() } else { 0 }
    }

    /// Samples a pixel of what is drawn into.
    pub fn pass_samples(self) -> u32 {
        match self {
            Self::Msaa { pass_samples } => pass_samples,
            Self::Deep | Self::IndirectGbuffer | Self::Ssaa | Self::TextureSpace(_) => 1,
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
    drawn.extend(choices.maps.iter().filter_map(|maps| maps.read(super::NAME)));
    if let Shading::TextureSpace(size) = choices.shading {
        drawn.extend(size.touches());
    }
    drawn.extend([touch(COUNTERS, Access::TransferWrite), touch(COUNTERS, Access::FragmentWrite)]);
    plan.pass(full(choices.shading.pass()), drawn);
    let resolved = [touch(COLORS, Access::ComputeSample), touch(COUNTERS, Access::ComputeWrite)];
    plan.pass(full("resolve"), resolved.into_iter().chain(stereo::resolved(choices)));
}

pub struct Baseline {
    sample: Sample,
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
                (visibility::stages(scene, choices, &repeat_frame::repeats(0)), texture_space::apply::fragment)
            }
            _ => (visibility::stages(scene, choices, &repeat_frame::repeats(0)), ssaa::fragment),
        };
        let textures = match (choices.shading, atlases) {
            (Shading::TextureSpace(size), Some(atlases)) => {
                Some(TextureSpace::new(gpu, resources, scene, choices, size, atlases)?)
            }
            _ => None,
        };
        let pipeline = |alpha| pipeline(gpu, scene, choices, &stages, fragment(scene, choices, alpha));
        Ok(Self {
            sample: Sample::of([pipeline("opaque")?, pipeline("tested")?], stages),
            colors: resources.image(&full(COLORS)),
            depth: resources.image(&full(DEPTH)),
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
            shading: choices.shading,
            textures,
        })
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

    /// Draws and shades every layer: what of it is in the frame. `maps`: the barrier of the shadow maps.
    pub fn record(
        &self,
        cmd: &mut Commands,
        drawn: Drawn<'_>,
        bound: &[(&'static str, Bound<'_>)],
        maps: Option<Barrier>,
        counters: &Buffer,
    ) -> Result<()> {
        let description = self.colors.description;
        let [textures_read, textures_written] =
            self.textures.as_ref().map_or([0; 2], |textures| textures.traffic(drawn));
        let traffic = Traffic {
            read_bytes: u64::from(description.layers()) * mesh::read_bytes(drawn.scene, drawn.list.calls())
                + textures_read,
            written_bytes: description.bytes() + self.depth.description.bytes() + textures_written,
            invocations: None,
        };
        cmd.pass(&full(self.shading.pass()), traffic, |cmd| {
            cmd.barriers(maps);
            cmd.barriers([self.colors.discard(Access::ColorWrite), self.depth.discard(Access::DepthWrite)]);
            begin_counters(cmd, counters);
            let mut bound = bound.to_vec();
            bound.push(("Counters", Bound::Buffer(counters)));
            if let Some(textures) = &self.textures {
                return textures.record(cmd, drawn, &bound, &self.sample, |cmd, lists, is_first| {
                    if !is_first {
                        // What was drawn before is tested and kept.
                        let attached = [
                            self.colors.from(Access::ColorWrite).to(Access::ColorWrite),
                            self.depth.from(Access::DepthWrite).to(Access::DepthWrite),
                        ];
                        cmd.barriers(attached);
                    }
                    self.draw(cmd, drawn, lists, is_first);
                });
            }
            let sets = self.sample.sets(cmd, &bound)?;
            self.draw(cmd, drawn, &[(drawn.list, &sets)], true);
            Ok(())
        })
    }

    /// Each of `lists` with its sets into every layer, which begins empty where they are the first.
    fn draw(&self, cmd: &mut Commands, drawn: Drawn<'_>, lists: &[(&DrawList, &Sets)], is_first: bool) {
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
                    cmd.set_scissor([0, 0], drawn.table.inside(drawn.frame, layer));
                    layer
                }
            };
            for (list, sets) in lists {
                let repeats = repeat_frame::repeats(first_tuple);
                self.sample.draw(cmd, Drawn { list, ..drawn }, sets, &repeats);
            }
            cmd.end_rendering();
        }
    }
}

fn pipeline(
    gpu: &Arc<Gpu>,
    scene: &SceneGpu,
    choices: &Choices,
    stages: &Stages,
    fragment: &'static Shader,
) -> Result<GraphicsPipeline> {
    let constants = super::constants_of(choices, &[Some(stages.vertex), stages.geometry, Some(fragment)]);
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
            blending: Blending::Replace,
            depth_format: Some(DEPTH_FORMAT),
            depth_write: true,
            depth_compare: vk::CompareOp::GREATER,
            depth_clamp: false,
            depth_slope_bias: 0.0,
            conservative_margin_px: None,
            stencil: None,
            foreign_sets: &[scene.material_layout],
        },
    )
}
