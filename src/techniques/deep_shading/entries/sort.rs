//! Entries sorted by material: counted, given room (spans.rs), and put there. Shader: sort.comp.
//! reads  shade.colors, the scene's draws      writes  entries.order, entries.spans

use super::order::EntryOrder;
use super::spans;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::entries::sort::{
    COLORS_ANYWHERE, COLORS_IN_ROW, COLORS_IN_TWO_ROWS, COMP_VARIANTS,
};
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::techniques::deep_shading::choices::{Choices, constants_of};
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::resources::{COLOR_BYTES, full};
use crate::units::Extent;
use std::sync::Arc;

pub const PASS: &str = "entries";

pub struct Sort {
    count: ComputePipeline,
    spans: ComputePipeline,
    place: ComputePipeline,
    /// As many as places of colours.
    threads: [u32; 3],
    material_count: u32,
}

impl Sort {
    /// `frame`: its extent; `materials` of the scene.
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices, frame: Extent, materials: usize) -> Result<Self> {
        let places = match choices {
            Choices { shading: Shading::IndirectGbuffer, .. } => COLORS_IN_ROW,
            Choices { lists, .. } if lists.is_direct || lists.is_compacted => COLORS_IN_TWO_ROWS,
            _ => COLORS_ANYWHERE,
        };
        let step = |name| {
            let shader = variant(COMP_VARIANTS, &[name]);
            let mut constants = constants_of(choices, &[Some(shader)]);
            constants.push(("COLOR_PLACES", places));
            ComputePipeline::new(gpu, shader, &constants)
        };
        let layer = choices.table.layer(frame);
        Ok(Self {
            count: step("count")?,
            spans: spans::pipeline(gpu, choices, materials)?,
            place: step("place")?,
            threads: [layer.width, layer.height, choices.table.tuple_count()],
            material_count: materials as u32,
        })
    }

    /// Colours' places hold entries that wait; they are only read.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        order: &EntryOrder,
        colors: Edge<'_, Buffer>,
        counters: Edge<'_, Buffer>,
    ) -> Result<()> {
        let places: u64 = self.threads.into_iter().map(u64::from).product();
        let traffic = Traffic {
            // Twice where all places are used.
            read_bytes: Some(2 * places * COLOR_BYTES),
            // Counted after the frame.
            written_bytes: None,
            invocations: Some(2 * places + u64::from(self.material_count)),
        };
        cmd.pass(&full(PASS), traffic, |cmd| {
            cmd.barriers([order.spans.discard(Access::TransferWrite)]);
            cmd.clear(&order.spans);
            let spans = order.spans.from(Access::TransferWrite);
            cmd.barriers([spans.to(Access::ComputeWrite), order.order.discard(Access::ComputeWrite)]);
            cmd.barriers([colors.to(Access::ComputeRead), counters.to(Access::ComputeWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(order.bound());
            bound.extend(
                [("Colors", colors), ("Counters", counters)].map(|(name, edge)| (name, Bound::Buffer(edge.resource))),
            );
            let counters = counters.resource;
            // The first one finds the barriers above, each other one waits for the one before.
            let mut step = |pipeline: &ComputePipeline, threads| {
                let steps = [&order.spans, counters].map(|buffer| buffer.from(Access::ComputeWrite));
                cmd.barriers(steps.map(|edge| edge.to(Access::ComputeWrite)));
                cmd.dispatch(pipeline, &[], &pipeline.interface.own(&bound), pipeline.groups(threads))
            };
            step(&self.count, self.threads)?;
            step(&self.spans, [self.material_count, 1, 1])?;
            step(&self.place, self.threads)
        })
    }
}
