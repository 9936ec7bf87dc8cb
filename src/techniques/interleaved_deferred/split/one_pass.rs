//! One-pass split: Segovia 2006, section 3.2. Shader: one_pass.comp. With layers as storage it is `--split layered`.
//! reads   gbuffer.position, gbuffer.normal, gbuffer.color where it is moved
//! writes  split.position  sub-buffers, 4, 8 or 16 B a texel      split.normal, split.color  sub-buffers, 8 B a texel each

use super::super::choices::Choices;
use super::super::split_method::{Copies, Form};
use super::super::sub_buffers::Surface;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::split::one_pass::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Commands, Edge, Gpu};
use crate::passes::gbuffer::GBuffer;
use crate::techniques::interleaved_deferred::split::from_frame::FromFrame;
use std::sync::Arc;

pub struct SplitOnePass {
    pipeline: ComputePipeline,
    copies: Copies,
}

impl SplitOnePass {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, copies: Copies) -> Result<Self> {
        let axes =
            [choices.shading.position.name(), copies.storage.name(), copies.form.name(), choices.moved.color_name()];
        let shader = variant(COMP_VARIANTS, &axes);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &choices.split_constants())?, copies })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        split: &Surface,
    ) -> Result<()> {
        let threads = match self.copies.form {
            Form::Pull => {
                // Sub-buffers before rows: as the shader has them.
                let [x, y, z] = self.copies.sub_buffer_threads(mapping);
                [x, z, y]
            }
            Form::Push => self.copies.padded_threads(mapping),
        };
        FromFrame::over("split", &self.pipeline, threads).record(cmd, mapping, gbuffer, split)
    }
}
