//! Decals: BLEND surfaces whose normals are blended into those of what they lie on, which is then lit once for both. Kircher
//! 2009, section 5.2: numbers in channels can be blended, words of bits cannot. Shaders: mesh.vert, decals.frag.
//! reads  the scene, geometry.dsf, geometry.depth      writes  geometry.normal
//!
//! A decal takes no layer of the stipple and is lit at all texels of the light buffer; its roughness and F0 are in no buffer,
//! so that highlights are those of what it lies on.

use super::choices::Choices;
use super::geometry::LowGeometry;
use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::structs::DecalParams;
use crate::gpu::shader::techniques::inferred_lighting::decals::FRAG_VARIANTS;
use crate::gpu::shader::{constants_of, variant};
use crate::gpu::{Access, Buffer, ColorTarget, Commands, Gpu, Traffic};
use crate::passes::{blend, mesh};
use crate::resident::{DrawCall, SceneGpu};
use crate::techniques::inferred_lighting::resources::NAME;
use bytemuck::Zeroable;
use std::sync::Arc;

/// Full name of the pass.
pub fn pass() -> String {
    format!("{NAME}.decals")
}

pub struct Decals {
    pipeline: GraphicsPipeline,
    /// Farthest first; at least one.
    calls: Vec<DrawCall>,
    depth_range_m: [f32; 2],
    depth_threshold: f32,
}

impl Decals {
    /// `calls`: at least one. `depth_range_m`: linear depth of the first step, and of all of them, metres.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        calls: Vec<DrawCall>,
        depth_range_m: [f32; 2],
        choices: &Choices,
    ) -> Result<Self> {
        let fragment = variant(FRAG_VARIANTS, &[mesh::vertex_name(scene)]);
        let mut constants = constants_of(&choices.geometry_constants(), &[Some(fragment)]);
        constants.push(scene.texture_constant());
        let pipeline = GraphicsPipeline::new(
            gpu,
            &GraphicsDescription {
                vertex: mesh::vertex_shader(scene),
                geometry: None,
                fragment: Some(fragment),
                constants: &constants,
                vertex_buffers: mesh::vertex_buffers(scene),
                color_formats: &[super::geometry::target_format(choices.packing)],
                samples: 1,
                are_placed: false,
                blending: Blending::Over,
                depth_format: Some(choices.depth_format()),
                depth_write: false,
                depth_compare: mesh::DEPTH_COMPARE,
                depth_clamp: false,
                depth_bias: blend::DECAL_BIAS,
                conservative_margin_px: None,
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        Ok(Self { pipeline, calls, depth_range_m, depth_threshold: choices.depth_threshold })
    }

    /// After the geometry pass. `frame`: the block of the light buffer's extent.
    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, scene: &SceneGpu, geometry: &LowGeometry) -> Result<()> {
        let params = |material: u32| DecalParams {
            material: scene.material_blocks[material as usize],
            first_depth_m: self.depth_range_m[0],
            depth_range_m: self.depth_range_m[1],
            depth_threshold: self.depth_threshold,
            ..DecalParams::zeroed()
        };
        cmd.pass(&pass(), Traffic::default(), |cmd| {
            cmd.barriers([
                geometry.normal.from(Access::ColorWrite).to(Access::ColorWrite),
                geometry.dsf.from(Access::ColorWrite).to(Access::FragmentSample),
                geometry.depth.from(Access::DepthWrite).to(Access::DepthTest),
            ]);
            let colors = [ColorTarget::new(&geometry.normal, None)];
            cmd.begin_rendering(geometry.extent(), &colors, Some((&geometry.depth, None, Access::DepthTest)));
            mesh::bind_streams(cmd, scene);
            let mut bound = mesh::bound(frame, scene);
            bound.push(("geometry_dsf", geometry.sampled(&geometry.dsf, Access::FragmentSample)));
            cmd.bind_graphics(&self.pipeline, bytemuck::bytes_of(&params(self.calls[0].material)), &bound)?;
            let push = |material| cmd.push(&self.pipeline.interface, bytemuck::bytes_of(&params(material)));
            mesh::draw_with(cmd, &self.pipeline, scene, &self.calls, push);
            cmd.end_rendering();
            Ok(())
        })
    }
}
