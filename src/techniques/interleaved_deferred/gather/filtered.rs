//! Gather and the filter's walk along the rows in one pass (`--fuse on`): a buffer less is written and read. Segovia 2006,
//! sections 3.4 and 4.5. Shader: filtered.comp.
//! reads  shade.irradiance  sub-buffers, discontinuity.flags      writes  filter.rows  buffer, frame order, 8 B a pixel

use super::super::choices::Choices;
use super::super::split_method::Copies;
use super::super::sub_buffers::{Stage, Texels};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::{GatherFilteredParams, MappingParams};
use crate::gpu::shader::techniques::interleaved_deferred::gather::filtered::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::filter::Kernel;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct GatherFiltered {
    pipeline: ComputePipeline,
    kernel: Kernel,
    copies: Copies,
    /// Pixels of a row that a thread filters.
    texels: u32,
}

impl GatherFiltered {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, copies: Copies) -> Result<Self> {
        let Choices { shading, kernel, .. } = choices;
        let shader = variant(COMP_VARIANTS, &[copies.storage.name()]);
        let texels = shading.texels.of_filter();
        let constants = [&shading.workgroup_constants()[..], &[("TEXELS", texels)], &kernel.constants()].concat();
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)?, kernel: *kernel, copies, texels })
    }

    /// `flags`: where walks end.
    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Texels>,
        flags: Edge<'_, Buffer>,
        rows: &Buffer,
    ) -> Result<()> {
        let threads = [mapping.width_px.div_ceil(self.texels), mapping.height_px, 1];
        let thread_count = u64::from(threads[0]) * u64::from(threads[1]);
        let window = u64::from(self.texels + 2 * self.kernel.radius());
        let traffic = Traffic {
            read_bytes: Some(thread_count * window * (8 + 4)),
            written_bytes: Some(mapping.extent().pixel_count() * 8),
            invocations: Some(thread_count),
        };
        cmd.pass(&format!("{NAME}.gather"), traffic, |cmd| {
            cmd.barriers([
                source.to(self.copies.storage.read(Stage::Compute)),
                flags.to(Access::ComputeRead),
                rows.discard(Access::ComputeWrite),
            ]);
            let params = GatherFilteredParams { walk: self.kernel.walk(true), mapping: *mapping };
            let bound = [
                ("source_irradiance", source.resource.source()),
                ("Flags", Bound::Buffer(flags.resource)),
                ("Rows", Bound::Buffer(rows)),
            ];
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &bound, self.pipeline.groups(threads))
        })
    }
}
