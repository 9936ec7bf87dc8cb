//! Each subset over the un-split G-buffer at the pattern's stride: no copy. Shader: strided.comp.
//! reads  the G-buffer, the lights      writes  the irradiance  buffer, frame order, 8 B a pixel
//!
//! `--split indirect` dispatches once a subset (Segovia 2006, section 3.1, bound by memory latency there); `--split
//! remap` once for all, with workgroups numbered so that each shades one subset; at a pattern of 1x1 it is plain deferred
//! shading of all lights (`--split none`).

use super::super::choices::Choices;
use super::{ShadeGpu, TexelListPipeline};
use crate::error::Result;
use crate::gpu::shader::structs::ShadeParams;
use crate::gpu::shader::techniques::interleaved_deferred::shade::strided::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::GBuffer;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

/// How many subsets a dispatch shades.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dispatches {
    One,
    PerSubset,
}

pub struct ShadeStrided {
    listed: TexelListPipeline,
    dispatches: Dispatches,
}

impl ShadeStrided {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, dispatches: Dispatches) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &choices.shade_axes());
        Ok(Self { listed: TexelListPipeline::new(gpu, choices, shader)?, dispatches })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        shade: &ShadeGpu,
        direct: &DirectGpu,
        gbuffer: Edge<'_, GBuffer>,
        irradiance: &Buffer,
    ) -> Result<()> {
        let mapping = shade.mapping();
        let pixels = gbuffer.resource.extent().pixel_count();
        let threads = self.listed.invocations(mapping.subset_count());
        let light_bytes = shade.read_bytes(direct, mapping.subset_count(), threads, pixels);
        let traffic = Traffic {
            read_bytes: light_bytes.map(|bytes| pixels * gbuffer.resource.parts_bytes(shade.parts) + bytes),
            written_bytes: Some(pixels * 8),
            invocations: Some(threads),
        };
        cmd.pass(&format!("{NAME}.shade"), traffic, |cmd| {
            cmd.barriers(gbuffer.parts_to(shade.parts, Access::ComputeSample));
            cmd.barriers(shade.hidden_to(Access::ComputeRead));
            cmd.barriers([irradiance.discard(Access::ComputeWrite)]);
            let mut bound = shade.bound(frame, direct);
            bound.push(("Irradiance", Bound::Buffer(irradiance)));
            bound.extend(gbuffer.resource.bound_parts(shade.parts));
            let mut dispatch = |subset_first: u32, subset_count: u32| {
                let params = ShadeParams { subset_first, ..shade.params };
                // No barrier between subsets: they write different pixels.
                let groups = [self.listed.workgroup_count, 1, subset_count];
                cmd.dispatch(&self.listed.pipeline, bytemuck::bytes_of(&params), &bound, groups)
            };
            match self.dispatches {
                Dispatches::One => dispatch(0, mapping.subset_count()),
                Dispatches::PerSubset => (0..mapping.subset_count()).try_for_each(|subset| dispatch(subset, 1)),
            }
        })
    }
}
