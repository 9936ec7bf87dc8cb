//! Stochastic rasterisation over all samples at once (`--sample-tests loop`): a polygon around a triangle's blur is drawn once over
//! the frame, and its fragments test the samples of their pixel in a loop, as the paper's do (Clarberg & Munkberg 2014, section
//! 4.2). The nearest triangle of each sample is the greatest of 64 bits of depth and draw, kept by atomics, from which spids.rs
//! makes SPIDs. Shaders: stochastic.vert, polygon.geom, bound.glsl, looped.frag, nearest.glsl.
//! reads   the scene, the tuples
//! writes  visibility.nearest: buffer, 8 B a sample
//!
//! Differs from the paper: pixels have as many samples as `--spp` says, whatever images of several samples the device has.
//!
//! Sees what a layer a tuple sees (`--sample-tests layers`), to the bit, at a vertex's work once instead of once a tuple.

use super::super::choices::Choices;
use super::super::primitives::Primitives;
use super::super::tuples::TupleTable;
use super::sample::TupleDraws;
use super::spids::Spids;
use super::stochastic;
use crate::caps::Limits;
use crate::error::{Error, Result};
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::visibility::looped::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu};
use crate::passes::{fullscreen, mesh};
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::pass_inputs::DrawInputs;
use crate::techniques::deep_shading::resources::{NAME, NEAREST_BYTES, full};
use crate::techniques::deep_shading::visibility::draw::Repeats;
use crate::techniques::deep_shading::visibility::samples::Samples;
use std::sync::Arc;

const NEAREST: &str = "visibility.nearest";

/// Errors: the device does not bind the buffer (exit code 4).
pub fn require_fitting(samples: u64, limits: &Limits) -> Result<()> {
    let (bytes, most) = (samples * NEAREST_BYTES, limits.max_storage_buffer_range_bytes);
    if bytes <= most {
        return Ok(());
    }
    Err(Error::memory(format!(
        "--sample-tests loop: {samples} samples take a buffer of {bytes} bytes, and this device binds {most} at once"
    ))
    .within(NAME)
    .note("--sample-tests layers needs none"))
}

/// `draws` of the scene.
pub fn plan(plan: &mut Plan, samples: u64, draws: u64) {
    plan.buffer("frame_buffer", full(NEAREST), samples * NEAREST_BYTES);
    super::spids::plan(plan, draws);
}

/// How the buffer is touched.
pub fn touches() -> [(String, Access); 3] {
    [Access::TransferWrite, Access::FragmentWrite, Access::GraphicsRead].map(|access| (full(NEAREST), access))
}

pub struct LoopedSamples {
    tuple_draws: TupleDraws,
    nearest: Buffer,
    spids: Spids,
    table: TupleTable,
}

impl LoopedSamples {
    /// `primitives`: numbered in the order of what is inputs.
    ///
    /// Errors: memory for the upload (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        primitives: &Primitives,
    ) -> Result<Self> {
        let stages = stochastic::stages(choices, "loop");
        let pipeline = |alpha| {
            let fragment = variant(FRAG_VARIANTS, &[alpha, mesh::vertex_name(scene), choices.count_axis()]);
            let constants = constants_of(choices, &[Some(stages.vertex), stages.geometry, Some(fragment)]);
            let description = GraphicsDescription {
                vertex: stages.vertex,
                geometry: stages.geometry,
                constants: &constants,
                foreign_sets: &[scene.material_layout],
                // Nothing is attached, and nothing tested but by the shader.
                ..fullscreen::description(fragment, &[])
            };
            GraphicsPipeline::new(gpu, &description)
        };
        Ok(Self {
            tuple_draws: TupleDraws::of([pipeline("opaque")?, pipeline("tested")?], stages),
            nearest: resources.buffer(&full(NEAREST)),
            spids: Spids::new(gpu, scene, resources, choices, primitives)?,
            table: choices.table,
        })
    }

    /// Bytes read of vertices, and all that is written on the way.
    pub(super) fn traffic_bytes(&self, inputs: DrawInputs<'_>) -> [u64; 2] {
        let vertices = u64::from(self.table.eyes) * mesh::read_bytes(inputs.scene, inputs.list.calls());
        [vertices + self.nearest.bytes, self.nearest.bytes]
    }

    /// After `begin_counters`.
    pub(super) fn record<'a>(
        &'a self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        mut bound: Vec<(&'static str, Bound<'a>)>,
        samples: &Samples,
    ) -> Result<()> {
        cmd.barriers([self.nearest.discard(Access::TransferWrite)]);
        cmd.clear(&self.nearest);
        cmd.barriers([self.nearest.from(Access::TransferWrite).to(Access::FragmentWrite)]);
        bound.push(("Nearest", Bound::Buffer(&self.nearest)));
        let sets = self.tuple_draws.sets(cmd, &bound)?;
        cmd.begin_rendering(inputs.frame, &[], None);
        let step = self.table.tuples_of_eye();
        let eyes = Repeats { tuples: 0..self.table.tuple_count(), step, instance_count: 1 };
        self.tuple_draws.draw(cmd, inputs, &sets, &eyes);
        cmd.end_rendering();
        cmd.barriers([self.nearest.from(Access::FragmentWrite).to(Access::GraphicsRead)]);
        self.spids.record(cmd, inputs, &bound, samples)
    }
}
