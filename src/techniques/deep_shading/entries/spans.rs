//! Room of the order for each material: between both steps of the sort. Shader: spans.comp.
//! reads and writes  entries.spans

use crate::error::Result;
use crate::gpu::Gpu;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::EntrySpanBlock;
use crate::gpu::shader::techniques::deep_shading::entries::spans::COMP;
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use std::sync::Arc;

pub const SPANS: &str = "entries.spans";

/// Bytes of a material's.
pub const BYTES: u64 = size_of::<EntrySpanBlock>() as u64;

/// A thread for each of `materials`.
pub(super) fn pipeline(gpu: &Arc<Gpu>, choices: &Choices, materials: usize) -> Result<ComputePipeline> {
    let mut constants = constants_of(choices, &[Some(&COMP)]);
    constants.push(("MATERIAL_COUNT", materials as u32));
    ComputePipeline::new(gpu, &COMP, &constants)
}
