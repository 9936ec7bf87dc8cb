//! Next run: the pass between runs of a frame that go in one submit. Shader: next_run.comp.
//! reads and writes  the frame's block

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::passes::next_run::COMP;
use crate::gpu::{Bound, Buffer, Commands, Gpu};
use std::sync::Arc;

pub struct NextRun {
    pipeline: ComputePipeline,
}

impl NextRun {
    pub fn new(gpu: &Arc<Gpu>) -> Result<Self> {
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &[])? })
    }

    /// After the last pass. `block`: the frame's, whose `sample_index` is one more then.
    pub fn record(&self, cmd: &mut Commands, block: &Buffer) -> Result<()> {
        cmd.wait_for_all();
        cmd.dispatch(&self.pipeline, &[], &[("Frame", Bound::Buffer(block))], [1, 1, 1])?;
        // A frame's first barriers take it for granted that the run before has ended.
        cmd.wait_for_all();
        Ok(())
    }
}
