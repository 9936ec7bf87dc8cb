//! Block translation, the second pass of two: Segovia 2006, section 3.3. Shader: translate.comp.
//! reads   split.blocks.position, .normal, .color      writes  split.position, split.normal, split.color

use super::super::choices::Choices;
use super::super::split_method::{Copies, Form};
use super::super::sub_buffers::Surface;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::split::translate::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Commands, Edge, Gpu};
use crate::techniques::interleaved_deferred::resources::NAME;
use crate::techniques::interleaved_deferred::split::from_frame::{copied, product};
use std::sync::Arc;

pub struct SplitTranslate {
    pipeline: ComputePipeline,
    copies: Copies,
}

impl SplitTranslate {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, copies: Copies) -> Result<Self> {
        let axes =
            [choices.shading.position.name(), copies.storage.name(), copies.form.name(), choices.moved.color_name()];
        let shader = variant(COMP_VARIANTS, &axes);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &choices.shading.workgroup_constants())?, copies })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        blocks: Edge<'_, Surface>,
        split: &Surface,
    ) -> Result<()> {
        let threads = match self.copies.form {
            Form::Pull => self.copies.sub_buffer_threads(mapping),
            Form::Push => self.copies.padded_threads(mapping),
        };
        let traffic = copied(mapping, [split.texel_bytes; 2], product(threads));
        cmd.pass(&format!("{NAME}.split.translate"), traffic, |cmd| {
            cmd.barriers(blocks.to(split.parts, self.copies.storage.read(self.copies.stage())));
            cmd.barriers(split.discard(Access::ComputeWrite));
            let bound: Vec<_> = blocks.resource.source(split.parts).chain(split.target()).collect();
            cmd.dispatch(&self.pipeline, bytemuck::bytes_of(mapping), &bound, self.pipeline.groups(threads))
        })
    }
}
