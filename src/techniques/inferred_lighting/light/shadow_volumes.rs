//! Stencil shadow volumes of chosen lights, in the light pass before each of them. Kircher & Lawrance 2009, sections 4 and
//! 7: what is drawn into the light buffer's depth is in shadow or not, be it solid or one of several layers of stippled glass.
//! Shaders: shadow_volumes.vert; then fullscreen.vert and volumes.frag, which casts no ray for these lights.
//! reads  light.shadow_volumes.positions, light.shadow_volumes.triangles, geometry.depth
//!
//! Volumes are made on the host (lights/shadow_casters.rs) and counted by the depth-fail test: their faces behind a surface,
//! backs up and fronts down, which is right with the eye inside of a shadow too. Depth is clamped, so that they go on beyond
//! the far plane. Eight bits count around: 256 shadows one in the other would be none. The light adds where the count is 0 and
//! leaves the stencil at 0 everywhere.
//!
//! Why this way: the front cap is the lit surface itself, and two shaders do not round one place to the same bits. All
//! volumes are moved away from the eye, so that a lit surface is in front of its own cap: by shadow_volumes.vert's AWAY of
//! the distance, and by a part of what a pixel's step changes depth by, because corners are rounded to parts of pixels too.

use crate::error::Result;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline, StencilUse, VertexBuffer};
use crate::gpu::shader::techniques::inferred_lighting::light::shadow_volumes::VERT;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, upload};
use crate::lights::shadow_casters::{CastingLight, ShadowCasters};
use crate::memory::kinds::Use;
use crate::passes::direct::DirectGpu;
use crate::plan::{Plan, Resources, Shape};
use crate::settings::DirectShadow;
use crate::techniques::inferred_lighting::resources::NAME;
use ash::vk;
use std::sync::Arc;

/// A homogeneous position a vertex.
const VERTEX_BUFFERS: [VertexBuffer; 1] =
    [VertexBuffer { stride_bytes: 16, attributes: &[(0, vk::Format::R32G32B32A32_SFLOAT, 0)] }];

/// Depth is reversed: less is farther. Devices round corners to a 256th of a pixel or finer, both here and in the geometry
/// pass; this is some times as much.
const BIAS: DepthBias = DepthBias { slope: -1.0 / 32.0, ..DepthBias::NONE };

/// The host's part, as reports name it, and what its resources' names begin with.
pub fn pass() -> String {
    format!("{NAME}.light.shadow_volumes")
}

/// Plans the volumes' buffers.
pub fn plan(plan: &mut Plan, casters: &ShadowCasters) {
    let buffer = |bytes: usize, flags: vk::BufferUsageFlags| Shape::Buffer {
        bytes: (bytes as u64).max(16),
        flags: flags | vk::BufferUsageFlags::TRANSFER_DST,
        usage: Use::Device,
    };
    let positions = buffer(size_of_val(casters.positions.as_slice()), vk::BufferUsageFlags::VERTEX_BUFFER);
    plan.push("shadow-volumes", format!("{}.positions", pass()), positions);
    let triangles = buffer(size_of_val(casters.triangles.as_slice()), vk::BufferUsageFlags::INDEX_BUFFER);
    plan.push("shadow-volumes", format!("{}.triangles", pass()), triangles);
}

/// Descriptor sets of the two pipelines.
#[derive(Clone, Copy)]
pub struct Sets {
    count: Option<vk::DescriptorSet>,
    light: Option<vk::DescriptorSet>,
}

pub struct ShadowVolumes {
    count: GraphicsPipeline,
    light: GraphicsPipeline,
    positions: Buffer,
    triangles: Buffer,
}

impl ShadowVolumes {
    /// Takes out what `plan` put in, and uploads `casters`. `light`: how lights are drawn without a stencil.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        casters: &ShadowCasters,
        light: &GraphicsDescription<'_>,
    ) -> Result<Self> {
        let mut filled = |what: &str, bytes: &[u8]| {
            let buffer = resources.buffer(&format!("{}.{what}", pass()));
            upload::buffer(gpu, &buffer, bytes, Access::VertexRead)?;
            Ok(buffer)
        };
        let mut constants = light.constants.to_vec();
        let traced = constants.iter_mut().filter(|(name, _)| *name == "DIRECT_SHADOW");
        traced.for_each(|(_, value)| *value = DirectShadow::None as u32);
        let lit = GraphicsDescription { constants: &constants, stencil: Some(StencilUse::LeaveUnequal), ..*light };
        let count = GraphicsDescription {
            vertex: &VERT,
            fragment: None,
            constants: &[],
            vertex_buffers: &VERTEX_BUFFERS,
            blending: Blending::Keep,
            depth_compare: vk::CompareOp::GREATER,
            depth_clamp: true,
            depth_bias: BIAS,
            stencil: Some(StencilUse::CountBehind),
            ..*light
        };
        Ok(Self {
            count: GraphicsPipeline::new(gpu, &count)?,
            light: GraphicsPipeline::new(gpu, &lit)?,
            positions: filled("positions", bytemuck::cast_slice(&casters.positions))?,
            triangles: filled("triangles", bytemuck::cast_slice(&casters.triangles))?,
        })
    }

    /// What `draw` binds. `bound`: what lights read.
    pub fn sets(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        frame: &Buffer,
        lights: &DirectGpu,
    ) -> Result<Sets> {
        let places = [("Frame", Bound::Buffer(frame)), ("Lights", Bound::Buffer(&lights.lights))];
        Ok(Sets { count: cmd.set_for(&self.count, &places)?, light: cmd.set_for(&self.light, bound)? })
    }

    /// Counts a light's volumes inside the scissor and binds what draws it where none is, inside rendering into a stencil
    /// of 0. `params`: the light's.
    pub fn draw(&self, cmd: &mut Commands, casting: &CastingLight, sets: Sets, params: &[u8]) {
        cmd.bind_with_set(&self.count, params, sets.count);
        cmd.set_stencil(0, 0xff);
        let index_count = 3 * casting.triangles.len() as u32;
        let (device, buffer) = (&cmd.gpu().device, cmd.buffer());
        cmd.bind_streams(&[&self.positions]);
        cmd.bind_indices(&self.triangles);
        // SAFETY: the buffer is being recorded inside rendering; `ShadowCasters` has every index below its light's positions.
        unsafe {
            device.cmd_set_cull_mode(buffer, vk::CullModeFlags::NONE);
            device.cmd_set_front_face(buffer, vk::FrontFace::COUNTER_CLOCKWISE);
            let (first_index, first_position) = (3 * casting.triangles.start, casting.first_position as i32);
            cmd.draw_indexed(first_index..first_index + index_count, first_position, 0..1);
        }
        cmd.bind_with_set(&self.light, params, sets.light);
        cmd.set_stencil(0, 0xff);
    }
}
