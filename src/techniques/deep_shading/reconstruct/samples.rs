//! What the reconstruction reads of each sample: its colour, circle of confusion, motion and depth (Clarberg & Munkberg 2014,
//! section 4.5, keep the last two). Shader: samples.comp.
//! reads   the scene, the tuples, visibility.spids, shade.colors, lists.addresses or the lists
//! writes  reconstruct.samples.colors and reconstruct.samples.vectors: buffers, 8 B a sample each
//!
//! Differs from the paper: visibility leaves no motion vectors; a SPID and a tuple determine them, whichever pass found
//! the SPID.

use super::super::sample_colors::SampleColors;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::reconstruct::samples::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Commands, Gpu, Traffic};
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::reconstruct::filter_buffers::FilterBuffers;
use crate::techniques::deep_shading::resources::full;
use crate::units::Extent;
use std::sync::Arc;

pub const PASS: &str = "reconstruct.samples";

pub struct Gather {
    pipeline: ComputePipeline,
}

impl Gather {
    /// `fetch`: how colours are found, as the resolve has it.
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, fetch: &str) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[fetch]);
        let constants = constants_of(choices, &[Some(shader)]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)? })
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
            read_bytes: Some(shaded.bytes()),
            written_bytes: Some(buffers.sample_bytes()),
            invocations: Some(frame.pixel_count()),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers(shaded.to_compute());
            let FilterBuffers { colors, vectors, .. } = buffers;
            cmd.barriers([colors, vectors].map(|buffer| buffer.discard(Access::ComputeWrite)));
            let mut bound = bound.to_vec();
            bound.extend(shaded.bound());
            bound.extend(buffers.bound());
            let groups = self.pipeline.groups([frame.width, frame.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
