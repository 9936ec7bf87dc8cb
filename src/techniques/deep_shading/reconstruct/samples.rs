//! What the reconstruction reads of each sample: its colour, circle of confusion, motion and depth (Clarberg & Munkberg 2014,
//! section 4.5, keep the last two). Shader: samples.comp.
//! reads   the scene, the tuples, visibility.spids, shade.colors, lists.addresses or the lists
//! writes  reconstruct.samples.colors and reconstruct.samples.vectors: buffers, 8 B a sample each
//!
//! Differs from the paper: visibility leaves no motion vectors; a SPID and a tuple determine them, whichever pass found
//! the SPID.

use super::super::primitives::Primitives;
use super::super::ranges;
use super::super::sample_colors::SampleColors;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::reconstruct::samples::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Traffic};
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::reconstruct::filter_buffers::{FilterBuffers, RANGES};
use crate::techniques::deep_shading::resources::full;
use crate::units::Extent;
use std::sync::Arc;

pub const PASS: &str = "reconstruct.samples";

pub struct Gather {
    pipeline: ComputePipeline,
    ranges: Buffer,
}

impl Gather {
    /// `fetch`: how colours are found, as the resolve has it.
    ///
    /// Errors: memory for the upload (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        scene: &SceneGpu,
        primitives: &Primitives,
        choices: &Choices,
        fetch: &str,
    ) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[fetch]);
        let constants = constants_of(choices, &[Some(shader)]);
        let mut calls = scene.calls.clone();
        // As ids count them.
        calls.sort_by_key(|call| call.draw);
        let buffer = resources.buffer(&full(RANGES));
        let id = |draw, first_index| primitives.id(draw, first_index);
        ranges::write(gpu, &buffer, scene, primitives, calls.iter(), id, Access::ComputeRead)?;
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)?, ranges: buffer })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        shaded: SampleColors<'_>,
        buffers: &FilterBuffers,
        frame: Extent,
    ) -> Result<()> {
        let traffic = Traffic {
            read_bytes: shaded.bytes(),
            written_bytes: buffers.sample_bytes(),
            invocations: Some(frame.pixel_count()),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers(shaded.to_compute());
            let FilterBuffers { colors, vectors, .. } = buffers;
            cmd.barriers([colors, vectors].map(|buffer| buffer.discard(Access::ComputeWrite)));
            let mut bound = bound.to_vec();
            bound.extend(shaded.bound());
            bound.extend(buffers.bound());
            bound.push(("DrawnRanges", Bound::Buffer(&self.ranges)));
            let groups = self.pipeline.groups([frame.width, frame.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
