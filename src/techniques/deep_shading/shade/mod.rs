//! Shade, with `--shade-by fragment`: all triangles once over shading space, every pixel that they touch; what the lists have
//! is shaded and stored (Clarberg & Munkberg 2014, section 4.4). Shaders: shade.frag, and the vertex and geometry stages of
//! the methods. With `--zmax on` lists.zmax is the draws' depth buffer, which hides what lies behind all that was seen.
//! reads   the scene, its lights, the lists, lists.zmax, lists.marks
//! writes  shade.colors   buffer, 8 B a sample: RGBA16F
//!         shade.depth    D32_SFLOAT, with `--zmax on`: lists.zmax

pub mod corner;
pub mod geometry;
pub(super) mod stages;
pub mod vertex;

use super::choices::{Choices, RasterChoices};
use super::lists::ListsEdge;
use super::pass_inputs::{DrawInputs, ShadingEdges};
use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::shade::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Commands, Gpu, Image, Traffic};
use crate::passes::mesh;
use crate::passes::shadow_maps;
use crate::plan::Resources;
use crate::resident::{SceneGpu, Sides};
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::modes::barycentrics::Barycentrics;
use crate::techniques::deep_shading::modes::conservative::Conservative;
use crate::techniques::deep_shading::resources::{DEPTH_FORMAT, SHADE_DEPTH, full};
use crate::techniques::deep_shading::shade::stages::SpaceStages;
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

fn stages_of(choices: &RasterChoices, marks: &str) -> SpaceStages {
    let weights = if choices.barycentrics == Barycentrics::Interpolated { "on" } else { "off" };
    match choices.conservative {
        Conservative::Hardware => corner::stages(true, marks, weights),
        Conservative::Geometry => geometry::stages(marks),
        Conservative::Vertex => vertex::stages(marks),
        Conservative::Plain => corner::stages(false, marks, weights),
    }
}

pub struct Shade {
    pipeline: GraphicsPipeline,
    stages: SpaceStages,
    space: Extent,
    /// With `--zmax on`.
    depth: Option<Image>,
}

impl Shade {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let lists = if choices.lists.is_compacted { "compact" } else { "linked" };
        let stages = stages_of(&choices.raster, if choices.lists.has_marks { "on" } else { "off" });
        let shadows = shadow_maps::axis(choices.maps.is_some());
        let axes = [lists, mesh::vertex_name(scene), shadows, choices.raster.barycentrics.name()];
        let fragment = variant(FRAG_VARIANTS, &axes);
        let shaders = [Some(stages.vertex), stages.geometry, Some(fragment)];
        let depth = choices.lists.has_zmax.then(|| resources.image(&full(SHADE_DEPTH)));
        let mut constants = constants_of(choices, &shaders);
        if !stages.has_hulls {
            constants.push(("HAS_ONE_DEPTH", u32::from(depth.is_some())));
        }
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
                are_placed: false,
                blending: Blending::Replace,
                depth_format: depth.is_some().then_some(DEPTH_FORMAT),
                depth_write: false,
                depth_compare: vk::CompareOp::GREATER_OR_EQUAL,
                depth_clamp: false,
                depth_bias: DepthBias::NONE,
                conservative_margin_px: stages.is_conservative.then(|| choices.snap_px()),
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        Ok(Self { pipeline, stages, space: choices.space.extent, depth })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        listed: ListsEdge<'_>,
        edges: ShadingEdges<'_>,
    ) -> Result<()> {
        let DrawInputs { scene, list, primitives, .. } = inputs;
        let (ShadingEdges { colors, counters, maps }, lists) = (edges, listed.lists);
        // Fragments that find their triangle in a list are counted after the frame.
        cmd.pass(&full("shade"), Traffic::default(), |cmd| {
            cmd.barriers(inputs.scales_to(Access::GraphicsRead));
            cmd.barriers(maps.and_then(|maps| maps.to(Access::FragmentSample)));
            cmd.barriers(listed.links_to(Access::GraphicsRead));
            cmd.barriers(listed.marks_to(Access::GraphicsRead));
            if let (Some(zmax), Some(depth)) = (&lists.zmax, &self.depth) {
                cmd.barriers(listed.zmax_to(Access::TransferRead));
                cmd.barriers([depth.discard(Access::TransferWrite)]);
                cmd.copy_to_image(zmax, depth);
                cmd.barriers([depth.from(Access::TransferWrite).to(Access::DepthTest)]);
            }
            cmd.barriers([colors, counters].map(|edge| edge.to(Access::FragmentWrite)));
            let mut bound = inputs.bound.to_vec();
            bound.extend(lists.bound());
            bound.extend(
                [("Colors", colors), ("Counters", counters)].map(|(name, edge)| (name, Bound::Buffer(edge.resource))),
            );
            let set = cmd.set_for(&self.pipeline, &self.pipeline.interface.own(&bound))?;
            cmd.begin_rendering(self.space, &[], self.depth.as_ref().map(|depth| (depth, None, Access::DepthTest)));
            let Some(first) = list.calls().next() else {
                cmd.end_rendering();
                return Ok(());
            };
            cmd.bind_with_set(&self.pipeline, bytemuck::bytes_of(&primitives.params(scene, first)), set);
            // A triangle whose back faces the middle of the lens may show its front to the rim.
            mesh::for_each(cmd, &self.pipeline, scene, Some(Sides::Both), list.calls(), |call| {
                cmd.push(&self.pipeline.interface, bytemuck::bytes_of(&primitives.params(scene, call)));
                let of = |indices: u32| indices / 3 * self.stages.vertex_count;
                let (count, first) = (of(call.index_count), of(call.first_index));
                // SAFETY: the buffer is being recorded inside rendering; the importer checked that every index has its vertex.
                unsafe { cmd.gpu().device.cmd_draw(cmd.buffer(), count, 1, first, 0) };
            });
            cmd.end_rendering();
            Ok(())
        })
    }
}
