//! The vertex stage that passes over triangles share, and the loop that draws with it. Shader: mesh.vert.
//! reads  scene.positions, scene.attributes, scene.extended (where the scene has it), scene.indices, scene.draws, the
//!        frame's block

use crate::gpu::pipeline::{GraphicsPipeline, VertexBuffer};
use crate::gpu::shader::passes::mesh::VERT_VARIANTS;
use crate::gpu::shader::{Shader, variant};
use crate::gpu::{Bound, Buffer, Commands};
use crate::resident::{DrawCall, DrawList, ExtendedAttributes, SceneGpu, Sides, VertexAttributes};
use ash::vk;
use std::mem::offset_of;

/// How passes over triangles compare reversed depths, those of `deep_shading` and of shadow maps excepted. Of several surfaces
/// in one place the last drawn is seen: so a pass that compares with `EQUAL` what a pre-pass left, in the same order, shows the
/// same ones.
pub const DEPTH_COMPARE: vk::CompareOp = vk::CompareOp::GREATER_OR_EQUAL;

/// Layout of the vertex streams; the last is the extended one.
const VERTEX_BUFFERS: [VertexBuffer; 3] = [
    VertexBuffer { stride_bytes: 12, attributes: &[(0, vk::Format::R32G32B32_SFLOAT, 0)] },
    VertexBuffer {
        stride_bytes: size_of::<VertexAttributes>() as u32,
        attributes: &[
            (1, vk::Format::R32G32B32_SFLOAT, offset_of!(VertexAttributes, normal) as u32),
            (2, vk::Format::R32G32B32A32_SFLOAT, offset_of!(VertexAttributes, tangent) as u32),
            (3, vk::Format::R32G32_SFLOAT, offset_of!(VertexAttributes, uv) as u32),
        ],
    },
    VertexBuffer {
        stride_bytes: size_of::<ExtendedAttributes>() as u32,
        attributes: &[
            (4, vk::Format::R32G32B32A32_SFLOAT, offset_of!(ExtendedAttributes, color) as u32),
            (5, vk::Format::R32G32_SFLOAT, offset_of!(ExtendedAttributes, uv_1) as u32),
        ],
    },
];

/// The stream of positions, for stages that read nothing else.
pub const POSITIONS: &[VertexBuffer] = &[VERTEX_BUFFERS[0]];

/// The streams that `scene` has.
pub fn vertex_buffers(scene: &SceneGpu) -> &'static [VertexBuffer] {
    if scene.extended.is_some() { &VERTEX_BUFFERS } else { &VERTEX_BUFFERS[..2] }
}

/// The value of the shaders' axis VERTEX.
pub fn vertex_name(scene: &SceneGpu) -> &'static str {
    if scene.extended.is_some() { "extended" } else { "plain" }
}

/// The vertex stage for `scene`.
pub fn vertex_shader(scene: &SceneGpu) -> &'static Shader {
    variant(VERT_VARIANTS, &[vertex_name(scene)])
}

/// Bindings of mesh.vert.
pub fn vertex_bound<'a>(frame: &'a Buffer, scene: &'a SceneGpu) -> [(&'static str, Bound<'a>); 2] {
    [("Frame", Bound::Buffer(frame)), ("Draws", Bound::Buffer(&scene.pose.draws))]
}

/// Bindings of mesh.vert, and those of material.glsl in set 0.
pub fn bound<'a>(frame: &'a Buffer, scene: &'a SceneGpu) -> Vec<(&'static str, Bound<'a>)> {
    let mut bound = vertex_bound(frame, scene).to_vec();
    bound.extend(scene.extended.as_ref().map(|extended| ("Placements", Bound::Buffer(&extended.placements))));
    bound
}

/// Bytes of indices, 4 each, and of each index's vertex in `streams` once.
fn stream_bytes<'a>(streams: &[VertexBuffer], calls: impl IntoIterator<Item = &'a DrawCall>) -> u64 {
    let vertex: u64 = streams.iter().map(|stream| u64::from(stream.stride_bytes)).sum();
    calls.into_iter().map(|call| u64::from(call.index_count) * (4 + vertex)).sum()
}

/// Bytes that a pass over `calls` reads of the scene.
pub fn read_bytes<'a>(scene: &SceneGpu, calls: impl IntoIterator<Item = &'a DrawCall>) -> u64 {
    stream_bytes(vertex_buffers(scene), calls)
}

/// Bytes that a pass reads which writes depth alone: positions. None where something has holes, which are looked up in textures.
pub fn depth_bytes(list: &DrawList) -> Option<u64> {
    list.mask.is_empty().then(|| stream_bytes(POSITIONS, &list.opaque))
}

/// Binds the scene's streams, inside rendering.
pub fn bind_streams(cmd: &Commands, scene: &SceneGpu) {
    let extended = scene.extended.as_ref().map(|extended| &extended.attributes);
    let streams: Vec<&Buffer> =
        [&scene.pose.positions, &scene.pose.attributes].into_iter().chain(extended).map(AsRef::as_ref).collect();
    cmd.bind_streams(&streams);
    cmd.bind_indices(&scene.indices);
}

/// Draws `calls` with `pipeline`, which is bound, setting sides, winding and material where they change; `changed` is told
/// each material before the draws that follow with it.
pub fn draw_with<'a>(
    cmd: &Commands,
    pipeline: &GraphicsPipeline,
    scene: &SceneGpu,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    changed: impl Fn(u32),
) {
    let mut known = None;
    draw_each(cmd, pipeline, scene, calls, |call| {
        if known != Some(call.material) {
            known = Some(call.material);
            changed(call.material);
        }
    });
}

/// The same; `before` is called with each draw before it is recorded.
pub fn draw_each<'a>(
    cmd: &Commands,
    pipeline: &GraphicsPipeline,
    scene: &SceneGpu,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    mut before: impl FnMut(&DrawCall),
) {
    for_each(cmd, pipeline, scene, None, calls, |call| {
        before(call);
        let DrawCall { index_count, first_index, vertex_offset, draw, .. } = *call;
        let indices = first_index..first_index + index_count;
        // SAFETY: the importer checked that every index has its vertex.
        unsafe { cmd.draw_indexed(indices, vertex_offset, draw..draw + 1) };
    });
}

/// Sets sides, winding and material where they change, and lets `draw` draw each call. `sides`: those of every call, if not its
/// own.
pub fn for_each<'a>(
    cmd: &Commands,
    pipeline: &GraphicsPipeline,
    scene: &SceneGpu,
    sides: Option<Sides>,
    calls: impl IntoIterator<Item = &'a DrawCall>,
    mut draw: impl FnMut(&DrawCall),
) {
    let device = &cmd.gpu().device;
    let buffer = cmd.buffer();
    let mut state: Option<(Sides, bool)> = None;
    let mut material = None;
    for call in calls {
        let sides = sides.unwrap_or(call.sides);
        if state != Some((sides, call.mirrored)) {
            state = Some((sides, call.mirrored));
            let cull = match sides {
                Sides::Fronts => vk::CullModeFlags::BACK,
                Sides::Backs => vk::CullModeFlags::FRONT,
                Sides::Both => vk::CullModeFlags::NONE,
            };
            // glTF's front faces are counter-clockwise; y is turned in clip space, so they arrive as such.
            let front = if call.mirrored { vk::FrontFace::CLOCKWISE } else { vk::FrontFace::COUNTER_CLOCKWISE };
            // SAFETY: the buffer is being recorded inside rendering.
            unsafe {
                device.cmd_set_cull_mode(buffer, cull);
                device.cmd_set_front_face(buffer, front);
            }
        }
        if material != Some(call.material) {
            material = Some(call.material);
            let set = [scene.material_sets[call.material as usize]];
            let layout = pipeline.interface.layout;
            // SAFETY: as above; the pipeline's set 1 is the scene's layout.
            unsafe {
                device.cmd_bind_descriptor_sets(buffer, vk::PipelineBindPoint::GRAPHICS, layout, 1, &set, &[]);
            }
        }
        draw(call);
    }
}
