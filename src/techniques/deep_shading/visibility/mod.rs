//! Visibility: which triangle each sample sees, and where it is in shading space (Clarberg & Munkberg 2014, section 4.2).
//! reads   the scene, the tuples
//! writes  visibility.spids, visibility.depth and, with `--zmax on`, visibility.shading_depths: arrays of a layer a tuple,
//!         of a table's part of the frame: 8, 4 and 4 B a sample
//!
//! The paper's four interleaved orders: within a layer draws come in one order in all of them, so that they see the same samples.
//! `ray` asks the host. `stochastic` draws a polygon around each triangle's blur, whose samples a shader tests: as `repeat-frame` does
//! layer by layer, or once for all samples (looped.rs), with neither images of depth nor of several samples.

pub mod instancing;
pub mod layer;
pub mod looped;
pub mod polygon;
pub mod ray;
pub mod repeat_draw;
pub mod repeat_frame;
pub mod replicate;
pub mod sample;
mod spids;
pub mod stochastic;

use super::choices::Choices;
use super::plan::{DEPTH, SHADING_DEPTHS, SPIDS};
use super::primitives::Primitives;
use super::tuples::Table;
use super::{NAME, full};
use crate::error::Result;
use crate::gpu::caps::Limits;
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Gpu, Image, Layers, Traffic};
use crate::passes::mesh;
use crate::plan::Resources;
use crate::resident::{DrawList, SceneGpu};
use crate::settings::Values;
use crate::units::Extent;
use ash::vk;
use looped::Looped;
use sample::{Repeats, Sample, Stages};
use std::sync::Arc;

/// Shape in which triangles are drawn, and order of tuples and draws (`--visibility`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    RepeatFrame,
    RepeatDraw,
    Instancing,
    Replicate,
    Stochastic,
    Ray,
}

impl Visibility {
    pub fn of(values: &Values) -> Self {
        match values.text("visibility") {
            "repeat-draw" => Self::RepeatDraw,
            "instancing" => Self::Instancing,
            "replicate" => Self::Replicate,
            "stochastic" => Self::Stochastic,
            "ray" => Self::Ray,
            _ => Self::RepeatFrame,
        }
    }

    /// Whether all layers are drawn into at once.
    pub fn is_layered(self) -> bool {
        matches!(self, Self::RepeatDraw | Self::Instancing | Self::Replicate)
    }

    /// Whether later passes redraw polygons around triangles, and find samples by the triangle that they see.
    pub fn has_polygons(self) -> bool {
        matches!(self, Self::Stochastic | Self::Ray)
    }

    /// How samples come into their layers.
    pub fn writes(self) -> Access {
        if self == Self::Ray { Access::TransferWrite } else { Access::ColorWrite }
    }

    /// Whether some stage must write `gl_Layer`, so that `--layer-from` chooses which.
    pub fn has_layer_from(self) -> bool {
        matches!(self, Self::RepeatDraw | Self::Instancing)
    }

    /// How each draw call is repeated for its tuples; where layers are drawn one by one, the repeats of the first.
    pub fn repeats(self, scene: &SceneGpu, limits: &Limits, tuple_count: u32) -> Repeats {
        match self {
            Self::RepeatFrame | Self::Stochastic | Self::Ray => repeat_frame::repeats(0),
            Self::RepeatDraw => repeat_draw::repeats(tuple_count),
            Self::Instancing => instancing::repeats(tuple_count),
            Self::Replicate => replicate::repeats(scene, limits, tuple_count),
        }
    }

    /// How often the vertices of a draw call are fetched.
    pub fn round_count(self, repeats: &Repeats, layer_count: u32) -> u32 {
        if self.is_layered() { repeats.round_count() } else { layer_count }
    }

    /// Calls `draw` with the layers to open, one after the other or all together, and how calls repeat in them.
    pub fn for_layers(self, repeats: &Repeats, layer_count: u32, mut draw: impl FnMut(Layers, &Repeats)) {
        if self.is_layered() {
            draw(Layers::All(layer_count), repeats);
        } else {
            (0..layer_count).for_each(|tuple| draw(Layers::One(tuple), &repeat_frame::repeats(tuple)));
        }
    }
}

/// Before fragments: whatever draws the samples' triangles again needs the same stages, as drivers may round otherwise after a
/// geometry shader. `repeats`: of the same visibility.
pub fn stages(scene: &SceneGpu, choices: &Choices, repeats: &Repeats) -> Stages {
    match choices.visibility {
        Visibility::RepeatFrame => Stages::sharp(sample::vertex_shader(scene, repeats, "none"), None),
        Visibility::RepeatDraw | Visibility::Instancing => choices.layer_from.stages(scene, repeats),
        Visibility::Replicate => replicate::stages(scene, repeats),
        Visibility::Stochastic | Visibility::Ray => stochastic::stages(choices, "layer"),
    }
}

/// One entry a sample.
pub struct Samples {
    pub spids: Image,
    /// Depth buffer of rasterised samples.
    pub depth: Option<Image>,
    /// How SPIDs and depths at shading points were written.
    pub written: Access,
    /// With `--zmax on`.
    shading_depths: Option<Image>,
    /// Texels are fetched: it only has to be there.
    nearest: Sampler,
}

impl Samples {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        Ok(Self {
            spids: resources.image(&full(SPIDS)),
            depth: choices.has_depth().then(|| resources.image(&full(DEPTH))),
            written: choices.visibility.writes(),
            shading_depths: choices.has_zmax.then(|| resources.image(&full(SHADING_DEPTHS))),
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
        })
    }

    pub fn sampled<'a>(&'a self, image: &'a Image, access: Access) -> Bound<'a> {
        Bound::Sampled(image, self.nearest.handle, access)
    }

    pub fn shading_depths(&self) -> Option<&Image> {
        self.shading_depths.as_ref()
    }

    fn bytes(&self) -> u64 {
        let images = [Some(&self.spids), self.depth.as_ref(), self.shading_depths.as_ref()];
        images.into_iter().flatten().map(|image| image.description.bytes()).sum()
    }

    fn colors(&self) -> impl Iterator<Item = &Image> {
        std::iter::once(&self.spids).chain(self.shading_depths())
    }

    /// Opens rendering into `layers`, and clears them.
    fn begin(&self, cmd: &mut Commands, layers: Layers) {
        // No triangle; and the depth of nothing, which no list hears of.
        let cleared = Some(vk::ClearColorValue { uint32: [u32::MAX; 4] });
        let targets: Vec<_> = self.colors().map(|image| ColorTarget::new(image, cleared)).collect();
        let depth = self.depth.as_ref().map(|depth| (depth, Some(0.0), Access::DepthWrite));
        cmd.begin_layers(self.spids.description.extent, layers, &targets, depth);
    }
}

/// What is drawn, and where.
#[derive(Clone, Copy)]
pub struct Drawn<'a> {
    pub scene: &'a SceneGpu,
    pub list: &'a DrawList,
    pub primitives: &'a Primitives,
    pub table: &'a Table,
    pub frame: Extent,
}

/// Sets the counters of a frame to 0, for shaders of fragments to count on.
pub fn begin_counters(cmd: &mut Commands, counters: &Buffer) {
    cmd.barriers([counters.discard(Access::TransferWrite)]);
    cmd.clear(counters);
    cmd.barriers([counters.from(Access::TransferWrite).to(Access::FragmentWrite)]);
}

/// What draws triangles.
pub enum Drawer {
    /// Each tuple into its layer.
    Layers(Box<Sample>),
    /// All samples at once.
    Loop(Box<Looped>),
}

impl Drawer {
    /// `primitives`: numbered in the order of what is drawn.
    ///
    /// Errors: memory for uploads (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        primitives: &Primitives,
    ) -> Result<Self> {
        Ok(match choices.is_looped {
            true => Self::Loop(Box::new(Looped::new(gpu, scene, resources, choices, primitives)?)),
            false => Self::Layers(Box::new(Sample::new(gpu, scene, choices)?)),
        })
    }

    fn traffic(&self, cmd: &Commands, drawn: Drawn<'_>, samples: &Samples, visibility: Visibility) -> Traffic {
        let layers = samples.spids.description.layers();
        let [read, written] = match self {
            Self::Loop(looped) => looped.traffic_bytes(drawn),
            Self::Layers(_) => {
                let repeats = visibility.repeats(drawn.scene, &cmd.gpu().caps.limits, layers);
                let rounds = visibility.round_count(&repeats, layers);
                [u64::from(rounds) * mesh::read_bytes(drawn.scene, drawn.list.calls()), 0]
            }
        };
        Traffic { read_bytes: read, written_bytes: samples.bytes() + written, invocations: None }
    }
}

/// Finds what every sample sees: what of each layer is in the frame.
pub fn record(
    cmd: &mut Commands,
    drawer: &Drawer,
    drawn: Drawn<'_>,
    bound: &[(&'static str, Bound<'_>)],
    samples: &Samples,
    counters: &Buffer,
    visibility: Visibility,
) -> Result<()> {
    let traffic = drawer.traffic(cmd, drawn, samples, visibility);
    cmd.pass(&format!("{NAME}.visibility"), traffic, |cmd| {
        cmd.barriers(samples.colors().map(|image| image.discard(Access::ColorWrite)));
        cmd.barriers(samples.depth.iter().map(|depth| depth.discard(Access::DepthWrite)));
        begin_counters(cmd, counters);
        let mut bound = bound.to_vec();
        bound.push(("Counters", Bound::Buffer(counters)));
        let sample = match drawer {
            Drawer::Loop(looped) => return looped.record(cmd, drawn, bound, samples),
            Drawer::Layers(sample) => sample,
        };
        let layers = samples.spids.description.layers();
        let repeats = visibility.repeats(drawn.scene, &cmd.gpu().caps.limits, layers);
        let sets = sample.sets(cmd, &bound)?;
        visibility.for_layers(&repeats, layers, |at, repeats| {
            samples.begin(cmd, at);
            if let Layers::One(tuple) = at {
                cmd.set_scissor([0, 0], drawn.table.inside(drawn.frame, tuple));
            }
            sample.draw(cmd, drawn, &sets, repeats);
            cmd.end_rendering();
        });
        Ok(())
    })
}
