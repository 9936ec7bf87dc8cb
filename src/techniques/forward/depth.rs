//! Depth pre-pass: the depth of solid surfaces, so that the material pass shades only what is seen. Shaders: mesh.vert and,
//! for MASK surfaces, depth.frag.
//! reads  the scene      writes  forward.depth.reversed  image, 4 B a sample

use super::NAME;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::structs::DepthParams;
use crate::gpu::shader::techniques::forward::depth::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image, Traffic};
use crate::passes::mesh;
use crate::resident::{DrawList, SceneGpu};
use ash::vk;
use std::sync::Arc;

pub const FORMAT: vk::Format = vk::Format::D32_SFLOAT;

pub struct Depth {
    opaque: GraphicsPipeline,
    mask: GraphicsPipeline,
}

impl Depth {
    pub fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, samples: u32) -> Result<Self> {
        let pipeline = |fragment| {
            GraphicsPipeline::new(
                gpu,
                &GraphicsDescription {
                    vertex: mesh::vertex_shader(scene),
                    geometry: None,
                    fragment,
                    constants: &[],
                    vertex_buffers: mesh::vertex_buffers(scene),
                    color_formats: &[],
                    samples,
                    blending: Blending::Replace,
                    depth_format: Some(FORMAT),
                    depth_write: true,
                    depth_compare: vk::CompareOp::GREATER,
                    depth_clamp: false,
                    depth_slope_bias: 0.0,
                    conservative: false,
                    stencil: None,
                    foreign_sets: &[scene.material_layout],
                },
            )
        };
        let mask = variant(FRAG_VARIANTS, &[mesh::vertex_name(scene)]);
        Ok(Self { opaque: pipeline(None)?, mask: pipeline(Some(mask))? })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        scene: &SceneGpu,
        list: &DrawList,
        depth: &Image,
    ) -> Result<()> {
        let traffic = Traffic {
            read_bytes: mesh::read_bytes(scene, list.calls()),
            written_bytes: depth.description.bytes(),
            invocations: None,
        };
        cmd.pass(&format!("{NAME}.depth"), traffic, |cmd| {
            cmd.barriers([depth.discard(Access::DepthWrite)]);
            cmd.begin_rendering(depth.description.extent, &[], Some((depth, Some(0.0), Access::DepthWrite)));
            mesh::bind_streams(cmd, scene);
            if !list.opaque.is_empty() {
                cmd.bind_graphics(&self.opaque, &[], &mesh::vertex_bound(frame, scene))?;
                mesh::draw_with(cmd, &self.opaque, scene, &list.opaque, |_| ());
            }
            if !list.mask.is_empty() {
                let params = |material: u32| DepthParams { material: scene.material_blocks[material as usize] };
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
