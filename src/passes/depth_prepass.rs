//! Depth pre-pass: the depth of solid surfaces, so that the pass with their materials shades only what is seen. Shaders:
//! depth_prepass.vert, and for MASK surfaces mesh.vert and depth_prepass.frag.
//! reads  the scene, of opaque surfaces positions alone      writes  a depth buffer, reversed, 4 B a sample
//!
//! The pass that shades draws its lists in the same order, nearest first, by "equal" with this one and by "nearer or as near"
//! without it (`mesh::DEPTH_COMPARE`). So it shows the same surface of several at the same depth: the last one drawn.

use super::mesh;
use super::samples::Samples;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, Constants, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::passes::depth_prepass::{FRAG_VARIANTS, VERT};
use crate::gpu::shader::structs::DepthPrepassParams;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Barrier, Buffer, Commands, Gpu, Image, Traffic};
use crate::resident::{DrawList, SceneGpu};
use ash::vk;
use std::sync::Arc;

/// Full name of a technique's pass.
pub fn pass(technique: &str) -> String {
    format!("{technique}.depth")
}

/// How a pass over the same surfaces compares depths.
pub fn compare(has_prepass: bool) -> vk::CompareOp {
    if has_prepass { vk::CompareOp::EQUAL } else { mesh::DEPTH_COMPARE }
}

/// How it holds the depth buffer.
pub fn access(has_prepass: bool) -> Access {
    if has_prepass { Access::DepthTest } else { Access::DepthWrite }
}

/// What a depth buffer holds before the first of the passes.
#[derive(Clone, Copy)]
pub enum DepthBegins {
    /// The far plane, everywhere.
    Far,
    /// What an earlier pass wrote as `Access::DepthWrite`: nothing is drawn where it is nearer.
    Written,
}

impl DepthBegins {
    fn barrier(self, depth: &Image) -> Barrier {
        match self {
            Self::Far => depth.discard(Access::DepthWrite),
            Self::Written => depth.from(Access::DepthWrite).to(Access::DepthWrite),
        }
    }

    fn clear(self) -> Option<f32> {
        matches!(self, Self::Far).then_some(0.0)
    }
}

/// The depth buffer as that pass attaches it, behind its barrier.
pub fn attach<'a>(
    cmd: &mut Commands,
    depth: &'a Image,
    begins: DepthBegins,
    has_prepass: bool,
) -> (&'a Image, Option<f32>, Access) {
    cmd.barriers([match has_prepass {
        true => depth.from(Access::DepthWrite).to(Access::DepthTest),
        false => begins.barrier(depth),
    }]);
    (depth, if has_prepass { None } else { begins.clear() }, access(has_prepass))
}

pub const FORMAT: vk::Format = vk::Format::D32_SFLOAT;

pub struct DepthPrepass {
    opaque: GraphicsPipeline,
    mask: GraphicsPipeline,
}

impl DepthPrepass {
    /// `levels`: constants of the levels of textures, as the pass with the materials has them: holes are then where it has them.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, samples: Samples, levels: Constants<'_>) -> Result<Self> {
        let pipeline = |(vertex, vertex_buffers), fragment, constants| {
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex,
                    geometry: None,
                    fragment,
                    constants,
                    vertex_buffers,
                    color_formats: &[],
                    samples: samples.count,
                    are_placed: samples.are_placed,
                    blending: Blending::Replace,
                    depth_format: Some(FORMAT),
                    depth_write: true,
                    depth_compare: vk::CompareOp::GREATER,
                    depth_clamp: false,
                    depth_bias: DepthBias::NONE,
                    conservative_margin_px: None,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        let mask = variant(FRAG_VARIANTS, &[mesh::vertex_name(scene), samples.shaded_name()]);
        let with_holes = (mesh::vertex_shader(scene), mesh::vertex_buffers(scene));
        Ok(Self {
            opaque: pipeline((&VERT, mesh::POSITIONS), None, &[])?,
            mask: pipeline(with_holes, Some(mask), &[levels, &[scene.texture_constant()]].concat())?,
        })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        technique: &str,
        frame: &Buffer,
        scene: &SceneGpu,
        list: &DrawList,
        (depth, begins): (&Image, DepthBegins),
    ) -> Result<()> {
        let traffic = Traffic {
            read_bytes: mesh::depth_bytes(list),
            written_bytes: Some(depth.description.bytes()),
            invocations: None,
        };
        cmd.pass(&pass(technique), traffic, |cmd| {
            cmd.barriers([begins.barrier(depth)]);
            cmd.begin_rendering(depth.description.extent, &[], Some((depth, begins.clear(), Access::DepthWrite)));
            mesh::bind_streams(cmd, scene);
            if !list.opaque.is_empty() {
                cmd.bind_graphics(&self.opaque, &[], &mesh::vertex_bound(frame, scene))?;
                mesh::draw_with(cmd, &self.opaque, scene, &list.opaque, |_| ());
            }
            if !list.mask.is_empty() {
                let params = |material: u32| DepthPrepassParams { material: scene.material_blocks[material as usize] };
                let first = params(list.mask[0].material);
                cmd.bind_graphics(&self.mask, bytemuck::bytes_of(&first), &mesh::bound(frame, scene))?;
                let push = |material| cmd.push(&self.mask.interface, bytemuck::bytes_of(&params(material)));
                mesh::draw_with(cmd, &self.mask, scene, &list.mask, push);
            }
            cmd.end_rendering();
            Ok(())
        })
    }
}
