//! Samples shaded where they are seen, each by itself, at their shading points: all of them (`--lists none`, the oracle), or
//! those that shading space has no place for or whose list is full (pass `strays`). Shaders: those before fragments of
//! visibility, brute.frag.
//! reads  the scene, its lights, visibility.spids, visibility.depth, the lists      writes  shade.colors

use super::choices::Choices;
use super::full;
use super::gate::Gate;
use super::lists::Lists;
use super::plan::DEPTH_FORMAT;
use super::primitives::Primitives;
use super::visibility::{self, Samples, Visibility, sample};
use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::brute::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, AccessSet, Barrier, Bound, Buffer, Commands, Gpu, Traffic};
use crate::passes::{mesh, shadow_maps};
use crate::plan::Resources;
use crate::resident::{DrawList, SceneGpu};
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

pub struct Brute {
    pipeline: GraphicsPipeline,
    stages: sample::Stages,
    gate: Option<Gate>,
    visibility: Visibility,
    /// One, and how many of them.
    layers: (Extent, u32),
    name: &'static str,
}

impl Brute {
    /// `frame`: its extent.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        frame: Extent,
    ) -> Result<Self> {
        let samples = match choices {
            Choices { has_lists: false, .. } => "all",
            Choices { is_direct: true, .. } => "direct",
            Choices { is_compacted: true, .. } => "compact",
            _ => "linked",
        };
        let repeats = choices.visibility.repeats(scene, &gpu.caps.limits, choices.table.tuple_count());
        let stages = visibility::stages(scene, choices, &repeats);
        // Polygons have no depth that samples have. The SPIDs alone say what is seen: a triangle covers a sample once.
        let has_polygons = choices.visibility.has_polygons();
        let visibility = if has_polygons { "stochastic" } else { "interleaved" };
        let shadows = shadow_maps::axis(choices.maps.is_some());
        let fragment = variant(FRAG_VARIANTS, &[samples, mesh::vertex_name(scene), shadows, visibility]);
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
                depth_format: (!has_polygons).then_some(DEPTH_FORMAT),
                depth_write: false,
                depth_compare: vk::CompareOp::EQUAL,
                depth_clamp: false,
                depth_slope_bias: 0.0,
                conservative: false,
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        let gate = if choices.is_gated { Some(Gate::new(gpu, resources, scene, (&stages, &repeats))?) } else { None };
        let layers = (choices.table.layer(frame), choices.table.tuple_count());
        Ok(Self { pipeline, stages, gate, visibility: choices.visibility, layers, name: choices.brute_pass() })
    }

    /// The lists of which these are the strays; the barrier of the shadow maps.
    #[allow(clippy::too_many_arguments)]
    pub fn record(
        &self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        list: &DrawList,
        primitives: &Primitives,
        bound: &[(&'static str, Bound<'_>)],
        samples: Option<&Samples>,
        (lists, maps): (Option<&Lists>, Option<Barrier>),
        colors: &Buffer,
        counters: &Buffer,
    ) -> Result<()> {
        let (layer, layers) = self.layers;
        let repeats = self.visibility.repeats(scene, &cmd.gpu().caps.limits, layers);
        let rounds = self.visibility.round_count(&repeats, layers);
        let traffic = Traffic {
            read_bytes: u64::from(rounds) * mesh::read_bytes(scene, list.calls())
                + samples.map_or(0, |samples| samples.spids.description.bytes()),
            // Counted after the frame.
            written_bytes: 0,
            invocations: None,
        };
        cmd.pass(&full(self.name), traffic, |cmd| {
            cmd.barriers(maps);
            match &self.gate {
                Some(gate) => gate.record(cmd, counters),
                None => cmd.barriers([counters.from(Access::FragmentWrite).to(Access::FragmentWrite)]),
            }
            if let Some(lists) = lists {
                cmd.barriers([colors.from(Access::FragmentWrite).to(Access::FragmentWrite)]);
                lists.links_to(cmd, Access::ComputeRead | Access::GraphicsRead, Access::GraphicsRead);
            } else {
                cmd.barriers([colors.discard(Access::TransferWrite)]);
                cmd.clear(colors);
                cmd.barriers([colors.from(Access::TransferWrite).to(Access::FragmentWrite)]);
            }
            if let Some(samples) = samples {
                // With lists compute shaders read them first: what wrote them was waited for by those alone.
                let left = match lists {
                    Some(_) => Access::ComputeSample | samples.written,
                    None => AccessSet::from(samples.written),
                };
                cmd.barriers([samples.spids.from(left).to(Access::FragmentSample)]);
            } else {
                let addresses = lists.and_then(|lists| lists.addresses.as_ref());
                cmd.barriers(addresses.map(|addresses| addresses.from(Access::ComputeWrite).to(Access::GraphicsRead)));
            }
            let depth = samples.and_then(|samples| samples.depth.as_ref()).filter(|_| !self.visibility.has_polygons());
            cmd.barriers(depth.map(|depth| depth.from(Access::DepthWrite).to(Access::DepthTest)));
            let mut bound = bound.to_vec();
            bound.extend(lists.map(Lists::bound).into_iter().flatten());
            bound.extend([("Colors", Bound::Buffer(colors)), ("Counters", Bound::Buffer(counters))]);
            let spids = samples.map(|samples| samples.sampled(&samples.spids, Access::FragmentSample));
            bound.extend(spids.map(|spids| ("spids", spids)));
            let set = cmd.set_for(&self.pipeline, &self.pipeline.interface.own(&bound))?;
            let Some(first) = list.calls().next() else { return Ok(()) };
            self.visibility.for_layers(&repeats, layers, |at, repeats| {
                let depth = depth.map(|depth| (depth, None, Access::DepthTest));
                cmd.begin_layers(layer, at, &[], depth);
                cmd.bind_with_set(&self.pipeline, bytemuck::bytes_of(&primitives.params(scene, first)), set);
                if let Some(gate) = &self.gate {
                    let drawn = (&self.pipeline, self.stages.sides);
                    sample::draw_by(cmd, drawn, scene, primitives, &scene.calls, repeats, |call| {
                        gate.draw(cmd, call.draw);
                    });
                } else {
                    sample::draw(cmd, (&self.pipeline, &self.stages), scene, primitives, list.calls(), repeats);
                }
                cmd.end_rendering();
            });
            Ok(())
        })
    }
}
