//! Visibility: which triangle each sample sees, and where it is in shading space (Clarberg & Munkberg 2014, section 4.2).
//! reads   the scene, the tuples
//! writes  visibility.spids, visibility.depth and, with `--zmax on`, visibility.shading_depths: arrays of a layer a tuple,
//!         of a table's part of the frame: 8, 4 and 4 B a sample
//!
//! The paper's four interleaved orders: within a layer draws come in one order in all of them, so that they see the same samples.
//! `ray` asks the host. `stochastic` draws a polygon around each triangle's blur, whose samples a shader tests: as `repeat-frame` does
//! layer by layer, or once for all samples (looped.rs), with neither images of depth nor of several samples.

pub(super) mod draw;
pub mod instancing;
pub mod layer;
pub mod looped;
pub mod polygon;
pub mod ray;
pub mod repeat_draw;
pub mod repeat_frame;
pub mod replicate;
pub mod sample;
pub(super) mod samples;
pub(super) mod spids;
pub(super) mod stages;
pub mod stochastic;

use super::choices::Choices;
use super::primitives::Primitives;
use crate::error::Result;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Layers, Traffic};
use crate::passes::mesh;
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::pass_inputs::DrawInputs;
use crate::techniques::deep_shading::resources::NAME;
use crate::techniques::deep_shading::visibility::samples::{Samples, begin_counters};
use looped::LoopedSamples;
use sample::TupleDraws;
use std::sync::Arc;

/// What draws triangles.
pub enum SampleRasterizer {
    /// Each tuple into its layer.
    Layers(Box<TupleDraws>),
    /// All samples at once.
    Loop(Box<LoopedSamples>),
}

impl SampleRasterizer {
    /// `primitives`: numbered in the order of what is inputs.
    ///
    /// Errors: memory for uploads (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        primitives: &Primitives,
    ) -> Result<Self> {
        Ok(match choices.raster.is_looped {
            true => Self::Loop(Box::new(LoopedSamples::new(gpu, scene, resources, choices, primitives)?)),
            false => Self::Layers(Box::new(TupleDraws::new(gpu, scene, choices)?)),
        })
    }

    fn traffic(&self, cmd: &Commands, inputs: DrawInputs<'_>, samples: &Samples, visibility: Visibility) -> Traffic {
        let layers = samples.spids.description.layers();
        let [read, written] = match self {
            Self::Loop(looped) => looped.traffic_bytes(inputs),
            Self::Layers(_) => {
                let repeats = visibility.repeats(inputs.scene, &cmd.gpu().caps.limits, layers);
                let rounds = visibility.round_count(&repeats, layers);
                [u64::from(rounds) * mesh::read_bytes(inputs.scene, inputs.list.calls()), 0]
            }
        };
        // Holes are looked up in textures.
        let read_bytes = inputs.list.mask.is_empty().then_some(read);
        Traffic { read_bytes, written_bytes: Some(samples.bytes() + written), invocations: None }
    }
}

/// Finds what every sample sees: what of each layer is in the frame.
pub fn record(
    cmd: &mut Commands,
    rasterizer: &SampleRasterizer,
    inputs: DrawInputs<'_>,
    samples: &Samples,
    counters: &Buffer,
    visibility: Visibility,
) -> Result<()> {
    let traffic = rasterizer.traffic(cmd, inputs, samples, visibility);
    cmd.pass(&format!("{NAME}.visibility"), traffic, |cmd| {
        cmd.barriers(samples.colors().map(|image| image.discard(Access::ColorWrite)));
        cmd.barriers(samples.depth.iter().map(|depth| depth.discard(Access::DepthWrite)));
        cmd.barriers(inputs.scales_to(Access::GraphicsRead));
        begin_counters(cmd, counters);
        let mut bound = inputs.bound.to_vec();
        bound.push(("Counters", Bound::Buffer(counters)));
        let tuple_draws = match rasterizer {
            SampleRasterizer::Loop(looped) => return looped.record(cmd, inputs, bound, samples),
            SampleRasterizer::Layers(tuple_draws) => tuple_draws,
        };
        let layers = samples.spids.description.layers();
        let repeats = visibility.repeats(inputs.scene, &cmd.gpu().caps.limits, layers);
        let sets = tuple_draws.sets(cmd, &bound)?;
        visibility.for_layers(&repeats, layers, |at, repeats| {
            samples.begin(cmd, at);
            if let Layers::One(tuple) = at {
                cmd.set_scissor([0, 0], inputs.table.inside(inputs.frame, tuple));
            }
            tuple_draws.draw(cmd, inputs, &sets, repeats);
            cmd.end_rendering();
        });
        Ok(())
    })
}
