//! The order in which entries are shaded, and the dispatches that go through it. Shaders' half: order.glsl.

use super::super::pass_inputs::DrawInputs;
use super::super::resources::{ORDER, full};
use super::spans;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::EntryParams;
use crate::gpu::{Access, Bound, Buffer, Commands, DispatchPart};
use crate::plan::Resources;
use bytemuck::Zeroable;
use std::collections::BTreeSet;

/// The order, and each material's part of it.
pub struct EntryOrder {
    pub order: Buffer,
    pub(super) spans: Buffer,
}

impl EntryOrder {
    pub fn new(resources: &mut Resources) -> Self {
        Self { order: resources.buffer(&full(ORDER)), spans: resources.buffer(&full(spans::SPANS)) }
    }

    pub fn bound(&self) -> [(&'static str, Bound<'_>); 2] {
        [("EntryOrder", Bound::Buffer(&self.order)), ("EntrySpans", Bound::Buffer(&self.spans))]
    }

    /// Waits for the sort, and dispatches once for each material of what is drawn. `bound`: all that shaders read and write, the
    /// order excepted.
    pub fn dispatch<'a>(
        &'a self,
        cmd: &mut Commands,
        pipeline: &ComputePipeline,
        DrawInputs { scene, list, .. }: DrawInputs<'_>,
        mut bound: Vec<(&'static str, Bound<'a>)>,
    ) -> Result<()> {
        let sorted = [&self.order, &self.spans].map(|buffer| buffer.from(Access::ComputeWrite));
        cmd.barriers(sorted.map(|edge| edge.to(Access::ComputeRead)));
        cmd.barriers([self.spans.from(Access::ComputeRead).to(Access::IndirectRead)]);
        bound.extend(self.bound());
        let materials: BTreeSet<u32> = list.calls().map(|call| call.material).collect();
        let params: Vec<_> = materials
            .into_iter()
            .map(|index| EntryParams {
                material: scene.material_blocks[index as usize],
                index,
                ..EntryParams::zeroed()
            })
            .collect();
        let parts = params.iter().map(|params| DispatchPart {
            params: bytemuck::bytes_of(params),
            foreign: scene.material_sets[params.index as usize],
            offset: u64::from(params.index) * spans::BYTES,
        });
        cmd.dispatch_parts(pipeline, &pipeline.interface.own(&bound), &self.spans, parts)
    }
}
