//! Block translation back, the first pass of two: Segovia 2006, section 3.4. Shader: translate.comp.
//! reads  shade.irradiance  sub-buffers      writes  gather.blocks.irradiance  block layout, 8 B a texel

use super::super::choices::Choices;
use super::super::split_method::{Copies, Form};
use super::super::sub_buffers::Texels;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::gather::translate::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Commands, Edge, Gpu};
use crate::techniques::interleaved_deferred::gather::traffic::moved;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct GatherTranslate {
    pipeline: ComputePipeline,
    copies: Copies,
}

impl GatherTranslate {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, copies: Copies) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[copies.storage.name(), copies.form.name()]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &choices.shading.workgroup_constants())?, copies })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Texels>,
        blocks: &Texels,
    ) -> Result<()> {
        let threads = match self.copies.form {
            Form::Pull => self.copies.padded_threads(mapping),
            Form::Push => self.copies.sub_buffer_threads(mapping),
        };
        let traffic = moved(mapping.texel_count(), mapping.texel_count(), threads);
        cmd.pass(&format!("{NAME}.gather.translate"), traffic, |cmd| {
            let read = self.copies.storage.read(self.copies.stage());
            cmd.barriers([source.to(read), blocks.discard(Access::ComputeWrite)]);
            let bound = [("source_irradiance", source.resource.source()), ("target_irradiance", blocks.target())];
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(mapping), &bound, self.pipeline.groups(threads))
        })
    }
}
