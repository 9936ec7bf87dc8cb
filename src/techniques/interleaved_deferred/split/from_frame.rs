//! Where splitting reads: the frame, or another order of sub-buffers.

use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::{Access, Commands, Edge, Traffic};
use crate::passes::gbuffer::GBuffer;
use crate::techniques::interleaved_deferred::resources::NAME;
use crate::techniques::interleaved_deferred::sub_buffers::Surface;

/// Bytes of a copy by a compute shader, padding included: the frame's nearest pixel is read for it. `texel_bytes`: read and
/// written.
pub fn copied(mapping: &MappingParams, texel_bytes: [u64; 2], invocations: u64) -> Traffic {
    let [read_bytes, written_bytes] = texel_bytes.map(|bytes| mapping.texel_count() * bytes);
    Traffic { read_bytes: Some(read_bytes), written_bytes: Some(written_bytes), invocations: Some(invocations) }
}

/// A compute shader from the G-buffer, dispatched.
pub struct FromFrame<'a> {
    /// Without the technique.
    pub(super) pass: &'a str,
    pub(super) pipeline: &'a ComputePipeline,
    pub(super) groups: [u32; 3],
    /// Those that do work.
    pub(super) invocations: u64,
}

impl<'a> FromFrame<'a> {
    /// One thread for each place of `threads`.
    pub(super) fn over(pass: &'a str, pipeline: &'a ComputePipeline, threads: [u32; 3]) -> Self {
        Self { pass, pipeline, groups: pipeline.groups(threads), invocations: product(threads) }
    }

    pub(super) fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        target: &Surface,
    ) -> Result<()> {
        let texel_bytes = [gbuffer.resource.parts_bytes(target.parts), target.texel_bytes];
        let traffic = copied(mapping, texel_bytes, self.invocations);
        cmd.pass(&format!("{NAME}.{}", self.pass), traffic, |cmd| {
            cmd.barriers(gbuffer.parts_to(target.parts, Access::ComputeSample));
            cmd.barriers(target.discard(Access::ComputeWrite));
            let mut bound = gbuffer.resource.bound_parts(target.parts);
            bound.extend(target.target());
            cmd.dispatch(self.pipeline, bytemuck::bytes_of(mapping), &bound, self.groups)
        })
    }
}

/// How many threads there are.
pub fn product(threads: [u32; 3]) -> u64 {
    threads.iter().map(|side| u64::from(*side)).product()
}
