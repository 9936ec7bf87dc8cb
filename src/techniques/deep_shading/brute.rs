//! Samples shaded where they are seen, each by itself, at their shading points: all of them (`--lists none`, the oracle), or
//! those that shading space has no place for or whose list is full (pass `strays`). Shaders: the vertex stage of visibility,
//! brute.frag.
//! reads  the scene, its lights, visibility.spids, visibility.depth, the lists      writes  shade.colors

use super::choices::Choices;
use super::full;
use super::lists::Lists;
use super::plan::DEPTH_FORMAT;
use super::primitives::Primitives;
use super::visibility::{Samples, sample};
use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::brute::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Barrier, Bound, Buffer, Commands, Gpu, Layers, Traffic};
use crate::passes::{mesh, shadow_maps};
use crate::resident::{DrawList, SceneGpu};
use ash::vk;
use std::sync::Arc;

pub struct Brute {
    pipeline: GraphicsPipeline,
    stages: sample::Stages,
    name: &'static str,
}

impl Brute {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, choices: &Choices) -> Result<Self> {
        let samples = match choices {
            Choices { has_lists: false, .. } => "all",
            Choices { is_compacted: true, .. } => "compact",
            _ => "linked",
        };
        let stages = sample::stages(scene, choices);
        let vertex = stages.vertex;
        // Depths that a shader wrote are not the polygons'. The SPIDs alone say what is seen: a triangle covers a sample once.
        let (visibility, depth_compare) = if choices.is_stochastic {
            ("stochastic", vk::CompareOp::ALWAYS)
        } else {
            ("interleaved", vk::CompareOp::EQUAL)
        };
        let shadows = shadow_maps::axis(choices.maps.is_some());
        let fragment = variant(FRAG_VARIANTS, &[samples, mesh::vertex_name(scene), shadows, visibility]);
        let constants = super::constants_of(choices, &[Some(vertex), Some(fragment)]);
        let pipeline = GraphicsPipeline::new(
            gpu,
            &GraphicsDescription {
                vertex,
                geometry: None,
                fragment: Some(fragment),
                constants: &constants,
                vertex_buffers: &[],
                color_formats: &[],
                samples: 1,
                blending: Blending::Replace,
                depth_format: Some(DEPTH_FORMAT),
                depth_write: false,
                depth_compare,
                depth_clamp: false,
                depth_slope_bias: 0.0,
                conservative: false,
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        Ok(Self { pipeline, stages, name: choices.brute_pass() })
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
        samples: &Samples,
        (lists, maps): (Option<&Lists>, Option<Barrier>),
        colors: &Buffer,
        counters: &Buffer,
    ) -> Result<()> {
        let description = samples.spids.description;
        let traffic = Traffic {
            read_bytes: u64::from(description.layers()) * mesh::read_bytes(scene, list.calls()) + description.bytes(),
            // Counted after the frame.
            written_bytes: 0,
            invocations: None,
        };
        cmd.pass(&full(self.name), traffic, |cmd| {
            cmd.barriers(maps);
            cmd.barriers([counters.from(Access::FragmentWrite).to(Access::FragmentWrite)]);
            let spids_left = if let Some(lists) = lists {
                cmd.barriers([colors.from(Access::FragmentWrite).to(Access::FragmentWrite)]);
                lists.links_to(cmd, Access::ComputeRead | Access::GraphicsRead, Access::GraphicsRead);
                // Compute shaders read them first: what drew them was waited for by those alone.
                Access::ComputeSample | Access::ColorWrite
            } else {
                cmd.barriers([colors.discard(Access::TransferWrite)]);
                cmd.clear(colors);
                cmd.barriers([colors.from(Access::TransferWrite).to(Access::FragmentWrite)]);
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
            for tuple in 0..description.layers() {
                let depth = (&samples.depth, None, Access::DepthTest);
                cmd.begin_layers(description.extent, Layers::One(tuple), &[], Some(depth));
                cmd.bind_with_set(&self.pipeline, bytemuck::bytes_of(&primitives.params(scene, first)), set);
                sample::draw(cmd, (&self.pipeline, &self.stages), scene, primitives, list.calls(), tuple);
                cmd.end_rendering();
            }
            Ok(())
        })
    }
}
