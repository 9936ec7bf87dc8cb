//! Samples shaded where they are seen, each by itself, at their shading points: all of them (`--lists none`, the oracle), or
//! those that shading space has no place for (pass `strays`). Shaders: those before fragments
//! of visibility, brute.frag.
//! reads  the scene, its lights, visibility.spids, visibility.depth      writes  shade.colors

use super::choices::Choices;
use super::full;
use super::lists::Lists;
use super::plan::DEPTH_FORMAT;
use super::primitives::Primitives;
use super::visibility::{Order, Samples, sample};
use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::brute::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Traffic};
use crate::passes::mesh;
use crate::resident::{DrawList, SceneGpu};
use ash::vk;
use std::sync::Arc;

pub struct Brute {
    pipeline: GraphicsPipeline,
    name: &'static str,
    order: Order,
}

impl Brute {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, choices: &Choices) -> Result<Self> {
        let samples = if choices.has_lists { "strays" } else { "all" };
        let repeats = choices.order.repeats(scene, &gpu.caps.limits, choices.table.tuple_count());
        let stages = choices.order.stages(scene, &repeats, choices.layer_from);
        let fragment = variant(FRAG_VARIANTS, &[samples, mesh::vertex_name(scene)]);
        let constants = super::constants_of(choices, &[Some(stages.vertex), stages.geometry, Some(fragment)]);
        let pipeline = GraphicsPipeline::new(
            gpu,
            &GraphicsDescription {
                vertex: stages.vertex,
                geometry: stages.geometry,
                fragment: Some(fragment),
                constants: &constants,
                vertex_buffers: &[],
                color_formats: &[],
                samples: 1,
                blending: Blending::Replace,
                depth_format: Some(DEPTH_FORMAT),
                depth_write: false,
                depth_compare: vk::CompareOp::EQUAL,
                depth_clamp: false,
                depth_slope_bias: 0.0,
                conservative: false,
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        Ok(Self { pipeline, name: choices.brute_pass(), order: choices.order })
    }

    /// `lists`: of which these are the strays.
    #[allow(clippy::too_many_arguments)]
    pub fn record(
        &self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        list: &DrawList,
        primitives: &Primitives,
        bound: &[(&'static str, Bound<'_>)],
        samples: &Samples,
        lists: Option<&Lists>,
        colors: &Buffer,
        counters: &Buffer,
    ) -> Result<()> {
        let description = samples.spids.description;
        let layers = description.layers();
        let repeats = self.order.repeats(scene, &cmd.gpu().caps.limits, layers);
        let rounds = self.order.round_count(&repeats, layers);
        let traffic = Traffic {
            read_bytes: u64::from(rounds) * mesh::read_bytes(scene, list.calls()) + description.bytes(),
            // Counted after the frame.
            written_bytes: 0,
            invocations: None,
        };
        cmd.pass(&full(self.name), traffic, |cmd| {
            let written = [colors, counters];
            let spids_left = if let Some(lists) = lists {
                let from = Access::FragmentWrite;
                cmd.barriers(written.map(|buffer| buffer.from(from).to(Access::FragmentWrite)));
                cmd.barriers([lists.nodes.from(Access::ComputeRead | Access::GraphicsRead).to(Access::GraphicsRead)]);
                // Compute shaders read them first: what drew them was waited for by those alone.
                Access::ComputeSample | Access::ColorWrite
            } else {
                cmd.barriers(written.map(|buffer| buffer.discard(Access::TransferWrite)));
                written.iter().for_each(|buffer| cmd.clear(buffer));
                cmd.barriers(written.map(|buffer| buffer.from(Access::TransferWrite).to(Access::FragmentWrite)));
                Access::ColorWrite.into()
            };
            cmd.barriers([
                samples.spids.from(spids_left).to(Access::FragmentSample),
                samples.depth.from(Access::DepthWrite).to(Access::DepthTest),
            ]);
            let mut bound = bound.to_vec();
            bound.extend(lists.map(Lists::bound).into_iter().flatten());
            bound.extend([
                ("Colors", Bound::Buffer(colors)),
                ("Counters", Bound::Buffer(counters)),
                ("spids", samples.sampled(&samples.spids, Access::FragmentSample)),
            ]);
            let set = cmd.set_for(&self.pipeline, &self.pipeline.interface.own(&bound))?;
            let Some(first) = list.calls().next() else { return Ok(()) };
            self.order.for_layers(&repeats, layers, |at, repeats| {
                let depth = (&samples.depth, None, Access::DepthTest);
                cmd.begin_layers(description.extent, at, &[], Some(depth));
                cmd.bind_with_set(&self.pipeline, bytemuck::bytes_of(&primitives.params(scene, first)), set);
                sample::draw(cmd, &self.pipeline, scene, primitives, list.calls(), repeats);
                cmd.end_rendering();
            });
            Ok(())
        })
    }
}
