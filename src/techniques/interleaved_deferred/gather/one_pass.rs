//! Gather in one pass: Segovia 2006, section 3.4 without its blocks. Shader: one_pass.comp.
//! reads  shade.irradiance  sub-buffers      writes  gather.irradiance  buffer, frame order, 8 B a pixel

use super::super::choices::Choices;
use super::super::split_method::{Copies, Form};
use super::super::sub_buffers::Texels;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::gather::one_pass::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu};
use crate::techniques::interleaved_deferred::gather::traffic::to_frame;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

pub struct GatherOnePass {
    pipeline: ComputePipeline,
    copies: Copies,
}

impl GatherOnePass {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, copies: Copies) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[copies.storage.name(), copies.form.name()]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &choices.shading.workgroup_constants())?, copies })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Texels>,
        irradiance: &Buffer,
    ) -> Result<()> {
        let threads = match self.copies.form {
            Form::Pull => Copies::frame_threads(mapping),
            Form::Push => self.copies.sub_buffer_threads(mapping),
        };
        let traffic = to_frame(mapping, self.copies.form == Form::Pull, threads);
        cmd.pass(&format!("{NAME}.gather"), traffic, |cmd| {
            let read = self.copies.storage.read(self.copies.stage());
            cmd.barriers([source.to(read), irradiance.discard(Access::ComputeWrite)]);
            let bound = [("source_irradiance", source.resource.source()), ("irradiance", Bound::Buffer(irradiance))];
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(mapping), &bound, self.pipeline.groups(threads))
        })
    }
}
