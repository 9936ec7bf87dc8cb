//! Drawing the triangles of samples: by which stages, and how often.

use crate::gpu::Commands;
use crate::gpu::pipeline::GraphicsPipeline;
use crate::gpu::shader::techniques::deep_shading::visibility::sample::VERT_VARIANTS;
use crate::gpu::shader::{Shader, variant};
use crate::passes::mesh;
use crate::resident::{DrawCall, SceneGpu, Sides};
use crate::techniques::deep_shading::modes::vertices::Vertices;
use crate::techniques::deep_shading::pass_inputs::DrawInputs;
use crate::techniques::deep_shading::primitives;
use std::ops::Range;

/// How each draw call is repeated for its tuples.
pub struct Repeats {
    /// The call is repeated for every `step`th of them, whose number it gets.
    pub tuples: Range<u32>,
    pub step: u32,
    /// Instances of each of these draws. More than one: an instance is a tuple.
    pub instance_count: u32,
}

impl Repeats {
    /// How often a vertex is fetched.
    pub fn round_count(&self) -> u32 {
        (self.tuples.len() as u32).div_ceil(self.step) * self.instance_count
    }
}

/// Shader stages that triangles are drawn with.
pub struct SampleStages {
    pub vertex: &'static Shader,
    pub geometry: Option<&'static Shader>,
    pub sides: Option<Sides>,
    /// Vertices of a triangle.
    pub vertex_count: u32,
    /// The device draws by the scene's indices; or else shaders look them up.
    pub is_indexed: bool,
}

impl SampleStages {
    /// Stages that draw triangles as one tuple sees them.
    pub fn sharp(vertex: &'static Shader, geometry: Option<&'static Shader>, vertices: Vertices) -> Self {
        Self { vertex, geometry, sides: None, vertex_count: 3, is_indexed: vertices == Vertices::Indexed }
    }

    /// How many vertices a call has, and the first.
    pub fn vertices(&self, call: &DrawCall) -> [u32; 2] {
        [call.index_count, call.first_index].map(|indices| indices / 3 * self.vertex_count)
    }
}

/// The vertex stage for `scene`. `layer`: a value of its axis LAYER.
pub fn vertex_shader(scene: &SceneGpu, repeats: &Repeats, layer: &str, vertices: Vertices) -> &'static Shader {
    let tuple = if repeats.instance_count > 1 { "instance" } else { "pushed" };
    variant(VERT_VARIANTS, &[mesh::vertex_name(scene), tuple, layer, vertices.name()])
}

/// Draws `calls`: triangles one after the other as the index buffer has them.
pub fn draw<'a>(
    cmd: &Commands,
    pipeline: &GraphicsPipeline,
    stages: &SampleStages,
    inputs: DrawInputs<'_>,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    repeats: &Repeats,
) {
    let DrawInputs { scene, primitives, .. } = inputs;
    if stages.is_indexed {
        cmd.bind_indices(&scene.indices);
    }
    mesh::for_each(cmd, pipeline, scene, stages.sides, calls, |call| {
        let params = primitives.params(scene, call);
        let [count, first] = stages.vertices(call);
        for tuple in repeats.tuples.clone().step_by(repeats.step as usize) {
            cmd.push(&pipeline.interface, bytemuck::bytes_of(&primitives::of_tuple(params, tuple)));
            let (device, buffer, instances) = (&cmd.gpu().device, cmd.buffer(), repeats.instance_count);
            // SAFETY: the buffer is being recorded inside rendering; the importer checked that every index has its vertex.
            unsafe {
                if stages.is_indexed {
                    cmd.draw_indexed(first..first + count, call.vertex_offset, 0..instances);
                } else {
                    device.cmd_draw(buffer, count, instances, first, 0);
                }
            }
        }
    });
}
